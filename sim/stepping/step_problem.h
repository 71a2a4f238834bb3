// What one time step is asked for and what it answers, and the parts that all schemes are made of: operators at frozen
// positions, the coupled solve, frames.
#pragma once

#include "sim/core/attempt.h"
#include "sim/core/derived.h"
#include "sim/stepping/dynamics.h"
#include "sim/suspension/suspension.h"

namespace sim {

/// A scene with its plans: what stays the same during a run.
struct Model {
  const Scene& scene;
  Plans& plans;
  std::vector<Material> materials;
  const Ranks& ranks;  ///< who share the work
};
Model make_model(const Scene&, Plans&, const Ranks& = alone);

/// A step to take: from a state, over dt, in the flows that act during it.
struct StepProblem {
  const Model& model;
  const Dynamics& before;
  double dt;
  std::vector<FlowParameters> flows;  ///< none is switched within the step
};

/// What becomes of one vesicle: its position and motion at the new time, the velocity of its grid along the membrane
/// and the frame of its shape there, and its history then.
struct Moved {
  Coefficients position;
  Motion motion;
  Coefficients sliding;
  Frame frame;
  History history;
  double c = 0;  ///< of the formula, x+ = h + c x'; 0: no formula looks back at how the position came about
  /// Estimated local error of the position, before any correction, by size_of(). Of the right order; right to leading
  /// order except for block-jacobi and explicit, whose splitting it does not see.
  double error = 0;
};

struct Advance {
  std::vector<Moved> vesicles;  ///< of this rank
  int iterations = 0;
  double residual = 0;
  Division division = {};  ///< whose vesicles are which
  Lessons learned = {};
};

/// The reason of a linear solve that has not converged.
Rejection not_converged(double residual, int iterations);

/// Smallest gap between two membranes; a run stops below it: numerics.gap_floor, or 0.001 area radii of the smallest
/// vesicle.
double gap_floor(const Model&, const Dynamics&);

/// Operators at frozen positions with everything that the scene says of them, and the tensions that are expected there;
/// a periodic cell is that of the time. Throws std::domain_error where vesicles cross.
Suspension freeze(const Model&, const Dynamics&, double time, std::span<const Coefficients> positions,
                  std::span<const Motion> expected);

/// Solves for the motions at frozen positions, relative to those of the frames, to a relative residual, with what the
/// steps before have learned.
Attempt<SuspensionSolve> solve(const Model&, const Suspension&, double c, std::span<const Coefficients> forcing,
                               std::span<const Motion> guess, std::span<const Frame> frames, double tolerance,
                               const Dynamics& before);

/// Velocity of a frame at the points of a body.
Coefficients frame_velocity(const RigidBody&, const Frame&);
/// The frame of a shape that moves with a velocity in a flow.
Frame frame_of(const Membrane&, const Coefficients& velocity, std::span<const FlowParameters>, double time);
/// Root of the mean square over the parameter sphere, in area radii of the vesicle.
double size_of(const VesicleDynamics&, const Matrix& difference);

/// Rate at which the membrane of a vesicle moves relative to its centre, largest of all.
double fastest_motion(const Dynamics&);
/// How far membranes move in a step, in area radii: what an error of position is compared with. A small constant is
/// added, so that steps need not become short for nothing while all motion dies out.
double motion_over(const Dynamics&, double dt);

/// Of every vesicle; sizes: A0 and V0.
std::vector<AreaVolume> sizes(const Dynamics&);
std::vector<Coefficients> positions(const Dynamics&);
std::vector<Motion> motions(const Dynamics&);
std::vector<Frame> frames(const Dynamics&);

}  // namespace sim
