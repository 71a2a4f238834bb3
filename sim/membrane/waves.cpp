#include "sim/membrane/waves.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace sim {

namespace {

/// C of the header: with A the mean over the sphere of the turned inverse metric, a 3 x 3 tangential tensor, the least
/// squares fit of A by C between tangential projections is C = (15/7) (A - (trace C)/15), trace C = (3/2) trace A.
Eigen::Matrix3d turned_metric(const Basis& basis, const Geometry& g) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  const Vector cos_theta = basis.theta().array().cos(), sin_theta = basis.theta().array().sin();
  for (int j = 0; j < basis.longitudes(); ++j) {
    const double cos_phi = std::cos(basis.phi()[j]), sin_phi = std::sin(basis.phi()[j]);
    const Vec3 e_f(-sin_phi, cos_phi, 0);
    for (int i = 0; i < basis.latitudes(); ++i) {
      const int k = i + basis.latitudes() * j;
      const double s = sin_theta[i];
      const Vec3 e_t(cos_theta[i] * cos_phi, cos_theta[i] * sin_phi, -s);
      mean += basis.weights()[k] / (4 * std::numbers::pi) *
              (g.lap_tt[k] * e_f * e_f.transpose() -
               0.5 * s * g.lap_tf[k] * (e_t * e_f.transpose() + e_f * e_t.transpose()) +
               s * s * g.lap_ff[k] * e_t * e_t.transpose());
    }
  }
  return 15.0 / 7 * (mean - mean.trace() / 10 * Eigen::Matrix3d::Identity());
}

/// Appends modes and wave numbers of a degree from its Laplacian; `mirrored`: sines, the first rows, and cosines do not
/// mix, and the two halves take a quarter of the time.
void append_modes(SurfaceWaves& waves, const Matrix& laplacian, bool mirrored) {
  const Eigen::Index size = laplacian.rows(), sines = mirrored ? size / 2 : 0;
  Matrix modes = Matrix::Zero(size, size);
  Vector numbers(size);
  for (const auto& [first, count] : {std::pair{Eigen::Index(0), sines}, std::pair{sines, size - sines}}) {
    if (count == 0) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix> half(laplacian.block(first, first, count, count));
    modes.block(first, first, count, count) = half.eigenvectors();
    numbers.segment(first, count) = half.eigenvalues().cwiseMax(0).cwiseSqrt();
  }
  waves.modes.push_back(std::move(modes));
  waves.numbers.push_back(std::move(numbers));
}

}  // namespace

SurfaceWaves surface_waves(Plans& plans, const Coefficients& position) {
  const int p = position.order;
  const Basis& basis = plans.basis(p + 1, p + 1);
  const Geometry g = geometry(basis, resized(position, p + 1));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(turned_metric(basis, g));
  const Eigen::Matrix3d C =
      axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).asDiagonal() * axes.eigenvectors().transpose();
  // Of a shape with the mirror y -> -y, which flows in the plane y = 0 keep; what a preconditioner leaves out costs
  // nothing.
  const bool mirrored = std::abs(C(0, 1)) + std::abs(C(1, 2)) <= 1e-9 * C.norm();
  const RotationPlan& rotation = plans.rotation(p + 1);
  SurfaceWaves waves{basis, g.n, {}, {}};
  for (int n = 0; n <= p + 1; ++n) {
    const auto& L = rotation.second_generators(n);
    // The sign is the one that makes it positive.
    const Matrix laplacian =
        C(0, 0) * L[0] + C(1, 1) * L[1] + C(2, 2) * L[2] + C(1, 2) * L[3] + C(2, 0) * L[4] + C(0, 1) * L[5];
    append_modes(waves, laplacian, mirrored);
  }
  return waves;
}

Matrix truncated_overlap(const SurfaceWaves& w, int first) {
  const int p = w.basis.order() - 1, nc = coefficient_count(p), below = first * first;
  const int count = coefficient_count(p + 1) - below;
  Matrix edge = Matrix::Zero(coefficient_count(p + 1), count);
  edge.bottomRows(count).setIdentity();
  const Matrix psi = w.basis.synthesize({p + 1, std::move(edge)}).values;
  Matrix overlap = Matrix::Zero(count, count);
  for (int axis = 0; axis < 3; ++axis) {
    const Matrix kept = w.basis.analyze(Matrix(psi.array().colwise() * w.n.col(axis).array())).values.topRows(nc);
    overlap.selfadjointView<Eigen::Lower>().rankUpdate(kept.transpose());
  }
  return overlap.selfadjointView<Eigen::Lower>();
}

}  // namespace sim
