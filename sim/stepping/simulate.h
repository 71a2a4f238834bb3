// A whole simulation: Algorithm 2 over time, with retries of failed steps, saved states and resume points.
#pragma once

#include "sim/stepping/stepper.h"
#include "sim/stepping/warnings.h"

#include <filesystem>
#include <functional>

namespace sim {

struct SimulationOptions {
  std::filesystem::path trajectory;  ///< the file to write
  bool resume = false;               ///< continue it
  bool another_time = false;         ///< ... with a new end or other saved times: the file gets this scene
  std::int64_t steps = -1;           ///< at most so many steps in this call; -1: to the end; 0: the initial state only
  std::string scene_text;            ///< resolved scene, kept in the file
  std::string program, build;        ///< version and compiler, kept in the file
};

/// Called from the simulating thread, of the first rank where there are several.
struct SimulationObserver {
  std::function<void(const Dynamics&, const StepRecord&)> on_step;
  std::function<void()> on_ready;  ///< once, before the file appears or changes: the scene can be simulated
  std::function<void(const State&)> on_state;
  std::function<void(const std::string&)> on_warning;
  std::function<bool()> should_stop;  ///< asked after every step, on every rank
};

enum class SimulationEnd {
  finished,     ///< reached time.end
  step_limit,   ///< did options.steps steps
  interrupted,  ///< should_stop returned true
  failed,       ///< a step failed despite retries; the last good state is in the file
};

struct SimulationOutcome {
  SimulationEnd end = SimulationEnd::finished;
  std::string reason;  ///< of a failure, one sentence
  std::int64_t step = 0;
  double time = 0;
};

/// Throws std::invalid_argument for scenes that cannot be started, std::runtime_error for file errors.
/// Several ranks call it with the same scene and options; the first of them reads and writes the file.
SimulationOutcome simulate(const Scene&, const SimulationOptions&, const SimulationObserver&, const Ranks& = alone);

/// The resume record of a trajectory, checked as strictly as its states. Throws std::runtime_error that names the
/// file.
Dynamics resume_point(const TrajectoryReader&, const std::filesystem::path&);

/// Everything known about a scene without running it: the initial state and its warnings.
struct Preview {
  State state;
  std::vector<std::string> warnings;
};
Preview preview(const Scene&);

}  // namespace sim
