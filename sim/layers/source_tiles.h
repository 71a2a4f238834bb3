// Which source point of a surface is nearest: points in tiles of neighbours on the grid, each with the box that holds
// it, of which a search looks into few.
#pragma once

#include "sim/core/cells.h"
#include "sim/layers/far_field.h"

#include <limits>
#include <utility>
#include <vector>

namespace sim {

struct SourceTiles {
  Matrix points;                     ///< of the sources, tile by tile
  std::vector<Eigen::Index> source;  ///< their places among the sources, ascending within a tile
  std::vector<Eigen::Index> first;   ///< of each tile, and the end
  std::vector<Box> boxes;            ///< by tile
};
SourceTiles make_tiles(const Basis&, const Sources&);

/// Index of the source point nearest to x, the lowest of equals, and its distance; {-1, limit} where none is nearer
/// than the limit.
std::pair<Eigen::Index, double> nearest_source(const SourceTiles&, const Vec3& x,
                                               double limit = std::numeric_limits<double>::infinity());

}  // namespace sim
