// One smooth surface, position x as a field on the sphere (8), looked at point by point: where a search by Newton's
// method takes a few points of a surface, and each depends on the one before, the tables of a grid or of a batch of
// points serve one point only. Here Legendre functions of a point come from tables of the recurrence, and x, y, z and
// both trigonometric halves of a coefficient lie side by side, so that a point costs a few hundred vector operations.
#pragma once

#include "sim/sphere/basis.h"

#include <vector>

namespace sim {

/// A point of the surface with its derivatives along great circles through the parameter s, in the directions e1 (away
/// from the north pole) and e2 (eastward) of the unit sphere: unlike derivatives in the angles they are finite at
/// poles, though there e1, e2 are any two.
struct PointTangents {
  Vec3 e1, e2;      ///< tangents of the unit sphere
  Vec3 x, a, b;     ///< position, first derivatives along e1 and e2
  Vec3 aa, ab, bb;  ///< second derivatives, covariant
  double pole = 0;  ///< sine of the colatitude: second derivatives lose digits like its inverse square
};

/// Immutable; made in a time of a few points.
class PointSampler {
 public:
  /// Of three fields x, y, z of one degree.
  explicit PointSampler(const Coefficients& position);

  /// x(s): `s` need not be of unit length, but not zero.
  Vec3 position(const Vec3& s) const;
  /// The same with derivatives. Nearer to a pole than 1e-9 a point 1e-6 beside it is taken, with its own x.
  PointTangents tangents(const Vec3& s) const;

 private:
  struct Recurrence {
    double next, before;  ///< P_nm = next cos P_n-1,m - before P_n-2,m
    double down, up;      ///< P_nm' = down P_n,m-1 - up P_n,m+1
  };
  void legendre(double cosine, double sine, double* value) const;
  void ladder(const double* table, double* derivative) const;

  int order_;
  std::vector<Recurrence> recurrence_;               ///< at legendre_index
  Eigen::Matrix<double, 8, Eigen::Dynamic> halves_;  ///< rows cos x, y, z, 0, sin x, y, z, 0; columns as legendre_index
};

/// The parameter itself, or one a little beside a pole, where circles of latitude have a direction.
Vec3 beside_the_pole(const Vec3& s);

}  // namespace sim
