// The membranes of a frame: solid with outlines, see-through in the order of depth, or cut open.
#include "render/draw/draw.h"

#include "render/core/style.h"
#include "render/draw/batch.h"
#include "render/draw/depth_order.h"
#include "render/draw/draw_values.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace render {
namespace {

// Nearest first: what is hidden is not shaded.
std::vector<std::size_t> front_to_back(const Frame& frame) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < frame.bodies.size(); ++k) {
    const Mesh& mesh = frame.bodies[k].mesh;
    const glm::dvec3 middle = (mesh.position[mesh.position.size() - 2] + mesh.position.back()) / 2.0;
    order.emplace_back(-(glm::dmat4(frame.camera.view) * glm::dvec4(frame.camera.place(middle), 1)).z, k);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> bodies;
  for (const auto& [depth, k] : order) bodies.push_back(k);
  return bodies;
}

}  // namespace

const Program& Renderer::use_for_bodies(const std::string& name, const Frame& frame, const std::string& defines) {
  const glm::vec3 cue = depth_cue_in(frame);
  const Program& p = program(name, defines + (cue.x > 0 ? "#define DEPTH_CUE\n" : ""));
  p.use();
  set_camera(p, frame.camera);
  if (cue.x > 0) {
    p.set("u_cue", cue);
    p.set("u_height", static_cast<float>(framebuffer_->height()));
    set_ground(p, frame);
  }
  return p;
}

void Renderer::upload(const Batch& batch) {
  bodies_.attribute(0, batch.position);
  bodies_.attribute(1, batch.normal);
  bodies_.attribute(2, batch.label);
  bodies_.attribute(5, batch.paint);
  bodies_.indices(batch.indices);
  if (!batch.dot.empty()) bodies_.attribute(3, batch.dot);
  if (!batch.dot.empty()) bodies_.attribute(4, batch.next_dot);
  if (!batch.detail.empty()) bodies_.attribute(6, batch.detail);
  if (!batch.scalar.empty()) bodies_.attribute(7, batch.scalar);
  if (!batch.cut.empty()) bodies_.attribute(8, batch.cut);
  if (!batch.from_contour.empty()) bodies_.attribute(9, batch.from_contour);
  if (!batch.contour.empty()) bodies_.attribute(10, batch.contour);
  if (!batch.light.empty()) bodies_.attribute(11, batch.light);
}

void Renderer::draw_batch(const Frame& frame, const Batch& batch, const Variant& variant) {
  const StyleRow& style = find_style(frame.view.style);
  const Program& p = use_for_bodies("body", frame,
                                    body_defines(style, frame.view, variant.grid, variant.sparse, variant.tracers,
                                                 variant.sign_dots, variant.occluded) +
                                        (variant.boxed ? "#define BOXED\n" : ""));
  set_box(p, frame);
  if (style.field) {
    palette_.bind();
    p.set("u_map", 0);
    if (variant.sign_dots)
      p.set("u_dot_spacing", static_cast<float>(2 * sign_dot_spacing(frame.view.size[1]) / frame.view.size[1]));
  }
  p.set("u_line_colour", line_ink);
  p.set("u_contour_width", samples(frame.view, frame.view.outline_width, 1.0));
  p.set("u_half_width", samples(frame.view, frame.view.line_width / 2, 0.42));
  p.set("u_opacity", static_cast<float>(frame.view.opacity));
  if (variant.tracers) {
    p.set("u_tracer_bright", linear(tracer_bright));
    p.set("u_tracer_dark", linear(tracer_dark));
  }
  upload(batch);
  context_.gl().DrawElements(GL_TRIANGLES, static_cast<GLsizei>(batch.indices.size()), GL_UNSIGNED_INT, nullptr);
}

// One draw for all bodies that are painted in one way.
void Renderer::draw_solids(const Frame& frame) {
  std::map<Variant, std::vector<std::size_t>> ways;
  for (const std::size_t k : front_to_back(frame))
    ways[variant_of(frame, frame.bodies[k], detail_in(frame, frame.bodies[k]))].push_back(k);
  for (const auto& [variant, bodies] : ways) {
    Batch batch;
    for (const std::size_t k : bodies)
      append(batch, frame, frame.bodies[k], detail_in(frame, frame.bodies[k]), variant, framebuffer_->height(), true);
    draw_batch(frame, batch, variant);
  }
}

// All membranes in one draw, farthest triangle first.
void Renderer::draw_ghosts(const Frame& frame) {
  if (frame.bodies.empty()) return;
  const Gl& gl = context_.gl();
  Variant variant{.grid = false, .sparse = false, .tracers = false};
  std::vector<Detail> details;
  for (const Body& body : frame.bodies) {
    details.push_back(detail_in(frame, body));
    const Variant own = variant_of(frame, body, details.back());
    variant.grid = variant.grid || own.grid;
    variant.sparse = variant.sparse || own.sparse;
    variant.tracers = variant.tracers || own.tracers;
    variant.boxed = variant.boxed || own.boxed;
  }
  Batch batch;
  for (std::size_t k = 0; k < frame.bodies.size(); ++k)
    append(batch, frame, frame.bodies[k], details[k], variant, framebuffer_->height(), false);
  batch.indices = back_to_front(frame.bodies, frame.camera);
  start_blending();
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  draw_batch(frame, batch, variant);
  gl.Enable(GL_CULL_FACE);
  gl.Enable(GL_DEPTH_TEST);
  gl.Disable(GL_BLEND);
}

// Two hulls more than the core make thirds of a sample at the outer edge. They let through what lies behind: all of
// that is there when they are drawn.
void Renderer::draw_outlines(const Frame& frame) {
  const Gl& gl = context_.gl();
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> outlines;
  std::vector<std::uint32_t> rims;
  for (const Body& body : frame.bodies) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    const float width = detail_in(frame, body).outline * samples(frame.view, frame.view.outline_width, 1.0);
    constexpr double slack = 1.5;  // samples
    for (const std::uint32_t k : rim_triangles(
             body.mesh, frame.camera, 2 * (static_cast<double>(width) + edge_step + slack) / framebuffer_->height()))
      rims.push_back(first + k);
    for (const glm::dvec3& p : body.mesh.position) positions.emplace_back(frame.camera.place(p));
    normals.insert(normals.end(), body.mesh.normal.begin(), body.mesh.normal.end());
    outlines.insert(outlines.end(), body.mesh.position.size(),
                    glm::vec4(vector_of(outline_colour(frame, body)), width));
  }
  const Program& p = use_for_bodies("outline", frame, frame.faces ? "#define BOXED\n" : "");
  // Where a membrane is seen edge-on at a face, pieces of its contour would stand out beside the line of its section.
  set_box(p, frame, static_cast<double>(samples(frame.view, frame.view.outline_width, 1.0)) / framebuffer_->height());
  p.set("u_sample",
        glm::vec2(2.0F / static_cast<float>(framebuffer_->width()), 2.0F / static_cast<float>(framebuffer_->height())));
  hulls_.attribute(0, positions);
  hulls_.attribute(1, normals);
  hulls_.attribute(2, outlines);
  hulls_.indices(rims);
  const auto hull = [&](double more, double share) {
    p.set("u_more", static_cast<float>(more));
    p.set("u_alpha", static_cast<float>(share));
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(rims.size()), GL_UNSIGNED_INT, nullptr);
  };
  gl.CullFace(GL_FRONT);
  hull(-edge_step, 1);
  start_blending();
  gl.DepthMask(GL_FALSE);
  hull(0, 1.0 / 2);
  hull(edge_step, 1.0 / 3);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
  gl.CullFace(GL_BACK);
}

void Renderer::draw_bodies(const Frame& frame) {
  const StyleRow& style = find_style(frame.view.style);
  if (style.see_through) return draw_ghosts(frame);
  if (style.field && frame.legend) palette_.fill(frame.legend->colours);
  if (!style.cut) {
    draw_solids(frame);
    if (frame.view.outline_width > 0) draw_outlines(frame);
    return;
  }
  const Gl& gl = context_.gl();
  gl.Enable(GL_CLIP_DISTANCE0);
  gl.Disable(GL_CULL_FACE);
  draw_solids(frame);
  gl.Disable(GL_CLIP_DISTANCE0);
  gl.Enable(GL_CULL_FACE);
  draw_cut_edges(frame);
  draw_flow_lines(frame);
}

}  // namespace render
