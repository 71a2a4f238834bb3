#include "sim/stepping/simulate.h"

#include "sim/core/checksum.h"
#include "sim/stepping/saved_start.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

namespace sim {

namespace {

constexpr double same_time = 1e-9;  ///< times nearer than this share of a step are one time

/// Time of the next saved state: multiples of save_every, and the end. Not counted from the last one, which may have
/// been the end of a run that is continued, or saved by another measure.
double save_time(const Scene& scene, double time) {
  const std::optional<double> interval = save_interval(scene.time);
  if (!interval) return scene.time.end;
  const double every = *interval;
  return std::min((std::floor(time / every + same_time) + 1) * every, scene.time.end);
}

/// The step that reaches `target` in equal steps no longer than the present limit.
double step_length(const Dynamics& d, double target) {
  const double left = target - d.time;
  return left / std::max(1.0, std::ceil(left / d.dt_limit - same_time));
}

/// What a failed attempt leads to: a warning, and steps that are half as long for a while; or the end, after too many.
std::optional<Rejection> failed(Dynamics& d, const std::string& reason, double dt, int failures, int most,
                                const SimulationObserver& observer) {
  if (failures >= most) return Rejection{fmt::format("{}, also in steps of {:.3g}", reason, dt)};
  if (observer.on_warning)
    observer.on_warning(fmt::format("t = {:.6g}: {}; trying a step of {:.3g}", d.time, reason, dt / 2));
  d.dt_limit = dt / 2;
  d.calm = 0;
  d.control.held = true;
  return std::nullopt;
}

/// The exact time of a target that was met but for rounding.
void settle(Step& step, double target, double dt) {
  if (std::abs(step.dynamics.time - target) < same_time * dt) step.dynamics.time = step.record.time = target;
}

/// Fixed steps: halves a failing one down to step / 2^step_retries, and lets it grow again after some calm ones.
Attempt<Step> fixed_step_with_retries(const Model& s, Dynamics& d, double target, const SimulationObserver& observer) {
  const double longest = longest_step(s.scene), shortest = std::ldexp(longest, -s.scene.numerics.step_retries);
  for (int retries = 0;; ++retries) {
    const double dt = step_length(d, target);
    if (Attempt<Step> step = take_step(s, d, dt)) {
      Dynamics& after = step->dynamics;
      step->record.retries = retries;
      settle(*step, target, dt);
      if (++after.calm >= calm_enough) after.dt_limit = std::min(2 * d.dt_limit, longest);
      after.control.held = false;
      return step;
    } else if (step.rejection().final) {
      return step.rejection();
    } else {
      const int most = dt / 2 < shortest * (1 - same_time) ? retries : retries + 1;
      if (auto end = failed(d, step.rejection().reason, dt, retries, most, observer)) return *end;
    }
  }
}

/// Steps that follow the tolerance: too large an error shortens them in silence, a failure is told.
Attempt<Step> adaptive_step(const Model& s, Dynamics& d, double target, const SimulationObserver& observer) {
  int failures = 0;
  constexpr int most_retries = 30;  // each takes a tenth at least: no error falls so slowly
  for (int retries = 0;; ++retries) {
    const double dt = length_towards(d.time, target, d.dt_limit);
    Attempt<Step> step = take_step(s, d, dt);
    if (!step) {
      if (step.rejection().final) return step.rejection();
      if (auto end = failed(d, step.rejection().reason, dt, failures++, s.scene.numerics.step_retries, observer))
        return *end;
    } else if (const std::optional<double> share = shortening(s, d, *step)) {
      if (retries >= most_retries)
        return Rejection{fmt::format("the error of a step stays above the tolerance, also in steps of {:.3g}", dt)};
      d.dt_limit = *share * dt;
      d.control.held = true;
    } else {
      step->record.retries = retries;
      if (stalls(s, *step))
        return Rejection{fmt::format(
            "steps have become as short as {:.2g}, of which a million would not reach the end; the order of a "
            "vesicle may be too low for its shape",
            dt)};
      plan_next(s, d, *step);
      settle(*step, target, dt);
      return step;
    }
  }
}

TrajectoryLayout layout_for(const Scene& scene, const Dynamics& d) {
  TrajectoryLayout layout = layout_of(d);
  // How many steps a tolerance takes is not known: room as for saved states, and the file grows.
  const double steps = steps_adapt(scene.time) ? 0 : std::ceil(scene.time.end / longest_step(scene));
  const std::optional<double> every = save_interval(scene.time);
  const double saved = every ? std::ceil(scene.time.end / *every) : steps;
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
    throw std::runtime_error(
        fmt::format("trajectory '{}' of version {} cannot be resumed: its resume record is damaged, or "
                    "of another version ({})",
                    path.string(), file.header().program, why));
  }
  Dynamics read() const {
    try {
      return deserialised(file.resume_payload(), file.layout());
    } catch (const std::runtime_error& error) {
      refuse(error.what());
    }
  }
};
// Clang deduces for aggregates from version 17 on.
template <class File>
ResumeRecord(const File&, const std::filesystem::path&) -> ResumeRecord<File>;

/// Starts take short steps, but none that doubling would not soon make long.
bool possible_step(const Scene& scene, const Dynamics& d) {
  constexpr int most_doublings = 60;
  const double longest = steps_adapt(scene.time) ? std::max(scene.time.end, d.time) : longest_step(scene);
  const bool unlimited = steps_adapt(scene.time);  // a scene without any motion
  return d.dt_limit >= std::ldexp(longest, -most_doublings) && (unlimited || d.dt_limit <= longest * (1 + same_time));
}

/// The record against the rest of the file and the scene.
Dynamics resumed(const TrajectoryWriter& file, const Scene& scene, const std::filesystem::path& path) {
  const ResumeRecord record{file, path};
  Dynamics d = record.read();
  if (d.vesicles.size() != scene.vesicles.size())
    record.refuse(fmt::format("{} vesicles, the scene has {}", d.vesicles.size(), scene.vesicles.size()));
  for (std::size_t k = 0; k < d.vesicles.size(); ++k)
    if (const int order = scene.vesicles[k].order; order > 0 && d.vesicles[k].position.order != order)
      record.refuse("an order is not that of the scene");
  if (!file.holds(d.step, d.time, d.saves)) record.refuse("it does not belong to the states of the file");
  if (!possible_step(scene, d)) record.refuse("the scene allows no such step");
  return d;
}

/// Renews the resume point after every step, but not more than 20 times a second, and not for more than a twentieth of
/// the time.
class ResumeClock {
 public:
  bool due() const { return Clock::now() >= next_; }
  void start() { started_ = Clock::now(); }
  void stop() {
    const auto now = Clock::now();
    next_ = std::max(started_ + std::chrono::milliseconds(50), now + 19 * (now - started_));
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point started_{}, next_{};
};

std::vector<std::string> starting_warnings(const Model& s, const Dynamics& d, const std::optional<State>& from) {
  std::vector<std::string> warnings = scene_warnings(s, d);
  if (from) {
    const std::string cut = cut_warning(s.scene, *from, positions(d));
    if (!cut.empty()) warnings.push_back(cut);
  }
  return warnings;
}

/// A run under way: the present state, its file, and what of it is not in the file yet.
class Run {
 public:
  Run(const Model& model, const SimulationOptions& options, const SimulationObserver& observer)
      : model_(model), scene_(model.scene), options_(options), observer_(model.ranks.first() ? observer : silent_) {
    if (model.ranks.first()) noting_ = observer;
    noting_.on_warning = [this](const std::string& warning) { warn(warning); };
    if (options.resume)
      resume();
    else
      begin();
    first_step_ = d_.step;
  }

  bool reached_end() const { return d_.time >= scene_.time.end * (1 - 1e-12); }
  bool reached_limit() const { return options_.steps >= 0 && d_.step - first_step_ >= options_.steps; }

  /// One step of Algorithm 2, with all that is due in it and after it.
  std::optional<Rejection> step() {
    const double switched = next_switch(scene_.flows, d_.time);
    const bool adapts = steps_adapt(scene_.time);
    const double due = save_time(scene_, d_.time);
    Attempt<Step> step = adapts ? adaptive_step(model_, d_, std::min(scene_.time.end, switched), noting_)
                                : fixed_step_with_retries(model_, d_, std::min(due, switched), noting_);
    if (!step) return step.rejection();
    std::vector<SpaceError> space;
    if (adapts && resolution_due(d_)) space = estimate_resolution(model_, d_, *step);
    const Dynamics before = std::exchange(d_, std::move(step->dynamics));
    records_.push_back(step->record);
    if (observer_.on_step) observer_.on_step(d_, step->record);
    if (adapts) {
      if (auto rejection = save_between(before)) return rejection;
    } else if (d_.time == due) {
      if (auto rejection = save()) return rejection;
    }
    if (d_.time == switched)
      if (auto rejection = begin_anew()) return rejection;
    if (auto rejection = adapt_orders(before, step->record.dt, space)) return rejection;
    warn_of_shapes();
    if (any(model_.ranks, file_ && clock_.due())) write_resume_point();
    model_.plans.forget_unused();
    compare_ranks();
    return std::nullopt;
  }

  SimulationOutcome end(SimulationEnd how, const std::string& reason = {}) {
    SimulationOutcome outcome{how, {}, d_.step, d_.time};
    if (how == SimulationEnd::failed) {
      outcome.reason = fmt::format("t = {:.6g}: {}", d_.time, reason);
      note("stopped at " + outcome.reason);
      if (any(model_.ranks, file_ && file_->last_time() < d_.time))
        if (const auto rejection = save())  // the last good state
          note(fmt::format("t = {:.6g}: {}", d_.time, rejection->reason));
    }
    const std::vector<double> record = resume_record();
    if (file_) {
      file_->append_steps(records_);
      file_->finish_resume(record, d_.step);
    }
    // Nobody ends before the file is whole: who is alone with it may need all the time there is.
    any(model_.ranks, false);
    return outcome;
  }

 private:
  /// From the scene: the file gets its first state.
  void begin() {
    const std::optional<State> from = start_state(scene_, model_.ranks);
    d_ = resolved_start(model_, from ? &*from : nullptr);
    const TrajectoryHeader header{options_.scene_text, options_.program, options_.build,
                                  starting_warnings(model_, d_, from)};
    if (observer_.on_warning)
      for (const std::string& warning : header.warnings) observer_.on_warning(warning);
    for (std::size_t k = 0; k < d_.vesicles.size(); ++k) d_.vesicles[k].warned = unresolved(model_, d_, k);
    for (const ThinFilm& film : thin_films(model_, d_)) d_.vesicles[film.vesicle].warned = true;
    const State first = evaluate(model_, d_).value();
    expect(model_, d_, first);
    start_steps(model_, d_);
    const TrajectoryLayout layout = layout_for(scene_, d_);
    mark_saved(d_, first);
    if (model_.ranks.first())
      file_.emplace(
          TrajectoryWriter::create(options_.trajectory, layout, header, first, serialised(d_), observer_.on_ready));
    if (observer_.on_state) observer_.on_state(first);
  }

  /// From the last resume point of the file, whoever wrote it.
  void resume() {
    if (model_.ranks.first()) reopen();
    from_first(model_.ranks, d_);
  }

  void reopen() {
    file_.emplace(TrajectoryWriter::resume(options_.trajectory));
    d_ = resumed(*file_, scene_, options_.trajectory);
    if (observer_.on_ready) observer_.on_ready();
    if (options_.another_time && d_.time < scene_.time.end)
      file_->continue_as(options_.scene_text, layout_for(scene_, d_));
    file_->make_room(layout_for(scene_, d_));  // a run may have been stopped just before
  }

  std::optional<Rejection> save() {
    const Attempt<State> state = evaluate(model_, d_);
    if (!state) return state.rejection();
    append(*state);
    return std::nullopt;
  }

  /// All states that are due in the last step.
  std::optional<Rejection> save_between(const Dynamics& before) {
    constexpr std::size_t at_once = 32;  // a step may hold more than fit into the memory
    for (double time = save_time(scene_, before.time); time <= d_.time;) {
      std::vector<double> times;
      for (; time <= d_.time && times.size() < at_once; time = save_time(scene_, time)) {
        times.push_back(time);
        if (time == scene_.time.end) break;
      }
      const Attempt<std::vector<State>> states = interpolated(model_, before, d_, times);
      if (!states) return states.rejection();
      for (const State& state : *states) append(state);
      if (times.back() == scene_.time.end) break;
    }
    return std::nullopt;
  }

  void append(const State& state) {
    if (file_) file_->append(state, records_);
    records_.clear();
    mark_saved(d_, state);
    if (observer_.on_state) observer_.on_state(state);
  }

  std::optional<Rejection> begin_anew() {
    Attempt<Dynamics> anew = begun_anew(model_, d_);
    if (!anew) return anew.rejection();
    d_ = std::move(*anew);
    return std::nullopt;
  }

  /// After an estimate of what degrees are worth.
  std::optional<Rejection> adapt_orders(const Dynamics& before, double dt, std::span<const SpaceError> errors) {
    if (errors.empty()) return std::nullopt;
    warn_of_limits(before, dt, errors);
    const std::vector<int> orders = orders_for(model_, before, dt, errors);
    Attempt<Dynamics> changed = in_orders(model_, d_, orders);
    if (!changed) return changed.rejection();
    d_ = std::move(*changed);
    if (file_) file_->make_room(layout_for(scene_, d_));
    return std::nullopt;
  }

  void note(const std::string& text) {
    if (file_) file_->note(text);
  }

  void warn(const std::string& warning) {
    note(warning);
    if (observer_.on_warning) observer_.on_warning(warning);
  }

  /// Once a vesicle and run: a shape may cross the bound often.
  void warn_of_shapes() {
    for (std::size_t k = 0; k < d_.vesicles.size(); ++k)
      if (VesicleDynamics& v = d_.vesicles[k]; !v.warned && unresolved(model_, d_, k)) {
        v.warned = true;
        warn(fmt::format("t = {:.6g}: {}", d_.time, resolution_warning(model_, d_, k)));
      }
    if (d_.step % 10 != 0) return;  // a film thins slowly
    std::vector<ThinFilm> films = thin_films(model_, d_);
    std::erase_if(films, [&](const ThinFilm& film) { return std::exchange(d_.vesicles[film.vesicle].warned, true); });
    if (!films.empty()) warn(fmt::format("t = {:.6g}: {}", d_.time, film_warning(d_, films.front(), films.size() - 1)));
  }

  /// Once a vesicle and run, too; of many at once the worst is named.
  void warn_of_limits(const Dynamics& before, double dt, std::span<const SpaceError> errors) {
    const double allowed = allowed_space_error(model_, before, dt);
    std::size_t worst = 0, found = 0;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      if (d_.vesicles[k].warned || !limited(model_, d_, k, errors[k].here / allowed)) continue;
      d_.vesicles[k].warned = true;
      if (found++ == 0 || errors[k].here > errors[worst].here) worst = k;
    }
    if (found > 0)
      warn(fmt::format("t = {:.6g}: {}", d_.time,
                       limit_warning(model_, d_, worst, errors[worst].here / allowed, found - 1)));
  }

  /// What all ranks compute must be the same on all. Processors of different kinds may round differently.
  void compare_ranks() const {
    if (model_.ranks.count == 1) return;
    Checksum places;
    for (const VesicleDynamics& v : d_.vesicles)
      places.add({reinterpret_cast<const char*>(v.position.values.data()), sizeof(double)});
    std::vector<double> mine{d_.time, d_.dt_limit, double(d_.control.order)};
    for (const char letter : places.text()) mine.push_back(letter);
    const auto all = model_.ranks.gathered(mine);
    for (const auto& theirs : all)
      if (theirs != all[0])
        throw std::runtime_error(
            "the processes have come to different results, as processors of different kinds may; "
            "start them on machines of one kind");
  }

  /// Of the first rank, with what all have learned; empty on the others.
  std::vector<double> resume_record() const {
    if (model_.ranks.count == 1) return serialised(d_);
    const Division all_to_first{&model_.ranks, std::vector<int>(d_.vesicles.size(), 0)};
    Lessons learned = delivered(d_.learned, d_.keepers, all_to_first);
    if (!file_) return {};
    Dynamics whole = d_;
    whole.learned = std::move(learned);
    return serialised(whole);
  }

  void write_resume_point() {
    clock_.start();
    const std::vector<double> record = resume_record();
    if (!file_) return;
    file_->append_steps(records_);
    records_.clear();
    file_->write_resume(record);
    clock_.stop();
  }

  const Model& model_;
  const Scene& scene_;
  const SimulationOptions& options_;
  const SimulationObserver silent_{};  ///< of the other ranks
  const SimulationObserver& observer_;
  SimulationObserver noting_;  ///< whose warnings are noted in the file
  Dynamics d_;
  std::optional<TrajectoryWriter> file_;  ///< of the first rank
  std::vector<StepRecord> records_;       ///< of steps that are not in the file yet
  std::int64_t first_step_ = 0;
  ResumeClock clock_;
};

}  // namespace

SimulationOutcome simulate(const Scene& scene, const SimulationOptions& options, const SimulationObserver& observer,
                           const Ranks& ranks) {
  Plans plans;
  const Model model = make_model(scene, plans, ranks);
  Run run(model, options, observer);
  while (!run.reached_end()) {
    if (run.reached_limit()) return run.end(SimulationEnd::step_limit);
    if (const auto rejection = run.step()) return run.end(SimulationEnd::failed, rejection->reason);
    if (any(ranks, observer.should_stop && observer.should_stop())) return run.end(SimulationEnd::interrupted);
  }
  return run.end(SimulationEnd::finished);
}

Dynamics resume_point(const TrajectoryReader& file, const std::filesystem::path& path) {
  return ResumeRecord{file, path}.read();
}

Preview preview(const Scene& scene) {
  Plans plans;
  const Model model = make_model(scene, plans);
  const std::optional<State> from = start_state(scene, model.ranks);
  const Dynamics d = resolved_start(model, from ? &*from : nullptr);
  return {evaluate(model, d).value(), starting_warnings(model, d, from)};
}

}  // namespace sim
