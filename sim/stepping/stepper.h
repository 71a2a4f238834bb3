// Time stepping: one step of the whole scene, by a scheme of the catalogue (schemes.h), with its checks, the area and volume
// correction, reparametrization and the renewal of upsampling rates.
#pragma once

#include "sim/measures/diagnostics.h"
#include "sim/stepping/schemes.h"
#include "sim/trajectory/trajectory.h"

namespace sim {

/// Initial state. Throws std::invalid_argument with one sentence when a vesicle cannot be made.
Dynamics initial_dynamics(const Setting&);

/// Longest step for a scene: time.step, and a twentieth of a period where a flow oscillates.
double longest_step(const Scene&);

/// One step of length dt, within which no flow is switched.
struct Step {
  Dynamics dynamics;
  StepRecord record;
};
Attempt<Step> take_step(const Setting&, const Dynamics&, double dt);

/// Where a flow has just been switched: what the past says of the future is forgotten, and the next step starts as the first.
Attempt<Dynamics> begun_anew(const Setting&, Dynamics);

/// Velocity and tension that solve (3a)-(3b) at the present positions, and all else that is saved.
Attempt<State> evaluate(const Setting&, const Dynamics&);
/// Takes velocity, tension and frames of a state of the present for what the next step starts from and expects.
void expect(const Setting&, Dynamics&, const State&);
/// Call it with a state that has been saved: it becomes the earlier end of the next interpolation.
void mark_saved(Dynamics&, const State&);

/// The warning that vesicle k is not resolved by its order.
std::string resolution_warning(const Setting&, const Dynamics&, std::size_t k);
/// All warnings about a scene before its first step: unresolved vesicles, flows that move nothing or vary faster than
/// the step.
std::vector<std::string> scene_warnings(const Setting&, const Dynamics&);

}  // namespace sim
