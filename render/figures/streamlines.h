// Evenly spaced streamlines of a plane flow (Jobard and Lefer 1997), each integrated in both directions by an
// embedded Runge-Kutta pair of order 5(4) in arc length, so that lines and spacing do not depend on the speed of the
// flow.
#pragma once

#include "render/figures/plot.h"

#include "sim/core/types.h"

#include <functional>
#include <vector>

namespace render {

/// Velocity in the plane at a point of the plane.
using PlaneFlow = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

struct StreamlineOptions {
  double spacing = 0.25;    ///< target distance of neighbouring lines
  double nearest = 0.45;    ///< a line ends where it is nearer to another than this share of the spacing
  double tolerance = 1e-4;  ///< of one step, as a share of the spacing
  double shortest = 2;      ///< lines shorter than so many spacings are dropped
  double closing =
      0.2;  ///< a line that passes its seed again within this share of the spacing is drawn as a closed one
  double stagnation = 1e-3;  ///< lines end where the speed falls below this share of the fastest seen
  double rest = 0;           ///< a flow that is nowhere faster counts as at rest and has no lines
};

struct Streamline {
  sim::Matrix points;   ///< count x 2, a tenth of the spacing or less apart
  sim::Vector speed;    ///< at the points
  bool closed = false;  ///< the last point is joined to the first
};

/// Lines that fill the window; seeds: points through which the first lines pass, where there is room. The result
/// depends only on the arguments.
std::vector<Streamline> streamlines(const PlaneFlow& flow, const Range& x, const Range& y,
                                    const StreamlineOptions& options, const std::vector<Eigen::Vector2d>& seeds = {});

/// Positions of arrow heads on a line: away from its ends, at least one on every line that is long enough, about
/// `apart` from each other, the first after the share `phase` of that. Indices of points.
std::vector<Eigen::Index> arrow_places(const Streamline& line, double apart, double phase = 0.5);

}  // namespace render
