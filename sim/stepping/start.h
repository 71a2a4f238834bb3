// Where a run begins, and where it begins anew because a flow has been switched: with the shapes as they are, no past,
// and steps short enough to find out how things move.
#pragma once

#include "sim/stepping/evaluate.h"

namespace sim {

/// Algorithm 1 runs anew after a time of so many steps of the scene.
inline constexpr double upsampling_steps = 10;

/// Initial state. Throws std::invalid_argument with one sentence when a vesicle cannot be made.
Dynamics initial_dynamics(const Model&);

/// Longest step for a scene: time.step, and a twentieth of a period where a flow oscillates.
double longest_step(const Scene&);

/// Where a flow has just been switched: what the past says of the future is forgotten, and the next step starts as the
/// first.
Attempt<Dynamics> begun_anew(const Model&, Dynamics);

}  // namespace sim
