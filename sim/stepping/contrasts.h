// Viscosity contrasts that cannot be computed with, or hardly.
//
// The double layer takes a rigid motion r to -r/2, so that in (39a) alpha r - (1 - lambda) D r = r: what its quadrature
// errs by, q, is to the drag of the inner fluid as q to lambda where lambda is small. A vesicle then answers to its own
// rounding as to a force: measured (docs/stepping.md), runs with q > lambda at their start come to a halt, and those
// with q > 0.05 lambda err by per cents of a radius. A contrast above the reciprocal of the rounding error hides what
// the outer fluid does.
#pragma once

#include "sim/stepping/step_problem.h"

namespace sim {

/// Throws std::invalid_argument, which names the key, what is wrong and what would do.
void check_contrasts(const Model&, const Dynamics&);
/// Of vesicles whose quadrature errs by more than a twentieth of their contrast; empty where there are none.
std::string contrast_warning(const Model&, const Dynamics&);

}  // namespace sim
