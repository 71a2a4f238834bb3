#include "sim/suspension/repulsion.h"

#include "sim/core/divided.h"
#include "sim/layers/near.h"
#include "sim/layers/source_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace sim {

namespace {

/// A vesicle with the grid on which the nearest of its points is looked for.
struct Repeller {
  const Basis& basis;
  PointSampler surface;
  Sources sources;
  SourceTiles tiles;
  double radius = 0;  ///< of the sphere of its area
};

Repeller repeller(Plans& plans, const Coefficients& x) {
  const Basis& basis = plans.basis(x.order, x.order + x.order / 2);
  Sources sources = make_sources(basis, x);
  const double radius = std::sqrt(sources.area.sum() / (4 * std::numbers::pi));
  SourceTiles tiles = make_tiles(basis, sources);
  return {basis, PointSampler(x), std::move(sources), std::move(tiles), radius};
}

/// Another vesicle, or an image, that is near.
struct Neighbour {
  int vesicle;
  Vec3 shift;
};

std::vector<std::vector<Neighbour>> neighbours(const std::vector<Box>& boxes, double reach, const CellSides& cell) {
  std::vector<std::vector<Neighbour>> of(boxes.size());
  for (const ImagePair& pair : near_images(boxes, reach, cell)) {
    const Vec3 shift = pair.shift(cell);
    of[std::size_t(pair.first)].push_back({pair.second, shift});
    of[std::size_t(pair.second)].push_back({pair.first, -shift});
  }
  return of;
}

/// Adds what one neighbour does at the points of vesicle `target`.
void repel(int target, const Neighbour& other, const Repeller& source, const Repulsion& repulsion, double reach,
           const Matrix& points, Matrix& traction) {
  // The foot of a point lies less than a spacing beside the nearest source.
  const double limit = std::hypot(reach, source.sources.spacing.maxCoeff());
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const Vec3 x = points.row(k).transpose() - other.shift;  // the image as seen from where its vesicle is
    if (distance(source.sources.box, x) >= reach) continue;
    const auto [nearest, away] = nearest_source(source.tiles, x, limit);
    if (nearest < 0) continue;
    const NearestPoint foot = nearest_point(source.surface, x, grid_direction(source.basis, nearest));
    if (foot.inside)
      throw std::domain_error(other.vesicle == target
                                  ? fmt::format("vesicle {} crosses its own image", target)
                                  : fmt::format("vesicle {} crosses vesicle {}", target, other.vesicle));
    if (foot.distance < reach)
      traction.row(k) += repulsion.strength * std::exp(-foot.distance / repulsion.range) *
                         (x - foot.position).normalized().transpose();
  }
}

}  // namespace

namespace {

// Two tips of curvature radius 0.3 R0 have a peak exp(-(r / width)^2) with width^2 = 0.3 R0 range, which the
// trapezoidal rule sums to 1e-3 with a spacing of 1.2 widths; the grid of a vesicle is stretched by up to 1.3.
constexpr double tip = 0.3, widths = 1.2, stretch = 1.3;
constexpr int finest_grid = 600;  // 720,000 points

}  // namespace

int repulsion_order(int degree, double radius, double smallest_radius, double range) {
  const double spacing = widths * std::sqrt(tip * smallest_radius * range) / stretch;
  return std::max(degree + 1, static_cast<int>(std::ceil(std::numbers::pi * radius / spacing)));
}

double sufficient_repulsion(double straining_rate, double radius, double range) {
  constexpr double measured = 7;  // in shear the rate is 0.41 of the shear rate; 5 was enough, 2.5 was not
  return measured * straining_rate * radius / range;
}

double least_repulsion_range(double smallest_radius, double largest_radius) {
  constexpr double thinnest = 1e-3;  // R0
  const double spacing = std::numbers::pi * largest_radius / finest_grid, width = stretch / widths * spacing;
  return std::max(thinnest * smallest_radius, width * width / (tip * smallest_radius));
}

std::vector<Coefficients> repulsion_forces(Plans& plans, std::span<const Coefficients> positions,
                                           const Repulsion& repulsion, const CellSides& cell,
                                           const Division& division) {
  const auto n = static_cast<int>(positions.size());
  if (repulsion.strength == 0 || n == 0 || (n < 2 && !cell)) return {};
  // A rank has its own vesicles and their neighbours; of the others it knows where they are and how large.
  std::vector<std::optional<Repeller>> all(static_cast<std::size_t>(n));
  std::vector<Box> boxes(static_cast<std::size_t>(n));
  std::vector<double> radii(static_cast<std::size_t>(n));
  const auto make = [&](int i) { all[std::size_t(i)].emplace(repeller(plans, positions[i])); };
  divided_for(
      division, n,
      [&](int i) {
        make(i);
        boxes[std::size_t(i)] = all[std::size_t(i)]->sources.box;
        radii[std::size_t(i)] = all[std::size_t(i)]->radius;
      },
      [&](Parcel& parcel, int i) {
        Box& box = boxes[std::size_t(i)];
        parcel(box.low), parcel(box.high), parcel(radii[std::size_t(i)]);
      });
  constexpr double ranges = 10;  // beyond it is less than 5e-5 of its strength
  const double reach = ranges * repulsion.range, smallest = *std::min_element(radii.begin(), radii.end());
  const auto of = neighbours(boxes, reach, cell);
  std::vector<char> wanted(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    if (division.mine(i))
      for (const Neighbour& other : of[std::size_t(i)]) wanted[std::size_t(other.vesicle)] = 1;
  parallel_for(n, [&](int i) {
    if (wanted[std::size_t(i)] && !division.mine(i)) make(i);
  });
  std::vector<Coefficients> forces(static_cast<std::size_t>(n));
  divided_for(division, n, [&](int i) {
    const auto k = std::size_t(i);
    const int p = positions[k].order;
    forces[k] = {p, Matrix::Zero((p + 1) * (p + 1), 3)};
    if (of[k].empty()) return;
    const Basis& basis = plans.basis(p, repulsion_order(p, radii[k], smallest, repulsion.range));
    const Matrix points = basis.synthesize(positions[k]).values;
    Matrix traction = Matrix::Zero(points.rows(), 3);
    for (const Neighbour& other : of[k])
      repel(i, other, *all[std::size_t(other.vesicle)], repulsion, reach, points, traction);
    forces[k] = basis.analyze(traction);
  });
  return forces;
}

}  // namespace sim
