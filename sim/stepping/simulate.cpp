#include "sim/stepping/simulate.h"

#include <fmt/format.h>
#include <omp.h>

#include <chrono>
#include <cmath>
#include <optional>

namespace sim {

namespace {

constexpr double same_time = 1e-9;  ///< times nearer than this share of a step are one time

/// Time of the next saved state: multiples of save_every, and the end. Not counted from the last one, which may have been
/// the end of a run that is continued, or saved by another measure.
double save_time(const Scene& scene, const Dynamics& d) {
  if (!scene.time.save_every) return scene.time.end;
  const double every = *scene.time.save_every;
  return std::min((std::floor(d.time / every + same_time) + 1) * every, scene.time.end);
}

/// The step that reaches `target` in equal steps no longer than the present limit.
double step_length(const Dynamics& d, double target) {
  const double left = target - d.time;
  return left / std::max(1.0, std::ceil(left / d.dt_limit - same_time));
}

/// Halves a failing step down to step / 2^step_retries, and lets it grow again after some calm ones.
Attempt<Step> step_with_retries(const Model& s, Dynamics& d, double target, const SimulationObserver& observer) {
  constexpr std::int64_t calm_enough = 8;
  const double longest = longest_step(s.scene), shortest = std::ldexp(longest, -s.scene.numerics.step_retries);
  for (int retries = 0;; ++retries) {
    const double dt = step_length(d, target);
    if (Attempt<Step> step = take_step(s, d, dt)) {
      Dynamics& after = step->dynamics;
      step->record.retries = retries;
      if (std::abs(after.time - target) < same_time * dt) after.time = step->record.time = target;
      if (++after.calm >= calm_enough && d.dt_limit < longest) {
        after.dt_limit = std::min(2 * d.dt_limit, longest);
        after.calm = 0;
      }
      return step;
    } else {
      const std::string& reason = step.rejection().reason;
      if (dt / 2 < shortest * (1 - same_time)) return Rejection{fmt::format("{}, also in steps of {:.3g}", reason, dt)};
      if (observer.on_warning)
        observer.on_warning(fmt::format("t = {:.6g}: {}; trying a step of {:.3g}", d.time, reason, dt / 2));
      d.dt_limit = dt / 2;
      d.calm = 0;
    }
  }
}

TrajectoryLayout layout_for(const Scene& scene, const Dynamics& d) {
  TrajectoryLayout layout;
  layout.vesicles = int(d.vesicles.size());
  layout.order = layout.label_order = 0;
  for (const VesicleDynamics& v : d.vesicles) {
    layout.order = std::max(layout.order, v.position.order);
    layout.label_order = std::max(layout.label_order, v.labels.order);
    layout.tracers = int(v.tracers.rows());
  }
  const double steps = std::ceil(scene.time.end / longest_step(scene));
  const double saved = scene.time.save_every ? std::ceil(scene.time.end / *scene.time.save_every) : steps;
  layout.states = std::int64_t(std::min(saved, 1e6)) + 2;
  layout.steps = std::int64_t(std::min(std::max(steps, saved), 1e7)) + 16;
  layout.resume = std::int64_t(resume_numbers(d, scheme_of(scene).past_levels));
  return layout;
}

/// Of a TrajectoryReader or TrajectoryWriter.
template <class File>
struct ResumeRecord {
  const File& file;
  const std::filesystem::path& path;

  [[noreturn]] void refuse(std::string_view why) const {
    throw std::runtime_error(fmt::format("trajectory '{}' of version {} cannot be resumed: its resume record is damaged, or "
                                         "of another version ({})", path.string(), file.header().program, why));
  }
  Dynamics read() const {
    try {
      return deserialised(file.resume_payload(), file.layout());
    } catch (const std::runtime_error& error) {
      refuse(error.what());
    }
  }
};

/// The record against the rest of the file and the scene.
Dynamics resumed(const TrajectoryWriter& file, const Scene& scene, const std::filesystem::path& path) {
  const ResumeRecord record{file, path};
  Dynamics d = record.read();
  if (d.vesicles.size() != scene.vesicles.size())
    record.refuse(fmt::format("{} vesicles, the scene has {}", d.vesicles.size(), scene.vesicles.size()));
  for (std::size_t k = 0; k < d.vesicles.size(); ++k)
    if (d.vesicles[k].position.order != scene.vesicles[k].order) record.refuse("an order is not that of the scene");
  if (!file.holds(d.step, d.time, d.saves)) record.refuse("it does not belong to the states of the file");
  // Starts of nearly round vesicles take short steps, but none that doubling would not soon make long.
  constexpr int most_doublings = 60;
  if (const double longest = longest_step(scene);
      d.dt_limit < std::ldexp(longest, -most_doublings) || d.dt_limit > longest * (1 + same_time))
    record.refuse("the scene allows no such step");
  return d;
}

/// Renews the resume point after every step, but not more than 20 times a second.
class ResumeClock {
 public:
  bool due() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return false;
    last_ = now;
    return true;
  }

 private:
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace

SimulationOutcome simulate(const Scene& scene, const SimulationOptions& options, const SimulationObserver& observer) {
  if (scene.numerics.threads > 0) omp_set_num_threads(scene.numerics.threads);
  Plans plans;
  const Model model = make_model(scene, plans);

  // The state to start from: the scene's, or the file's last resume point.
  Dynamics d;
  std::optional<TrajectoryWriter> file;
  if (options.resume) {
    file.emplace(TrajectoryWriter::resume(options.trajectory));
    d = resumed(*file, scene, options.trajectory);
    if (observer.on_ready) observer.on_ready();
    if (options.another_time && d.time < scene.time.end) file->continue_as(options.scene_text, layout_for(scene, d));
  } else {
    d = initial_dynamics(model);
    const TrajectoryHeader header{options.scene_text, options.program, options.build, scene_warnings(model, d)};
    if (observer.on_warning)
      for (const std::string& warning : header.warnings) observer.on_warning(warning);
    for (VesicleDynamics& v : d.vesicles) v.warned = v.tail > scene.numerics.tail_warning;
    const State first = evaluate(model, d).value();
    expect(model, d, first);
    const TrajectoryLayout layout = layout_for(scene, d);
    mark_saved(d, first);
    file.emplace(TrajectoryWriter::create(options.trajectory, layout, header, first, serialised(d), observer.on_ready));
    if (observer.on_state) observer.on_state(first);
  }

  ResumeClock clock;
  std::vector<StepRecord> records;
  const auto warn = [&](const std::string& warning) {
    file->note(warning);
    if (observer.on_warning) observer.on_warning(warning);
  };
  SimulationObserver noting = observer;
  noting.on_warning = warn;
  const auto save = [&]() -> std::optional<Rejection> {
    const Attempt<State> state = evaluate(model, d);
    if (!state) return state.rejection();
    file->append(*state, records);
    records.clear();
    mark_saved(d, *state);
    if (observer.on_state) observer.on_state(*state);
    return std::nullopt;
  };
  SimulationOutcome outcome;
  const auto fail = [&](const Rejection& rejection) {
    outcome.end = SimulationEnd::failed;
    outcome.reason = fmt::format("t = {:.6g}: {}", d.time, rejection.reason);
    file->note("stopped at " + outcome.reason);
  };
  const std::int64_t first_step = d.step;
  while (d.time < scene.time.end * (1 - 1e-12)) {
    if (options.steps >= 0 && d.step - first_step >= options.steps) {
      outcome.end = SimulationEnd::step_limit;
      break;
    }
    const bool every_step = !scene.time.save_every;
    const double due = save_time(scene, d), switched = next_switch(scene.flows, d.time), target = std::min(due, switched);
    Attempt<Step> step = step_with_retries(model, d, target, noting);
    if (!step) {
      fail(step.rejection());
      break;
    }
    d = std::move(step->dynamics);
    records.push_back(step->record);
    if (observer.on_step) observer.on_step(d, step->record);
    std::optional<Rejection> unsaved;
    if (every_step || d.time == due) unsaved = save();
    if (!unsaved && d.time == switched) {
      Attempt<Dynamics> anew = begun_anew(model, d);
      if (anew) d = std::move(*anew);
      else unsaved = anew.rejection();
    }
    if (unsaved) {
      fail(*unsaved);
      break;
    }
    for (std::size_t k = 0; k < d.vesicles.size(); ++k)  // one warning a vesicle and run: a shape may cross the bound often
      if (VesicleDynamics& v = d.vesicles[k]; !v.warned && v.tail > scene.numerics.tail_warning) {
        v.warned = true;
        warn(fmt::format("t = {:.6g}: {}", d.time, resolution_warning(model, d, k)));
      }
    if (clock.due()) {
      file->append_steps(records);
      records.clear();
      file->write_resume(serialised(d));
    }
    if (observer.should_stop && observer.should_stop()) {
      outcome.end = SimulationEnd::interrupted;
      break;
    }
  }
  if (outcome.end == SimulationEnd::failed && file->last_time() < d.time)
    if (const auto rejection = save())  // the last good state
      file->note(fmt::format("t = {:.6g}: {}", d.time, rejection->reason));
  file->append_steps(records);
  file->finish_resume(serialised(d), d.step);
  outcome.step = d.step;
  outcome.time = d.time;
  return outcome;
}

Dynamics resume_point(const TrajectoryReader& file, const std::filesystem::path& path) {
  return ResumeRecord{file, path}.read();
}

Preview preview(const Scene& scene) {
  Plans plans;
  const Model model = make_model(scene, plans);
  const Dynamics d = initial_dynamics(model);
  return {evaluate(model, d).value(), scene_warnings(model, d)};
}

}  // namespace sim
