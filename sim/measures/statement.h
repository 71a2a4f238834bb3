// What a run says of its own errors. Each number is an estimate of one kind of error; none of them bounds the sum.
#pragma once

#include "sim/layers/plans.h"
#include "sim/trajectory/trajectory.h"

#include <span>

namespace sim {

struct ErrorStatement {
  double time = 0;     ///< what all steps leave in the position, added up, in area radii
  double degrees = 0;  ///< what the degrees that vesicles lack leave, of the worst vesicle in each step, likewise
  double space = 0;    ///< share of the curvature's spectrum in its last quarter of degrees, largest of the run
  double solve = 0;    ///< largest relative residual of a linear solve
  double area = 0, volume = 0;  ///< largest relative errors
};

ErrorStatement stated_errors(std::span<const StepRecord>);

/// How far the double layer D r of a rigid motion r is from -r/2, relative to r: the largest of six motions.
double quadrature_error(Plans&, const Coefficients& position);

}  // namespace sim
