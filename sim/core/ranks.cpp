#include "sim/core/ranks.h"

#include <algorithm>
#include <numeric>

namespace sim {

namespace {

/// Gives the items to ranks [first, first + count).
void bisect(std::span<int> items, int first, int count, std::span<const Vec3> places, std::span<const double> weights,
            std::vector<int>& owner) {
  if (count == 1 || items.empty()) {
    for (const int k : items) owner[std::size_t(k)] = first;
    return;
  }
  Vec3 low = places[std::size_t(items[0])], high = low;
  double total = 0;
  for (const int k : items) {
    low = low.cwiseMin(places[std::size_t(k)]);
    high = high.cwiseMax(places[std::size_t(k)]);
    total += weights[std::size_t(k)];
  }
  Eigen::Index side = 0;
  (high - low).maxCoeff(&side);
  std::sort(items.begin(), items.end(), [&](int a, int b) {
    const double x = places[std::size_t(a)][side], y = places[std::size_t(b)][side];
    return x != y ? x < y : a < b;
  });
  const int half = count / 2;
  const double wanted = total * half / count;
  std::size_t cut = 0;
  for (double sum = 0; cut < items.size(); ++cut) {
    const double weight = weights[std::size_t(items[cut])];
    if (sum + weight / 2 > wanted) break;  // half of it lies beyond
    sum += weight;
  }
  bisect(items.first(cut), first, half, places, weights, owner);
  bisect(items.subspan(cut), first + half, count - half, places, weights, owner);
}

}  // namespace

Division divided(const Ranks& ranks, std::span<const Vec3> places, std::span<const double> weights) {
  Division division{&ranks, {}};
  if (ranks.count == 1) return division;
  division.owner.resize(places.size());
  std::vector<int> items(places.size());
  std::iota(items.begin(), items.end(), 0);
  bisect(items, 0, ranks.count, places, weights, division.owner);
  return division;
}

Division divided(const Ranks& ranks, int items) {
  Division division{&ranks, {}};
  if (ranks.count == 1) return division;
  for (int k = 0; k < items; ++k) division.owner.push_back(int(std::int64_t(k) * ranks.count / items));
  return division;
}

}  // namespace sim
