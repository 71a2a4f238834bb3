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
//
// Two differences from the paper. First, the expected tension of the membrane is stiff in the position, as bending
// is: a ripple of wave number k relaxes at the rate sigma k/4. Where it is positive, 2 sigma (H+ - H) n is added to
// f_b, with the first variation H+ of forces.h; the terms left out are of second order in the step. Treated
// explicitly it would limit the step to about 5/(sigma p). Second, the tension has degree p - 1: its gradient then
// has degree p, as velocities do. With degree p the gradients of the highest degree would be cut off, and the
// velocity-tension pair would be nearly singular.
//
// A sphere has no excess area: a constant tension that grows without bound keeps it round, while the linear
// constraint P u = 0 leaves normal velocities free. Its constant tension is therefore not an unknown but prescribed
// and large, sigma_p, "pinned": 2 sigma_p (H+ - <H>) n without the pressure -2 sigma_p <H> n, which moves nothing.
#pragma once

#include "flows.h"
#include "forces.h"
#include "gmres.h"
#include "rigid.h"
#include "waves.h"

#include <optional>

namespace sim {

/// Physical constants of one vesicle.
struct Material {
  double viscosity_contrast = 1;
  double bending_modulus = 0.01;
  double density_difference = 0;
  double alpha() const { return (1 + viscosity_contrast) / 2; }
};

/// The prescribed constant tension of a sphere, and the time over which it acts in an instantaneous problem (c = 0),
/// where it would otherwise have no effect on u.
struct PinnedTension {
  double tension = 0, time = 0;
};

struct Membrane {
  ForceBases bases;
  const Basis& ripples;  ///< degree p + 4 on the upsampled grid: the normal part of a displacement of degree p
  Material material;
  Geometry geometry;     ///< on the upsampled grid
  LayerMatrices layers;  ///< D assembled only when lambda differs from 1
  double radius;         ///< area radius
  RigidBody body;
  Matrix curvature_gradient;
  Vector stretched;      ///< positive part of the expected tension on the grid
  double mean_stretched; ///< its mean over the surface
  SurfaceWaves waves;
  std::optional<PinnedTension> pinned;  ///< of a sphere
  int order() const { return bases.field.order(); }
};

/// Geometry and operators at x*; upsampling is the rate of Algorithm 1, source_order 0 means p + 1. Without an expected
/// tension (order p or less) the tension is explicit in the position, as in the paper; a pinned one takes its place.
Membrane freeze_membrane(Plans&, const Material&, const Coefficients& position, int upsampling, int source_order,
                         const Coefficients& expected_tension = {}, std::optional<PinnedTension> pinned = {});

/// Velocity (3 fields) and tension (1 field) as coefficients of degree p; the highest degree of the tension is zero.
struct Motion {
  Coefficients velocity, tension;
};
Vector packed(const Motion&);
Motion unpacked(const Vector&, int order);

/// Eq. (36): surface divergence of a velocity, projected on degree p - 1 and padded to p.
Coefficients divergence(const Membrane&, const Coefficients& velocity);

/// Buoyancy as a traction on the membrane, (density inside - outside) (g.x) n: points x 3. Its integral is the
/// weight.
Matrix buoyancy_force(const Membrane&, const Vec3& gravity);

/// Forces as coefficients of degree p: the part of f_b(h + c u) + f_sigma(sigma) that is linear in u and sigma, and
/// the rest of it with buoyancy. `displacement`: h minus the frozen position; empty when they coincide.
Coefficients implicit_force(const Membrane&, double c, const Motion&);
Coefficients known_force(const Membrane&, const Vec3& gravity, const Coefficients& displacement = {});

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

/// The spectral preconditioner of section 3.5, corrected, and with the wave numbers k of the surface in place of n/R:
///   velocity: 1/alpha along the membrane, 1/(alpha + g) along its normal, g = c (kappa_b k^3/8 + sigma k/4)
///   tension:  1/l_n, l_n = n(n+1)(2n^2+2n-1)/((2n-1)(2n+1)(2n+3)), with n(n+1) = (kR)^2, l_0 = 1.
/// Velocities are truncated at degree p, which keeps only about half of normal fields of degree p and p + 1, so
/// 1/(alpha + g) is far from the inverse of alpha + N g N^T (N: psi -> psi n, truncated). Where the highest waves are
/// stiff, the full Woodbury formula 1/alpha - N (alpha/g + N^T N)^{-1} N^T / alpha is used for the last degrees.
struct SpectralInverse {
  double alpha;
  std::vector<Matrix> normal;   ///< 1/alpha minus the inverse for normal velocities, per degree; empty for c = 0
  Matrix edge;                  ///< the same for all higher degrees, as one matrix; may be empty
  std::vector<Matrix> tension;  ///< per degree
};
SpectralInverse spectral_inverse(const Membrane&, double c);
Coefficients precondition_velocity(const Membrane&, const SpectralInverse&, const Coefficients& u);
Coefficients precondition_tension(const SpectralInverse&, const Coefficients& sigma);
/// Both, packed.
Vector precondition(const Membrane&, const SpectralInverse&, const Vector&);

struct Solve {
  Motion motion;
  int iterations = 0;
  double residual = 0;
  bool converged = false;
};
/// Solves (39) from a guess. On an exact sphere the constant tension is a null vector unless it is pinned; it keeps
/// the value of the guess.
Solve solve_system(const Membrane&, double c, const Coefficients& forcing, const Motion& guess, double tolerance);

/// Eq. (43): the tension that makes (r + S f_sigma) / alpha free of divergence, -P S f_sigma(sigma) = P r.
Solve solve_tension(const Membrane&, const Coefficients& r, const Motion& guess, double tolerance);
/// Eq. (44): the velocity for a known tension, alpha u - (1-lambda) D u - S f_b(c u) = r + S f_sigma(sigma).
Solve solve_position(const Membrane&, double c, const Coefficients& r, const Motion& known, double tolerance);

}  // namespace sim
