// Measures of a saved state: areas, volumes, axes, inclination, energy, velocities, tensions.
#pragma once

#include "sim/surface/correction.h"

namespace sim {

/// One vesicle of one saved state. Lengths in scene units; E/(8 pi kappa) with Helfrich's kappa = kappa_b/2.
struct VesicleMeasures {
  double area = 0, volume = 0, area_error = 0, volume_error = 0, reduced_volume = 0;
  Vec3 center = Vec3::Zero();  ///< volume centroid c
  double inclination_deg = 0;  ///< atan2(2 M_xz, M_xx - M_zz)/2 in (-90, 90]
  Vec3 axes = Vec3::Zero();    ///< sqrt(5 m_i/V), m_i the eigenvalues of M = int (x-c)(x-c)^T dV, largest first
  double energy = 0;           ///< E/(8 pi kappa), 1 for a sphere
  double velocity_l2 = 0, normal_velocity_l2 = 0;             ///< sqrt(int |u|^2 dA), sqrt(int (u.n)^2 dA)
  double tension_mean = 0, tension_min = 0, tension_max = 0;  ///< mean over the area; extremes on the grid
};

/// area0, volume0: of the initial state, reference for the errors.
VesicleMeasures measure(Plans&, const VesicleState&, double area0, double volume0);

/// The columns of a table of measures, declared once: v(name, meaning, value).
template <class V>
void visit(const VesicleMeasures& m, V&& v) {
  v("area", "surface area", m.area);
  v("volume", "enclosed volume", m.volume);
  v("area_error", "A/A0 - 1 against the initial state", m.area_error);
  v("volume_error", "V/V0 - 1 against the initial state", m.volume_error);
  v("reduced_volume", "V/((4 pi/3)(A/4 pi)^(3/2))", m.reduced_volume);
  v("center_x", "volume centroid", m.center[0]);
  v("center_y", "volume centroid", m.center[1]);
  v("center_z", "volume centroid", m.center[2]);
  v("inclination_deg", "atan2(2 M_xz, M_xx - M_zz)/2 of the second moments, in (-90, 90]", m.inclination_deg);
  v("axis_1", "sqrt(5 m_i/V) of the second moments, largest", m.axes[0]);
  v("axis_2", "... middle", m.axes[1]);
  v("axis_3", "... smallest", m.axes[2]);
  v("energy", "E/(8 pi kappa), 1 for a sphere", m.energy);
  v("velocity_l2", "sqrt(int |u|^2 dA)", m.velocity_l2);
  v("normal_velocity_l2", "sqrt(int (u.n)^2 dA)", m.normal_velocity_l2);
  v("tension_mean", "int sigma dA / A", m.tension_mean);
  v("tension_min", "smallest tension", m.tension_min);
  v("tension_max", "largest tension", m.tension_max);
}

}  // namespace sim
