// What follows from the parameters of a scene where keys are not given: the kind of steps, their tolerance, the times
// of saved states, the residual of the solves.
#pragma once

#include "sim/core/parameters.h"

#include <algorithm>

namespace sim {

/// Where neither a tolerance nor a step is given.
inline constexpr double default_tolerance = 1e-3;

/// Whether steps follow a tolerance.
inline bool steps_adapt(const TimeParameters& time) { return time.scheme ? *time.scheme == "adaptive" : !time.step; }
inline double tolerance_of(const TimeParameters& time) { return time.tolerance.value_or(default_tolerance); }
/// Whether the order of a vesicle follows the tolerance; an automatic one is fixed_order where steps are fixed.
inline bool order_follows(const TimeParameters& time, const VesicleParameters& v) {
  return v.order == 0 && steps_adapt(time);
}
inline constexpr int fixed_order = 8;
/// Time between saved states, which are at its multiples; adaptive steps are no frames of a movie. None: there is no
/// time.
inline std::optional<double> save_interval(const TimeParameters& time) {
  constexpr double states = 200;
  if (time.save_every || time.end == 0) return time.save_every;
  return steps_adapt(time) ? time.end / states : time.step;
}
/// Relative residual of a linear solve: a hundredth of what a step may err leaves no trace, a tenth hardly one. The
/// volume of a vesicle with little viscosity inside answers to a residual by one over its contrast.
inline double solve_tolerance(const Scene& scene, double share, double step_error) {
  double tolerance = share * step_error;
  for (const VesicleParameters& v : scene.vesicles)
    tolerance = std::min(tolerance, share * step_error * v.viscosity_contrast);
  return tolerance;
}
/// Where steps are fixed and it is not given: of a step of which nothing is known.
inline constexpr double tightest_fixed_solve = 1e-10;
inline double solve_tolerance(const Scene& scene) {
  if (scene.numerics.gmres_tolerance) return *scene.numerics.gmres_tolerance;
  if (!steps_adapt(scene.time)) return tightest_fixed_solve;
  constexpr double least = 1e-11;
  return std::max(solve_tolerance(scene, 0.1, tolerance_of(scene.time)), least);
}
/// Of a step whose error is expected to be so large, as time.tolerance counts it; 0: unknown. Fixed steps are taken
/// where errors are to be smooth in the step: a thousandth cannot be seen in them. What a solve leaves comes back in
/// the next guess, enlarged by extrapolation, and the few iterations that a solve needs with what was learned lessen it
/// little: therefore a third of a tenth, and a tenth of a thousandth.
inline double solve_tolerance(const Scene& scene, double step_error) {
  if (scene.numerics.gmres_tolerance) return *scene.numerics.gmres_tolerance;
  constexpr double adaptive_share = 0.03, least = 1e-11, share = 1e-4, loosest = 1e-7;
  if (steps_adapt(scene.time)) return std::max(solve_tolerance(scene, adaptive_share, tolerance_of(scene.time)), least);
  return std::clamp(solve_tolerance(scene, share, step_error), tightest_fixed_solve, loosest);
}

}  // namespace sim
