// One vesicle's operators at a frozen geometry, and the semi-implicit system (39)-(42) they form.
//
// The unknowns are the velocity u and the tension sigma rather than x+ = h + c u with the history h: for backward Euler
// h = x and c = dt, for BDF2 see stepper.h, and c = 0 gives the instantaneous problem (3a)-(3b). In these unknowns
//   alpha u - (1-lambda) D u - S [f_b(c u) + f_sigma(sigma)] = r,      r = u_inf + S [f_b(h) + buoyancy]      (39a)
//   -P { (1-lambda) D u + S [f_b(c u) + f_sigma(sigma)] } = P r,                                              (39b)
// with P the surface divergence; (39b) is P applied to (39a) under P u = 0. S carries 1/(8 pi), viscosity 1 outside.
//
// D acts on u minus its rigid part, for which the exact value -1/2 is used (rigid.h): rigid motions then solve (39)
// exactly for every lambda.
#pragma once

#include "sim/membrane/flows.h"
#include "sim/membrane/sheet.h"
#include "sim/membrane/waves.h"

namespace sim {

/// A sheet in a fluid: what velocities its forces and its own motion induce on itself.
struct Membrane : Sheet {
  LayerMatrices layers;  ///< D assembled only when lambda differs from 1
  SurfaceWaves waves;
};

/// Geometry and operators at x*, source_order 0 means p + 1; the rest as in freeze_sheet().
Membrane freeze_membrane(Plans&, const Material&, const Coefficients& position, double upsampling, int source_order,
                         const Coefficients& expected_tension = {}, std::optional<PinnedTension> pinned = {});

/// How many unknowns there are of a vesicle of degree p.
inline Eigen::Index unknowns(int order) { return 4 * Eigen::Index(coefficient_count(order)); }
Vector packed(const Motion&);
Motion unpacked(const Vector&, int order);

/// (1 - lambda) D u, exact for the rigid part of u; empty values for lambda = 1.
Coefficients double_layer(const Membrane&, const Coefficients& velocity);
/// Density of the double layer for other vesicles: (1 - lambda) u minus its rigid part, whose velocity outside is
/// zero.
Coefficients dual_density(const RigidBody&, double viscosity_contrast, const Coefficients& velocity);

/// (1 - lambda) D u + S f.
Coefficients layer_velocity(const Membrane&, const Coefficients& force, const Coefficients& velocity);

/// Both rows of (39), packed, from the trial motion (u, sigma) and the velocity v that all layers induce: alpha
/// u - v, -R P v. The area radius R makes both rows velocities, so that a residual means the same in any unit of
/// length. Where the tension is pinned, the constant part of the unknown is zero, which the row enforces.
Vector system_rows(const Membrane&, const Motion&, const Coefficients& v);
/// Right-hand side of (39) for a forcing r: r, R P r.
Vector system_right(const Membrane&, const Coefficients& r);

/// Left-hand side of (39) for the packed unknowns.
Vector apply_system(const Membrane&, double c, const Vector& unknowns);

}  // namespace sim
