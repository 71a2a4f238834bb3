// Time-stepping schemes: how one step moves all vesicles. Checks, corrections and relabelling follow, in stepper.h.
//
// Of first order, everything frozen at x_n, section 3.4 of the paper:
//   explicit           tension by (43), then x+ = x + dt/alpha (...); other forces and the own motion lag
//   block-jacobi       tension by (43), then the position implicitly by (44)
//   block-implicit     both together, vesicle by vesicle; other vesicles' forces lag
//   globally-implicit  backward Euler (38) on the coupled system
// bdf2: in a frame that moves with the vesicle (below), operators, normal and background flow at x* = x_n + w dt/dt_before,
//   u+ = (x+ - h)/c. With r = dt/dt_before, h = x_n + r^2/(1+2r) w and c = dt (1+r)/(1+2r); second order for steps of any
//   length. It starts with one step of extrapolated backward Euler, 2 x(two half steps) - x(one step).
//
// The frame of a vesicle rotates at a rate extrapolated linearly from the rotation of its shape at the last two
// times, and drifts with the gradient of the flow (rigid.h). Past positions are carried to the new time by its mean
// motion in each step, and only the remaining motion of the membrane is discretised: steady drift and rotation have
// no error for any step, and unsteady rotation has a second-order error only in the change of its rate.
#pragma once

#include "dynamics.h"
#include "suspension.h"

namespace sim {

/// Why a step was not accepted.
struct StepFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A scene with its plans: everything constant during a run.
struct Setting {
  const Scene& scene;
  Plans& plans;
  std::vector<Material> materials;
};
Setting make_setting(const Scene&, Plans&);

/// A step to take: from a state, over dt, in the flows that act during it.
struct StepProblem {
  const Setting& setting;
  const Dynamics& before;
  double dt;
  std::vector<FlowParameters> flows;  ///< none is switched within the step
};

/// New positions, their motions, the frame of each shape at the new time and its mean over this step, and statistics
/// of the solver.
struct Advance {
  std::vector<Coefficients> positions;
  std::vector<Motion> motions;
  std::vector<Frame> frames, carriers;
  int iterations = 0;
  double residual = 0;
};

/// Advances all vesicles by dt.
using SchemeFunction = Advance (*)(const StepProblem&);
const std::vector<CatalogueRow<SchemeFunction>>& scheme_catalogue();

/// Smallest gap between two membranes; a run stops below it: numerics.gap_floor, or 0.001 area radii of the smallest
/// vesicle.
double gap_floor(const Setting&, const Dynamics&);

/// Operators at frozen positions, with the options of the scene.
Suspension freeze(const Setting&, const Dynamics&, std::span<const Coefficients> positions);

/// Solves for the motions at frozen positions, relative to those of the frames.
SuspensionSolve solve(const Setting&, const Suspension&, double c, std::span<const Coefficients> forcing,
                      std::span<const Motion> guess, std::span<const Frame> frames);

/// Of every vesicle; sizes: A0 and V0.
std::vector<AreaVolume> sizes(const Dynamics&);
std::vector<Coefficients> positions(const Dynamics&);
std::vector<Motion> motions(const Dynamics&);
std::vector<Frame> frames(const Dynamics&);

}  // namespace sim
