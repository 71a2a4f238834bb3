// Which of many boxes are near one another, found by a list of cells: the cost grows like the number of boxes and of
// pairs.
#pragma once

#include "sim/core/types.h"

#include <span>
#include <utility>

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

/// The pairs i < j of boxes that are no farther apart than `reach`, in ascending order.
std::vector<std::pair<int, int>> near_pairs(std::span<const Box>, double reach);

}  // namespace sim
