// Helpers shared by all passes of a frame.
#pragma once

#include "render/core/ground.h"
#include "render/core/paint.h"
#include "render/gl/gpu.h"
#include "render/scene/detail.h"
#include "render/scene/frame.h"

#include <algorithm>
#include <cmath>

namespace render {

// px at a height of 1080 in samples of this picture, at least `least` px wide however small it is.
inline float samples(const ViewParameters& view, double px, double least) {
  return static_cast<float>(view.supersampling * std::max(px * view.size[1] / 1080.0, std::min(px, least)));
}

inline void set_ground(const Program& program, const Frame& frame) {
  const Ground ground = ground_of(frame.view.background);
  program.set("u_top", vector_of(ground.top));
  program.set("u_bottom", vector_of(ground.bottom));
  program.set("u_ground", ground.transparent ? 0.0F : 1.0F);
}

/// Share that fades at the far end; z of the near end in eye space; extent between both: distance.glsl.
inline glm::vec3 depth_cue_in(const Frame& frame) {
  const double cue = depth_cue_of(frame.view, frame.vesicles > 0 ? frame.vesicles : frame.bodies.size());
  const double away = glm::distance(frame.camera.eye, frame.camera.target), depth = frame.camera.depth;
  return {cue, (depth - away) / frame.camera.half_height, 2 * depth / frame.camera.half_height};
}

/// Of box.glsl. short_of: how far before the faces towards the eye things end, half heights of the picture.
inline void set_box(const Program& program, const Frame& frame, double short_of = 0) {
  if (!frame.faces) return;
  glm::dvec3 low = frame.camera.place(frame.faces->low), high = frame.camera.place(frame.faces->high);
  for (int axis = 0; axis < 3; ++axis) {
    if (faces_eye(*frame.faces, 2 * axis, frame.camera)) low[axis] += short_of;
    if (faces_eye(*frame.faces, 2 * axis + 1, frame.camera)) high[axis] -= short_of;
  }
  program.set("u_low", glm::vec3(low));
  program.set("u_high", glm::vec3(high));
}

inline void set_camera(const Program& program, const Camera& camera) {
  program.set("u_view", camera.view);
  program.set("u_projection", camera.projection);
  program.set("u_perspective", camera.perspective ? 1 : 0);
}

}  // namespace render
