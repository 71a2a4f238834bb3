// Framing: what the pictures of a movie hold, one scale for all of them.
#pragma once

#include "render/core/parameters.h"
#include "render/scene/view.h"

#include "sim/core/types.h"

#include <span>
#include <vector>

namespace render {

/// Data of one state for framing: a coarse net of points on every membrane, and their means.
struct StateSummary {
  double time = 0;
  glm::dvec3 centroid{0};             ///< of the area of all vesicles
  std::vector<glm::dvec3> centroids;  ///< of each
  /// The same number for each vesicle, one vesicle after the other; relative to its centroid, so that single
  /// precision suffices.
  std::vector<glm::vec3> points;
  std::vector<glm::vec3> areas;  ///< outward normal times the share of the area that a point represents

  std::size_t points_of_each() const { return points.size() / centroids.size(); }
  glm::dvec3 point(std::size_t k) const { return centroids[k / points_of_each()] + glm::dvec3(points[k]); }
};
StateSummary summarize(const sim::State& state);

/// An instant for the camera: the position it follows, and the time for cameras that move by themselves.
struct Moment {
  glm::dvec3 centre{0};
  double time = 0;
  Moment(const glm::dvec3& where, double when = 0) : centre(where), time(when) {}
};

/// One framing for a whole movie, so that the scale does not jump or fluctuate.
struct Framing {
  ViewAxes axes;                ///< of a camera that does not turn
  std::vector<CameraKey> keys;  ///< sorted by time; if not empty, they determine the axes
  double orbit = 0;             ///< radians per unit of time about the z axis
  int vesicle = -1;             ///< followed by the camera; -1: the centroid of all
  bool follows = false;         ///< target = centroid of the frame's own state
  glm::dvec3 target{0};         ///< of a fixed framing
  glm::dvec3 offset{0};         ///< of a following one: target - centroid
  bool placed = false;          ///< the scene sets the position of the eye
  bool perspective = true;
  double distance = 10;      ///< from the eye to the target, when perspective
  double half_height = 1;    ///< of the picture in the plane of the target, length
  double aspect = 16.0 / 9;  ///< width / height
  double depth = 1;          ///< everything lies within +-depth of the target along the line of sight

  bool turns() const { return !keys.empty() || orbit != 0; }
  ViewAxes axes_at(double time) const;
  Moment moment(const StateSummary& state) const;
  glm::dvec3 target_at(const Moment& moment) const { return follows ? moment.centre + offset : target; }
};

/// Fits all states into the picture, with room for captions. `follow = "auto"` follows the centroid when it moves by
/// more than half the extent of the vesicles at one instant; a following
/// framing takes its scale from the largest extent about the centroid at any instant. Empty input frames the unit
/// sphere. view.follow "vesicle" follows one vesicle, with room for its neighbours; view.eye and view.target place
/// the camera instead. Throws std::invalid_argument for a vesicle that does not exist, two key frames of the same
/// time, or an eye that coincides with its target.
Framing frame_trajectory(std::span<const StateSummary> states, const ViewParameters& view,
                         std::span<const KeyFrameParameters> key_frames = {});

}  // namespace render
