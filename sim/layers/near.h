// The near-singular rule: single and double layer of one vesicle at a point close to, but not on it.
//
// The nearest point of the surface becomes the pole of a rotated grid whose colatitudes are graded towards it,
//   t = eps sinh(a u), u in (0, 1), a = asinh(pi / eps), eps = distance / metric at the pole,
// which resolves 1/|x - y| with a number of nodes that grows like log(1/distance). The result is a row: a functional of
// the density's coefficients, so that one evaluation of the kernel serves a whole solve.
#pragma once

#include "sim/sphere/point_sampler.h"
#include "sim/sphere/rotation.h"

namespace sim {

/// Nodes of the graded rule. Values at single points, the sharp tips of a prolate included: (48, 64) reaches 1e-5 down
/// to gaps of 0.003.
struct NearOrder {
  int latitudes = 32, longitudes = 32;
};
/// The least rule with which velocities of vesicles of such a degree err by less than about `error`, beside flows of
/// unit size, down to gaps of 0.005 radii: measured for p from 6 to 24 (docs/stepping.md).
NearOrder near_order_for(int degree, double error);

/// What all targets beside vesicles of one degree have in common; made in the time of a row.
struct NearRule {
  int degree;               ///< of the rotation plan that it is used with
  GaussLegendre latitudes;  ///< before they are graded
  Matrix cosines, slopes;   ///< (2p+1) x longitudes: cos and sin of m phi, normalised, and their derivatives
};
NearRule near_rule(int degree, NearOrder);

struct NearestPoint {
  Vec3 parameter = Vec3::UnitZ();  ///< on the unit sphere
  Vec3 position = Vec3::Zero();
  double distance = 0;
  bool inside = false;  ///< the target lies on the inner side of the membrane
};

/// Newton's method for the nearest point of x(s) to the target, started at the parameter `start`.
NearestPoint nearest_point(const PointSampler& position, const Vec3& target, const Vec3& start);

/// Rows of (4) with mu = 1 and of (5) without (1 - lambda) for one target: (p+1)^2 x 6 each, blocks xx, xy, xz, yy, yz,
/// zz.
struct PointRow {
  Matrix single, dual;  ///< dual: empty unless asked for
};
PointRow near_row(const NearRule&, const RotationPlan&, const Coefficients& position, const Vec3& target,
                  const NearestPoint&, bool with_double);

/// The same applied directly to densities, for a point that is evaluated once: S force + D dual (nullptr: none).
Vec3 near_velocity(const NearRule&, const RotationPlan&, const Coefficients& position, const Vec3& target,
                   const NearestPoint&, const Coefficients& force, const Coefficients* dual);

/// Velocity of a row: sum over the tensor blocks.
Vec3 apply_row(const Matrix& row, const Matrix& density);

}  // namespace sim
