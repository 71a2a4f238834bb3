#include "render/draw/depth_order.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace render {

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
  std::vector<glm::vec3> place;
  std::vector<float> facing;
  place.reserve(mesh.position.size());
  facing.reserve(mesh.position.size());
  double farthest = 0;
  for (std::size_t k = 0; k < mesh.position.size(); ++k) {
    const glm::dvec3 p = camera.place(mesh.position[k]), toward = camera.perspective ? eye - p : back;
    farthest = std::max(farthest, glm::dot(eye - p, back));
    place.emplace_back(p);
    facing.push_back(glm::dot(mesh.normal[k], glm::vec3(glm::normalize(toward))));
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

}  // namespace render
