#include "sim/core/cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

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

std::vector<ImagePair> near_images(std::span<const Box> given, double reach, const CellSides& lattice) {
  std::vector<ImagePair> pairs;
  if (!lattice) {
    for (const auto& [i, j] : near_pairs(given, reach)) pairs.push_back({i, j, Eigen::Vector3i::Zero()});
    return pairs;
  }
  const Eigen::Matrix3d inverse = lattice->inverse();
  const auto moved = [&](const Box& box, const Eigen::Vector3i& by) {
    const Vec3 shift = *lattice * by.cast<double>();
    return Box{box.low + shift, box.high + shift};
  };
  const auto n = static_cast<int>(given.size());
  std::vector<Eigen::Vector3i> home;  // the number of the cell that holds a box
  std::vector<Box> boxes;
  Box all{};
  double widest = 0;
  for (const Box& box : given) {
    home.emplace_back((inverse * (0.5 * (box.low + box.high))).array().floor().matrix().cast<int>());
    boxes.push_back(moved(box, -home.back()));
    all = boxes.size() == 1 ? boxes[0] : united(all, boxes.back());
    widest = std::max(widest, (box.high - box.low).norm());
  }
  Eigen::Vector3i most;
  for (int d = 0; d < 3; ++d) most[d] = static_cast<int>(std::ceil((reach + widest) * inverse.row(d).norm())) + 1;
  struct Image {
    int box;
    Eigen::Vector3i number;
  };
  std::vector<Image> images;
  for (int j = 0; j < n; ++j) images.push_back({j, Eigen::Vector3i::Zero()});
  for (int j = 0; j < n; ++j)
    for (int x = -most[0]; x <= most[0]; ++x)
      for (int y = -most[1]; y <= most[1]; ++y)
        for (int z = -most[2]; z <= most[2]; ++z) {
          const Eigen::Vector3i number(x, y, z);
          if (number.isZero()) continue;
          const Box box = moved(boxes[j], number);
          if (distance(box, all) > reach) continue;
          images.push_back({j, number});
          boxes.push_back(box);
        }
  const auto key = [](const ImagePair& p) { return std::tuple(p.first, p.second, p.image[0], p.image[1], p.image[2]); };
  for (const auto& [a, b] : near_pairs(boxes, reach)) {
    if (a >= n) continue;
    const int j = images[b].box;
    const ImagePair pair{a, j, images[b].number - home[j] + home[a]};
    // Of the two in which each stands for the other, one.
    if (a < j || (a == j && key(pair) > std::tuple(a, a, 0, 0, 0))) pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(), [&](const ImagePair& p, const ImagePair& q) { return key(p) < key(q); });
  return pairs;
}

}  // namespace sim
