#include "depth_order.h"

#include <algorithm>
#include <bit>

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
    for (const glm::vec3& p : body.mesh.position) depth.push_back((camera.view * glm::vec4(p, 1)).z);
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

std::vector<std::uint32_t> rim_triangles(const Mesh& mesh, const Camera& camera) {
  constexpr float nearly_square = 0.3F;  // cosine; hulls reach two pixels beyond the rim, this reaches much farther inside
  const glm::vec3 eye = camera.eye, back = glm::normalize(glm::vec3(camera.eye - camera.target));
  std::vector<float> facing;
  facing.reserve(mesh.position.size());
  for (std::size_t k = 0; k < mesh.position.size(); ++k)
    facing.push_back(glm::dot(mesh.normal[k], camera.perspective ? glm::normalize(eye - mesh.position[k]) : back));
  std::vector<std::uint32_t> rim;
  const std::span<const std::uint32_t> indices = mesh.plan->indices();
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const float a = facing[indices[i]], b = facing[indices[i + 1]], c = facing[indices[i + 2]];
    if (std::max({a, b, c}) > -nearly_square && std::min({a, b, c}) < nearly_square)
      rim.insert(rim.end(), {indices[i], indices[i + 1], indices[i + 2]});
  }
  return rim;
}

}  // namespace render
