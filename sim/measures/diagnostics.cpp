#include "sim/measures/diagnostics.h"

#include <cmath>
#include <numbers>

namespace sim {

VesicleMeasures measure(Plans& plans, const VesicleState& v, double area0, double volume0) {
  const int p = v.position.order;
  const Basis& basis = plans.basis(p, measure_order(p));
  const Geometry g = geometry(basis, v.position);
  const Measures whole = measures(g);
  VesicleMeasures m;
  m.area = whole.area;
  m.volume = whole.volume;
  m.area_error = whole.area / area0 - 1;
  m.volume_error = whole.volume / volume0 - 1;
  m.reduced_volume = reduced_volume(whole.area, whole.volume);
  m.center = whole.centroid;
  const auto& M = whole.moments;
  m.inclination_deg = inclination(M) * 180 / std::numbers::pi;
  const Vec3 eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(M, Eigen::EigenvaluesOnly).eigenvalues();
  for (int i = 0; i < 3; ++i) m.axes[i] = std::sqrt(5 * eigenvalues[2 - i] / whole.volume);
  m.energy = whole.h_squared / (4 * std::numbers::pi);
  const Matrix u = basis.synthesize(v.velocity).values, sigma = basis.synthesize(v.tension).values;
  m.velocity_l2 = std::sqrt(integrate(g, u.rowwise().squaredNorm()));
  m.normal_velocity_l2 = std::sqrt(integrate(g, u.cwiseProduct(g.n).rowwise().sum().cwiseAbs2()));
  m.tension_mean = integrate(g, sigma.col(0)) / whole.area;
  m.tension_min = sigma.minCoeff();
  m.tension_max = sigma.maxCoeff();
  return m;
}

}  // namespace sim
