// All vesicles at frozen positions, and the coupled system (40)-(42): the self blocks of membrane.h plus interactions.
#pragma once

#include "interaction.h"

namespace sim {

struct Suspension {
  std::vector<Membrane> membranes;
  Interaction interaction;
  std::vector<Coefficients> repulsion;  ///< force density on each vesicle; empty: none
};

struct SuspensionOptions {
  int source_order = 0;           ///< of the singular rule
  InteractionOptions interaction;
  double repulsion_strength = 0, repulsion_range = 0.05;  ///< strength 0: none
};

/// Geometry and operators of all vesicles at x*; expected tensions: see freeze_membrane().
Suspension freeze_suspension(Plans&, std::span<const Material>, std::span<const Coefficients> positions,
                             std::span<const int> upsamplings, const SuspensionOptions&,
                             std::span<const Coefficients> expected_tensions = {});

/// r of (39a) for every vesicle: background flow, and the velocities that the bending of the histories, buoyancy and
/// repulsion cause, one's own and the others'. `displacements`: histories less frozen positions, none where they are the same.
std::vector<Coefficients> suspension_forcing(const Suspension&, std::span<const FlowParameters>, double time,
                                             const Vec3& gravity, std::span<const Coefficients> displacements = {});

/// Velocity that known forces (per vesicle, degree p) on all vesicles induce on the others, with the double layer of known
/// motions if they are given: the lagged interaction of the block schemes.
std::vector<Coefficients> interaction_of(const Suspension&, std::span<const Coefficients> forces,
                                         std::span<const Motion> motions = {});

enum class Preconditioner {
  spectral,  ///< the corrected one of section 3.5
  block,     ///< a loose GMRES solve of each self block
};

struct SuspensionSolve {
  std::vector<Motion> motions;
  int iterations = 0;
  double residual = 0;
  bool converged = false;
};
/// Solves the coupled system from a guess.
SuspensionSolve solve_suspension(const Suspension&, double c, std::span<const Coefficients> forcing,
                                 std::span<const Motion> guess, double tolerance, Preconditioner);

}  // namespace sim
