// What the processor could do at most, measured in the same run, and how much arithmetic kernels need: their rate over
// the ceiling is what is left to gain. A multiplication with an addition counts as two operations, a root and a
// quotient as one each, though they take far longer; idle lanes and padding are counted as nothing.
#pragma once

#include "sim/layers/folded_analysis.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

namespace bench {

using namespace sim;

/// The least time of some tries, seconds: what else runs on the machine only makes it longer.
template <class F>
double least_time(F&& f) {
  double least = std::numeric_limits<double>::max();
  for (int k = 0; k < 7; ++k) {
    const auto start = std::chrono::steady_clock::now();
    f();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return least;
}

/// Operations a second of one core on vectors that stay in registers.
template <class Vector>
double measured_arithmetic() {
  constexpr int chains = 12, turns = 400000;  // two units, four or five cycles of latency
  Vector x[chains];
  for (int c = 0; c < chains; ++c) x[c] = Vector{} + (1.0 + c);
  Vector factor = Vector{} + 0.999, term = Vector{} + 1e-3;
  const double time = least_time([&] {
    run_apart<Vector>([&]() __attribute__((always_inline)) {
      benchmark::DoNotOptimize(factor);
      Vector y[chains];
      for (int c = 0; c < chains; ++c) y[c] = x[c];
      for (int k = 0; k < turns; ++k)
        for (Vector& v : y) v = v * factor + term;
      for (int c = 0; c < chains; ++c) x[c] = y[c];
      benchmark::DoNotOptimize(x);
    });
  });
  return 2.0 * width_of<Vector> * chains * turns / time;
}
inline double arithmetic_ceiling(LaneCount most = LaneCount::four) {
  static const double four = measured_arithmetic<Lane>();
  static const double widest = has_wide_lanes() ? measured_arithmetic<WideLane>() : four;
  return most == LaneCount::widest ? widest : four;
}

/// The same in a product of two square matrices of this size by Eigen: what well-kept code gets of it.
inline double product_rate(int size) {
  const Matrix a = Matrix::Random(size, size), b = Matrix::Random(size, size);
  Matrix c(size, size);
  const double time = least_time([&] {
    c.noalias() = a * b;
    benchmark::DoNotOptimize(c.data());
  });
  return 2.0 * size * size * size / time;
}

/// Bytes a second that one core reads from a buffer of this size, again and again: from whichever cache holds it.
inline double reading_ceiling(std::size_t bytes) {
  constexpr std::size_t sums = 8;
  const std::size_t count = std::max<std::size_t>(1, bytes / sizeof(Lane) / sums) * sums;
  const int turns = int(std::max<std::size_t>(4, (std::size_t(1) << 26) / (count * sizeof(Lane))));
  const LaneBuffer buffer(count);
  std::fill(buffer.get(), buffer.get() + count, Lane{} + 1.0);
  const double time = least_time([&] {
    Lane sum[sums] = {};
    for (int k = 0; k < turns; ++k) {
      const Lane* from = buffer.get();
      benchmark::DoNotOptimize(from);
      for (std::size_t i = 0; i < count; i += sums)
        for (std::size_t j = 0; j < sums; ++j) sum[j] += from[i + j];
    }
    benchmark::DoNotOptimize(sum);
  });
  return double(turns) * double(count * sizeof(Lane)) / time;
}

/// Counters of a kernel with so many operations, which has to read so many bytes besides: its rate, and its share of
/// what the slower of the two ceilings allows with vectors of that many lanes.
inline void against_ceiling(benchmark::State& state, double operations, double bytes = 0,
                            LaneCount most = LaneCount::four) {
  double least = operations / arithmetic_ceiling(most);
  if (bytes > 0) least = std::max(least, bytes / reading_ceiling(std::size_t(bytes)));
  constexpr auto rate = benchmark::Counter::kIsIterationInvariantRate;
  state.counters["GFLOPS"] = benchmark::Counter(operations / 1e9, rate);
  state.counters["of_ceiling"] = benchmark::Counter(least, rate);
}

/// Operations of a kernel between a target and a source: differences, distance, its inverse, tensor products.
constexpr double pair_operations(bool with_double) { return with_double ? 49 : 34; }
/// The same as 6 or 12 components of matrices, with their weights.
constexpr double component_operations(bool with_double) { return with_double ? 42 : 24; }

/// Longitude sums of one latitude on a folded grid, `width` numbers each, with or without the mirrors' four sums.
inline double fourier_operations(const FoldedGrid& g, int width) {
  double products = 0;
  for (const FoldedGrid::Block& block : g.blocks) products += double(block.m.size() * g.orbits.size());
  return 2 * products * width;
}

/// Latitude sums of one row of every order and parity.
inline double legendre_operations(const FoldedGrid& g, const SpectrumRows& rows, int width) {
  double products = 0;
  for (const std::vector<int>& degrees : rows.coefficients) products += double(degrees.size()) * g.half;
  return 2 * products * width;
}

/// Rotations of all coefficients about the z-axis and by the angle of a latitude.
inline double rotation_operations(int p, int width) {
  double products = 0;
  for (int n = 0; n <= p; ++n) products += (n + 1) * (n + 1) + n * n;
  return (2 * products + 6.0 * p * (p + 1) / 2) * width;
}

/// Assembly of S, or of S and D, of degree p: rows of all targets, then their projection.
inline double assembly_operations(int p, bool with_double) {
  const FoldedGrid grid(p, p + 1);  // of targets and of sources
  const SpectrumRows rows(grid);
  const int used = with_double ? components : components / 2, spectrum = 2 * p + 1;
  const double points = double(grid.nlat) * grid.nlon, targets = points;
  // For a target and its antipode together: the points that they see, their tangents and normals.
  double shared = rotation_operations(p, 3) + 2 * legendre_operations(grid, rows, 3);
  shared += double(grid.nlat) * (6.0 * spectrum + double(grid.orbits.size()) * 3 * (2 * 3 * spectrum + 8 * 3));
  shared += points * 15;
  // For each of the two: kernels at the points, summed over mirrors, analysed and turned back.
  constexpr double mirrors = 3;  // additions a sample and component
  const double own = points * (component_operations(with_double) + mirrors * used) +
                     2 * grid.half * fourier_operations(grid, used) + legendre_operations(grid, rows, used) +
                     rotation_operations(p, used);
  // All rows as columns of one analysis.
  const double columns = double(used) * coefficient_count(p);
  const double projection = points * (1 + mirrors) * columns + 2 * grid.half * fourier_operations(grid, 1) * columns +
                            legendre_operations(grid, rows, 1) * columns;
  return targets * (shared / 2 + own) + projection;
}

/// Synthesis of fields of degree p on a grid of nlat latitudes: `tables` functions of the latitude, and so many sums in
/// longitude; an analysis has one of each.
inline double transform_operations(int p, int nlat, int fields, int tables, int sums) {
  const int half = (nlat + 1) / 2, longitudes = 2 * nlat, spectrum = 2 * p + 1;
  const double legendre = 2.0 * coefficient_count(p) * half * tables + 2.0 * spectrum * half * tables;
  const double fourier = double(nlat) * (longitudes / 4 + 1) * (2.0 * spectrum + 8) * sums;
  return (legendre + fourier) * fields;
}

}  // namespace bench
