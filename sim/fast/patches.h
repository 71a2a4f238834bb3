// Points in patches of neighbours, and who sees whom: targets come in groups, sources in bodies.
#pragma once

#include "sim/fast/mesh.h"

namespace sim {

/// The targets of a group that do not see a surface, in ascending order.
struct Exclusion {
  int group, surface;
  std::vector<int> targets;
};

struct Patches {
  std::vector<int> order;  ///< of the points; a patch is a piece of it
  std::vector<int> first;  ///< of each patch, and the end
  Points centres;
  std::vector<double> radii;  ///< of spheres about the centres that hold a patch
  int count() const { return static_cast<int>(radii.size()); }
};

/// Halves the points along their widest direction until `size` or fewer are left; all patches but the last are full.
Patches divide(const Points&, int size);

}  // namespace sim
