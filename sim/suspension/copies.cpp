#include "sim/suspension/copies.h"

#include "sim/surface/geometry.h"
#include "sim/surface/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

using std::numbers::pi;

Extent extent_of(const VesicleParameters& v) {
  VesicleParameters centred = v;
  centred.center.setZero();
  const Coefficients x = initial_position(centred);
  const Basis basis(x.order, 2 * x.order + 8);
  const Matrix points = basis.synthesize(x).values;
  const Vector distance = points.rowwise().norm();
  const AreaVolume size = area_volume(basis, x);
  return {size.volume, distance.maxCoeff(), distance.minCoeff(), std::sqrt(size.area / (4 * pi)),
          (points.colwise().maxCoeff() - points.colwise().minCoeff()).transpose()};
}

/// z of which a share p of a normal distribution lies below.
double normal_quantile(double p) {
  double low = -9, high = 9;  // beyond lies less than uniform() tells apart
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erfc(-middle / std::numbers::sqrt2) / 2 < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1.0p-53; }

Vec3 random_direction(std::mt19937_64& random) {
  const double z = 2 * uniform(random) - 1, f = 2 * pi * uniform(random), r = std::sqrt(1 - z * z);
  return {r * std::cos(f), r * std::sin(f), z};
}

std::vector<double> drawn_sizes(int count, double spread, int seed) {
  std::vector<double> sizes(std::size_t(count), 1.0);
  if (spread == 0) return sizes;
  // Numbers of their own, so that places and directions stay those of a seed.
  std::mt19937_64 random(std::uint64_t(seed) + (std::uint64_t(1) << 32));
  const double variance = std::log1p(spread * spread);  // of the logarithm
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const double z = normal_quantile((double(k) + uniform(random)) / double(count));
    sizes[k] = std::exp(std::sqrt(variance) * z - variance / 2);
  }
  for (std::size_t k = sizes.size() - 1; k > 0; --k)
    std::swap(sizes[k], sizes[std::size_t(uniform(random) * double(k + 1))]);
  return sizes;
}

Copies copies_of(const PlacementParameters& p, const VesicleParameters& original) {
  return {p, original, extent_of(original), drawn_sizes(p.count, p.size_spread, p.seed)};
}

double Copies::gap() const { return p.gap.value_or(default_placement_gap * extent.radius); }

double Copies::mean(const std::function<double(double)>& f) const {
  double sum = 0;
  for (const double size : sizes) sum += f(size) - f(1);
  return f(1) + sum / double(sizes.size());
}

double Copies::volume() const {
  return p.count * extent.volume * mean([](double size) { return size * size * size; });
}

double Copies::largest() const { return *std::max_element(sizes.begin(), sizes.end()); }

VesicleParameters Copies::copy(std::size_t k) const {
  VesicleParameters v = original;
  if (p.size_spread == 0) return v;
  v.area.reset();
  v.radius = extent.radius * sizes[k];
  return v;
}

double Copies::fraction(const std::optional<Vec3>& cell) const {
  return cell ? volume() / cell->prod() : p.volume_fraction;
}

double Copies::filled_share(double room) const {
  const double equivalent = std::cbrt(3 * extent.volume / (4 * pi));
  return p.count * 4 * pi / 3 * mean([&](double size) { return std::pow(equivalent * size + gap() / 2, 3); }) / room;
}

}  // namespace sim
