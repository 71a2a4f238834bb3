#include "render/draw/batch.h"

#include "render/draw/depth_order.h"
#include "render/draw/draw_values.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

glm::vec3 eye_place(const Camera& camera, const glm::dvec3& point) {
  return camera.view * glm::vec4(glm::vec3(camera.place(point)), 1);
}

template <class T>
void repeat(std::vector<T>& all, std::size_t count, const T& value) {
  all.insert(all.end(), count, value);
}

template <class T>
void extend(std::vector<T>& all, const std::vector<T>& some) {
  all.insert(all.end(), some.begin(), some.end());
}

void append_tracers(Batch& batch, const Camera& camera, const Mesh& mesh) {
  std::vector<glm::vec4> places;
  for (const Mesh::Tracer& t : mesh.tracers) places.emplace_back(eye_place(camera, t.position), t.bright ? 1.0F : 0.0F);
  const auto place = [&](float k) { return k < 0 ? glm::vec4(0, 0, 0, -1) : places[static_cast<std::size_t>(k)]; };
  for (const glm::vec2& nearest : nearest_tracers(mesh)) {
    batch.dot.push_back(place(nearest.x));
    batch.next_dot.push_back(place(nearest.y));
  }
}

void append_field(Batch& batch, const Frame& frame, const Body& body) {
  if (!frame.legend || body.mesh.scalar.size() != body.mesh.position.size())
    throw std::invalid_argument("the style 'field' needs a legend, and a scalar on every mesh");
  const double low = frame.legend->low, width = frame.legend->high - low;
  for (const double value : body.mesh.scalar) batch.scalar.push_back(static_cast<float>((value - low) / width));
}

}  // namespace

Detail detail_in(const Frame& frame, const Body& body) {
  const Mesh& mesh = body.mesh;
  const glm::dvec3 middle = (mesh.position[mesh.position.size() - 2] + mesh.position.back()) / 2.0;  // of the poles
  return detail_of(frame.view, mesh.area_radius * pixels_at(frame.camera, middle, frame.view.size[1]));
}

Variant variant_of(const Frame& frame, const Body& body, const Detail& detail) {
  const StyleRow& style = find_style(frame.view.style);
  return {.grid = detail.lines > 0 || detail.few_lines > 0,
          .sparse = detail.lines < 1,
          .tracers = style.tracers && frame.view.tracers && !body.mesh.tracers.empty() && detail.tracers > 0,
          .sign_dots = style.field && frame.legend && frame.legend->mirrored && frame.view.sign_dots,
          .occluded = style.occluded && !body.mesh.light.empty(),
          .boxed = frame.faces && crosses(body.mesh.position, *frame.faces)};
}

Colour outline_colour(const Frame& frame, const Body& body) {
  return outline_colour(body.colour, ground_of(frame.view.background), find_style(frame.view.style).see_through);
}

void append(Batch& batch, const Frame& frame, const Body& body, const Detail& detail, const Variant& variant,
            int samples_high, bool with_triangles) {
  const StyleRow& style = find_style(frame.view.style);
  const Mesh& mesh = body.mesh;
  const Camera& camera = frame.camera;
  const std::size_t count = mesh.position.size();
  const auto first = static_cast<std::uint32_t>(batch.position.size());
  for (const glm::dvec3& p : mesh.position) batch.position.emplace_back(camera.place(p));
  extend(batch.normal, mesh.normal);
  extend(batch.label, frame.view.lines == "grid" ? mesh.plan->parameters() : mesh.label);
  repeat(batch.paint, count, glm::vec4(linear(style.own_colour ? body.colour : white), detail.outline));
  if (variant.tracers) append_tracers(batch, camera, mesh);
  if (variant.tracers || variant.sparse)
    repeat(batch.detail, count,
           glm::vec4(detail.lines, detail.few_lines, tracer_radius * mesh.area_radius / camera.half_height,
                     detail.tracers));
  if (style.field) append_field(batch, frame, body);
  if (style.cut) {
    glm::vec4 plane(0, 0, 0, -1);  // of nothing
    if (body.cut) plane = glm::vec4(body.cut->normal, -glm::dot(body.cut->normal, camera.place(body.cut->point)));
    repeat(batch.cut, count, plane);
  }
  if (frame.view.outline_width > 0) {
    repeat(batch.contour, count, vector_of(outline_colour(frame, body)));
    if (style.cut || style.see_through) {
      const double width = detail.outline * samples(frame.view, frame.view.outline_width, 1.0);
      extend(batch.from_contour, contour_distances(mesh, camera, samples_high / 2.0, width + 6));
    }
  }
  if (variant.occluded) {
    // Stronger than in nature, where light that membranes throw at each other fills shallow hollows less than eyes
    // expect of a drawing.
    const auto strength = static_cast<float>(0.75 * frame.view.occlusion);
    for (const glm::vec2& open : mesh.light) batch.light.push_back(1.0F - strength * (1.0F - open * open * open));
  }
  if (!with_triangles) return;
  for (const std::uint32_t k : mesh.plan->indices()) batch.indices.push_back(first + k);
}

}  // namespace render
