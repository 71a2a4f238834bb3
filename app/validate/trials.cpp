#include "app/validate/trials.h"

#include "app/base/interrupt.h"
#include "app/base/version.h"
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"
#include "app/validate/base_scenes.h"

#include "sim/core/parallel.h"
#include "sim/measures/motion.h"
#include "sim/sphere/basis.h"
#include "sim/stepping/simulate.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <numbers>
#include <system_error>

namespace app {

namespace fs = std::filesystem;

namespace {

/// As a shell takes it.
std::string quoted_change(const std::string& change) {
  return change.find_first_of("[]\"' ") == std::string::npos ? change : fmt::format("'{}'", change);
}

fs::path temporary_folder() {
  std::string name = (fs::temp_directory_path() / "tanktread-XXXXXX").string();
  if (!::mkdtemp(name.data()))
    throw std::system_error(errno, std::generic_category(), fmt::format("cannot make folder '{}'", name));
  return name;
}

}  // namespace

Changes operator+(Changes a, const Changes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Trials::Trials(int threads, std::function<void(const std::string&)> show)
    : threads_(threads), show_(std::move(show)), folder_(temporary_folder()) {}

Trials::~Trials() {
  std::error_code error;
  fs::remove_all(folder_, error);
}

Trial Trials::attempt(std::string_view name, const Changes& changes) {
  const BaseScene& base = find_base_scene(name);
  Changes all = changes;
  if (std::none_of(all.begin(), all.end(), [](const std::string& c) { return c.starts_with("vesicle.order"); }))
    all.push_back(fmt::format("vesicle.order={}", base.order));
  ++count_;
  if (count_ == 1) {
    first_command_ = fmt::format("tanktread simulate {}{}.toml", base.in_folder ? "scenes/" : "", name);
    for (const std::string& change : all) first_command_ += " --set " + quoted_change(change);
  }
  const Settings settings = parse_scene(base.text, std::string(name), ".", all);
  sim::SimulationOptions how;
  how.trajectory = folder_ / fmt::format("{}.h5", count_);
  how.scene_text = write_scene(settings);
  how.program = version();
  how.build = build();
  sim::SimulationObserver observer;
  observer.on_step = [&](const sim::Dynamics&, const sim::StepRecord& record) {
    show_(fmt::format("run {}, t = {:.4g} of {:.4g}", count_, record.time, settings.scene.time.end));
  };
  observer.should_stop = [] { return interrupted(); };
  const std::clock_t start = std::clock();
  sim::SimulationOutcome outcome;
  sim::with_threads(threads_, [&] { outcome = sim::simulate(settings.scene, how, observer); });
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  if (outcome.end == sim::SimulationEnd::interrupted) throw Interrupted{};
  Trial trial{settings, sim::TrajectoryReader(how.trajectory), seconds, {}};
  if (outcome.end == sim::SimulationEnd::failed)
    trial.stopped = fmt::format("t = {:.4g}: {}", outcome.time, outcome.reason);
  std::error_code error;
  fs::remove(how.trajectory, error);  // it stays open
  return trial;
}

Trial Trials::run(std::string_view scene, const Changes& changes) {
  Trial trial = attempt(scene, changes);
  if (trial.stopped.empty()) return trial;
  std::string text;
  for (const std::string& change : changes) text += fmt::format("{}{}", text.empty() ? "" : ", ", change);
  throw std::runtime_error(fmt::format("{} with {} stops at {}", scene, text, trial.stopped));
}

Samples Trials::history(const Trial& trial, std::size_t vesicle) {
  Samples all;
  for (std::int64_t k = 0; k < trial.trajectory.count(); ++k) {
    stop_if_interrupted();
    const sim::State state = trial.trajectory.state(k);
    const double area = all.empty() ? 1 : all[0].area, volume = all.empty() ? 1 : all[0].volume;
    all.push_back({sim::measure(plans_, state.vesicles[vesicle], area, volume), state.time});
    if (k == 0) all[0].area_error = all[0].volume_error = 0;
  }
  return all;
}

Sample Trials::last(const Trial& trial, std::size_t vesicle) {
  const sim::VesicleMeasures first = sim::measure(plans_, trial.trajectory.state(0).vesicles[vesicle], 1, 1);
  const sim::State state = trial.last();
  return {sim::measure(plans_, state.vesicles[vesicle], first.area, first.volume), state.time};
}

sim::FlowMeasures Trials::last_flow(const Trial& trial) {
  return sim::flow_measures(plans_, trial.settings.scene, trial.last()).front();
}

double largest(const Samples& samples, double sim::VesicleMeasures::*member) {
  double most = 0;
  for (const Sample& s : samples) most = std::max(most, std::abs(s.*member));
  return most;
}

std::vector<double> unwrapped(const Samples& samples) {
  std::vector<double> angles;
  for (const Sample& s : samples)
    angles.push_back(angles.empty() ? s.inclination_deg : sim::unwrapped(s.inclination_deg, angles.back()));
  return angles;
}

double least_angle(const Samples& samples) {
  const std::vector<double> angles = unwrapped(samples);
  return *std::min_element(angles.begin(), angles.end());
}

double time_at(const Samples& samples, double target) {
  const std::vector<double> angles = unwrapped(samples);
  for (std::size_t k = 1; k < angles.size(); ++k)
    if (angles[k - 1] > target && target >= angles[k])
      return samples[k - 1].time +
             (angles[k - 1] - target) / (angles[k - 1] - angles[k]) * (samples[k].time - samples[k - 1].time);
  return std::nan("");
}

sim::Matrix mesh_directions(int latitudes) {
  const int longitudes = 2 * latitudes;
  sim::Matrix directions(longitudes * (latitudes - 1) + 2, 3);
  Eigen::Index row = 0;
  for (int j = 0; j < longitudes; ++j)
    for (int i = 1; i < latitudes; ++i)
      directions.row(row++) =
          sim::unit_vector(std::numbers::pi * i / latitudes, 2 * std::numbers::pi * j / longitudes).transpose();
  directions.row(row++) << 0, 0, 1;
  directions.row(row) << 0, 0, -1;
  return directions;
}

}  // namespace app
