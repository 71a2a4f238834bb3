// Directions of the camera: the catalogue, and the keys of a camera that moves.
#pragma once

#include "render/core/vectors.h"

#include "sim/core/catalogue.h"

#include <span>
#include <vector>

namespace render {

/// Axes of the picture in the scene: right, up, and toward the viewer; a right-handed orthonormal frame.
struct ViewAxes {
  glm::dvec3 right, up, back;
};
/// back: toward the viewer; up: upward in the picture. Of any length, not parallel.
ViewAxes axes_from(const glm::dvec3& back, const glm::dvec3& up);
/// Degrees to the right of and above the flow-gradient view.
ViewAxes axes_turned(double azimuth, double elevation);

struct CameraRow {
  std::string_view name;
  std::string_view meaning;
  ViewAxes axes;
};
/// "flow-gradient" (from -y, x to the right, z up) and others.
const std::vector<CameraRow>& cameras();
/// Throws std::invalid_argument that names the nearest known camera.
const CameraRow& find_camera(std::string_view name);

/// A key frame, see KeyFrameParameters.
struct CameraKey {
  double time = 0, azimuth = 0, elevation = 0, zoom = 1;
};
/// Between keys a cubic in time without overshoot, at rest at the first and last key and beyond them. Keys are
/// sorted.
CameraKey camera_at(std::span<const CameraKey> keys, double time);

}  // namespace render
