// Points in patches of neighbours, and who sees whom: targets come in groups, sources in bodies.
#pragma once

#include "sim/core/lanes.h"
#include "sim/fast/mesh.h"

#include <algorithm>

namespace sim {

/// The targets of a group that do not see a surface, in ascending order; in a periodic cell, its image so many lattice
/// vectors away.
struct Exclusion {
  int group, surface;
  std::vector<int> targets;
  Eigen::Vector3i image = Eigen::Vector3i::Zero();
};

struct Patches {
  std::vector<int> order;  ///< of the points; a patch is a piece of it
  std::vector<int> first;  ///< of each patch, and the end
  Points centres;
  std::vector<double> radii;  ///< of spheres about the centres that hold a patch
  int count() const { return static_cast<int>(radii.size()); }
  std::span<const int> members(int patch) const {
    return std::span(order).subspan(std::size_t(first[std::size_t(patch)]),
                                    std::size_t(first[std::size_t(patch) + 1] - first[std::size_t(patch)]));
  }
};

/// Halves the points along their widest direction until `size` or fewer are left; all patches but the last are full.
Patches divide(const Points&, int size);

/// Some points from a centre, one a lane; lanes beyond the end repeat the last.
template <class Real>
struct PatchLanes {
  LaneOf<Real> x[3];
};
template <class Real>
PatchLanes<Real> lanes_of(const Points& points, std::span<const int> members, const Eigen::Vector3d& centre) {
  PatchLanes<Real> p;
  for (int d = 0; d < 3; ++d)
    for (int l = 0; l < lane_count<Real>; ++l)
      p.x[d][l] = static_cast<Real>(points(d, members[std::min<std::size_t>(l, members.size() - 1)]) - centre[d]);
  return p;
}

}  // namespace sim
