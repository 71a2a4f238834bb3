// The arrow of the flow field, and the bead that marks fluid at rest, as triangles.
#pragma once

#include <glm/glm.hpp>

#include <vector>

namespace render {

inline constexpr int arrow_shape_sides = 20;
inline constexpr int arrow_shape_vertices = arrow_shape_sides * (6 + 3 + 3 + 3);

/// An arrow along x whose shaft has radius 1. Vertices with x < 0 belong to the head and are measured back from the tip
/// in shaft radii; the tail lies at x = 0.
struct ArrowShape {
  std::vector<glm::vec3> position, normal;
};
ArrowShape arrow_shape();

inline constexpr int bead_shape_vertices = arrow_shape_sides * (arrow_shape_sides / 2) * 6;
/// A sphere of radius 1; normal = position.
ArrowShape bead_shape();

}  // namespace render
