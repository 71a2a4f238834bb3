#include "sim/surface/correction.h"

#include <cmath>
#include <numbers>

namespace sim {

Correction area_volume_correction(Plans& plans, const Coefficients& position, double area, double volume) {
  const Basis& basis = plans.basis(position.order, measure_order(position.order));
  return area_volume_correction(plans, position, geometry(basis, position), area, volume);
}

Correction area_volume_correction(Plans& plans, const Coefficients& position, const Geometry& g, double area,
                                  double volume) {
  const int p = position.order;
  const Basis& basis = plans.basis(p, measure_order(p));
  const double radius = std::sqrt(area / (4 * std::numbers::pi));
  const Coefficients along[2] = {basis.analyze(g.n),
                                 basis.analyze(Matrix((g.n.array().colwise() * (radius * g.H).array()).matrix()))};
  Correction c{{p, Matrix::Zero(coefficient_count(p), 3)}, 0, 0, 0, false};
  Eigen::Vector2d amount = Eigen::Vector2d::Zero();
  // d(area) = -2 int H (shift.n), d(volume) = int shift.n, from the geometry before the shift; Broyden's update learns
  // how they change with it. The rows are made dimensionless.
  Eigen::Matrix2d slope;
  const double h = integrate(g, g.H), hh = integrate(g, g.H.cwiseAbs2());
  slope << -2 * h / area, -2 * radius * hh / area, g.dA.sum() / volume, radius * h / volume;
  Eigen::Vector2d before = Eigen::Vector2d::Zero(), step = Eigen::Vector2d::Zero();
  for (int iteration = 0; iteration < 12; ++iteration) {
    c.shift.values = amount[0] * along[0].values + amount[1] * along[1].values;
    const AreaVolume now = area_volume(basis, {p, position.values + c.shift.values});
    c.area = now.area;
    c.volume = now.volume;
    const Eigen::Vector2d miss(1 - now.area / area, 1 - now.volume / volume);
    if (!miss.allFinite()) return c;
    if (miss.cwiseAbs().maxCoeff() < 2e-13) break;
    if (iteration == 11) break;
    if (iteration > 0) slope += (before - miss - slope * step) * step.transpose() / step.squaredNorm();
    Eigen::JacobiSVD<Eigen::Matrix2d> svd(slope, Eigen::ComputeFullU | Eigen::ComputeFullV);
    svd.setThreshold(1e-7);
    step = svd.solve(miss);
    if (!(step.squaredNorm() > 0)) break;
    amount += step;
    before = miss;
  }
  c.converged = std::abs(c.area / area - 1) < 1e-9 && std::abs(c.volume / volume - 1) < 1e-9;
  c.largest = basis.synthesize(c.shift).values.rowwise().norm().maxCoeff();
  return c;
}

Correction volume_correction(Plans& plans, const Coefficients& position, const Geometry& g, double area,
                             double volume) {
  const int p = position.order;
  const Basis& basis = plans.basis(p, measure_order(p));
  const Coefficients along = basis.analyze(g.n);
  Correction c{{p, Matrix::Zero(coefficient_count(p), 3)}, 0, 0, 0, false};
  double amount = 0;
  for (int iteration = 0; iteration < 6; ++iteration) {
    c.shift.values = amount * along.values;
    const AreaVolume now = area_volume(basis, {p, position.values + c.shift.values});
    c.area = now.area;
    c.volume = now.volume;
    if (!(std::abs(now.volume / volume - 1) > 2e-14)) break;
    amount += (volume - now.volume) / now.area;  // d(volume) = area d(amount)
  }
  c.converged = std::abs(c.area / area - 1) < 1e-5 && std::abs(c.volume / volume - 1) < 1e-9;
  c.largest = basis.synthesize(c.shift).values.rowwise().norm().maxCoeff();
  return c;
}

}  // namespace sim
