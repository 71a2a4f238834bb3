// The camera of one frame: matrices, and where a point of the scene is seen.
#pragma once

#include "render/scene/framing.h"

namespace render {

/// The matrices of one frame. Single precision is used only after place(), where every scene has the size of its
/// picture and is centred at the origin, whatever its unit and its distance from its own origin.
struct Camera {
  glm::mat4 view{1};                       ///< place -> eye: x right, y up, z toward the viewer
  glm::mat4 projection{1};                 ///< eye -> clip
  glm::dvec3 target{0};                    ///< in the middle of the picture
  glm::dvec3 eye{0};                       ///< orthographic: far away
  double half_width = 1, half_height = 1;  ///< of the picture in the plane of the target
  double depth = 1;                        ///< what the movie shows lies within +-depth of the target along the sight
  bool perspective = true;
  bool follows = false;  ///< moves with the vesicles

  /// A point of the scene relative to the target, in half heights of the picture.
  glm::dvec3 place(const glm::dvec3& point) const { return (point - target) / half_height; }
  glm::dvec4 clip(const glm::dvec3& point) const {
    return glm::dmat4(projection) * (glm::dmat4(view) * glm::dvec4(place(point), 1));
  }
  /// Where a point of the scene is seen: -1..1 from left to right and from bottom to top.
  glm::dvec2 picture_place(const glm::dvec3& point) const;
};
/// moment: of the frame's own state; used only by framings that follow or turn.
Camera make_camera(const Framing& framing, const Moment& moment);

/// Throws std::invalid_argument with one sentence when no state is visible, or when the eye lies inside a vesicle at
/// any of these instants.
void check_framing(const Framing& framing, std::span<const StateSummary> states);

}  // namespace render
