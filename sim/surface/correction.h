// Area and volume correction: x += (a + b H) n with a, b from a 2x2 Newton iteration restores A0 and V0 after a step.
#pragma once

#include "sim/layers/plans.h"
#include "sim/surface/geometry.h"

namespace sim {

struct Correction {
  Coefficients shift;           ///< to add to the position, degree p
  double largest = 0;           ///< longest shift of a grid point
  double area = 0, volume = 0;  ///< after it
  bool converged = false;
};

/// Near a sphere n and H n nearly coincide; the minimum-norm solution is taken.
Correction area_volume_correction(Plans&, const Coefficients& position, double area, double volume);
/// The same with the geometry of the position on the grid of measure_order().
Correction area_volume_correction(Plans&, const Coefficients& position, const Geometry&, double area, double volume);

/// For a sphere, whose area and volume cannot both be prescribed: x += a n restores the volume. The area error is
/// then of second order in the deviation from roundness, and must be below 1e-5.
Correction volume_correction(Plans&, const Coefficients& position, const Geometry&, double area, double volume);

}  // namespace sim
