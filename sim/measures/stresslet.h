// What a vesicle does to a suspension, and how it moves as a whole, from one saved state: stresslet, intrinsic
// viscosity and normal stress differences, velocity of its centre, turning of its long axis.
//
// The particle stress of a suspension is (sum of S)/volume, with the stresslet about the centre c of the volume
//   S = dev { -oint sym(f (x - c)) dA + (lambda - 1) oint (u n + n u) dA },   viscosity 1 outside,
// f the force density of the membrane on the fluid and dev the part without trace, which is a pressure. S.E > 0 for a
// body that resists straining, and S = (20 pi/3) R^3 E for a rigid sphere. Far away it makes the velocity
//   u - u_inf = -(3/(8 pi)) r (r.S.r)/|r|^5.
#pragma once

#include "sim/layers/plans.h"
#include "sim/surface/geometry.h"

#include "sim/core/parameters.h"

#include <limits>
#include <vector>

namespace sim {

/// On the grid of the geometry, about c: force and velocity are points x 3.
Eigen::Matrix3d stresslet(const Geometry&, const Vec3& c, const Matrix& force, const Matrix& velocity,
                          double viscosity_contrast);

/// Rate of change of the inclination, rad/time, of a body with second moments M about c whose surface moves with a
/// velocity (points x 3).
double inclination_rate(const Geometry&, const Vec3& c, const Eigen::Matrix3d& M, const Matrix& velocity);

/// One vesicle of one saved state, in scene units; NaN: has no meaning there.
struct FlowMeasures {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix3d stresslet = Eigen::Matrix3d::Constant(none);
  /// S_xz/(rate V), (S_xx - S_zz)/(|rate| V), (S_zz - S_yy)/(|rate| V) in a steady shear
  double intrinsic_viscosity = none, normal_stress_1 = none, normal_stress_2 = none;
  Vec3 center_velocity = Vec3::Zero();  ///< dc/dt = 1/V oint (x - c) (u.n) dA, the centre's own volume kept
  double migration = none;              ///< of it less the undisturbed flow at c, the part along across()
  double inclination_rate = none;       ///< of the long axis, rad/time; a sphere has none
};

/// Of all vesicles of a state of that scene. Stresslets, and what follows from them, take a solve of the whole state;
/// without forces they are NaN.
std::vector<FlowMeasures> flow_measures(Plans&, const Scene&, const State&, bool forces = true);

/// The columns of a table of measures, declared once: v(name, meaning, value).
template <class V>
void visit(const FlowMeasures& m, V&& v) {
  v("stresslet_xx", "stresslet about the centroid, without trace; viscosity 1 outside", m.stresslet(0, 0));
  v("stresslet_yy", "...", m.stresslet(1, 1));
  v("stresslet_zz", "...", m.stresslet(2, 2));
  v("stresslet_xy", "...", m.stresslet(0, 1));
  v("stresslet_xz", "...", m.stresslet(0, 2));
  v("stresslet_yz", "...", m.stresslet(1, 2));
  v("intrinsic_viscosity", "S_xz/(rate V) in steady shear; nan in other flows", m.intrinsic_viscosity);
  v("normal_stress_1", "(S_xx - S_zz)/(|rate| V) in steady shear; nan in other flows", m.normal_stress_1);
  v("normal_stress_2", "(S_zz - S_yy)/(|rate| V) in steady shear; nan in other flows", m.normal_stress_2);
  v("center_velocity_x", "velocity of the volume centroid", m.center_velocity[0]);
  v("center_velocity_y", "velocity of the volume centroid", m.center_velocity[1]);
  v("center_velocity_z", "velocity of the volume centroid", m.center_velocity[2]);
  v("migration",
    "velocity of the centroid across a shear flow, along z, or away from the axis of a Poiseuille flow; nan in others",
    m.migration);
  v("inclination_rate", "d(inclination)/dt in rad/time; nan for a sphere", m.inclination_rate);
}

}  // namespace sim
