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

/// A vesicle without excess area to speak of: the shape is a sphere's to 1.2e-3 of its radius, and a constant tension holds it.
bool is_sphere(const AreaVolume&);
/// The fastest rate at which anything strains the vesicles of a scene: the background flow at its full strength, bending,
/// buoyancy. `sizes`: A0 and V0.
double straining_rate(Plans&, std::span<const FlowParameters>, const Vec3& gravity, std::span<const Material>,
                      std::span<const Coefficients> positions, std::span<const AreaVolume> sizes);

/// The tensions of those that are spheres, from the rate that strains the vesicles of the scene.
std::vector<std::optional<PinnedTension>> pinned_tensions(Plans&, std::span<const FlowParameters>, const Vec3& gravity,
                                                          std::span<const Material>, std::span<const Coefficients> positions,
                                                          std::span<const AreaVolume> sizes);

/// Least area radius of some vesicles.
double smallest_radius(std::span<const AreaVolume> sizes);

/// Geometry and operators of all vesicles at x*; expected tensions: see freeze_membrane().
Suspension freeze_suspension(Plans&, std::span<const Material>, std::span<const Coefficients> positions,
                             std::span<const int> upsamplings, const SuspensionOptions&,
                             std::span<const Coefficients> expected_tensions = {},
                             std::span<const std::optional<PinnedTension>> pinned = {});

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
/// Solves the coupled system from a guess. `frames`: a rigid motion a vesicle near its own. What is solved for is the rest of the
/// motion, and so the tolerance, which is relative to the rest, and displacements over the time c are those of the rest.
SuspensionSolve solve_suspension(const Suspension&, double c, std::span<const Coefficients> forcing,
                                 std::span<const Motion> guess, double tolerance, Preconditioner,
                                 std::span<const RigidMotion> frames = {});

}  // namespace sim
