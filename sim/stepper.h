// Time stepping: one step of the whole scene, by a scheme of the catalogue, with its checks, the area and volume
// correction, reparametrization and the renewal of upsampling rates.
//
// Of first order, everything frozen at x_n, section 3.4 of the paper:
//   explicit           tension by (43), then x+ = x + dt/alpha (...); the others' forces and one's own motion lag
//   block-jacobi       tension by (43), then the position implicitly by (44)
//   block-implicit     both together, vesicle by vesicle; the others' forces lag
//   globally-implicit  backward Euler (38) on the coupled system
// bdf2: operators, normal and background flow at x* = x_n + w dt/dt_before, u+ = (x+ - h)/c. With r = dt/dt_before,
//   h = x_n + r^2/(1+2r) w and c = dt (1+r)/(1+2r); second order for steps of any length. It starts with one step of
//   extrapolated backward Euler, 2 x(two half steps) - x(one step).
#pragma once

#include "diagnostics.h"
#include "dynamics.h"
#include "suspension.h"
#include "trajectory.h"

namespace sim {

/// Why a step was not accepted.
struct StepFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// New positions, their motions, and what the solver did.
struct Advance {
  std::vector<Coefficients> positions;
  std::vector<Motion> motions;
  int iterations = 0;
  double residual = 0;
};

/// A scene with its plans: what stays the same during a run.
struct Setting {
  const Scene& scene;
  Plans& plans;
  std::vector<Material> materials;
};
Setting make_setting(const Scene&, Plans&);

/// Advances all vesicles by dt.
using SchemeFunction = Advance (*)(const Setting&, const Dynamics&, double dt);
const std::vector<CatalogueRow<SchemeFunction>>& scheme_catalogue();

/// Initial state. Throws std::invalid_argument with one sentence when a vesicle cannot be made.
Dynamics initial_dynamics(const Setting&);

/// One step of length dt; throws StepFailure and leaves the input as it was.
struct Step {
  Dynamics dynamics;
  StepRecord record;
};
Step take_step(const Setting&, const Dynamics&, double dt);

/// Velocity and tension that solve (3a)-(3b) at the present positions, and all else that is saved.
State evaluate(const Setting&, const Dynamics&);
/// To be called with a state that has been saved: it becomes the earlier end of the next interpolation.
void mark_saved(Dynamics&, const State&);

/// A sentence that vesicle k is not resolved by its order.
std::string resolution_warning(const Setting&, const Dynamics&, std::size_t k);
/// One for each vesicle of which that is true.
std::vector<std::string> resolution_warnings(const Setting&, const Dynamics&);

}  // namespace sim
