// What a run says of its own errors. Each number is an estimate of one kind of error; none of them bounds the sum.
#pragma once

#include "sim/layers/plans.h"
#include "sim/trajectory/trajectory.h"

namespace sim {

struct ErrorStatement {
  double time = 0;   ///< what all steps leave in the position, added up, in area radii
  double space = 0;  ///< share of the curvature's spectrum in its last quarter of degrees, largest of the run
  double quadrature =
      0;             ///< how far the double layer of a rigid motion r is from -r/2 at the last state, relative to r
  double solve = 0;  ///< largest relative residual of a linear solve
  double area = 0, volume = 0;  ///< largest relative errors
};

ErrorStatement stated_errors(Plans&, std::span<const StepRecord>, const State& last);

/// The largest |D r + r/2| / |r| of the six rigid motions.
double quadrature_error(Plans&, const Coefficients& position);

}  // namespace sim
