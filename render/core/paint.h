// Colours of a membrane's paint, and the sizes of what is painted on it; the shaders do the rest.
#pragma once

#include "render/core/ground.h"

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <cmath>
#include <string>

namespace render {

inline constexpr double tracer_radius = 0.088;  ///< area radii
inline constexpr double edge_step = 1.0 / 3;    ///< samples between the hulls of an outline
/// Arrows of the flow: the longest, and the radius of all; half heights of the picture.
inline constexpr double longest_arrow = 0.21, arrow_thickness = 0.009;
inline constexpr double weakest_arrow = 0.10;  ///< of the longest; shorter ones are left out
/// Along the line of sight an arrow is a blot: there a ring with a dot or a cross takes its place. Its radius is a
/// share of the arrow's length, its colour one of the arrow's.
inline constexpr double end_on_radius = 0.16, end_on_shade = 0.82;

/// Towards the key light: x right, y up, z to the viewer; any length. Shaders know it by the line that follows.
inline constexpr glm::dvec3 key_light{-0.45, 0.75, 0.85};
inline std::string light_defines() {
  return fmt::format("#define KEY_LIGHT vec3({}, {}, {})\n", key_light.x, key_light.y, key_light.z);
}

inline glm::vec3 vector_of(const Colour& c) { return {c.r, c.g, c.b}; }

inline glm::vec3 linear(const Colour& c) {
  const auto decode = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
  return {decode(c.r), decode(c.g), decode(c.b)};
}

/// Linear colour of lines, to which the shader adds a share of the membrane's own.
inline constexpr glm::vec3 line_ink{0.010F, 0.012F, 0.018F};

/// Of the outline of a membrane, sRGB: dark, on dark ground light, with a share of the membrane's own colour.
inline Colour outline_colour(const Colour& c, const Ground& ground, bool see_through) {
  if (ground.dark()) return {0.50 + 0.40 * c.r, 0.50 + 0.40 * c.g, 0.51 + 0.40 * c.b};
  const glm::dvec3 own = see_through ? glm::dvec3(linear(c)) : glm::dvec3(c.r, c.g, c.b);
  return {0.10 + 0.08 * own.r, 0.11 + 0.08 * own.g, 0.14 + 0.08 * own.b};
}

}  // namespace render
