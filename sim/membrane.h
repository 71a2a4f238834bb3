// One vesicle's operators at a frozen geometry, and the semi-implicit system (39)-(42) they make.
//
// The unknowns are the velocity u and the tension sigma rather than x+ = h + c u with the history h: for backward Euler
// h = x and c = dt, for BDF2 see stepper.h, and c = 0 gives the instantaneous problem (3a)-(3b). In these unknowns
//   alpha u - (1-lambda) D u - S [f_b(c u) + f_sigma(sigma)] = r,      r = u_inf + S [f_b(h) + buoyancy]      (39a)
//   -P { (1-lambda) D u + S [f_b(c u) + f_sigma(sigma)] } = P r,                                              (39b)
// with P the surface divergence; (39b) is P applied to (39a) under P u = 0. S carries 1/(8 pi), viscosity 1 outside.
#pragma once

#include "flows.h"
#include "forces.h"
#include "gmres.h"
#include "plans.h"

namespace sim {

/// Physical constants of one vesicle.
struct Material {
  double viscosity_contrast = 1;
  double bending_modulus = 0.01;
  double density_difference = 0;
  double alpha() const { return (1 + viscosity_contrast) / 2; }
};

struct Membrane {
  ForceBases bases;
  Material material;
  Geometry geometry;     ///< on the upsampled grid
  LayerMatrices layers;  ///< D assembled only when lambda differs from 1
  double radius;         ///< area radius
  int order() const { return bases.field.order(); }
};

/// Geometry and operators at x*; upsampling is the rate of Algorithm 1, source_order 0 means p + 1.
Membrane freeze_membrane(Plans&, const Material&, const Coefficients& position, int upsampling, int source_order);

/// Velocity (3 fields) and tension (1 field), degree p.
struct Motion {
  Coefficients velocity, tension;
};
Vector packed(const Motion&);
Motion unpacked(const Vector&, int order);

/// Eq. (36): surface divergence of a velocity, projected on degree p.
Coefficients divergence(const Membrane&, const Coefficients& velocity);

/// Buoyancy as a traction on the membrane, (density inside - outside) (g.x) n: points x 3. It adds up to the weight.
Matrix buoyancy_force(const Membrane&, const Vec3& gravity);

/// Forces as coefficients of degree p: f_b(c u) + f_sigma(sigma); and f_b(x) plus buoyancy.
Coefficients implicit_force(const Membrane&, double c, const Motion&);
Coefficients known_force(const Membrane&, const Vec3& gravity, const Coefficients& position);

/// (1 - lambda) D u + S f.
Coefficients layer_velocity(const Membrane&, const Coefficients& force, const Coefficients& velocity);

/// Both rows of (39), packed, from the trial velocity u and the velocity v that all layers make of it: alpha u - v, -P v.
Vector system_rows(const Membrane&, const Coefficients& u, const Coefficients& v);

/// Left-hand side of (39) for the packed unknowns.
Vector apply_system(const Membrane&, double c, const Vector& unknowns);

/// The corrected diagonal of section 3.5: 1/(alpha + c kappa_b n^3/(8 R^3)) for velocity, R/l_n for tension with
/// l_n = n(n+1)(2n^2+2n-1)/((2n-1)(2n+1)(2n+3)), l_0 = 1.
Vector preconditioner(const Membrane&, double c);

/// Right-hand side r of (39a) as velocity coefficients: background flow at time t at the frozen positions, the bending
/// force of the history h, and buoyancy.
Coefficients forcing(const Membrane&, std::span<const FlowParameters>, double time, const Vec3& gravity,
                     const Coefficients& history);

struct Solve {
  Motion motion;
  int iterations = 0;
  double residual = 0;
  bool converged = false;
};
/// Solves (39) from a guess. On an exact sphere the constant tension is a null vector; it stays what the guess has.
Solve solve_system(const Membrane&, double c, const Coefficients& forcing, const Motion& guess, double tolerance);


/// Eq. (43): the tension that makes (r + S f_sigma) / alpha free of divergence, -P S f_sigma(sigma) = P r.
Solve solve_tension(const Membrane&, const Coefficients& r, const Motion& guess, double tolerance);
/// Eq. (44): the velocity for a known tension, alpha u - (1-lambda) D u - S f_b(c u) = r + S f_sigma(sigma).
Solve solve_position(const Membrane&, double c, const Coefficients& r, const Motion& known, double tolerance);

}  // namespace sim
