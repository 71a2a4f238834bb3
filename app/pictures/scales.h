// Natural scales of the quantities of a scene. Values far below them are rounding errors, in any unit.
#pragma once

#include "sim/core/parameters.h"
#include "sim/measures/fields.h"

namespace app {

struct NaturalScales {
  double length = 1;    ///< area radius of the first vesicle
  double velocity = 1;  ///< the largest of background flow, bending and weight (the viscosity is 1)
  double digits = 0;    ///< rounding of positions, relative to the length: large where vesicles are far from the origin
  double solve = 0;     ///< relative error of the linear solver
  int order = 1;        ///< highest degree of the surfaces

  /// Of a field, in units of the scene.
  double size_of(sim::FieldScale) const;
  /// Differences below it are rounding errors.
  double rounding_of(sim::FieldScale) const;
};
NaturalScales natural_scales(const sim::Scene&, const sim::State&, double area_radius);

}  // namespace app
