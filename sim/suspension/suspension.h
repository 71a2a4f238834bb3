// All vesicles at frozen positions, and the coupled system (40)-(42): the self blocks of membrane.h plus interactions.
#pragma once

#include "sim/membrane/block.h"
#include "sim/membrane/learned.h"
#include "sim/suspension/interaction.h"
#include "sim/suspension/repulsion.h"

namespace sim {

struct Suspension {
  std::vector<std::optional<Membrane>> membranes;  ///< of this rank's vesicles
  Interaction interaction;
  std::vector<Coefficients> repulsion;  ///< force density on each vesicle of this rank; empty: none
  Division division;                    ///< of the vesicles among ranks
};

struct SuspensionOptions {
  int source_order = 0;  ///< of the singular rule
  InteractionOptions interaction;
  Repulsion repulsion;
};

/// A vesicle with negligible excess area: its shape is a sphere to 1.2e-3 of its radius, held by a constant tension.
bool is_sphere(const AreaVolume&);
/// Largest strain rate of the vesicles of a scene by any cause: background flow at full strength, bending, buoyancy.
/// `sizes`: A0 and V0.
double straining_rate(Plans&, std::span<const FlowParameters>, const Vec3& gravity, std::span<const Material>,
                      std::span<const Coefficients> positions, std::span<const AreaVolume> sizes);

/// The tensions of the spheres among them, from the strain rate of the scene.
std::vector<std::optional<PinnedTension>> pinned_tensions(Plans&, std::span<const FlowParameters>, const Vec3& gravity,
                                                          std::span<const Material>,
                                                          std::span<const Coefficients> positions,
                                                          std::span<const AreaVolume> sizes);

/// R0 = sqrt(A / 4 pi), and the smallest of several.
double area_radius(const AreaVolume&);
double smallest_radius(std::span<const AreaVolume> sizes);
/// The range asked for, or the default one.
double repulsion_range(const NumericsParameters&, double smallest_radius);

/// Geometry and operators of all vesicles at x*, each on its rank (options.interaction.division); expected tensions:
/// see freeze_membrane().
Suspension freeze_suspension(Plans&, std::span<const Material>, std::span<const Coefficients> positions,
                             std::span<const double> upsamplings, const SuspensionOptions&,
                             std::span<const Coefficients> expected_tensions = {},
                             std::span<const std::optional<PinnedTension>> pinned = {});

/// As a scene asks for them, lengths that are not given in terms of the smallest vesicle; far fields to a tolerance.
SuspensionOptions suspension_options(const NumericsParameters&, double smallest_radius, double tolerance,
                                     const CellSides& = {});

/// r of (39a) for every vesicle: background flow, and the velocities induced by bending at the histories, buoyancy
/// and repulsion of all vesicles, itself included. `displacements`: histories minus frozen positions, none when they
/// coincide. As with all that is given by vesicle here, those of other ranks stay empty.
std::vector<Coefficients> suspension_forcing(const Suspension&, std::span<const FlowParameters>, double time,
                                             const Vec3& gravity, std::span<const Coefficients> displacements = {});

/// Velocity that known forces (per vesicle, degree p) on all vesicles induce on the others, with the double layer of
/// known motions if given: the lagged interaction of the block schemes.
std::vector<Coefficients> interaction_of(const Suspension&, std::span<const Coefficients> forces,
                                         std::span<const Motion> motions = {});

struct SuspensionSolve {
  std::vector<Motion> motions;
  int iterations = 0;
  double residual = 0;
  bool converged = false;
  Lessons learned;  ///< what the next solve may use
};
/// Solves the coupled system from a guess. `frames`: for each vesicle a rigid motion close to its own. The unknown is
/// the rest of the motion, so the tolerance is relative to the rest, and displacements over the time c are those of
/// the rest. Each rank gets the motions of its own vesicles. `known`: what earlier solves have learned, nothing or an
/// entry a vesicle.
SuspensionSolve solve_suspension(const Suspension&, double c, std::span<const Coefficients> forcing,
                                 std::span<const Motion> guess, double tolerance, Preconditioner,
                                 std::span<const RigidMotion> frames = {}, const Lessons& known = {});

}  // namespace sim
