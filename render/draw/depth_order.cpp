#include "render/draw/depth_order.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace render {
namespace {

// Cosine between the normal and the direction to the eye; below 0: a back face.
std::vector<float> facing_of(const Mesh& mesh, const Camera& camera) {
  const glm::dvec3 eye = camera.place(camera.eye), back = eye / glm::length(eye);
  std::vector<float> facing;
  facing.reserve(mesh.position.size());
  for (std::size_t k = 0; k < mesh.position.size(); ++k) {
    const glm::dvec3 toward = camera.perspective ? eye - camera.place(mesh.position[k]) : back;
    facing.push_back(glm::dot(mesh.normal[k], glm::vec3(glm::normalize(toward))));
  }
  return facing;
}

struct Segment {
  glm::vec2 from, to;
};

float distance(const glm::vec2& point, const Segment& s) {
  const glm::vec2 along = s.to - s.from;
  const float length2 = glm::dot(along, along);
  const float share = length2 > 0 ? std::clamp(glm::dot(point - s.from, along) / length2, 0.0F, 1.0F) : 0.0F;
  return glm::distance(point, s.from + share * along);
}

// The vertices that share an edge with vertex v, or a diagonal.
template <class F>
void for_neighbours(const MeshPlan& plan, std::uint32_t v, F&& f) {
  const auto rings = static_cast<std::uint32_t>(plan.latitudes() - 1),
             columns = static_cast<std::uint32_t>(plan.longitudes());
  const std::uint32_t north = rings * columns, south = north + 1;
  if (v >= north) {
    for (std::uint32_t j = 0; j < columns; ++j) f(j * rings + (v == north ? 0 : rings - 1));
    return;
  }
  const std::uint32_t i = v % rings, j = v / rings;
  for (const std::uint32_t column : {j, (j + 1) % columns, (j + columns - 1) % columns}) {
    if (column != j) f(column * rings + i);
    f(i > 0 ? column * rings + i - 1 : north);
    f(i + 1 < rings ? column * rings + i + 1 : south);
  }
}

}  // namespace

std::vector<std::uint32_t> back_to_front(const std::vector<Body>& bodies, const Camera& camera) {
  // Negative depth along the line of sight as an integer that sorts alike, over the number of the triangle.
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> corners;
  std::uint32_t first = 0;
  for (const Body& body : bodies) {
    const std::span<const std::uint32_t> indices = body.mesh.plan->indices();
    std::vector<float> depth;
    depth.reserve(body.mesh.position.size());
    for (const glm::dvec3& p : body.mesh.position)
      depth.push_back((camera.view * glm::vec4(glm::vec3(camera.place(p)), 1)).z);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const float z = depth[indices[i]] + depth[indices[i + 1]] + depth[indices[i + 2]];
      const auto bits = std::bit_cast<std::uint32_t>(z);
      const std::uint32_t sortable = bits & 0x80000000U ? ~bits : bits | 0x80000000U;
      keys.push_back(static_cast<std::uint64_t>(sortable) << 32 | corners.size() / 3);
      for (std::size_t k = 0; k < 3; ++k) corners.push_back(first + indices[i + k]);
    }
    first += static_cast<std::uint32_t>(body.mesh.position.size());
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> sorted;
  sorted.reserve(corners.size());
  for (const std::uint64_t key : keys) {
    const auto triangle = static_cast<std::size_t>(key & 0xffffffffU);
    sorted.insert(sorted.end(), corners.begin() + static_cast<std::ptrdiff_t>(3 * triangle),
                  corners.begin() + static_cast<std::ptrdiff_t>(3 * triangle + 3));
  }
  return sorted;
}

// Going inward from the contour the cosine grows by at most the largest curvature k a length. Where it has reached c,
// the picture shows the surface at least (1 - sqrt(1 - c^2)) / k inside of the contour.
std::vector<std::uint32_t> rim_triangles(const Mesh& mesh, const Camera& camera, double reach) {
  constexpr double narrowest = 0.3;     // cosine: wide enough for most
  constexpr float front_enough = 0.1F;  // faces in front of the contour serve for nothing
  const glm::dvec3 eye = camera.place(camera.eye);
  const double away = glm::length(eye);
  const glm::dvec3 back = eye / away;
  const std::vector<float> facing = facing_of(mesh, camera);
  std::vector<glm::vec3> place;
  place.reserve(mesh.position.size());
  double farthest = 0;
  for (const glm::dvec3& position : mesh.position) {
    const glm::dvec3 p = camera.place(position);
    farthest = std::max(farthest, glm::dot(eye - p, back));
    place.emplace_back(p);
  }
  const double scale =
      camera.perspective ? std::max(farthest / away, 0.0) : 1;  // of lengths there that look like the reach
  const std::span<const std::uint32_t> indices = mesh.plan->indices();
  std::vector<std::uint32_t> rim;
  for (double cosine = narrowest;;) {
    rim.clear();
    const auto least = static_cast<float>(-cosine);
    float bent = 0;  // the square of the largest curvature
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
      if (std::max({facing[a], facing[b], facing[c]}) <= least ||
          std::min({facing[a], facing[b], facing[c]}) >= front_enough)
        continue;
      rim.insert(rim.end(), {a, b, c});
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}}) {
        const glm::vec3 turn = mesh.normal[to] - mesh.normal[from], step = place[to] - place[from];
        const float length = glm::dot(step, step);
        if (length > 0) bent = std::max(bent, glm::dot(turn, turn) / length);
      }
    }
    if (cosine > 1) return rim;  // all back faces
    double curvature = std::sqrt(static_cast<double>(bent));
    if (camera.perspective) curvature += 1 / farthest;  // the line of sight turns as well
    const double inside = 1 - curvature * reach * scale;
    const double needed = inside > 0 ? std::sqrt(1 - inside * inside) : 2;
    if (needed <= cosine) return rim;
    cosine = needed;
  }
}

std::vector<float> contour_distances(const Mesh& mesh, const Camera& camera, double unit, double reach) {
  const std::vector<float> facing = facing_of(mesh, camera);
  std::vector<glm::vec2> seen;
  seen.reserve(mesh.position.size());
  for (const glm::dvec3& p : mesh.position)
    seen.emplace_back(camera.picture_place(p) * glm::dvec2(camera.half_width / camera.half_height, 1) * unit);
  const auto far = static_cast<float>(4 * reach);
  std::vector<float> nearest(seen.size(), far);
  std::vector<std::uint32_t> source(seen.size(), 0), front;
  std::vector<Segment> contour;
  const auto offer = [&](std::uint32_t vertex, std::uint32_t segment) {
    const float d = distance(seen[vertex], contour[segment]);
    if (d >= nearest[vertex]) return;
    nearest[vertex] = d;
    source[vertex] = segment;
    if (d < static_cast<float>(reach)) front.push_back(vertex);
  };
  const std::span<const std::uint32_t> indices = mesh.plan->indices();
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const bool mixed = (facing[indices[i]] < 0) != (facing[indices[i + 1]] < 0) ||
                       (facing[indices[i]] < 0) != (facing[indices[i + 2]] < 0);
    if (!mixed) continue;
    std::vector<glm::vec2> crossings;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = indices[i + k], b = indices[i + (k + 1) % 3];
      if ((facing[a] < 0) == (facing[b] < 0)) continue;
      const float share = facing[a] / (facing[a] - facing[b]);
      crossings.push_back(seen[a] + share * (seen[b] - seen[a]));
    }
    // longer by itself at both ends: what is beside an end may never hear of the next piece
    const glm::vec2 along = crossings[1] - crossings[0];
    constexpr float corner = 0.02F;  // samples: one that only touches the contour has no direction
    if (glm::length(along) < corner) continue;
    contour.push_back({crossings[0] - along, crossings[1] + along});
    for (std::size_t k = 0; k < 3; ++k) offer(indices[i + k], static_cast<std::uint32_t>(contour.size() - 1));
  }
  // Neighbours of vertices that are near are offered the same piece of the contour; who comes nearer offers it again.
  for (std::size_t k = 0; k < front.size(); ++k) {
    const std::uint32_t vertex = front[k], segment = source[vertex];
    for_neighbours(*mesh.plan, vertex, [&](std::uint32_t other) { offer(other, segment); });
  }
  return nearest;
}

}  // namespace render
