// Helpers shared by all passes of a frame.
#pragma once

#include "render/core/ground.h"
#include "render/core/paint.h"
#include "render/gl/gpu.h"
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

inline void set_camera(const Program& program, const Camera& camera) {
  program.set("u_view", camera.view);
  program.set("u_projection", camera.projection);
  program.set("u_perspective", camera.perspective ? 1 : 0);
}

}  // namespace render
