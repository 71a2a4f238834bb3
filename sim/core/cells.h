// Which of many boxes are near one another, found by a list of cells: the cost grows like the number of boxes and of
// pairs.
#pragma once

#include "sim/core/types.h"

#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace sim {

struct Box {
  Vec3 low, high;
};

inline double distance(const Box& box, const Vec3& x) {
  return (box.low - x).cwiseMax(x - box.high).cwiseMax(0).norm();
}
inline double distance(const Box& a, const Box& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0).norm();
}

inline Box united(const Box& a, const Box& b) { return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)}; }

/// A box that holds nothing: united with another one it is that one.
inline Box empty_box() {
  constexpr double huge = std::numeric_limits<double>::max();
  return {Vec3::Constant(huge), Vec3::Constant(-huge)};
}
inline bool is_empty(const Box& box) { return !(box.low.array() <= box.high.array()).all(); }

/// The pairs i < j of boxes that are no farther apart than `reach`, in ascending order.
std::vector<std::pair<int, int>> near_pairs(std::span<const Box>, double reach);

/// Sides of a periodic cell, in columns; none: unbounded space.
using CellSides = std::optional<Eigen::Matrix3d>;

/// Two boxes, the second one moved by whole numbers of the sides.
struct ImagePair {
  int first, second;
  Eigen::Vector3i image;
  Vec3 shift(const CellSides& sides) const { return sides ? Vec3(*sides * image.cast<double>()) : Vec3(Vec3::Zero()); }
};
/// The boxes and images that are no farther apart than `reach`, a box and its own images included, each pair once with
/// first <= second, in ascending order. Boxes may lie in any cell.
std::vector<ImagePair> near_images(std::span<const Box>, double reach, const CellSides&);

}  // namespace sim
