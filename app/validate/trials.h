// Runs of the validations: scenes with changes, simulated one after the other, and the measures of their states.
#pragma once

#include "app/scene/settings.h"

#include "sim/layers/plans.h"
#include "sim/measures/diagnostics.h"
#include "sim/measures/statement.h"
#include "sim/measures/stresslet.h"
#include "sim/trajectory/trajectory.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace app {

/// Changes to a scene, "vesicle.order=8", as --set takes them.
using Changes = std::vector<std::string>;
Changes operator+(Changes, const Changes&);

struct Trial {
  Settings settings;
  sim::TrajectoryReader trajectory;
  double seconds = 0;   ///< processor time of the run
  std::string stopped;  ///< why it ended early; empty: it did not

  sim::State last() const { return trajectory.state(trajectory.count() - 1); }
  sim::ErrorStatement statement() const { return sim::stated_errors(trajectory.steps()); }
};

/// One vesicle of one saved state.
struct Sample : sim::VesicleMeasures {
  double time = 0;
};
using Samples = std::vector<Sample>;

class Trials {
 public:
  /// threads: of each run. show: what is done now, for a line of progress.
  Trials(int threads, std::function<void(const std::string&)> show);
  Trials(const Trials&) = delete;
  Trials& operator=(const Trials&) = delete;
  ~Trials();

  /// A base scene with changes. Throws std::runtime_error with the reason where the run stops early, and Interrupted.
  Trial run(std::string_view scene, const Changes&);
  /// The same, where stopping is a result.
  Trial attempt(std::string_view scene, const Changes&);
  /// Measures of a vesicle in all saved states.
  Samples history(const Trial&, std::size_t vesicle = 0);
  Samples history(std::string_view scene, const Changes& changes) { return history(run(scene, changes)); }
  /// Of the last state.
  Sample last(const Trial&, std::size_t vesicle = 0);
  Sample last(std::string_view scene, const Changes& changes) { return last(run(scene, changes)); }
  sim::FlowMeasures last_flow(const Trial&);

  sim::Plans& plans() { return plans_; }
  int count() const { return count_; }
  /// The command line of the first run.
  const std::string& first_command() const { return first_command_; }

 private:
  int threads_;
  std::function<void(const std::string&)> show_;
  std::filesystem::path folder_;  ///< of trajectories, which go with it
  sim::Plans plans_;
  int count_ = 0;
  std::string first_command_;
};

/// Largest absolute value in a history.
double largest(const Samples&, double sim::VesicleMeasures::*member);
/// Inclination in degrees, continued beyond 90.
std::vector<double> unwrapped(const Samples&);
double least_angle(const Samples&);
/// When the falling unwrapped angle passes a value in degrees, linear between saved states; NaN: never.
double time_at(const Samples&, double degrees);

/// Unit vectors: points of a regular mesh on the parameter sphere, poles included.
sim::Matrix mesh_directions(int latitudes = 32);

}  // namespace app
