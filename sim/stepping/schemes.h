// Time-stepping schemes: how one step moves all vesicles. Checks, corrections and relabelling follow, in stepper.h.
//
// A scheme maps a state and a step to positions, motions, the history of the next step and an estimate of its own local
// error, or says why there is no such step. A row of the catalogue tells how far back a scheme looks; nothing else need
// know.
//
// Backward differentiation formulas of orders 2 to 4 with fixed steps, and of variable order with steps that follow a
// tolerance (control.h): bdf.h. Of first order, everything frozen at x_n, section 3.4 of the paper:
//   explicit           tension by (43), then x+ = x + dt/alpha (...); other forces and the own motion lag
//   block-jacobi       tension by (43), then the position implicitly by (44)
//   block-implicit     both together, vesicle by vesicle; other vesicles' forces lag
//   globally-implicit  backward Euler (38) on the coupled system
#pragma once

#include "sim/stepping/bdf.h"

namespace sim {

struct Scheme {
  Attempt<Advance> (*advance)(const StepProblem&) = nullptr;  ///< all vesicles, by dt
  int past_levels = 0;                                        ///< how many earlier times it looks back at
  int order = 1;                                              ///< the highest that it reaches
  bool slides = false;                                        ///< can move its grid as part of a step
};
const std::vector<CatalogueRow<Scheme>>& scheme_catalogue();
/// time.scheme, or what stands for it where it is not given.
std::string_view scheme_name(const Scene&);
/// Its row; throws std::invalid_argument where there is none of that name.
const Scheme& scheme_of(const Scene&);
/// Whether the grid slides along the membrane as part of each step; where the scheme cannot do so, it is relabelled
/// when needed.
bool grid_slides(const Scene&);

}  // namespace sim
