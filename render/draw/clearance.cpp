#include "render/draw/clearance.h"

#include <algorithm>
#include <cmath>

namespace render {

Shadow shadow_of(const Camera& camera, const std::vector<glm::dvec3>& points) {
  Shadow shadow;
  for (const glm::dvec3& point : points) {
    const glm::dvec2 place = camera.picture_place(point);
    shadow.points.emplace_back(place.x * camera.half_width / camera.half_height, place.y);
    shadow.centre += shadow.points.back();
  }
  shadow.centre /= static_cast<double>(shadow.points.size());
  for (const glm::dvec2& p : shadow.points) shadow.radius = std::max(shadow.radius, glm::distance(p, shadow.centre));
  return shadow;
}

std::vector<Shadow> shadows(const Frame& frame) {
  std::vector<Shadow> all;
  for (const Body& body : frame.bodies) {
    std::vector<glm::dvec3> points;
    const int stride = body.mesh.plan->latitudes() > 64 ? 2 : 1;  // of the mesh: 48 x 96 points of a large body
    const int rings = body.mesh.plan->latitudes() - 1, columns = body.mesh.plan->longitudes();
    for (int j = 0; j < columns; j += stride)
      for (int i = 0; i < rings; i += stride) {
        const int point = j * rings + i;
        const glm::dvec3& place = body.mesh.position[static_cast<std::size_t>(point)];
        if (!frame.faces || frame.faces->holds(place)) points.emplace_back(place);
      }
    if (!points.empty()) all.push_back(shadow_of(frame.camera, points));
  }
  return all;
}

double clear_of_bodies(const std::vector<Shadow>& shadows, const glm::dvec2& tail, const glm::dvec2& tip) {
  constexpr double near = 0.03, far = 0.055;  // half heights
  const glm::dvec2 along = tip - tail;
  const double length2 = std::max(glm::dot(along, along), 1e-12);
  const auto away_from = [&](const glm::dvec2& p) {
    return p - tail - along * std::clamp(glm::dot(p - tail, along) / length2, 0.0, 1.0);
  };
  double nearest2 = far * far;
  for (const Shadow& shadow : shadows) {
    if (glm::length(away_from(shadow.centre)) > shadow.radius + shadow.reach + far) continue;
    for (const glm::dvec2& p : shadow.points) {
      const glm::dvec2 away = away_from(p);
      double apart2 = glm::dot(away, away);
      if (shadow.reach > 0) apart2 = std::pow(std::max(std::sqrt(apart2) - shadow.reach, 0.0), 2);
      nearest2 = std::min(nearest2, apart2);
    }
  }
  return glm::smoothstep(near, far, std::sqrt(nearest2));
}

}  // namespace render
