// The camera: a catalogue of directions, framing over a whole movie, and the matrices of one frame.
#pragma once

#include "render/core/parameters.h"
#include "render/core/vectors.h"

#include "sim/core/catalogue.h"
#include "sim/core/types.h"

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
/// "flow-gradient" (from -y, x to the right, z up) and others.
const std::vector<CameraRow>& cameras();
/// Throws std::invalid_argument that names the nearest known camera.
const CameraRow& find_camera(std::string_view name);

/// Data of one state for framing: a coarse net of points on every membrane, and their means.
struct StateSummary {
  double time = 0;
  glm::dvec3 centroid{0};              ///< of the area of all vesicles
  std::vector<glm::dvec3> centroids;   ///< of each
  /// The same number for each vesicle, one vesicle after the other; relative to its centroid, so that single
  /// precision suffices.
  std::vector<glm::vec3> points;
  std::vector<glm::vec3> areas;        ///< outward normal times the share of the area that a point represents

  glm::dvec3 point(std::size_t k) const { return centroids[k / (points.size() / centroids.size())] + glm::dvec3(points[k]); }
};
StateSummary summarize(const sim::State& state);

/// An instant for the camera: the position it follows, and the time for cameras that move by themselves.
struct Moment {
  glm::dvec3 centre{0};
  double time = 0;
  Moment(const glm::dvec3& where, double when = 0) : centre(where), time(when) {}
};

/// A key frame, see KeyFrameParameters.
struct CameraKey {
  double time = 0, azimuth = 0, elevation = 0, zoom = 1;
};
/// Between keys a cubic in time without overshoot, at rest at the first and last key and beyond them. Keys are
/// sorted.
CameraKey camera_at(std::span<const CameraKey> keys, double time);

/// One framing for a whole movie, so that the scale does not jump or fluctuate.
struct Framing {
  ViewAxes axes;               ///< of a camera that does not turn
  std::vector<CameraKey> keys; ///< sorted by time; if not empty, they determine the axes
  double orbit = 0;            ///< radians per unit of time about the z axis
  int vesicle = -1;            ///< followed by the camera; -1: the centroid of all
  bool follows = false;  ///< target = centroid of the frame's own state
  glm::dvec3 target{0};  ///< of a fixed framing
  glm::dvec3 offset{0};  ///< of a following one: target - centroid
  bool placed = false;   ///< the scene sets the position of the eye
  bool perspective = true;
  double distance = 10;      ///< from the eye to the target, when perspective
  double half_height = 1;    ///< of the picture in the plane of the target, length
  double aspect = 16.0 / 9;  ///< width / height
  double depth = 1;          ///< everything lies within +-depth of the target along the line of sight

  bool turns() const { return !keys.empty() || orbit != 0; }
  ViewAxes axes_at(double time) const;
  Moment moment(const StateSummary& state) const;
};

/// Fits all states into the picture, with room for captions. `follow = "auto"` follows the centroid when it moves by
/// more than 1.5 times the extent of the vesicles at one instant (a few radii for a single vesicle); a following
/// framing takes its scale from the largest extent about the centroid at any instant. Empty input frames the unit
/// sphere. view.follow "vesicle" follows one vesicle, with room for its neighbours; view.eye and view.target place
/// the camera instead. Throws std::invalid_argument for a vesicle that does not exist, or an eye that coincides with
/// its target.
Framing frame_trajectory(std::span<const StateSummary> states, const ViewParameters& view,
                         std::span<const KeyFrameParameters> key_frames = {});
/// Throws std::invalid_argument with one sentence when no state is visible, or when the eye lies inside a vesicle at
/// any of these instants.
void check_framing(const Framing& framing, std::span<const StateSummary> states);

/// The matrices of one frame. Single precision is used only after place(), where every scene has the size of its
/// picture and is centred at the origin, whatever its unit and its distance from its own origin.
struct Camera {
  glm::mat4 view{1};                       ///< place -> eye: x right, y up, z toward the viewer
  glm::mat4 projection{1};                 ///< eye -> clip
  glm::dvec3 target{0};                    ///< in the middle of the picture
  glm::dvec3 eye{0};                       ///< orthographic: far away
  double half_width = 1, half_height = 1;  ///< of the picture in the plane of the target
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

/// Centres of the flow arrows: a regular net in the coordinate plane through the target that faces the viewer most,
/// clear of the captions. count x 3. The net is fixed in space under a following camera, so that arrows move past.
sim::Matrix arrow_points(const Framing& framing, const Moment& moment);

/// 1, or less when a turning camera sees the plane of the arrows too obliquely; 0: edge on.
double arrows_shown(const Framing& framing, const Moment& moment);

/// Columns of the most even division of a picture into `count` panels.
int panel_columns(int count, int width, int height);

/// 0 under captions, 1 elsewhere, smooth in between. place: from Camera::picture_place().
double clear_of_captions(const glm::dvec2& place);

}  // namespace render
