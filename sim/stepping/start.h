// Where a run begins, and where it begins anew because a flow has been switched: with the shapes as they are, no past,
// and steps short enough to find out how things move.
#pragma once

#include "sim/stepping/evaluate.h"

#include <numbers>

namespace sim {

inline constexpr double unit_sphere_area = 4 * std::numbers::pi;

/// Algorithm 1 runs anew after so many steps.
inline constexpr std::int64_t upsampling_steps = 10;
/// Fixed steps that have become shorter grow again after so many steps without a failure.
inline constexpr std::int64_t calm_enough = 8;

/// Degree of the material labels of a vesicle where none is given.
inline int automatic_label_order(int order) { return std::max(2 * order, 24); }

/// Initial state, in the orders of the scene, or in others; an automatic order is that which the shape needs. With a
/// state of another run, the vesicles are in it: their surfaces and labels in the orders of this run. Throws
/// std::invalid_argument with one sentence when a vesicle cannot be made.
Dynamics initial_dynamics(const Model&, std::span<const int> orders = {}, const State* from = nullptr);

/// Step of a scheme of fixed steps, and the longest it takes: a twentieth of a period where a flow oscillates.
double fixed_step(const Scene&);
double longest_step(const Scene&);

/// No step that follows a tolerance is longer: a tenth of the period of a flow that oscillates, half of the time in
/// which flows strain a sphere, whose tension would take too many iterations; infinite otherwise.
double longest_adaptive_step(const Model&, const Dynamics&);
bool any_sphere(const Dynamics&);

/// Largest rate at which any vesicle is strained by any cause.
double strain(const Model&, const Dynamics&);

/// How the first step of a history is taken, from the motions of the present.
void start_steps(const Model&, Dynamics&);

/// Where a flow has just been switched: what the past says of the future is forgotten, and the next step starts as the
/// first.
Attempt<Dynamics> begun_anew(const Model&, Dynamics);

}  // namespace sim
