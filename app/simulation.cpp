#include "simulation.h"

#include "interrupt.h"
#include "message.h"
#include "progress.h"
#include "scene_file.h"
#include "scene_text.h"
#include "version.h"

#include "sim/simulate.h"

#include <fmt/format.h>

namespace app {

namespace {

SimulationReport simulate(const Settings& settings, const std::filesystem::path& path, bool resume, std::int64_t first_step,
                          const Options& options, const std::function<void()>& ready) {
  const sim::Scene& scene = settings.scene;
  sim::SimulationOptions how;
  how.trajectory = path;
  how.resume = resume;
  how.steps = options.steps ? std::max<std::int64_t>(0, *options.steps - first_step) : -1;
  how.scene_text = write_scene(settings);
  how.program = version();
  how.build = build();

  Progress progress("simulating", options.quiet);
  sim::SimulationObserver observer;
  observer.on_step = [&](const sim::Dynamics& d, const sim::StepRecord& record) {
    const double share = options.steps ? static_cast<double>(d.step) / static_cast<double>(*options.steps)
                                       : d.time / scene.time.end;
    progress.show(share, fmt::format("step {:.0f}, t = {:.4g}", record.step, record.time));
  };
  observer.on_warning = [&](const std::string& warning) {
    progress.clear();
    if (!options.quiet) tell(fmt::format("warning: {}", warning));
  };
  observer.on_ready = ready;
  observer.should_stop = [] { return interrupted(); };
  const sim::SimulationOutcome outcome = sim::simulate(scene, how, observer);

  SimulationReport report;
  const sim::TrajectoryReader reader(path);
  report.states = reader.count();
  report.time = outcome.time;
  report.interrupted = outcome.end == sim::SimulationEnd::interrupted;
  if (outcome.end == sim::SimulationEnd::failed) report.stopped = outcome.reason;
  return report;
}

}  // namespace

SimulationReport simulate_new(const Settings& settings, const std::filesystem::path& path, const Options& options,
                              const std::function<void()>& ready) {
  if (path.has_parent_path()) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error)
      throw std::runtime_error(fmt::format("cannot make folder '{}': {}", path.parent_path().string(), error.message()));
  }
  return simulate(settings, path, false, 0, options, ready);
}

SimulationReport simulate_further(const Settings& settings, const std::filesystem::path& path, const Options& options,
                                  const std::function<void()>& ready) {
  const sim::TrajectoryReader reader(path);
  const Settings there =
      parse_scene(reader.header().scene, path.string() + " (its scene)", path.parent_path(), {}, SceneUse::draw);
  if (physics_hash(there.scene) != physics_hash(settings.scene))
    throw std::runtime_error(fmt::format("'{}' belongs to another scene, '{}'", path.string(), there.scene.title));
  const std::int64_t states = reader.count();
  const double last = states > 0 ? reader.time(states - 1) : 0;
  const std::int64_t steps = sim::deserialised(reader.resume_payload()).step;
  if (states > 0 && (last >= settings.scene.time.end || (options.steps && steps >= *options.steps)))
    return {states, last, true, false, {}};
  return simulate(settings, path, true, steps, options, ready);
}

}  // namespace app
