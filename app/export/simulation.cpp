#include "app/export/simulation.h"

#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/base/progress.h"
#include "app/base/version.h"
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"
#include "app/scene/trajectory_scene.h"

#include "sim/core/parallel.h"
#include "sim/core/result_file.h"
#include "sim/stepping/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

namespace app {

namespace {

/// What the ranks after the first have to know.
void share(const sim::Ranks& ranks, sim::SimulationOptions& how) {
  sim::from_first(ranks, how, [](sim::Parcel& parcel, sim::SimulationOptions& all) {
    parcel(all.resume), parcel(all.steps), parcel(all.scene_text);
  });
}

/// Of this process; 0: one for each processor.
int threads_of(const Options& options, const sim::Scene& scene, const sim::Ranks& ranks) {
  if (options.jobs > 0) return options.jobs;
  if (scene.numerics.threads > 0) return scene.numerics.threads;
  if (const char* const asked = std::getenv("OMP_NUM_THREADS"))
    if (const int threads = std::atoi(asked); threads > 0) return threads;
  if (ranks.neighbours == 1) return 0;
  const int processors = static_cast<int>(std::thread::hardware_concurrency());
  return std::clamp(processors / ranks.neighbours, 1, sim::thread_count());
}

SimulationReport simulate(const Settings& settings, const std::filesystem::path& path, bool resume, bool another_time,
                          std::int64_t first_step, const Options& options, const std::function<void()>& ready,
                          const ProgressSpan& span, const sim::Ranks& ranks) {
  const sim::Scene& scene = settings.scene;
  sim::SimulationOptions how;
  how.trajectory = path;
  how.resume = resume;
  how.another_time = another_time;
  how.steps = options.steps ? std::max<std::int64_t>(0, *options.steps - first_step) : -1;
  how.scene_text = write_scene(settings);
  share(ranks, how);
  how.program = version();
  how.build = build();

  Progress progress(span.what, options.quiet);
  sim::SimulationObserver observer;
  observer.on_step = [&](const sim::Dynamics& d, const sim::StepRecord& record) {
    const double share =
        options.steps ? static_cast<double>(d.step) / static_cast<double>(*options.steps) : d.time / scene.time.end;
    progress.show(span.first + span.share * share, fmt::format("step {:.0f}, t = {:.4g}", record.step, record.time));
  };
  observer.on_warning = [&](const std::string& warning) {
    progress.clear();
    if (!options.quiet) tell(fmt::format("warning: {}{}{}", span.name, span.name.empty() ? "" : ": ", warning));
  };
  observer.on_ready = ready;
  observer.should_stop = [] { return interrupted(); };
  sim::SimulationOutcome outcome;
  sim::with_threads(threads_of(options, scene, ranks), [&] { outcome = sim::simulate(scene, how, observer, ranks); });

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
                              const std::function<void()>& ready, const ProgressSpan& span, const sim::Ranks& ranks) {
  if (path.has_parent_path()) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error)
      throw std::runtime_error(
          fmt::format("cannot make folder '{}': {}", path.parent_path().string(), error.message()));
  }
  std::error_code missing;
  if (const auto& from = settings.scene.start.from; from && std::filesystem::equivalent(*from, path, missing))
    throw std::runtime_error(
        fmt::format("'{}' would be replaced by the run that starts from it; give another -o", path.string()));
  return simulate(settings, path, false, false, 0, options, ready, span, ranks);
}

namespace {

/// Lets the other ranks go, which wait for a scene.
void release(const sim::Ranks& ranks) {
  sim::SimulationOptions nothing;
  share(ranks, nothing);
}

/// What may be different is; the rest is refused.
std::vector<SceneDifference> checked_differences(const Settings& settings, const sim::TrajectoryReader& reader,
                                                 const std::filesystem::path& path) {
  auto differences = physics_differences(scene_in(reader, path).scene, settings.scene);
  if (!continuable(differences))
    throw std::runtime_error(fmt::format("'{}' belongs to another scene: {}; give another -o, or --force to replace it",
                                         path.string(), text_of(differences)));
  const std::int64_t states = reader.count();
  if (const double last = states > 0 ? reader.time(states - 1) : 0; last > settings.scene.time.end * (1 + 1e-9))
    throw std::runtime_error(
        fmt::format("'{}' has states up to time {:.6g}, beyond time.end = {:.6g}; give another -o, or "
                    "--force to replace it",
                    path.string(), last, settings.scene.time.end));
  return differences;
}

}  // namespace

void check_further(const Settings& settings, const std::filesystem::path& path) {
  checked_differences(settings, sim::TrajectoryReader(path), path);
}

SimulationReport simulate_further(const Settings& settings, const std::filesystem::path& path, const Options& options,
                                  const std::function<void()>& ready, const ProgressSpan& span,
                                  const sim::Ranks& ranks) {
  const sim::TrajectoryReader reader(path);
  const bool another_time = !checked_differences(settings, reader, path).empty();
  const sim::Dynamics d = sim::resume_point(reader, path);
  const std::int64_t states = reader.count();
  const bool done = d.time >= settings.scene.time.end * (1 - 1e-12) || (options.steps && d.step >= *options.steps);
  // One that was killed before its last words says them now.
  if (done && reader.finished_after(d.step)) {
    sim::remove_dead_drafts(sim::destination(path).parent_path());
    release(ranks);
    return {states, reader.time(states - 1), true, false, {}};
  }
  SimulationReport report = simulate(settings, path, true, another_time, d.step, options, ready, span, ranks);
  report.already_finished = done;
  return report;
}

void simulate_along(const Options& options, const sim::Ranks& ranks) {
  sim::SimulationOptions how;
  share(ranks, how);
  if (how.scene_text.empty()) return;
  const Settings settings = parse_scene(how.scene_text, "the scene of the first rank", ".", {}, SceneUse::draw);
  sim::SimulationObserver observer;
  observer.should_stop = [] { return interrupted(); };
  sim::with_threads(threads_of(options, settings.scene, ranks),
                    [&] { sim::simulate(settings.scene, how, observer, ranks); });
}

}  // namespace app
