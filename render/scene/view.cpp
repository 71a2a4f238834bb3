#include "render/scene/view.h"

#include <cmath>
#include <stdexcept>

namespace render {

using glm::dvec3;

ViewAxes axes_from(const dvec3& back, const dvec3& up) {
  const dvec3 b = glm::normalize(back), r = glm::normalize(glm::cross(up, b));
  return {.right = r, .up = glm::cross(b, r), .back = b};
}

ViewAxes axes_turned(double azimuth, double elevation) {
  const double a = glm::radians(azimuth), e = glm::radians(elevation);
  return axes_from({std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e)}, {0, 0, 1});
}

const std::vector<CameraRow>& cameras() {
  static const std::vector<CameraRow> rows{
      {"flow-gradient", "from -y: the flow to the right, its gradient up", axes_turned(0, 0)},
      {"three-quarter", "flow-gradient, from a little to the left and above", axes_turned(-22, 16)},
      {"flow-vorticity", "from above: the flow to the right, vorticity up the picture",
       axes_from({0, 0, 1}, {0, 1, 0})},
      {"gradient-vorticity", "against the flow: its gradient up", axes_from({1, 0, 0}, {0, 0, 1})},
      {"along-flow", "with the flow, from behind: its gradient up", axes_from({-1, 0, 0}, {0, 0, 1})},
  };
  return rows;
}

const CameraRow& find_camera(std::string_view name) {
  if (const CameraRow* row = sim::find_row(cameras(), name)) return *row;
  throw std::invalid_argument("unknown camera '" + std::string(name) + "'" +
                              sim::suggestion(name, sim::row_names(cameras())));
}

CameraKey camera_at(std::span<const CameraKey> keys, double time) {
  if (keys.empty()) return {};
  if (time <= keys.front().time) return keys.front();
  if (time >= keys.back().time) return keys.back();
  std::size_t k = 0;
  while (keys[k + 1].time <= time) ++k;
  const CameraKey &from = keys[k], &to = keys[k + 1];
  const double h = to.time - from.time, u = (time - from.time) / h, rest = 1 - u;
  // Tangents by Fritsch and Butland's harmonic mean: no overshoot; none at the ends and where the motion turns back.
  const auto value = [&](double CameraKey::*member) {
    const auto secant = [&](std::size_t i) {
      return (keys[i + 1].*member - keys[i].*member) / (keys[i + 1].time - keys[i].time);
    };
    const auto tangent = [&](std::size_t i) {
      if (i == 0 || i + 1 == keys.size()) return 0.0;
      const double before = secant(i - 1), after = secant(i);
      return before * after > 0 ? 2 * before * after / (before + after) : 0.0;
    };
    return rest * rest * (1 + 2 * u) * from.*member + u * u * (3 - 2 * u) * to.*member +
           h * u * rest * (rest * tangent(k) - u * tangent(k + 1));
  };
  return {.time = time,
          .azimuth = value(&CameraKey::azimuth),
          .elevation = value(&CameraKey::elevation),
          .zoom = value(&CameraKey::zoom)};
}

}  // namespace render
