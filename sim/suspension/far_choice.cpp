#include "sim/suspension/far_choice.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace sim {

int spread_order(int p, int finer) {
  return finer == 0 ? p + 1 : finer == 1 ? std::max(p + 1, (3 * p + 1) / 2) : 2 * p;
}

// The smooth rule errs by exp(-2 pi d) at a distance of d spacings; what the grid aliases of a density asks for more.
double coarse_limit(double tolerance) { return 1.5 - std::log(tolerance) / (2 * std::numbers::pi); }

namespace {

/// Largest K h / pi with which a grid of spacing h integrates the smooth part of a single layer to a tolerance, by the
/// number of digits; of grids of order p + 1, 3p/2, 2p (measured at p = 8, with which finer grids do better). Double
/// layers need a quarter less.
struct Resolution {
  double digits, kh;
};
constexpr std::array<std::array<Resolution, 4>, 3> resolutions{{{{{3, 2.0}, {4, 1.75}, {5, 1.4}, {6, 1.0}}},
                                                                {{{3, 2.2}, {4, 1.95}, {6, 1.45}, {8, 1.0}}},
                                                                {{{4, 2.1}, {6, 1.6}, {8, 1.2}, {10, 1.0}}}}};

/// 0: none will do.
double largest_kh(int finer, double tolerance, bool dual) {
  const auto& table = resolutions[std::size_t(finer)];
  const double digits = std::max(-std::log10(tolerance), table.front().digits);
  if (digits > table.back().digits + 1e-9) return 0;
  std::size_t k = 1;
  while (k + 1 < table.size() && digits > table[k].digits) ++k;
  const auto &a = table[k - 1], &b = table[k];
  return a.kh + (digits - a.digits) / (b.digits - a.digits) * (b.kh - a.kh) - (dual ? 0.25 : 0);
}

/// Pairs of a target and a source point by their distance, for an average target; whole surfaces by the distance of the
/// nearest point, in bins of an eighth of an octave.
class Neighbourhood {
 public:
  Neighbourhood(std::span<const Sources> surfaces, double scale) : scale_(scale) {
    Eigen::Index points = 0;
    for (const Sources& s : surfaces) points += s.points.rows();
    constexpr int wanted = 128, a_surface = 12;
    const Eigen::Index stride = std::max<Eigen::Index>(1, points / wanted);
    std::vector<std::pair<int, Eigen::Index>> targets;
    Eigen::Index first = 0;
    for (int i = 0; i < std::ssize(surfaces); ++i) {
      const Eigen::Index count = surfaces[std::size_t(i)].points.rows();
      for (Eigen::Index k = (stride - first % stride) % stride; k < count; k += stride) targets.emplace_back(i, k);
      first += count;
    }
    std::vector<Bins> each(targets.size());
    parallel_for(static_cast<int>(targets.size()), [&](int t) {
      const auto [own, row] = targets[std::size_t(t)];
      const Vec3 x = surfaces[std::size_t(own)].points.row(row).transpose();
      for (int j = 0; j < std::ssize(surfaces); ++j) {
        const Sources& s = surfaces[std::size_t(j)];
        if (j == own || bin(distance(s.box, x)) == bins - 1) continue;
        const Eigen::Index step = std::max<Eigen::Index>(1, s.points.rows() / a_surface);
        std::array<int, bins> at{};
        int nearest = bins - 1, sampled = 0;
        for (Eigen::Index k = row % step; k < s.points.rows(); k += step, ++sampled) {
          const int b = bin((s.points.row(k).transpose() - x).norm());
          ++at[std::size_t(b)];
          nearest = std::min(nearest, b);
        }
        for (int b = 0; b < bins; ++b)
          each[std::size_t(t)][std::size_t(nearest)][std::size_t(b)] += double(at[std::size_t(b)]) / sampled;
      }
    });
    for (const Bins& one : each)
      for (std::size_t n = 0; n < bins; ++n)
        for (std::size_t b = 0; b < bins; ++b) mean_[n][b] += one[n][b] / double(each.size());
  }

  /// Source points within r of an average target, where a surface whose nearest point is within `finely` has so many,
  /// any other so many.
  double count(double r, double finely, double fine, double coarse) const {
    double sum = 0;
    for (int n = 0; n < bins; ++n)
      for (int b = 0; b < bin(r); ++b) sum += mean_[std::size_t(n)][std::size_t(b)] * (n < bin(finely) ? fine : coarse);
    return sum;
  }

 private:
  static constexpr int bins = 64;
  using Bins = std::array<std::array<double, bins>, bins>;
  int bin(double r) const {
    return std::clamp(static_cast<int>(std::floor(8 * std::log2(std::max(r, 1e-300) / scale_))), 0, bins - 1);
  }
  double scale_;
  Bins mean_{};
};

/// Core seconds, measured with g++ 12 and AVX2 (docs/fast-sums.md).
struct Rates {
  double direct_pair, pair, node, spread, read;
};
Rates rates_of(const FastSetting& s, bool dual) {
  const int vectors = (s.window + 3) / 4;
  const double squares = double(s.window) * s.window * vectors;
  return {dual ? 1.3e-9 : 1.03e-9, (s.single_precision ? 1.0e-9 : 2.4e-9) * (dual ? 1.8 : 1), 9e-9,
          (dual ? 3.2e-9 : 1.9e-9) * squares + 0.1e-6, 1.7e-9 * squares + 0.1e-6};
}

/// As Neighbourhood does, where surfaces fill a periodic cell evenly.
class EvenNeighbourhood {
 public:
  EvenNeighbourhood(std::span<const Outline> surfaces, const Eigen::Matrix3d& cell)
      : density_(double(surfaces.size()) / std::abs(cell.determinant())) {
    for (const Outline& s : surfaces) reach_ = std::max(reach_, (s.box.high - s.box.low).norm() / 2);
  }
  double count(double r, double finely, double fine, double coarse) const {
    const double near = std::min(r, finely + reach_);
    return density_ * 4 * std::numbers::pi / 3 * (std::pow(near, 3) * (fine - coarse) + std::pow(r, 3) * coarse);
  }

 private:
  double density_, reach_ = 0;
};

/// Points of the grids of the targets.
double targets_of(const SurfaceCrowd& crowd) {
  double sum = 0;
  for (const int p : crowd.orders) sum += grid_points(p + 1);
  return sum;
}

/// The cheapest cut-off and grid. `nodes_of`: nodes of the transforms, by the cut-off; `octaves`: how far beyond
/// the least cut-off to look.
template <class Neighbours, class Nodes>
FastChoice cheapest(const SurfaceCrowd& crowd, const FarOptions& options, const FastSetting& setting,
                    const Neighbours& near, const Nodes& nodes_of, double octaves) {
  const auto n = crowd.orders.size();
  const Rates rates = rates_of(setting, crowd.dual);
  const double targets = targets_of(crowd), transforms = crowd.dual ? 7 : 6;
  FastChoice best{setting, 0, std::numeric_limits<double>::infinity()};
  for (const int finer : {0, 1, 2}) {
    const double kh = largest_kh(finer, options.tolerance, crowd.dual);
    if (kh <= 0) continue;
    double spread = 0, spacing = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double s = spread_order(crowd.orders[i], finer);
      spread += 2 * (s + 1) * (s + 1);
      spacing = std::max(spacing, crowd.coarse[i].spacing * (crowd.orders[i] + 2) / (s + 1));
    }
    const double least = setting.wave_number * spacing / (std::numbers::pi * kh);
    for (int step = 0; step < 8 * octaves; ++step) {
      const double cutoff = least * std::exp2(step / 8.0);
      const double pairs = targets * near.count(cutoff, coarse_limit(options.tolerance) * spacing,
                                                crowd.fine_points / double(n), spread / double(n));
      constexpr double lanes_within = 0.5;  // of those evaluated
      const double nodes = nodes_of(cutoff);
      const double seconds = (pairs / lanes_within + targets * spread / double(n)) * rates.pair +
                             nodes * transforms * rates.node + spread * rates.spread + targets * rates.read;
      constexpr double most_nodes = 1e9;  // 6 GB a channel
      if (nodes < most_nodes && seconds < best.seconds) {
        best.finer = finer;
        best.setting.cutoff = cutoff;
        best.seconds = seconds;
      }
    }
  }
  return best;
}

FastChoice choose_periodic(const SurfaceCrowd& crowd, const FarOptions& options) {
  FastSetting setting = fast_setting(options.tolerance, crowd.dual);
  setting.cell = options.cell;
  double largest = 0;
  for (const Outline& surface : crowd.coarse) largest = std::max(largest, surface.spacing);
  const double node = Mesh::spacing(setting.wave_number, setting.oversampling);
  const Vec3 sides = options.cell->colwise().norm().transpose();
  // A cut-off beyond the whole cell leaves a mesh of a few nodes.
  const double octaves = 4 + std::max(0.0, std::log2(sides.maxCoeff() / largest));
  return cheapest(
      crowd, options, setting, EvenNeighbourhood(crowd.coarse, *options.cell),
      [&](double cutoff) { return (sides / cutoff / node).cwiseMax(setting.window + 1).prod(); }, octaves);
}

}  // namespace

Outline outline_of(const Sources& s) { return {s.box, s.spacing.maxCoeff()}; }

std::optional<FastChoice> choose_fast(const SurfaceCrowd& crowd, const FarOptions& options) {
  if (options.cell) return choose_periodic(crowd, options);
  if (options.method == "direct") return std::nullopt;
  const auto n = double(crowd.orders.size());
  const double targets = targets_of(crowd);
  double largest = 0;
  Box all = empty_box();
  for (const Outline& surface : crowd.coarse) {
    largest = std::max(largest, surface.spacing);
    all = united(all, surface.box);
  }
  const FastSetting setting = fast_setting(options.tolerance, crowd.dual);
  const Rates rates = rates_of(setting, crowd.dual);
  double direct = targets * targets * (n - 1) / n * rates.direct_pair;
  // For few vesicles nothing but spreading and reading is worth counting.
  if (options.method == "auto" && 2 * targets * (rates.spread + rates.read) > direct) return std::nullopt;
  const Neighbourhood near(crowd.sources, largest / 4);
  constexpr double everywhere = 1e300, coarse_from = 6;  // spacings: as InteractionOptions has it
  direct +=
      targets * near.count(everywhere, coarse_from * largest, (crowd.fine_points - targets) / n, 0) * rates.direct_pair;
  const double node = Mesh::spacing(setting.wave_number, setting.oversampling);
  const FastChoice best = cheapest(
      crowd, options, setting, near,
      [&](double cutoff) {
        return Mesh::padded_nodes(Mesh::nodes_for((all.high - all.low) / cutoff, node, setting.window));
      },
      4);
  if (!std::isfinite(best.seconds)) return std::nullopt;
  if (options.method == "auto" && best.seconds > direct) return std::nullopt;
  return best;
}

}  // namespace sim
