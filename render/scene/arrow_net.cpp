#include "render/scene/arrow_net.h"

#include "render/core/places.h"

#include <algorithm>
#include <cmath>

namespace render {

using glm::dvec3;

namespace {

/// The coordinate axis that a vector follows most.
int leading(const dvec3& v) {
  const dvec3 a = glm::abs(v);
  return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

}  // namespace

sim::Matrix arrow_points(const Framing& framing, const Moment& moment, int finer) {
  const Camera camera = make_camera(framing, moment);
  // The coordinate plane that faces the viewer most, through the target: there the velocity is what it seems to be.
  const ViewAxes& axes = framing.axes;  // of a camera that turns: its first view, so that the plane does not change
  const auto unit = [](int axis) {
    dvec3 e(0);
    e[axis] = 1;
    return e;
  };
  const int normal = leading(axes.back);
  dvec3 in_plane = axes.right;
  in_plane[normal] = 0;
  const int across = leading(in_plane), along = 3 - normal - across;
  const dvec3 e1 = unit(across), e2 = unit(along);

  const double height = 2 * camera.half_height, width = 2 * camera.half_width;
  // Two columns at most: the longest arrows would meet in a row.
  const double step1 = height / 4.2 / std::min(finer, 2), step2 = height / 7.5 / finer;
  // A following camera carries the window over a net at rest; passing arrows enter from outside the picture.
  const double shift1 = framing.follows ? camera.target[across] : 0,
               shift2 = framing.follows ? camera.target[along] : 0;
  const double phase1 = framing.follows ? 0 : (std::lround(width / step1) % 2 == 0 ? 0.5 : 0.0);
  const glm::dvec2 reach = framing.follows ? glm::dvec2(1.2, 1.2) : glm::dvec2(0.94, 0.86);
  const auto first = [](double middle, double extent, double step) { return std::floor((middle - extent) / step); };
  std::vector<dvec3> points;
  for (double j = first(shift2, height, step2); j * step2 <= shift2 + height; ++j)
    for (double i = first(shift1, width, step1); (i + phase1) * step1 <= shift1 + width; ++i) {
      const dvec3 point = camera.target + ((i + phase1) * step1 - shift1) * e1 + (j * step2 - shift2) * e2;
      const glm::dvec2 place = camera.picture_place(point);
      if (std::abs(place.x) > reach.x || std::abs(place.y) > reach.y) continue;
      if (!framing.follows && clear_of_captions(place) < 1) continue;
      points.push_back(point);
    }
  sim::Matrix result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k)
    result.row(static_cast<Eigen::Index>(k)) = to_sim(points[k]).transpose();
  return result;
}

double arrows_shown(const Framing& framing, const Moment& moment) {
  if (!framing.turns()) return 1;
  return glm::smoothstep(0.2, 0.45, std::abs(framing.axes_at(moment.time).back[leading(framing.axes.back)]));
}

}  // namespace render
