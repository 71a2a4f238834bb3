// A body as one block of the coupled system (40)-(42): so many unknowns, the densities by which the others feel it, its
// own rows, and an approximate inverse. A vesicle is one kind of body; the solver knows no other property of it.
#pragma once

#include "sim/membrane/gmres.h"
#include "sim/membrane/preconditioner.h"

namespace sim {

/// Densities on one body, degree p: force for the single layer, (1 - lambda) u minus its rigid part for the double
/// layer.
struct Densities {
  Coefficients force, dual;
};

/// What given unknowns of a body put into the fluid, and the velocity that this induces on itself.
struct Trial {
  Densities densities;
  Coefficients own_velocity;
};

struct Block {
  Eigen::Index size = 0;
  std::function<Trial(const Vector& unknowns)> trial;
  /// Rows of the left-hand side, given the velocity that all bodies together induce on this one.
  std::function<Vector(const Vector& unknowns, const Coefficients& velocity)> rows;
  LinearMap precondition;
};

enum class Preconditioner {
  spectral,  ///< the corrected one of section 3.5
  block,     ///< a loose GMRES solve of each self block
};
/// Of a vesicle at a step of c; the membrane must outlive it. `felt`: by others, or by images of itself; if not, the
/// density of the double layer, which they alone see, is left empty.
Block vesicle_block(const Membrane&, double c, Preconditioner, bool felt);

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
