// A phase diagram of ellipsoids.
#pragma once

#include "render/figures/figure.h"
#include "surfaces.h"

namespace surfaces {

/// `side` x `side` vesicles, one of each kind of motion in turn, in three positions.
inline render::Diagram diagram(std::size_t side) {
  render::Diagram d;
  d.x = "viscosity contrast λ";
  d.y = "reduced volume ν";
  d.kinds = {"tank-treading", "swinging", "tumbling", "not determined"};
  std::vector<std::vector<render::ClosedCurve>> outlines;
  for (const double angle : {60.0, 30.0, 0.0})
    outlines.push_back(render::cut(ellipsoid({1.5, 0.8, 0.8}, turn(angle, {0, 1, 0}), {0, 0, 0}).position, {}));
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t k = 0; k < side; ++k) {
      render::DiagramPoint& point = d.points.emplace_back();
      point.x = std::pow(3.0, static_cast<double>(i));
      point.y = 0.8 + 0.03 * static_cast<double>(k);
      point.kind = (i + k) % d.kinds.size();
      point.outlines = outlines;
    }
  d.csv = "x,y,motion,period,angle_mean\n1,0.8,tumbling,26.1,nan\n3,0.8,swinging,20,5\n";
  return d;
}

}  // namespace surfaces
