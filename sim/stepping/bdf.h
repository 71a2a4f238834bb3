// Backward differentiation formulas (multistep.h) of any order for all vesicles at once. Of order k, with levels x_n,
// x_{n-1}, ... and the polynomial x* through the last of them at the new time,
//   u+ = (x+ - h)/c - w+:  operators, normal and flow at x*, one assembly and one linear solve a step,
//   known forces at h + c w*,  y = h + c u+,  w+ from y and u+ (sliding.h),  x+ = y + c w+,
// where w*, and the guess for u+ and for the tension, are extrapolated like x*. The shift that corrects area and volume
// afterwards counts as a part of w: without it forces would be those of a place that is off by the shift, an error of
// first order.
//
// Levels are seen from a frame that moves with the vesicle (rigid.h) as at t_n, its rotation changing as in the step
// before: past positions are where it carries them by the new time, and only the motion relative to it is discretised.
// Steady drift and rotation have no error, whatever the step. One smooth frame for all levels takes no order from a
// formula, as one that changes between them would.
#pragma once

#include "sim/stepping/step_problem.h"

namespace sim {

/// Through how many levels x* goes: as many as the order, which at fixed steps is stable for longer ones, or one more,
/// which leaves a smaller error where the steps follow it.
enum class Extrapolation { as_order, one_more };

/// Where the past has fewer levels, of the order that they allow. `past_levels`: what the next history is to hold.
Attempt<Advance> bdf_step(const StepProblem&, int order, Extrapolation, int past_levels);

/// Estimated local error of each order from 1 for a step from `before` over dt that led to a position, by size_of(), as
/// far as the levels allow. From the first step, of one level, an order 1 that compares with Euler's rule.
std::vector<double> estimated_errors(const VesicleDynamics& before, double dt, const Coefficients& position,
                                     int most_order);

/// What is known of a vesicle at one time, as a frame carries it to another.
struct Level {
  double time = 0;        ///< relative to the other
  Coefficients position;  ///< where the frame has carried it
  Coefficients velocity;  ///< relative to the frame there, turned with it
  Coefficients sliding;   ///< likewise
  Coefficients tension;
};
/// The present and the past of a vesicle, the latest first. The frame's own time is 0; `present` and `to` are those of
/// the vesicle and of what is looked at.
std::vector<Level> carried_levels(const VesicleDynamics&, const Frame&, double present, double to);
/// sum_j weight_j member_j over the first levels.
Coefficients combined(std::span<const Level>, std::span<const double> weights, Coefficients Level::*member);

/// How the grid slides in a step over dt from `before` that led to a position: times relative to the end of the step.
SlidingPath sliding_path(const VesicleDynamics& before, double dt, const Coefficients& position,
                         const Coefficients& sliding);

}  // namespace sim
