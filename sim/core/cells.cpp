#include "sim/core/cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace sim {

std::vector<std::pair<int, int>> near_pairs(std::span<const Box> boxes, double reach) {
  std::vector<std::pair<int, int>> pairs;
  if (boxes.size() < 2) return pairs;
  // Centres of near boxes are no farther apart than the largest box is wide and the reach is long: neighbouring cells
  // hold them.
  double width = 0;
  Vec3 low = boxes[0].low;
  for (const Box& box : boxes) {
    width = std::max(width, (box.high - box.low).maxCoeff());
    low = low.cwiseMin(box.low);
  }
  const double side = width + reach;
  using Cell = std::array<double, 3>;  // whole numbers, of any size
  const auto cell_of = [&](const Box& box) {
    const Vec3 c = ((0.5 * (box.low + box.high) - low) / side).array().floor();
    return side > 0 ? Cell{c[0], c[1], c[2]} : Cell{};
  };
  std::map<Cell, std::vector<int>> cells;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) cells[cell_of(boxes[i])].push_back(i);
  for (int j = 0; j < static_cast<int>(boxes.size()); ++j) {
    const Cell here = cell_of(boxes[j]);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const auto cell = cells.find({here[0] + dx, here[1] + dy, here[2] + dz});
          if (cell == cells.end()) continue;
          for (const int i : cell->second)
            if (i < j && distance(boxes[i], boxes[j]) <= reach) pairs.emplace_back(i, j);
        }
  }
  std::sort(pairs.begin(), pairs.end());
  // So far out that 1 is lost in the number of a cell, neighbouring cells are the same one.
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace sim
