// The smooth rule: single and double layers of many surfaces at many targets, all with all. Everything else about
// interactions is a correction to it, so that a fast method can take its place.
//
// Targets come in groups: the grid of a surface, which does not see that surface (its own layers are singular there),
// or any points. A target for which the smooth rule of some surface is not good enough is excluded from it: whoever
// excludes it adds a better value. The direct sum leaves these pairs out; a fast method has to subtract them.
#pragma once

#include "sim/core/cells.h"
#include "sim/core/lanes.h"
#include "sim/fast/patches.h"
#include "sim/sphere/basis.h"

#include <memory>
#include <span>

namespace sim {

/// A surface as the smooth rule sees it.
struct Sources {
  Matrix points, normals;  ///< points x 3; normals weighted by dA
  Vector area;             ///< dA
  Vector spacing;          ///< local distance of neighbouring source points
  Box box;
};
Sources make_sources(const Basis&, const Coefficients& position);
/// Order of the fine source grid, q ~ p^(3/2) (section 3.1.10), unless another one is wanted.
int smooth_order(int p, int wanted = 0);

/// Densities at the points of one surface: force for the single layer; for the double layer, or empty where there is
/// none.
struct SourceDensities {
  Matrix force, dual;
};

struct TargetGroup {
  Matrix points;     ///< points x 3
  int surface = -1;  ///< whose grid they are; -1: of none
};

/// The targets of a group that do see a surface which not all of them see, in ascending order.
struct PartialView {
  int surface;
  std::vector<int> targets;
};

struct FarField {
  std::shared_ptr<const std::vector<Sources>> sources;  ///< many sets of targets may see the same ones
  std::vector<TargetGroup> groups;
  std::vector<std::vector<PartialView>> partial;  ///< by group, in ascending order of the surface
};
FarField plan_far_field(std::shared_ptr<const std::vector<Sources>>, std::vector<TargetGroup>);
/// In place of the exclusions that there were; they come by group.
void exclude(FarField&, const std::vector<Exclusion>&);

/// Velocity at the targets, points x 3 a group. Does not depend on the number of threads.
std::vector<Matrix> far_velocity(const FarField&, std::span<const SourceDensities>);

/// The smooth rule of one surface at points (count x 3), added to `velocity`.
void add_direct_sum(const Sources&, const SourceDensities&, const Matrix& points, Matrix& velocity,
                    LaneCount = LaneCount::widest);

}  // namespace sim
