#include "flows.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sim {

const std::vector<CatalogueRow<FlowFunction>>& flow_catalogue() {
  static const std::vector<CatalogueRow<FlowFunction>> table{
      {"none", "fluid at rest", {}, [](const FlowParameters&, const Vec3&) -> Vec3 { return Vec3::Zero(); }},
      {"shear", "simple shear, u = rate z e_x", {"rate"},
       [](const FlowParameters& f, const Vec3& x) -> Vec3 { return {f.rate * x[2], 0, 0}; }},
      {"poiseuille", "parabolic tube flow, u_x = U - a (y^2 + z^2)", {"curvature", "centreline_velocity"},
       [](const FlowParameters& f, const Vec3& x) -> Vec3 {
         return {f.centreline_velocity - f.curvature * (x[1] * x[1] + x[2] * x[2]), 0, 0};
       }},
      {"extension", "straining flow, rate (x, 0, -z) planar or rate (x, -y/2, -z/2) uniaxial", {"rate", "planar"},
       [](const FlowParameters& f, const Vec3& x) -> Vec3 {
         if (f.planar) return {f.rate * x[0], 0, -f.rate * x[2]};
         return {f.rate * x[0], -f.rate * x[1] / 2, -f.rate * x[2] / 2};
       }},
      {"rotation", "rigid rotation, u = omega x r", {"angular_velocity"},
       [](const FlowParameters& f, const Vec3& x) -> Vec3 { return f.angular_velocity.cross(x); }},
      {"uniform", "the same velocity everywhere", {"velocity"},
       [](const FlowParameters& f, const Vec3&) -> Vec3 { return f.velocity; }},
  };
  return table;
}

double time_factor(const FlowParameters& f, double time) {
  if (f.time_factor == "oscillating") return std::cos(2 * std::numbers::pi * f.frequency * time + f.phase);
  if (f.time_factor == "step") return time >= f.from && time < f.until ? 1 : 0;
  return 1;
}

Matrix background_velocity(std::span<const FlowParameters> flows, double time, const Matrix& points) {
  Matrix u = Matrix::Zero(points.rows(), 3);
  for (const FlowParameters& flow : flows) {
    const auto* row = find_row(flow_catalogue(), flow.kind);
    if (!row) throw std::invalid_argument("unknown flow '" + flow.kind + "'");
    const double factor = time_factor(flow, time);
    if (factor == 0) continue;
    for (Eigen::Index k = 0; k < points.rows(); ++k)
      u.row(k) += factor * row->function(flow, points.row(k).transpose()).transpose();
  }
  return u;
}

}  // namespace sim
