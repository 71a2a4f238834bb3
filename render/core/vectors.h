// Conversion between GLM vectors, used in pictures, and Eigen vectors, used in the simulation.
#pragma once

#include "sim/core/types.h"

#include <glm/glm.hpp>

namespace render {

/// Three components of an Eigen expression, a row or a column.
template <class Derived>
glm::dvec3 to_glm(const Eigen::MatrixBase<Derived>& v) {
  return {v[0], v[1], v[2]};
}
inline sim::Vec3 to_sim(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace render
