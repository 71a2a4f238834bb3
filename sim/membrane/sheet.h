// The membrane as a sheet that resists bending and stretching, at a frozen geometry: what forces it puts on the fluid,
// without any flow. All that is linear in the unknowns of a step, velocity and tension, and the rest.
//
// Two things differ from the paper. The expected tension of the membrane is stiff in the position, as bending is: a
// ripple of wave number k relaxes at the rate sigma k/4. Where it is positive, 2 sigma (H+ - H) n is added to f_b, with
// the first variation H+ of forces.h; the terms left out are of second order in the step. Treated explicitly it would
// limit the step to about 5/(sigma p). And the tension has degree p - 1: its gradient then has degree p, as velocities
// do. With degree p the gradients of the highest degree would be cut off, and the velocity-tension pair would be nearly
// singular.
//
// A sphere has no excess area: a constant tension that grows without bound keeps it round, while the linear constraint
// P u = 0 leaves normal velocities free. Its constant tension is therefore not an unknown but prescribed and large,
// sigma_p, "pinned": 2 sigma_p (H+ - <H>) n without the pressure -2 sigma_p <H> n, which moves nothing.
#pragma once

#include "sim/layers/plans.h"
#include "sim/membrane/forces.h"
#include "sim/membrane/rigid.h"

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

struct Sheet {
  ForceBases bases;
  const Basis& ripples;  ///< degree p + 4 on the upsampled grid: the normal part of a displacement of degree p
  Material material;
  Geometry geometry;  ///< on the upsampled grid
  double radius;      ///< area radius
  RigidBody body;
  Matrix curvature_gradient;
  Vector stretched;                     ///< positive part of the expected tension on the grid
  double mean_stretched;                ///< its mean over the surface
  std::optional<PinnedTension> pinned;  ///< of a sphere
  int order() const { return bases.field.order(); }
};

/// Geometry at x*; upsampling is the rate of Algorithm 1. Without an expected tension (order p or less) the tension is
/// explicit in the position, as in the paper; a pinned one takes its place.
Sheet freeze_sheet(Plans&, const Material&, const Coefficients& position, double upsampling,
                   const Coefficients& expected_tension = {}, std::optional<PinnedTension> pinned = {});

/// Velocity (3 fields) and tension (1 field) as coefficients of degree p; the highest degree of the tension is zero.
struct Motion {
  Coefficients velocity, tension;
};
/// The time c of a step, or that in which a pinned tension acts in an instantaneous problem.
double step_of(const Sheet&, double c);

/// Eq. (36): surface divergence of a velocity, projected on degree p - 1 and padded to p.
Coefficients divergence(const Sheet&, const Coefficients& velocity);

/// Buoyancy as a traction on the membrane, (density inside - outside) (g.x) n: points x 3. Its integral is the
/// weight.
Matrix buoyancy_force(const Sheet&, const Vec3& gravity);

/// Forces as coefficients of degree p: the part of f_b(h + c u) + f_sigma(sigma) that is linear in u and sigma, and
/// the rest of it with buoyancy. `displacement`: h minus the frozen position; empty when they coincide.
Coefficients implicit_force(const Sheet&, double c, const Motion&);
Coefficients known_force(const Sheet&, const Vec3& gravity, const Coefficients& displacement = {});

}  // namespace sim
