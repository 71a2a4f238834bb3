#include "render/draw/arrow_shape.h"

#include <cmath>
#include <numbers>

namespace render {

ArrowShape arrow_shape() {
  constexpr float head_length = 6.4F, head_radius = 2.6F;
  // x = -tip is the point itself; exactly 0 would count as the tail
  constexpr float tip = 1e-3F;
  ArrowShape shape;
  const auto put = [&](float x, float radius, float angle, const glm::vec3& n) {
    shape.position.emplace_back(x, radius * std::cos(angle), radius * std::sin(angle));
    shape.normal.push_back(n);
  };
  const float slope = std::atan2(head_radius, head_length);
  for (int k = 0; k < arrow_shape_sides; ++k) {
    const float step = 2 * std::numbers::pi_v<float> / arrow_shape_sides;
    const float a = step * static_cast<float>(k), b = step * static_cast<float>(k + 1), middle = (a + b) / 2;
    const auto round = [](float f) { return glm::vec3(0, std::cos(f), std::sin(f)); };
    const auto cone = [&](float f) {
      return glm::vec3(std::sin(slope), std::cos(slope) * std::cos(f), std::cos(slope) * std::sin(f));
    };
    const glm::vec3 back(-1, 0, 0);
    // shaft
    put(0, 1, a, round(a)), put(-head_length, 1, a, round(a)), put(-head_length, 1, b, round(b));
    put(0, 1, a, round(a)), put(-head_length, 1, b, round(b)), put(0, 1, b, round(b));
    // tail disc, collar, cone
    put(0, 0, a, back), put(0, 1, a, back), put(0, 1, b, back);
    put(-head_length, 0, a, back), put(-head_length, head_radius, a, back), put(-head_length, head_radius, b, back);
    put(-head_length, head_radius, a, cone(a)), put(-tip, 0, middle, cone(middle)),
        put(-head_length, head_radius, b, cone(b));
  }
  return shape;
}

ArrowShape bead_shape() {
  constexpr int rings = arrow_shape_sides / 2;
  constexpr float step = std::numbers::pi_v<float> / rings;
  ArrowShape shape;
  const auto put = [&](int i, int j) {
    const float t = step * static_cast<float>(i), f = step * static_cast<float>(j);
    shape.position.emplace_back(std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t));
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < arrow_shape_sides; ++j) {
      put(i, j), put(i + 1, j), put(i + 1, j + 1);
      put(i, j), put(i + 1, j + 1), put(i, j + 1);
    }
  shape.normal = shape.position;
  return shape;
}

}  // namespace render
