// Area and volume correction: x += (a + b H) n with a, b from a 2x2 Newton iteration, so that a step ends at A0 and V0.
#pragma once

#include "geometry.h"
#include "plans.h"

namespace sim {

struct Correction {
  Coefficients shift;    ///< to be added to the position, degree p
  double largest = 0;    ///< longest shift of a grid point
  double area = 0, volume = 0;  ///< after it
  bool converged = false;
};

/// Near a sphere n and H n nearly coincide; the minimum-norm solution is taken.
Correction area_volume_correction(Plans&, const Coefficients& position, double area, double volume);
/// The same with the geometry of the position on the grid of measure_order().
Correction area_volume_correction(Plans&, const Coefficients& position, const Geometry&, double area, double volume);

/// For a sphere, whose area and volume cannot be had both: x += a n restores the volume; the area is then right to the square
/// of what it is out of round, and must be so to 1e-5.
Correction volume_correction(Plans&, const Coefficients& position, const Geometry&, double area, double volume);

}  // namespace sim
