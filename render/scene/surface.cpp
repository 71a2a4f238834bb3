#include "render/scene/surface.h"

#include "sim/sphere/basis.h"
#include "sim/sphere/legendre.h"

#include <cmath>
#include <numbers>

namespace render {

SurfacePoints surface_points(const sim::Coefficients& position, const sim::Matrix& directions) {
  // Derivatives in phi do not exist on the axis; 1e-7 rad beside it the normal is the same to seven digits.
  sim::Matrix beside = directions;
  for (Eigen::Index i = 0; i < beside.rows(); ++i)
    if (std::hypot(beside(i, 0), beside(i, 1)) < 1e-7) {
      beside(i, 0) = 1e-7;
      beside.row(i).normalize();
    }
  const sim::FirstDerivatives x = sim::sample_points_first(position, beside);
  SurfacePoints points;
  points.position = x.value;
  points.normal.resize(x.value.rows(), 3);
  for (Eigen::Index i = 0; i < x.value.rows(); ++i) {
    const sim::Vec3 t = x.t.row(i), f = x.f.row(i);
    points.normal.row(i) = t.cross(f).stableNormalized().transpose();
  }
  return points;
}

// Divergence theorem: int f dV over a homogeneous polynomial f of degree k is 1/(3 + k) oint f x.n dA.
VolumeMoments volume_moments(const sim::Coefficients& position) {
  const int nodes = 2 * position.order + 4;
  const sim::GaussLegendre rule = sim::gauss_legendre(nodes);
  const Eigen::Index columns = 2 * nodes;
  const sim::Vector phi = sim::Vector::LinSpaced(columns + 1, 0, 2 * std::numbers::pi).head(columns);
  const sim::FirstDerivatives x = sim::sample_grid(position, rule.theta, phi);
  const sim::Vec3 origin = x.value.colwise().mean().transpose();  // far from the scene's own, digits would be lost
  VolumeMoments m;
  sim::Vec3 first = sim::Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < x.value.rows(); ++i) {
    const sim::Vec3 p = x.value.row(i).transpose() - origin, t = x.t.row(i), f = x.f.row(i);
    const Eigen::Index latitude = i % nodes;  // the rule's weights are for d(cos theta) = sin theta d theta
    const double flux = p.dot(t.cross(f)) * rule.weight[latitude] / std::sin(rule.theta[latitude]) * 2 *
                        std::numbers::pi / static_cast<double>(columns);
    m.volume += flux / 3;
    first += flux / 4 * p;
    second += flux / 5 * p * p.transpose();
  }
  const sim::Vec3 offset = first / m.volume;
  m.centroid = origin + offset;
  m.second = second / m.volume - offset * offset.transpose();
  return m;
}

}  // namespace render
