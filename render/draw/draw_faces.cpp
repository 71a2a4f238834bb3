// The faces of the box at which membranes of a periodic suspension end: its edges, and the sections of the membranes.
#include "render/core/style.h"
#include "render/draw/draw.h"
#include "render/draw/draw_values.h"
#include "render/overlay/layout.h"

#include <algorithm>

namespace render {
namespace {

/// The section of a body by one face.
struct Section {
  const Body* body;
  int face;
  FaceSection shape;
};

std::vector<Section> sections_of(const Frame& frame, bool in_front) {
  constexpr double overlap = 0.05;  // px
  const double length = overlap * 2 * frame.camera.half_height / frame.view.size[1];
  std::vector<Section> all;
  for (const Body& body : frame.bodies) {
    if (!crosses(body.mesh.position, *frame.faces)) continue;
    for (int face = 0; face < FaceBox::faces; ++face)
      if (faces_eye(*frame.faces, face, frame.camera) == in_front)
        all.push_back({&body, face, face_section(body.mesh, *frame.faces, face, length)});
  }
  return all;
}

/// As distance.glsl; times what is left of a line beside texts.
std::vector<float> shares_seen(const Frame& frame, const std::vector<glm::dvec3>& points,
                               const std::vector<Box>& texts) {
  const glm::vec3 cue = depth_cue_in(frame);
  std::vector<float> shares;
  for (const glm::dvec3& point : points) {
    const float z = (frame.camera.view * glm::vec4(glm::vec3(frame.camera.place(point)), 1)).z;
    const double clear = clear_of(texts, frame.camera.picture_place(point), frame.view.size);
    shares.push_back(static_cast<float>(clear) * (1 - cue.x * std::clamp((cue.y - z) / cue.z, 0.0F, 1.0F)));
  }
  return shares;
}

}  // namespace

// No depth is compared: a face is in front of all that is in the box, or behind it.
void Renderer::draw_faces(const Frame& frame, bool in_front) {
  if (!frame.faces) return;
  const Gl& gl = context_.gl();
  const StyleRow& style = find_style(frame.view.style);
  const std::vector<Section> sections = sections_of(frame, in_front);
  gl.Disable(GL_DEPTH_TEST);
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_CULL_FACE);
  if (in_front && !style.see_through && !style.cut) {
    std::vector<glm::vec3> positions, normals, colours;
    for (const Section& section : sections) {
      glm::vec3 normal(0);
      normal[section.face / 2] = section.face % 2 == 1 ? 1 : -1;
      constexpr float paler = 0.4F;  // than the membrane: one tells inside from outside
      // Fields have no values in there.
      const glm::vec3 own = linear(style.own_colour && !style.field ? section.body->colour : white);
      for (const glm::dvec3& point : section.shape.triangles) {
        positions.emplace_back(frame.camera.place(point));
        normals.push_back(normal);
        colours.push_back(glm::mix(own, glm::vec3(1), paler));
      }
    }
    use_for_bodies("section", frame, style.defines == "FLAT" ? "#define FLAT\n" : "");
    sections_.attribute(0, positions);
    sections_.attribute(1, normals);
    sections_.attribute(2, colours);
    gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(positions.size()));
  }
  const Program& p = program("ribbon", "");
  p.use();
  p.set("u_core", -2.0F);
  start_blending();
  const auto draw_edges = [&] {
    const std::vector<Box> texts = lay_out(frame, font_).boxes();
    const float half_width = samples(frame.view, 1.1, 0.4);
    p.set("u_half_width", half_width);
    p.set("u_rim", vector_of(inks_on(ground_of(frame.view.background)).flow_line));
    for (const BoxEdge& edge : edges_of(*frame.faces, frame.camera))
      if (edge.in_front == in_front)
        draw_ribbon(frame.camera, edge.line.points, false, half_width + 1, 0,
                    shares_seen(frame, edge.line.points, texts));
  };
  if (!in_front) draw_edges();
  for (const Section& section : sections) {
    const Body& body = *section.body;
    if (frame.view.outline_width == 0 || section.shape.lines.empty()) continue;
    // Of a line behind its body only the outer half is seen: as wide as the contour, which it goes on.
    const bool covered = !in_front && !style.see_through;
    const float width = detail_in(frame, body).outline * samples(frame.view, frame.view.outline_width, 1.0);
    const float half_width = std::max(0.5F, covered ? width : width / 2);
    p.set("u_half_width", half_width);
    p.set("u_rim", vector_of(outline_colour(frame, body)));
    for (const SpaceLine& line : section.shape.lines) {
      std::vector<SpaceLine> parts{line};
      if (body.cut)
        parts =
            parts_within(line, std::vector{HalfSpace{body.cut->normal, glm::dot(body.cut->normal, body.cut->point)}});
      for (const SpaceLine& part : parts)
        draw_ribbon(frame.camera, part.points, part.closed, half_width + 1, 0, shares_seen(frame, part.points, {}));
    }
  }
  if (in_front) draw_edges();
  gl.Enable(GL_CULL_FACE);
  gl.DepthMask(GL_TRUE);
  gl.Enable(GL_DEPTH_TEST);
  gl.Disable(GL_BLEND);
}

}  // namespace render
