// Where the picture is seen from: a catalogue of directions, framing over a whole movie, and the matrices of one frame.
#pragma once

#include "parameters.h"

#include "sim/catalogue.h"
#include "sim/types.h"

#include <Eigen/Geometry>

#include <span>
#include <vector>

namespace render {

/// Axes of the picture in the scene: right, up, and toward the viewer; a right-handed orthonormal frame.
struct ViewAxes {
  sim::Vec3 right, up, back;
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
  sim::Vec3 centroid = sim::Vec3::Zero();  ///< of the area of all vesicles
  Eigen::Matrix3Xf points;                 ///< 3 x points
};
StateSummary summarize(const sim::State& state);

/// One framing serves a whole movie, so nothing jumps or breathes.
struct Framing {
  ViewAxes axes;
  bool follows = false;                  ///< target = centroid of the frame's own state
  sim::Vec3 target = sim::Vec3::Zero();  ///< of a fixed framing
  sim::Vec3 offset = sim::Vec3::Zero();  ///< of a following one: target - centroid
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
  Eigen::Matrix4f view;        ///< scene -> eye: x right, y up, z toward the viewer
  Eigen::Matrix4f projection;  ///< eye -> clip
  sim::Vec3 target, right, up, back;
  double half_width = 1, half_height = 1;  ///< of the picture in the plane of the target
  bool perspective = true;
};
/// centroid: of the frame's own state; a fixed framing ignores it.
Camera make_camera(const Framing& framing, const sim::Vec3& centroid);

/// Points where flow arrows start: a regular net in the picture, in a plane behind everything, clear of the captions.
/// count x 3. The net is fixed in space under a following camera, so that arrows pass by.
sim::Matrix arrow_points(const Framing& framing, const sim::Vec3& centroid);

}  // namespace render
