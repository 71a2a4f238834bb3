#include "sim/measures/statement.h"

#include "sim/membrane/rigid.h"

#include <algorithm>
#include <cmath>

namespace sim {

double quadrature_error(Plans& plans, const Coefficients& position) {
  const LayerMatrix dual = plans.layers(position.order, position.order + 1).assemble(position, true).dual;
  const RigidBody body = rigid_body(position);
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool turns : {false, true}) {
      RigidMotion motion;
      (turns ? motion.rotation : motion.translation) = Vec3::Unit(axis);
      motion.centre = body.centre;
      const Coefficients r = rigid_velocity(body, motion);
      largest = std::max(largest, (dual.apply(r).values + r.values / 2).norm() / r.values.norm());
    }
  return largest;
}

ErrorStatement stated_errors(std::span<const StepRecord> steps) {
  ErrorStatement e;
  for (const StepRecord& step : steps) {
    e.time += step.error;
    e.solve = std::max(e.solve, step.residual);
    double degrees = 0;
    for (const VesicleStep& v : step.vesicles) {
      degrees = std::max(degrees, v.space_error);
      e.space = std::max(e.space, v.tail);
      e.area = std::max(e.area, std::abs(v.area_error));
      e.volume = std::max(e.volume, std::abs(v.volume_error));
    }
    e.degrees += degrees;
  }
  return e;
}

}  // namespace sim
