// The membranes of a frame: solid with outlines, see-through in the order of depth, or cut open.
#include "render/draw/draw.h"

#include "render/core/style.h"
#include "render/draw/depth_order.h"
#include "render/draw/draw_values.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

// Single precision holds these whatever the unit of the scene.
std::vector<glm::vec3> places(const Mesh& mesh, const Camera& camera) {
  std::vector<glm::vec3> all;
  all.reserve(mesh.position.size());
  for (const glm::dvec3& p : mesh.position) all.emplace_back(camera.place(p));
  return all;
}

glm::vec3 eye_place(const Camera& camera, const glm::dvec3& point) {
  return camera.view * glm::vec4(glm::vec3(camera.place(point)), 1);
}

}  // namespace

void Renderer::upload(const Body& body, const Camera& camera) {
  bodies_.attribute(0, places(body.mesh, camera));
  bodies_.attribute(1, body.mesh.normal);
  if (uploaded_plan_ == body.mesh.plan) return;
  bodies_.indices(body.mesh.plan->indices());
  uploaded_plan_ = body.mesh.plan;
}

void Renderer::draw_body(const Frame& frame, const Body& body) {
  const Gl& gl = context_.gl();
  const StyleRow& style = find_style(frame.view.style);
  const std::vector<Mesh::Tracer>& tracers = body.mesh.tracers;
  const bool dotted = style.field && frame.legend && frame.legend->mirrored && frame.view.sign_dots;
  const Program& p = program("body", body_defines(style, frame.view, tracers.size(), dotted));
  p.use();
  set_camera(p, frame.camera);
  if (style.field) {
    if (!frame.legend || body.mesh.scalar.size() != body.mesh.position.size())
      throw std::invalid_argument("the style 'field' needs a legend, and a scalar on every mesh");
    const double low = frame.legend->low, width = frame.legend->high - low;
    std::vector<float> shares;
    for (const double value : body.mesh.scalar) shares.push_back(static_cast<float>((value - low) / width));
    bodies_.attribute(6, shares);
    palette_.bind();
    p.set("u_map", 0);
    if (dotted)
      p.set("u_dot_spacing", static_cast<float>(2 * sign_dot_spacing(frame.view.size[1]) / frame.view.size[1]));
  }
  if (style.cut) {
    glm::vec4 plane(0, 0, 0, -1);  // of nothing
    if (body.cut) plane = glm::vec4(body.cut->normal, -glm::dot(body.cut->normal, frame.camera.place(body.cut->point)));
    p.set("u_cut", std::array{plane});
    p.set("u_contour_width", samples(frame.view, frame.view.outline_width, 1.0));
  }
  const glm::vec3 colour = linear(style.own_colour ? body.colour : white);
  p.set("u_colour", colour);
  p.set("u_line_colour", line_colour(colour));
  p.set("u_contour", vector_of(outline_colour(body.colour)));
  p.set("u_half_width", samples(frame.view, frame.view.line_width / 2, 0.42));
  if (style.tracers && frame.view.tracers && !tracers.empty()) {
    std::vector<glm::vec4> dots;
    for (const Mesh::Tracer& t : tracers)
      dots.emplace_back(eye_place(frame.camera, t.position), t.bright ? 1.0F : 0.0F);
    p.set("u_tracer", dots);
    p.set("u_tracer_bright", linear(tracer_bright));
    p.set("u_tracer_dark", linear(tracer_dark));
    bodies_.attribute(3, nearest_tracers(body.mesh));
    p.set("u_tracer_radius", static_cast<float>(tracer_radius * body.mesh.area_radius / frame.camera.half_height));
  }
  upload(body, frame.camera);
  bodies_.attribute(2, frame.view.lines == "grid" ? body.mesh.plan->parameters() : body.mesh.label);
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(body.mesh.plan->indices().size()), GL_UNSIGNED_INT, nullptr);
}

std::vector<std::uint32_t> Renderer::rim_of(const Frame& frame, const Body& body) const {
  const double widest = samples(frame.view, frame.view.outline_width, 1.0) + edge_step, slack = 1.5;  // samples
  return rim_triangles(body.mesh, frame.camera, 2 * (widest + slack) / framebuffer_->height());
}

void Renderer::draw_outline(const Frame& frame, const Body& body, const std::vector<std::uint32_t>& rim,
                            OutlinePart part) {
  const Gl& gl = context_.gl();
  const Program& p = program("outline", "");
  p.use();
  set_camera(p, frame.camera);
  p.set("u_colour", vector_of(outline_colour(body.colour)));
  hulls_.attribute(0, places(body.mesh, frame.camera));
  hulls_.attribute(1, body.mesh.normal);
  hulls_.indices(rim);
  gl.CullFace(GL_FRONT);
  const auto hull = [&](double more, double share) {
    const float width = samples(frame.view, frame.view.outline_width, 1.0) + static_cast<float>(more);
    p.set("u_push", glm::vec2(2 * width / static_cast<float>(framebuffer_->width()),
                              2 * width / static_cast<float>(framebuffer_->height())));
    p.set("u_alpha", static_cast<float>(share));
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(rim.size()), GL_UNSIGNED_INT, nullptr);
  };
  if (part == OutlinePart::core) hull(-edge_step, 1);
  if (part == OutlinePart::edge) {
    hull(0, 1.0 / 2);
    hull(edge_step, 1.0 / 3);
  }
  gl.CullFace(GL_BACK);
}

// All membranes in one draw, farthest triangle first.
void Renderer::draw_ghosts(const Frame& frame) {
  const Gl& gl = context_.gl();
  const StyleRow& style = find_style(frame.view.style);
  std::vector<glm::vec3> positions, normals, labels, colours;
  std::vector<glm::vec4> dots, next_dots;
  std::size_t tracers = 0;
  double radius = 0;
  for (const Body& body : frame.bodies) {
    const auto append = [](auto& all, const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
    append(positions, places(body.mesh, frame.camera));
    append(normals, body.mesh.normal);
    append(labels, frame.view.lines == "grid" ? body.mesh.plan->parameters() : body.mesh.label);
    colours.resize(positions.size(), linear(style.own_colour ? body.colour : white));
    tracers = std::max(tracers, body.mesh.tracers.size());
    radius = std::max(radius, body.mesh.area_radius);
  }
  const bool dotted = style.tracers && frame.view.tracers && tracers > 0;
  if (dotted)
    for (const Body& body : frame.bodies) {
      const auto place = [&](float k) {
        if (k < 0) return glm::vec4(0, 0, 0, -1);
        const Mesh::Tracer& t = body.mesh.tracers[static_cast<std::size_t>(k)];
        return glm::vec4(eye_place(frame.camera, t.position), t.bright ? 1 : 0);
      };
      for (const glm::vec2& nearest : nearest_tracers(body.mesh)) {
        dots.push_back(place(nearest.x));
        next_dots.push_back(place(nearest.y));
      }
    }
  const Program& p = program("body", body_defines(style, frame.view, tracers));
  p.use();
  set_camera(p, frame.camera);
  p.set("u_line_colour", line_ink);
  p.set("u_contour", outline_ink);
  p.set("u_contour_width", samples(frame.view, frame.view.outline_width, 1.0));
  p.set("u_half_width", samples(frame.view, frame.view.line_width / 2, 0.42));
  p.set("u_opacity", static_cast<float>(frame.view.opacity));
  ghosts_.attribute(0, positions);
  ghosts_.attribute(1, normals);
  ghosts_.attribute(2, labels);
  ghosts_.attribute(5, colours);
  if (dotted) {
    ghosts_.attribute(3, dots);
    ghosts_.attribute(4, next_dots);
    p.set("u_tracer_bright", linear(tracer_bright));
    p.set("u_tracer_dark", linear(tracer_dark));
    p.set("u_tracer_radius", static_cast<float>(tracer_radius * radius / frame.camera.half_height));
  }
  const std::vector<std::uint32_t> triangles = back_to_front(frame.bodies, frame.camera);
  ghosts_.indices(triangles);
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(triangles.size()), GL_UNSIGNED_INT, nullptr);
  gl.Enable(GL_CULL_FACE);
  gl.Enable(GL_DEPTH_TEST);
  gl.Disable(GL_BLEND);
}

void Renderer::draw_ribbon(const Camera& camera, std::span<const glm::dvec3> points, bool closed, float reach,
                           double nearer) {
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
  std::vector<float> across;
  for (std::size_t k = 0; k < n + closed; ++k) {
    const glm::dvec4 &here = clips[k % n], &before = clips[k > 0 || closed ? (k + n - 1) % n : 0],
                     &after = clips[k + 1 < n || closed ? (k + 1) % n : n - 1];
    const glm::dvec2 along = (glm::dvec2(after) / after.w - glm::dvec2(before) / before.w) / sample;
    const glm::dvec2 side = glm::dvec2(-along.y, along.x) / std::max(glm::length(along), 1e-9) * sample * here.w;
    for (const float sign : {-1.0F, 1.0F}) {
      strip.emplace_back(glm::dvec2(here) + static_cast<double>(sign * reach) * side, here.z, here.w);
      across.push_back(sign * reach);
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
  p.set("u_rim", vector_of(flow_line_colour));
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_CULL_FACE);
  const glm::dvec3 toward = glm::normalize(frame.camera.eye - frame.camera.target);
  for (const FlowLines::Line& line : frame.flow_lines.lines) {
    draw_ribbon(frame.camera, line.points, line.closed, half_width + 1, 0);
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
      ribbons_.attribute(1, std::vector<float>(3, 0.0F));
      gl.DrawArrays(GL_TRIANGLES, 0, 3);
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
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_CULL_FACE);
  for (const Body& body : frame.bodies) {
    if (!body.cut) continue;
    p.set("u_colour", vector_of({0.5 + 0.5 * body.colour.r, 0.5 + 0.5 * body.colour.g, 0.5 + 0.5 * body.colour.b}));
    p.set("u_rim", vector_of(outline_colour(body.colour)));
    for (const std::vector<glm::dvec3>& edge : body.cut->edges) {
      draw_ribbon(frame.camera, edge, true, half_width + 1, 0.004 * body.mesh.area_radius);
    }
  }
  gl.Enable(GL_CULL_FACE);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

void Renderer::draw_bodies(const Frame& frame) {
  const StyleRow& style = find_style(frame.view.style);
  if (style.see_through) return draw_ghosts(frame);
  if (style.field && frame.legend) palette_.fill(frame.legend->colours);
  if (style.cut) {
    const Gl& gl = context_.gl();
    gl.Enable(GL_CLIP_DISTANCE0);
    gl.Disable(GL_CULL_FACE);
    for (const Body& body : frame.bodies) draw_body(frame, body);
    gl.Disable(GL_CLIP_DISTANCE0);
    gl.Enable(GL_CULL_FACE);
    draw_cut_edges(frame);
    return draw_flow_lines(frame);
  }
  const bool outlined = frame.view.outline_width > 0;
  std::vector<std::vector<std::uint32_t>> rims;
  for (const Body& body : frame.bodies) {
    draw_body(frame, body);
    if (!outlined) continue;
    rims.push_back(rim_of(frame, body));
    draw_outline(frame, body, rims.back(), OutlinePart::core);
  }
  if (!outlined) return;
  // Two hulls more make thirds of a sample at the outer edge. They let through what lies behind: all of that is there
  // now.
  const Gl& gl = context_.gl();
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl.DepthMask(GL_FALSE);
  for (std::size_t k = 0; k < rims.size(); ++k) draw_outline(frame, frame.bodies[k], rims[k], OutlinePart::edge);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

}  // namespace render
