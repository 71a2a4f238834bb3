// Resolution in space: how many degrees a vesicle needs for a tolerance.
//
// A step from the same past with fewer degrees says what the degrees that it lacks are worth. With u_q the velocity
// that degree q gives where a step of degree p gives u_p,
//   e_q = s |(u_p - u_q).n| / R0   (root mean square over the surface),   q = p - 4, p - 2,
// are the errors of position, a time, that lower degrees would leave; of normal velocities, since grid points may slide
// as they like. Most of a wrong deformation relaxes again where the flow turns material: a share s = 0.15 stays, but
// all of it where the flow only stretches, and more where it ends before material has turned (docs/stepping.md). Errors
// fall geometrically with the degree, so that p itself leaves e_p = e_{p-2}^2 / e_{p-4}. Both compare with the error
// that a step may have (control.h): an automatic order rises where e_p is above it, and falls where e_{p-2} is far
// below.
//
// Between membranes a distance h apart the pressure of the film varies over lengths of sqrt(h R0). What it is wrong by
// does not relax: a degree leaves
//   exp(-2.1 p sqrt(h / R0)) R0   of position (measured, docs/stepping.md),
// which is compared with half the tolerance.
#pragma once

#include "sim/stepping/control.h"

namespace sim {

/// Estimated errors a time, in area radii: of the degree that a vesicle has, and of two degrees less.
struct SpaceError {
  double here = 0, lower = 0;
};
/// Of every vesicle, for the step that led from `before` to `after`. Two more steps, of fewer degrees, are taken for
/// it: about 0.4 of the work of a step. Nothing where one of them is impossible.
std::vector<SpaceError> space_errors(const Model&, const Dynamics& before, const Dynamics& after);

/// Error of position, in area radii, that a degree leaves where the nearest neighbour is `gap` area radii away.
double film_error(int degree, double gap);

/// Whether the next step is one after which errors are estimated: every tenth.
bool resolution_due(const Dynamics&);
/// Puts the estimates for an accepted step into its dynamics and its record.
std::vector<SpaceError> estimate_resolution(const Model&, const Dynamics& before, Step&);

/// Error a time, in area radii, that the degrees of a vesicle may leave during a step over dt from `before`.
double allowed_space_error(const Model&, const Dynamics& before, double dt);
/// The orders of all vesicles for what follows a step over dt from `before`: those with an automatic order follow their
/// errors.
std::vector<int> orders_for(const Model&, const Dynamics& before, double dt, std::span<const SpaceError>);
/// All vesicles in these orders, the past included: new coefficients are zero, lost ones are corrected for in area and
/// volume.
Attempt<Dynamics> in_orders(const Model&, const Dynamics&, std::span<const int> orders);

/// The start of a run, perhaps in a state of another, with orders that suit its first step.
Dynamics resolved_start(const Model&, const State* from = nullptr);

}  // namespace sim
