#include "sim/measures/stresslet.h"

#include "sim/core/parallel.h"
#include "sim/suspension/loads.h"

#include <cmath>
#include <stdexcept>

namespace sim {

Eigen::Matrix3d stresslet(const Geometry& g, const Vec3& c, const Matrix& force, const Matrix& velocity,
                          double viscosity_contrast) {
  const Matrix arm = g.x.value.rowwise() - c.transpose();
  const auto weights = g.dA.asDiagonal();
  const Eigen::Matrix3d moment = force.transpose() * weights * arm, strain = velocity.transpose() * weights * g.n;
  const Eigen::Matrix3d s =
      -(moment + moment.transpose()) / 2 + (viscosity_contrast - 1) * (strain + strain.transpose());
  return s - s.trace() / 3 * Eigen::Matrix3d::Identity();
}

double inclination_rate(const Geometry& g, const Vec3& c, const Eigen::Matrix3d& m, const Matrix& velocity) {
  const Matrix arm = g.x.value.rowwise() - c.transpose();
  const Vector outflow = velocity.cwiseProduct(g.n).rowwise().sum().cwiseProduct(g.dA);
  const Eigen::Matrix3d rate = arm.transpose() * outflow.asDiagonal() * arm;  // dM/dt, by Reynolds
  const double a = m(0, 0) - m(2, 2), b = 2 * m(0, 2);                        // the angle is atan2(b, a)/2
  return (a * 2 * rate(0, 2) - b * (rate(0, 0) - rate(2, 2))) / (2 * (a * a + b * b));
}

std::vector<FlowMeasures> flow_measures(Plans& plans, const Scene& scene, const State& state, bool forces) {
  std::vector<Load> loads;
  if (forces) try {
      loads = solved_loads(plans, scene, state);
    } catch (const std::domain_error&) {  // a vesicle reaches into another: no flow has such a state
      forces = false;
    }
  const auto n = static_cast<int>(state.vesicles.size());
  const std::optional<double> rate = steady_shear_rate(scene.flows);
  std::vector<FlowMeasures> all(n);
  parallel_for(n, [&](int i) {
    const VesicleState& v = state.vesicles[i];
    const int p = v.position.order;
    const Basis& basis = plans.basis(p, measure_order(p));
    const Geometry g = geometry(basis, v.position);
    const Measures whole = measures(g);
    const Vec3& c = whole.centroid;
    FlowMeasures& m = all[i];
    Matrix u = basis.synthesize(v.velocity).values;
    // The velocity of the vesicle as a whole costs digits of what is left. What a step's residual adds to the volume
    // must not act at a distance.
    const Eigen::RowVector3d mean = u.colwise().mean();
    u.rowwise() -= mean;
    const Vector outflow = u.cwiseProduct(g.n).rowwise().sum().cwiseProduct(g.dA);
    const Vec3 rest = (g.x.value.rowwise() - c.transpose()).transpose() * outflow / whole.volume;
    m.center_velocity = mean.transpose() + rest;
    u.rowwise() -= rest.transpose();
    if (forces)
      m.stresslet = stresslet(g, c, basis.synthesize(loads[i].force).values,
                              basis.synthesize(without_rigid_part(loads[i].body, loads[i].velocity)).values,
                              scene.vesicles[i].viscosity_contrast);
    if (rate) {
      const double unit = *rate * whole.volume;
      m.intrinsic_viscosity = m.stresslet(0, 2) / unit;
      m.normal_stress_1 = (m.stresslet(0, 0) - m.stresslet(2, 2)) / std::abs(unit);
      m.normal_stress_2 = (m.stresslet(2, 2) - m.stresslet(1, 1)) / std::abs(unit);
    }
    if (const std::optional<Vec3> direction = across(scene.flows, c)) {
      const Vec3 undisturbed = background_velocity(scene.flows, state.time, c.transpose()).row(0).transpose();
      m.migration = (m.center_velocity - undisturbed).dot(*direction);
    }
    if (!is_sphere({whole.area, whole.volume})) m.inclination_rate = inclination_rate(g, c, whole.moments, u);
  });
  return all;
}

}  // namespace sim
