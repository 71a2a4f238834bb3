#include "render/scene/camera.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace render {

using glm::dvec3;

Camera make_camera(const Framing& framing, const Moment& moment) {
  Camera camera;
  const ViewAxes axes = framing.axes_at(moment.time);
  const double zoom = camera_at(framing.keys, moment.time).zoom;
  camera.target = framing.target_at(moment);
  camera.half_height = framing.half_height / zoom;
  camera.half_width = framing.half_height / zoom * framing.aspect;
  camera.depth = framing.depth;
  camera.perspective = framing.perspective;
  camera.follows = framing.follows;

  const double reach = 4 * (framing.depth + framing.half_height * std::max(1.0, framing.aspect));
  // Keys come nearer; a placed eye stays and sees a narrower field.
  const double distance = framing.perspective ? framing.distance / zoom : 2 * reach;
  const double near = std::max(distance - reach, 0.02 * distance), far = distance + reach;
  camera.eye = camera.target + distance * axes.back;
  const double unit = camera.half_height, w = framing.aspect;
  camera.view = glm::lookAt(distance / unit * axes.back, dvec3(0), axes.up);
  const double share = near / distance;  // of the near plane's size in that of the target
  camera.projection = framing.perspective ? glm::frustum(-w * share, w * share, -share, share, near / unit, far / unit)
                                          : glm::ortho(-w, w, -1.0, 1.0, near / unit, far / unit);
  return camera;
}

glm::dvec2 Camera::picture_place(const dvec3& point) const {
  const glm::dvec4 seen = clip(point);
  return glm::dvec2(seen) / seen.w;
}

namespace {

/// The solid angle of a closed surface is 4 pi from inside and 0 from outside.
double solid_angle(const StateSummary& state, std::size_t vesicle, const dvec3& eye) {
  const std::size_t each = state.points_of_each();
  double angle = 0;
  for (std::size_t i = vesicle * each; i < (vesicle + 1) * each; ++i) {
    const dvec3 away = state.point(i) - eye;
    const double distance = glm::length(away);
    if (distance > 0) angle += glm::dot(away / distance, dvec3(state.areas[i]) / distance / distance);
  }
  return angle;
}

}  // namespace

void check_framing(const Framing& framing, std::span<const StateSummary> states) {
  bool seen = false;
  for (const StateSummary& state : states) {
    const Camera camera = make_camera(framing, framing.moment(state));
    for (std::size_t k = 0; k < state.points.size(); ++k) {
      const glm::dvec4 clip = camera.clip(state.point(k));
      seen = seen || (clip.w > 0 && std::max(std::abs(clip.x), std::abs(clip.y)) < clip.w);
    }
    if (!framing.perspective || state.areas.size() != state.points.size()) continue;
    for (std::size_t v = 0; v < state.centroids.size(); ++v)
      if (solid_angle(state, v, camera.eye) > 2 * std::numbers::pi)
        throw std::invalid_argument(fmt::format("the camera is inside vesicle {} at t = {:.6g}; {}", v, state.time,
                                                framing.placed ? "move view.eye" : "lower view.zoom"));
  }
  if (!seen)
    throw std::invalid_argument(
        "this view shows nothing: no vesicle comes into the picture; change view.eye, view.target or "
        "view.zoom");
}

}  // namespace render
