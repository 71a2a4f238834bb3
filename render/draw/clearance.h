// What gives way to what: arrows to membranes, and arrows and streamlines to text and overlays.
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
};
std::vector<Shadow> shadows(const Frame& frame);

/// 0 when the segment touches a membrane's shadow, 1 when it is well away: half an arrow beside a contour looks like
/// something that belongs to the vesicle.
double clear_of_bodies(const std::vector<Shadow>& shadows, const glm::dvec2& tail, const glm::dvec2& tip);

/// 0 where an overlay of the frame stands, captions aside, 1 elsewhere, smooth in between; place as
/// Camera::picture_place() gives it.
double clear_of_overlays(const Frame& frame, const glm::dvec2& place);

}  // namespace render
