// A grid that moves as part of a step: grid points slide along the membrane with a tangential velocity w,
//   x' = u + w,
// so that the high degrees of the position stay small while the membrane flows. w is smooth in time, so that nothing
// has to be carried to another parametrisation, ever. With the rigid motion R of the shape and a rate r, it minimises
// over fields of degree p
//   sum_n a_n (1 + r c) |w_n + g_n|^2 + eps |w|^2 + L oint (w.n)^2 dOmega,    g = (u - R + r y)/(1 + r c),
// with a_n = (n/p)^4, a_0 = 0, that is, with the new position x+ = y + c w,
//   a_n (w + u - R + r x+)_n + eps w_n + L (...) = 0:
// the degrees of x' relative to R shall be -r times those of x+, the more so the higher they are; w is as small as
// possible otherwise, and tangential up to 1/L. c does not occur in this condition, which is thus the same for every
// step, so that formulas of high order keep it. r is the rate at which the membrane moves within its shape, the size of
// u - R over the radius, or half of that at which the flow strains it, if that is larger: neither depends on how fast
// the whole turns. dOmega is that of the parameter sphere.
#pragma once

#include "sim/membrane/rigid.h"

namespace sim {

/// What the grid of a vesicle is to follow.
struct SlidingProblem {
  const Basis& basis;            ///< degree p, on the grid of the geometry
  const Geometry& geometry;      ///< whose normals are taken
  const RigidBody& body;         ///< of that geometry
  const Coefficients& position;  ///< y
  const Coefficients& velocity;  ///< u, in a frame in which it may turn
  double radius = 1;             ///< area radius
  Eigen::Matrix3d gradient;      ///< of the flow
  double c = 0;                  ///< time over which w moves the points: x+ = y + c w
};

/// w by conjugate gradients from a guess, to a residual relative to that of w = 0. It must be well below the error that
/// a step may have: w would not be smooth in time otherwise.
Coefficients sliding_velocity(const SlidingProblem&, const Coefficients& guess, double tolerance);

/// Root of the mean square over the parameter sphere of a velocity without its mean, in units of a length: the rate at
/// which a membrane moves, 1/time.
double motion_rate(const Coefficients& velocity, double length);

}  // namespace sim
