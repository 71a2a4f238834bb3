// Time-stepping schemes: how one step moves all vesicles. Checks, corrections and relabelling follow, in stepper.h.
//
// A scheme maps a state and a step to positions, motions, the history of the next step and an estimate of its own local
// error, or says why there is no such step. A row of the catalogue tells how far back a scheme looks; nothing else need
// know.
//
// Of first order, everything frozen at x_n, section 3.4 of the paper:
//   explicit           tension by (43), then x+ = x + dt/alpha (...); other forces and the own motion lag
//   block-jacobi       tension by (43), then the position implicitly by (44)
//   block-implicit     both together, vesicle by vesicle; other vesicles' forces lag
//   globally-implicit  backward Euler (38) on the coupled system
// bdf2: in a frame that moves with the vesicle (below), operators, normal and background flow at x* = x_n + r w,
//   u+ = (x+ - h)/c. With r = dt/dt_before, w = x_n - x_{n-1}, h = x_n + r^2/(1+2r) w and c = dt (1+r)/(1+2r); second
//   order for steps of any length. It starts with one step of extrapolated backward Euler, 2 x(two half steps) - x(one
//   step).
//
// The frame of a vesicle rotates at a rate extrapolated linearly from the rotation of its shape at the last two
// times, and drifts with the gradient of the flow (rigid.h). Past positions are carried to the new time by its mean
// motion in each step, and only the remaining motion of the membrane is discretised: steady drift and rotation have
// no error for any step, and unsteady rotation has a second-order error only in the change of its rate.
#pragma once

#include "sim/core/attempt.h"
#include "sim/stepping/dynamics.h"
#include "sim/suspension/suspension.h"

namespace sim {

/// A scene with its plans: what stays the same during a run.
struct Model {
  const Scene& scene;
  Plans& plans;
  std::vector<Material> materials;
};
Model make_model(const Scene&, Plans&);

/// A step to take: from a state, over dt, in the flows that act during it.
struct StepProblem {
  const Model& model;
  const Dynamics& before;
  double dt;
  std::vector<FlowParameters> flows;  ///< none is switched within the step
};

/// What becomes of one vesicle: its position and motion at the new time, the frame of its shape there, and its history
/// then.
struct Moved {
  Coefficients position;
  Motion motion;
  Frame frame;
  History history;
  /// Estimated local error of the position: root of its mean square over the parameters, in area radii. Of the right
  /// order; right to leading order except for block-jacobi and explicit, whose splitting it does not see.
  double error = 0;
};

struct Advance {
  std::vector<Moved> vesicles;
  int iterations = 0;
  double residual = 0;
};

struct Scheme {
  Attempt<Advance> (*advance)(const StepProblem&) = nullptr;  ///< all vesicles, by dt
  int past_levels = 0;                                        ///< how many earlier positions it looks back at
  bool past_corrected = true;  ///< they move along with the correction of area and volume
};
const std::vector<CatalogueRow<Scheme>>& scheme_catalogue();
/// Of time.scheme; throws std::invalid_argument where there is none of that name.
const Scheme& scheme_of(const Scene&);

/// Smallest gap between two membranes; a run stops below it: numerics.gap_floor, or 0.001 area radii of the smallest
/// vesicle.
double gap_floor(const Model&, const Dynamics&);

/// Operators at frozen positions with everything that the scene says of them. Throws std::domain_error where vesicles
/// cross.
Suspension freeze(const Model&, const Dynamics&, std::span<const Coefficients> positions);

/// Solves for the motions at frozen positions, relative to those of the frames.
Attempt<SuspensionSolve> solve(const Model&, const Suspension&, double c, std::span<const Coefficients> forcing,
                               std::span<const Motion> guess, std::span<const Frame> frames);

/// Of every vesicle; sizes: A0 and V0.
std::vector<AreaVolume> sizes(const Dynamics&);
std::vector<Coefficients> positions(const Dynamics&);
std::vector<Motion> motions(const Dynamics&);
std::vector<Frame> frames(const Dynamics&);

}  // namespace sim
