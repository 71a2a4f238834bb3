#include "sim/layers/source_tiles.h"

#include <algorithm>
#include <cmath>

namespace sim {

SourceTiles make_tiles(const Basis& basis, const Sources& s) {
  constexpr int side = 6;  // points
  const int latitudes = basis.latitudes(), longitudes = basis.longitudes();
  SourceTiles tiles;
  tiles.points.resize(s.points.rows(), 3);
  tiles.source.reserve(std::size_t(s.points.rows()));
  tiles.first.push_back(0);
  for (int j0 = 0; j0 < longitudes; j0 += side)
    for (int i0 = 0; i0 < latitudes; i0 += side) {
      const int j1 = std::min(longitudes, j0 + side), rows = std::min(side, latitudes - i0);
      for (int j = j0; j < j1; ++j) {
        const Eigen::Index from = i0 + Eigen::Index(latitudes) * j;
        tiles.points.middleRows(Eigen::Index(tiles.source.size()), rows) = s.points.middleRows(from, rows);
        for (int i = 0; i < rows; ++i) tiles.source.push_back(from + i);
      }
      const auto end = static_cast<Eigen::Index>(tiles.source.size());
      const auto tile = tiles.points.middleRows(tiles.first.back(), end - tiles.first.back());
      tiles.boxes.push_back({tile.colwise().minCoeff().transpose(), tile.colwise().maxCoeff().transpose()});
      tiles.first.push_back(end);
    }
  return tiles;
}

std::pair<Eigen::Index, double> nearest_source(const SourceTiles& tiles, const Vec3& x, double limit) {
  Eigen::Index best = -1;
  double square = limit * limit;
  const auto look = [&](std::size_t tile) {
    const Eigen::Index first = tiles.first[tile], count = tiles.first[tile + 1] - first;
    Eigen::Index k = 0;
    const double least = ((tiles.points.col(0).segment(first, count).array() - x[0]).square() +
                          (tiles.points.col(1).segment(first, count).array() - x[1]).square() +
                          (tiles.points.col(2).segment(first, count).array() - x[2]).square())
                             .minCoeff(&k);
    const Eigen::Index source = tiles.source[std::size_t(first + k)];
    if (least < square || (least == square && best >= 0 && source < best)) {
      square = least;
      best = source;
    }
  };
  const auto away = [&](std::size_t tile) {
    return (tiles.boxes[tile].low - x).cwiseMax(x - tiles.boxes[tile].high).cwiseMax(0).squaredNorm();
  };
  // The nearest box first: then few others can hold a nearer point.
  std::size_t nearest = 0;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < tiles.boxes.size(); ++t)
    if (const double d = away(t); d < shortest) {
      shortest = d;
      nearest = t;
    }
  if (shortest > square) return {-1, limit};
  look(nearest);
  for (std::size_t t = 0; t < tiles.boxes.size(); ++t)
    if (t != nearest && away(t) <= square) look(t);
  return best < 0 ? std::pair(best, limit) : std::pair(best, std::sqrt(square));
}

}  // namespace sim
