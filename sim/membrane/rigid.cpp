#include "sim/membrane/rigid.h"

#include "sim/surface/rows.h"

#include <cmath>
#include <numbers>

namespace sim {

namespace {

/// Coefficient of Y_00 of the constant 1.
const double constant = std::sqrt(4 * std::numbers::pi);

Eigen::Matrix3d cross_matrix(const Vec3& w) {
  Eigen::Matrix3d m;
  m << 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0;
  return m;
}

}  // namespace

RigidBody rigid_body(const Coefficients& x) {
  RigidBody b{x.values.row(0).transpose() / constant, x, {}};
  b.arm.values.row(0).setZero();
  const Eigen::Matrix3d second = b.arm.values.transpose() * b.arm.values;
  b.inverse_inertia = (second.trace() * Eigen::Matrix3d::Identity() - second).inverse();
  return b;
}

RigidMotion rigid_part(const RigidBody& b, const Coefficients& u) {
  // moment = sum of arm x u, from the antisymmetric part of arm^T u
  const Eigen::Matrix3d m = b.arm.values.transpose() * u.values;
  const Vec3 moment(m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0));
  return {u.values.row(0).transpose() / constant, b.inverse_inertia * moment, b.centre};
}

Coefficients rigid_velocity(const RigidBody& b, const RigidMotion& r) {
  Coefficients u{b.arm.order, b.arm.values * cross_matrix(r.rotation).transpose()};
  u.values.row(0) += constant * r.at(b.centre).transpose();
  return u;
}

Coefficients without_rigid_part(const RigidBody& b, const Coefficients& u) {
  return {u.order, u.values - rigid_velocity(b, rigid_part(b, u)).values};
}

RigidMotion shape_motion(const RigidBody& b, const Geometry& g, const Matrix& u) {
  constexpr double eta = 0.03;
  // Rotations are taken in units of the size, so that the six unknowns are all velocities. A motion (t, w) moves the
  // point at the arm a by t + w x a, and along the normal by n.t + (a x n).w.
  const double size = 1 / std::sqrt(b.inverse_inertia.trace());
  const Matrix arm = (g.x.value.rowwise() - b.centre.transpose()) / size;
  Matrix along(g.dA.size(), 6);
  along.leftCols(3) = g.n;
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    along.col(3 + d).array() = arm.col(e).array() * g.n.col(f).array() - arm.col(f).array() * g.n.col(e).array();
  }
  const Matrix weighted = scaled_rows(g.dA, along), weighted_arm = scaled_rows(g.dA, arm);
  const Eigen::Matrix3d second = sum_of_products(weighted_arm, arm), moment = sum_of_products(weighted_arm, u);
  const Vec3 first = weighted_arm.colwise().sum().transpose();
  Eigen::Matrix<double, 6, 6> all;
  all << g.dA.sum() * Eigen::Matrix3d::Identity(), -cross_matrix(first), cross_matrix(first),
      second.trace() * Eigen::Matrix3d::Identity() - second;
  Eigen::Matrix<double, 6, 1> carried;
  carried << u.transpose() * g.dA, moment(1, 2) - moment(2, 1), moment(2, 0) - moment(0, 2),
      moment(0, 1) - moment(1, 0);
  const Eigen::Matrix<double, 6, 6> left = (1 - eta) * sum_of_products(weighted, along) + eta * all;
  const Eigen::Matrix<double, 6, 1> right = (1 - eta) * sum_of_products(weighted, row_products(u, g.n)) + eta * carried;
  const Eigen::Matrix<double, 6, 1> r = left.ldlt().solve(right);
  return {r.head<3>(), r.tail<3>() / size, b.centre};
}

Eigen::Matrix3d mean_gradient(const RigidBody& b, const Coefficients& u) {
  return ((b.arm.values.transpose() * b.arm.values).ldlt().solve(b.arm.values.transpose() * u.values)).transpose();
}

namespace {

Eigen::Matrix3d turn(const Frame& frame, Span span) {
  const Vec3 mean = frame.motion.rotation + (span.from + span.to) / 2 * frame.spin_up;
  const double angle = mean.norm() * span.length();
  return angle == 0 ? Eigen::Matrix3d::Identity() : Eigen::AngleAxisd(angle, mean.normalized()).toRotationMatrix();
}

/// exp(a), and its mean over the way, the integral of exp(a s) over s from 0 to 1: by their series for a/2^k, doubled k
/// times.
struct Exponential {
  Eigen::Matrix3d whole, mean;
};
Exponential exponential(const Eigen::Matrix3d& a) {
  int halvings = 0;
  while (std::ldexp(a.norm(), -halvings) > 0.25) ++halvings;
  const Eigen::Matrix3d part = a * std::ldexp(1.0, -halvings), unit = Eigen::Matrix3d::Identity();
  Exponential e{unit, unit};
  Eigen::Matrix3d term = unit;
  for (int n = 1; n <= 14; ++n) {  // 0.25^14 / 14! is far below rounding
    term = (term * part / n).eval();
    e.whole += term;
    e.mean += term / (n + 1);
  }
  for (int k = 0; k < halvings; ++k) {
    e.mean = (0.5 * (unit + e.whole) * e.mean).eval();
    e.whole = (e.whole * e.whole).eval();
  }
  return e;
}

}  // namespace

Coefficients carried(const Frame& frame, Span span, const Coefficients& x) {
  const double time = span.length();
  const Vec3 centre = x.values.row(0).transpose() / constant;
  Coefficients moved{x.order, x.values * turn(frame, span).transpose()};
  // centre' = V + drift (centre - where it is now), V its velocity now
  const Vec3 shift = exponential(frame.drift * time).mean * (time * frame.at(centre).translation);
  moved.values.row(0) = constant * (centre + shift).transpose();
  return moved;
}

Coefficients turned(const Frame& frame, Span span, const Coefficients& u) {
  return {u.order, u.values * turn(frame, span).transpose()};
}

}  // namespace sim
