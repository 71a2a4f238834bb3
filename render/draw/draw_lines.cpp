// Lines of constant width on the picture: streamlines, arrows seen end-on, the rims of cuts.
#include "render/draw/draw.h"
#include "render/draw/draw_values.h"
#include "render/overlay/layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace render {

void Renderer::draw_ribbon(const Camera& camera, std::span<const glm::dvec3> points, bool closed, float reach,
                           double nearer, std::span<const float> shown) {
  const glm::dvec2 sample(2.0 / framebuffer_->width(), 2.0 / framebuffer_->height());  // clip units
  const std::size_t n = points.size();
  if (n < 2) return;
  std::vector<glm::dvec4> clips;
  for (const glm::dvec3& point : points) {
    glm::dvec4 eye = glm::dmat4(camera.view) * glm::dvec4(camera.place(point), 1);
    eye.z += nearer / camera.half_height;
    clips.push_back(glm::dmat4(camera.projection) * eye);
  }
  std::vector<glm::vec4> strip;
  std::vector<glm::vec2> across;  // samples from the middle; how much is seen
  for (std::size_t k = 0; k < n + closed; ++k) {
    const glm::dvec4 &here = clips[k % n], &before = clips[k > 0 || closed ? (k + n - 1) % n : 0],
                     &after = clips[k + 1 < n || closed ? (k + 1) % n : n - 1];
    const glm::dvec2 along = (glm::dvec2(after) / after.w - glm::dvec2(before) / before.w) / sample;
    const glm::dvec2 side = glm::dvec2(-along.y, along.x) / std::max(glm::length(along), 1e-9) * sample * here.w;
    for (const float sign : {-1.0F, 1.0F}) {
      strip.emplace_back(glm::dvec2(here) + static_cast<double>(sign * reach) * side, here.z, here.w);
      across.emplace_back(sign * reach, shown.empty() ? 1.0F : shown[k % n]);
    }
  }
  ribbons_.attribute(0, strip);
  ribbons_.attribute(1, across);
  context_.gl().DrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(strip.size()));
}

void Renderer::draw_flow_lines(const Frame& frame) {
  if (frame.flow_lines.lines.empty()) return;
  const Gl& gl = context_.gl();
  const Program& p = program("ribbon", "");
  const float half_width = samples(frame.view, 1.1, 0.4);
  const double head = 0.034 * frame.camera.half_height;
  p.use();
  p.set("u_core", -2.0F);
  p.set("u_half_width", half_width);
  p.set("u_rim", vector_of(inks_on(ground_of(frame.view.background)).flow_line));
  start_blending();
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_CULL_FACE);
  const glm::dvec3 toward = glm::normalize(frame.camera.eye - frame.camera.target);
  const std::vector<Box> overlays = lay_out(frame, font_).boxes();
  for (const FlowLines::Line& line : frame.flow_lines.lines) {
    std::vector<float> shown;  // less under text and overlays
    for (const glm::dvec3& point : line.points)
      shown.push_back(static_cast<float>(clear_of(overlays, frame.camera.picture_place(point), frame.view.size)));
    draw_ribbon(frame.camera, line.points, line.closed, half_width + 1, 0, shown);
    for (const std::size_t k : line.heads) {
      if (k == 0 || k + 1 >= line.points.size()) continue;
      const glm::dvec3 along = glm::normalize(line.points[k + 1] - line.points[k - 1]),
                       side = glm::cross(toward, along);
      std::vector<glm::vec4> corners;
      for (const glm::dvec3& corner :
           {line.points[k] - 0.5 * head * along + 0.36 * head * side,
            line.points[k] - 0.5 * head * along - 0.36 * head * side, line.points[k] + 0.5 * head * along})
        corners.emplace_back(frame.camera.clip(corner));
      ribbons_.attribute(0, corners);
      ribbons_.attribute(1, std::vector<glm::vec2>(3, {0.0F, shown[k]}));
      gl.DrawArrays(GL_TRIANGLES, 0, 3);
    }
  }
  gl.Enable(GL_CULL_FACE);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

void Renderer::draw_end_on(const Frame& frame, const std::vector<EndOn>& arrows) {
  if (arrows.empty()) return;
  const Gl& gl = context_.gl();
  const Program& p = program("ribbon", "");
  const float half_width = samples(frame.view, 1.5, 0.5);
  p.use();
  p.set("u_core", -2.0F);
  p.set("u_half_width", half_width);
  p.set("u_rim", static_cast<float>(end_on_shade) * vector_of(inks_on(ground_of(frame.view.background)).arrow));
  start_blending();
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_CULL_FACE);
  const glm::dmat3 axes = glm::transpose(glm::dmat3(frame.camera.view));
  for (const EndOn& arrow : arrows) {
    const auto round = [&](double radius) {
      constexpr int corners = 40;
      std::vector<glm::dvec3> points;
      for (int k = 0; k < corners; ++k) {
        const double angle = 2 * std::numbers::pi * k / corners;
        points.push_back(arrow.place + radius * (std::cos(angle) * axes[0] + std::sin(angle) * axes[1]));
      }
      return points;
    };
    const auto draw = [&](const std::vector<glm::dvec3>& points, bool closed) {
      draw_ribbon(frame.camera, points, closed, half_width + 1, 0, std::vector<float>(points.size(), arrow.shown));
    };
    draw(round(arrow.radius), true);
    if (arrow.toward) {
      for (const double share : {0.06, 0.14, 0.22}) draw(round(share * arrow.radius), true);  // a dot
      continue;
    }
    const double reach = arrow.radius / std::numbers::sqrt2;
    for (const double sign : {-1.0, 1.0}) {
      const glm::dvec3 arm = reach * (axes[0] + sign * axes[1]);
      draw({arrow.place - arm, arrow.place + arm}, false);
    }
  }
  gl.Enable(GL_CULL_FACE);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

// The rims that the plane leaves: a bright core between two dark lines, like the membrane's thickness under a lens.
void Renderer::draw_cut_edges(const Frame& frame) {
  const Gl& gl = context_.gl();
  const Program& p = program("ribbon", "");
  const float line = samples(frame.view, std::max(frame.view.outline_width, 1.6), 1.0);
  const float core = 0.9F * line, half_width = core + 0.9F * line;
  p.use();
  p.set("u_core", core);
  p.set("u_half_width", half_width);
  start_blending();
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_CULL_FACE);
  for (const Body& body : frame.bodies) {
    if (!body.cut) continue;
    p.set("u_colour", vector_of({0.5 + 0.5 * body.colour.r, 0.5 + 0.5 * body.colour.g, 0.5 + 0.5 * body.colour.b}));
    p.set("u_rim", vector_of(outline_colour(frame, body)));
    for (const std::vector<glm::dvec3>& edge : body.cut->edges) {
      const double nearer = 0.004 * body.mesh.area_radius;
      if (!frame.faces) {
        draw_ribbon(frame.camera, edge, true, half_width + 1, nearer);
        continue;
      }
      for (const SpaceLine& part : parts_within({edge, true}, half_spaces(*frame.faces)))
        draw_ribbon(frame.camera, part.points, part.closed, half_width + 1, nearer);
    }
  }
  gl.Enable(GL_CULL_FACE);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

}  // namespace render
