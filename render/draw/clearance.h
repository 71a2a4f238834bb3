// How arrows give way to membranes.
#pragma once

#include "render/scene/frame.h"

#include <vector>

namespace render {

/// A membrane as the picture shows it: points in half heights of the picture, dense enough for distances to them, and a
/// circle round them.
struct Shadow {
  std::vector<glm::dvec2> points;
  glm::dvec2 centre{0};
  double radius = 0;
  double reach = 0;  ///< of few points: what is so near to one may be covered
};
std::vector<Shadow> shadows(const Frame& frame);
/// Of a body of which no more than these points are known.
Shadow shadow_of(const Camera& camera, const std::vector<glm::dvec3>& points);

/// 0 when the segment touches a membrane's shadow, 1 when it is well away: half an arrow beside a contour looks like
/// something that belongs to the vesicle.
double clear_of_bodies(const std::vector<Shadow>& shadows, const glm::dvec2& tail, const glm::dvec2& tip);

}  // namespace render
