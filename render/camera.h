// Where the picture is seen from: a catalogue of directions, framing over a whole movie, and the matrices of one frame.
#pragma once

#include "parameters.h"
#include "vectors.h"

#include "sim/catalogue.h"
#include "sim/types.h"

#include <span>
#include <vector>

namespace render {

/// Axes of the picture in the scene: right, up, and toward the viewer; a right-handed orthonormal frame.
struct ViewAxes {
  glm::dvec3 right, up, back;
};

struct CameraRow {
  std::string_view name;
  std::string_view meaning;
  ViewAxes axes;
};
/// "flow-gradient" (from -y, x to the right, z up) and its companions.
const std::vector<CameraRow>& cameras();
/// Throws std::invalid_argument that names the nearest known camera.
const CameraRow& find_camera(std::string_view name);

/// What framing needs to know of one state: a coarse net of points on every membrane, and their mean.
struct StateSummary {
  glm::dvec3 centroid{0};  ///< of the area of all vesicles
  std::vector<glm::vec3> points;
};
StateSummary summarize(const sim::State& state);

/// One framing serves a whole movie, so nothing jumps or breathes.
struct Framing {
  ViewAxes axes;
  bool follows = false;  ///< target = centroid of the frame's own state
  glm::dvec3 target{0};  ///< of a fixed framing
  glm::dvec3 offset{0};  ///< of a following one: target - centroid
  bool perspective = true;
  double distance = 10;      ///< from the eye to the target, when perspective
  double half_height = 1;    ///< of the picture in the plane of the target, length
  double aspect = 16.0 / 9;  ///< width / height
  double depth = 1;          ///< everything lies within +-depth of the target along the line of sight
};

/// Fits all states into the picture, with room for captions. `follow = "auto"` follows the centroid when it strays by
/// more than 1.5 times the size of what is seen at one instant (a few radii for a single vesicle); a following framing
/// takes its scale from the largest extent about the centroid at any instant. Empty input frames the unit sphere.
Framing frame_trajectory(std::span<const StateSummary> states, const ViewParameters& view);

/// The matrices of one frame.
struct Camera {
  glm::mat4 view{1};                       ///< scene -> eye: x right, y up, z toward the viewer
  glm::mat4 projection{1};                 ///< eye -> clip
  glm::dvec3 target{0};                    ///< in the middle of the picture
  double half_width = 1, half_height = 1;  ///< of the picture in the plane of the target
  bool perspective = true;
  bool follows = false;  ///< moves with the vesicles

  /// Where a point of the scene is seen: -1..1 from left to right and from bottom to top.
  glm::dvec2 picture_place(const glm::dvec3& point) const;
};
/// centroid: of the frame's own state; a fixed framing ignores it.
Camera make_camera(const Framing& framing, const glm::dvec3& centroid);

/// Middles of the flow arrows: a regular net in the coordinate plane through the target that faces the viewer most, clear
/// of the captions. count x 3. The net is fixed in space under a following camera, so that arrows pass by.
sim::Matrix arrow_points(const Framing& framing, const glm::dvec3& centroid);

/// 0 where captions stand, 1 elsewhere, smooth between. place: as Camera::picture_place() gives it.
double clear_of_captions(const glm::dvec2& place);

}  // namespace render
