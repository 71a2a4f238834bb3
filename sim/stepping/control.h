// Steps that follow a tolerance: which of them are accepted, how long the next one is and of which order.
//
// The tolerance is an error of position, in area radii for each radius that the membrane moves: a step over dt may
// leave
//   1/2 tolerance (w dt + a),   w the rate of motion, largest of all vesicles, a = 0.01,
// where the half makes up for the growth of errors later on, and a keeps steps from becoming short for nothing while
// all motion dies out, and a gap that closes does so by no more than half a step. The length follows the estimate of
// the order in use, the order follows the three estimates of its neighbours.
#pragma once

#include "sim/stepping/stepper.h"

#include <optional>

namespace sim {

/// Error that a step of a length may leave.
double allowed_error(const Model&, const Dynamics& before, double dt);

/// The length of a step towards a time that steps must meet, at most `wanted`: no tiny remainder is left.
double length_towards(double time, double target, double wanted);

/// How much of its length a step that has left too large an error may have in the next attempt; of one that has not,
/// nothing.
std::optional<double> shortening(const Model&, const Dynamics& before, const Step&);

/// Whether steps have been so short for so long that the run gets nowhere; counted in the dynamics of the step.
bool stalls(const Model&, Step&);

/// Order and longest step of what follows an accepted step; they go into its dynamics.
void plan_next(const Model&, const Dynamics& before, Step&);

}  // namespace sim
