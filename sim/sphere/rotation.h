// Rotations of the parameter sphere acting on coefficients: x'(s) = x(Q s) with Q = Rz(phi) Ry(theta), which moves
// the point (theta, phi) to the pole. Ry(theta) = Rx(-pi/2) Rz(theta) Rx(pi/2), so one constant block matrix per
// degree and rotations about z suffice for every angle.
#pragma once

#include "sim/sphere/basis.h"

#include <array>

namespace sim {

class RotationPlan {
 public:
  explicit RotationPlan(int order);
  int order() const { return order_; }
  /// Of the generators L = s x grad, antisymmetric matrices on the coefficients of degree n: -L_a L_b - L_b L_a for (a,
  /// b) = (y, z), (z, x), (x, y), after -L_a L_a for the axes x, y, z.
  const std::array<Matrix, 6>& second_generators(int n) const { return second_generators_[n]; }
  /// Coefficients of f(Q s), field by field: (p+1)^2 x fields in and out.
  Matrix to_pole(const Matrix& coefficients, double theta, double phi) const;
  /// The transpose: maps functionals of the rotated coefficients to functionals of the original ones.
  Matrix from_pole(const Matrix& functionals, double theta, double phi) const;

 private:
  int order_;
  std::vector<Matrix> quarter_;  ///< per degree: coefficients of f(Rx(pi/2) s)
  std::vector<std::array<Matrix, 6>> second_generators_;
};

}  // namespace sim
