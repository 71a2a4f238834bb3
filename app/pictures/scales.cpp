#include "app/pictures/scales.h"

#include "sim/core/derived.h"
#include "sim/membrane/flows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace app {

double NaturalScales::size_of(sim::FieldScale scale) const {
  switch (scale) {
    case sim::FieldScale::length:
      return length;
    case sim::FieldScale::curvature:
      return 1 / length;
    case sim::FieldScale::square_curvature:
      return 1 / length / length;
    case sim::FieldScale::tension:
      return velocity;  // viscosity x velocity
    case sim::FieldScale::force:
      return velocity / length;
    case sim::FieldScale::velocity:
      return velocity;
  }
  return 1;
}

// Each derivative of a surface multiplies the rounding of its positions by up to its order: two in curvatures, four in
// forces, from which tensions and velocities come.
double NaturalScales::rounding_of(sim::FieldScale scale) const {
  const double base = 10 * digits, two = static_cast<double>(order) * order;
  switch (scale) {
    case sim::FieldScale::length:
      return base * size_of(scale);
    case sim::FieldScale::curvature:
    case sim::FieldScale::square_curvature:
      return base * two * size_of(scale);
    case sim::FieldScale::tension:
    case sim::FieldScale::force:
    case sim::FieldScale::velocity:
      return std::max(base * two * two, solve) * size_of(scale);
  }
  return 0;
}

NaturalScales natural_scales(const sim::Scene& scene, const sim::State& state, double area_radius) {
  NaturalScales s;
  s.length = area_radius;
  s.solve = sim::solve_tolerance(scene);
  s.velocity = 0;
  std::vector<sim::FlowParameters> flows = scene.flows;
  for (sim::FlowParameters& flow : flows) flow.time_factor = "constant";  // where it oscillates: at its strongest
  double farthest = 0;
  for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
    const sim::Coefficients& x = state.vesicles[v].position;
    s.order = std::max(s.order, x.order);
    const sim::Vec3 centre = x.values.row(0).transpose() / std::sqrt(4 * std::numbers::pi);  // mean over the parameters
    farthest = std::max(farthest, centre.norm());
    sim::Matrix points = centre.transpose().replicate(6, 1);
    for (Eigen::Index k = 0; k < 3; ++k) {
      points(2 * k, k) += area_radius;
      points(2 * k + 1, k) -= area_radius;
    }
    s.velocity = std::max(s.velocity, sim::background_velocity(flows, 0, points).rowwise().norm().maxCoeff());
    const sim::VesicleParameters& p = scene.vesicles[v];
    s.velocity = std::max(s.velocity, p.bending_modulus / area_radius / area_radius);
    s.velocity = std::max(s.velocity,
                          std::abs(p.density_difference) * scene.buoyancy.gravity.norm() * area_radius * area_radius);
  }
  if (!(s.velocity > 0)) s.velocity = 1;
  s.digits = std::numeric_limits<double>::epsilon() * (1 + farthest / area_radius);
  return s;
}

}  // namespace app
