#include "sim/fast/patches.h"

#include <algorithm>
#include <numeric>

namespace sim {

namespace {

void halve(const Points& points, int size, std::vector<int>::iterator begin, std::vector<int>::iterator end) {
  const auto count = static_cast<int>(end - begin);
  if (count <= size) return;
  Eigen::Vector3d low = points.col(*begin), high = low;
  for (auto k = begin; k != end; ++k) {
    low = low.cwiseMin(points.col(*k));
    high = high.cwiseMax(points.col(*k));
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const auto middle = begin + (count + size - 1) / size / 2 * size;
  std::nth_element(begin, middle, end,
                   [&](int a, int b) { return std::pair(points(axis, a), a) < std::pair(points(axis, b), b); });
  halve(points, size, begin, middle);
  halve(points, size, middle, end);
}

}  // namespace

Patches divide(const Points& points, int size) {
  const auto count = static_cast<int>(points.cols());
  Patches p;
  p.order.resize(std::size_t(count));
  std::iota(p.order.begin(), p.order.end(), 0);
  halve(points, size, p.order.begin(), p.order.end());
  for (int first = 0; first < count; first += size) p.first.push_back(first);
  p.first.push_back(count);
  p.centres.resize(3, std::ssize(p.first) - 1);
  for (std::size_t b = 0; b + 1 < p.first.size(); ++b) {
    const std::span<const int> members(p.order.begin() + p.first[b], p.order.begin() + p.first[b + 1]);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const int k : members) centre += points.col(k);
    centre /= static_cast<double>(members.size());
    double radius = 0;
    for (const int k : members) radius = std::max(radius, (points.col(k) - centre).norm());
    p.centres.col(Eigen::Index(b)) = centre;
    p.radii.push_back(radius);
  }
  return p;
}

}  // namespace sim
