#include "sim/layers/layer_plan.h"

#include "sim/core/parallel.h"
#include "sim/layers/kernels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace sim {

namespace {

using std::numbers::pi;

template <class Vector>
struct SourcePoint {
  Vector x[3], n[3], area;  ///< position, area-weighted normal x_t x x_f, its length
};

/// Stokes kernels at the targets of a tile, with the weight and |n| or n of the source, n = x_t x x_f.
template <class Vector>
[[gnu::always_inline]] inline void kernels(const Vector* target, const SourcePoint<Vector>& y, double weight,
                                           bool with_double, Vector* out) {
  const Vector r0 = target[0] - y.x[0], r1 = target[1] - y.x[1], r2 = target[2] - y.x[2];
  Vector distance = r0 * r0 + r1 * r1 + r2 * r2;
  take_root(distance);
  const Vector r[3] = {r0, r1, r2}, inverse = 1.0 / distance;
  const KernelTensor<Vector> single = stokeslet(inverse, y.area * (weight * stokeslet_factor));
  outer_components(single.outer, r, out);
  for (const int diagonal : {0, 3, 5}) out[diagonal] += single.even;
  if (!with_double) return;
  const Vector rn = (r0 * y.n[0] + r1 * y.n[1] + r2 * y.n[2]) * (weight * stresslet_factor);
  Vector outer;
  stresslet(inverse, rn, outer);
  outer_components(outer, r, out + 6);
}

void transpose(Lane* block) {
  const Lane a = __builtin_shufflevector(block[0], block[1], 0, 4, 2, 6);
  const Lane b = __builtin_shufflevector(block[0], block[1], 1, 5, 3, 7);
  const Lane c = __builtin_shufflevector(block[2], block[3], 0, 4, 2, 6);
  const Lane d = __builtin_shufflevector(block[2], block[3], 1, 5, 3, 7);
  block[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  block[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  block[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  block[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

}  // namespace

/// Rows of one tile after the other, and the memory of a thread for it.
template <class Vector>
struct LayerPotentials::Plan::Rows {
  using Buffer = BufferOf<Vector>;
  const Plan& plan;
  const int p;
  const FoldedGrid &target, &source;
  const SpectrumRows& source_rows;
  Buffer turned, pole;  ///< [nm][3]
  Buffer x_lat;         ///< [parity][block, m][value or slope, half][3]
  Buffer spectra;       ///< [latitude of a pair][cosines of m = 0.., then sines of m = 1..][x, x_theta]
  BufferOf<SourcePoint<Vector>> points;  ///< [latitude of the pair][orbit][member]
  Buffer samples, folded;                ///< of the kernels
  Buffer spectrum[2];                    ///< of the kernels: of the targets, of their antipodes
  Buffer functionals, back;              ///< [nm][component], in the pole's frame and in the original one
  Vector target_x[2][3];                 ///< of the targets and of their antipodes
  std::vector<int> degrees;

  explicit Rows(const Plan& the_plan)
      : plan(the_plan),
        p(plan.p),
        target(plan.target),
        source(plan.source),
        source_rows(plan.source_rows),
        turned(3 * std::size_t(coefficient_count(p))),
        pole(3 * std::size_t(coefficient_count(p))),
        x_lat(std::size_t(2) * source_rows.count * 2 * source.half * 3),
        spectra(std::size_t(2) * (2 * p + 1) * 6),
        points(std::size_t(2) * source.orbits.size() * 4),
        samples(8 * components),
        folded(std::size_t(8) * source.orbits.size() * components),
        spectrum{Buffer(std::size_t(2) * source_rows.count * source.half * components),
                 Buffer(std::size_t(2) * source_rows.count * source.half * components)},
        functionals(std::size_t(components) * coefficient_count(p)),
        back(std::size_t(components) * coefficient_count(p)),
        degrees(std::size_t(p) + 2) {}

  const double* turn(const std::vector<double>& table, int m, int first) const {
    return table.data() + std::ptrdiff_t(m) * plan.longitudes + first;
  }

  /// Positions in the frame whose pole is the target: the z-rotation, then that by theta. [nm][3]
  [[gnu::always_inline]] void to_pole(const Tile& tile, const Coefficients& x) {
    for (int n = 0; n <= p; ++n)
      for (int d = 0; d < 3; ++d) turned.get()[3 * coefficient_index(n, 0) + d] = Vector{} + x.values(n * n + n, d);
    for (int m = 1; m <= p; ++m) {
      Vector cosine, sine;
      load(turn(plan.cosine, m, tile.first), cosine);
      load(turn(plan.sine, m, tile.first), sine);
      for (int n = m; n <= p; ++n)
        for (int d = 0; d < 3; ++d) {
          const double c = x.values(coefficient_index(n, m), d), s = x.values(coefficient_index(n, -m), d);
          turned.get()[3 * coefficient_index(n, m) + d] = c * cosine + s * sine;
          turned.get()[3 * coefficient_index(n, -m) + d] = s * cosine - c * sine;
        }
    }
    // Sines stand in reverse order of m, hence the negative distances.
    for (int n = 0; n <= p; ++n) {
      const Rotation& w = plan.rotations[tile.latitude][n];
      const int centre = 3 * coefficient_index(n, 0);
      multiply({n + 1, n + 1, w.cosine.data()}, 3, turned.get() + centre, EqualRows{3}, pole.get() + centre,
               EqualRows{3});
      multiply({n, n, w.sine.data()}, 3, turned.get() + centre - 3, EqualRows{-3}, pole.get() + centre - 3,
               EqualRows{-3});
    }
  }

  /// Legendre synthesis of x and x_theta at the source latitudes.
  [[gnu::always_inline]] void along_latitudes() {
    const int half = source.half;
    for (int b = 0; b < 4; ++b)
      for (std::size_t k = 0; k < source.blocks[b].m.size(); ++k)
        for (int parity = 0; parity < 2; ++parity) {
          const int m = source.blocks[b].m[k], sign = b < 2 ? 1 : -1, count = (p - m - parity + 2) / 2;
          const int row = parity * source_rows.count + source_rows.first[b] + int(k);
          Vector* out = x_lat.get() + std::ptrdiff_t(row) * 2 * half * 3;
          if (count <= 0) {
            for (int e = 0; e < 2 * half * 3; ++e) out[e] = Vector{};
            continue;
          }
          for (int c = 0; c < count; ++c) degrees[c] = 3 * coefficient_index(m + parity + 2 * c, sign * m);
          multiply({2 * half, count, source.synthesis[parity][m].data()}, 3, pole.get(), ListedRows(degrees.data()),
                   out, EqualRows{3});
        }
  }

  /// Longitude spectra of x and x_theta at source latitude i and its mirror, where P is even in z for an even n - m and
  /// P' odd.
  [[gnu::always_inline]] void spectra_of(int i) {
    const std::ptrdiff_t half = source.half, row = 2 * half * 3, odd = source_rows.count * row;
    Vector* here = spectra.get();
    Vector* there = here + std::ptrdiff_t(2 * p + 1) * 6;
    for (int b = 0; b < 4; ++b)
      for (std::size_t k = 0; k < source.blocks[b].m.size(); ++k) {
        const Vector* value = x_lat.get() + (source_rows.first[b] + std::ptrdiff_t(k)) * row + i * 3;
        const Vector* slope = value + half * 3;
        const std::ptrdiff_t at = 6 * (source.blocks[b].m[k] + (b < 2 ? 0 : p));
        for (int d = 0; d < 3; ++d) {
          here[at + d] = value[d] + value[odd + d];
          there[at + d] = value[d] - value[odd + d];
          here[at + 3 + d] = slope[d] + slope[odd + d];
          there[at + 3 + d] = slope[odd + d] - slope[d];
        }
      }
  }

  /// Points and normals at all longitudes of one latitude of the pair.
  [[gnu::always_inline]] void points_of(int lat) {
    using Sums = Mirrored<3, Vector>;
    const int orbits = int(source.orbits.size()), width = 2 * p + 1;
    const Vector* cosines = spectra.get() + std::ptrdiff_t(lat) * width * 6;
    const Vector* sines = cosines + std::ptrdiff_t(p) * 6;
    for (int l = 0; l < orbits; ++l) {
      const double* row = source.longitude[0].data() + std::ptrdiff_t(l) * width;
      const double* slopes = source.longitude[1].data() + std::ptrdiff_t(l) * width;
      const Sums x = fourier_sums<3>(row, p, p, true, cosines, sines, 6);
      const Sums t = fourier_sums<3>(row, p, p, true, cosines + 3, sines + 3, 6);
      const Sums f = fourier_sums<3>(slopes, p, p, false, sines, cosines, 6);
      for (int member = 0; member < 4; ++member) {
        if (source.orbits[l].index[member] < 0) continue;
        const Pack<3, Vector>&x_t = t.member[member], &x_f = f.member[member];
        SourcePoint<Vector>& y = points.get()[(std::size_t(lat) * orbits + l) * 4 + member];
        x.member[member].store(y.x);
        y.n[0] = x_t.b * x_f.c - x_t.c * x_f.b;
        y.n[1] = x_t.c * x_f.a - x_t.a * x_f.c;
        y.n[2] = x_t.a * x_f.b - x_t.b * x_f.a;
        y.area = y.n[0] * y.n[0] + y.n[1] * y.n[1] + y.n[2] * y.n[2];
        take_root(y.area);
      }
    }
  }

  /// Kernels of a pair of latitudes, folded. In the frame of the antipode, half a turn about the x-axis further, the
  /// point (t, f) is (pi - t, -f), and its normal is the same.
  [[gnu::always_inline]] void fold_kernels(int i, bool antipode, bool with_double) {
    const int orbits = int(source.orbits.size()), members = source.mirror(i) == i ? 1 : 2;
    for (int l = 0; l < orbits; ++l) {
      const auto& index = source.orbits[l].index;
      for (int lat = 0; lat < 2; ++lat)
        for (int member = 0; member < 4; ++member) {
          Vector* out = samples.get() + (lat * 4 + member) * components;
          if (lat >= members || index[member] < 0) {
            for (int k = 0; k < components; ++k) out[k] = Vector{};
            continue;
          }
          const int there = antipode ? members - 1 - lat : lat;
          const int turned_member = antipode && index[member ^ 1] >= 0 ? member ^ 1 : member;
          kernels(target_x[antipode], points.get()[(std::size_t(there) * orbits + l) * 4 + turned_member],
                  plan.singular_weight[lat == 0 ? i : source.mirror(i)], with_double, out);
        }
      fold(samples.get(), folded.get() + l * components, std::ptrdiff_t(orbits) * components,
           with_double ? components : components / 2);
    }
  }

  /// Functionals in the pole's frame as functionals in the original one: W^T, then the z-rotation.
  [[gnu::always_inline]] void from_pole(int latitude, int first, int used) {
    for (int n = 0; n <= p; ++n) {
      const Rotation& w = plan.rotations[latitude][n];
      const int centre = components * coefficient_index(n, 0);
      const Vector* from = functionals.get() + centre;
      Vector* to = back.get() + centre;
      multiply({n + 1, n + 1, w.cosine_t.data()}, used, from, EqualRows{components}, to, EqualRows{components});
      multiply({n, n, w.sine_t.data()}, used, from - components, EqualRows{-components}, to - components,
               EqualRows{-components});
    }
    for (int m = 1; m <= p; ++m) {
      Vector cosine, sine;
      load(turn(plan.cosine, m, first), cosine);
      load(turn(plan.sine, m, first), sine);
      for (int n = m; n <= p; ++n) {
        Vector* c = back.get() + components * coefficient_index(n, m);
        Vector* s = back.get() + components * coefficient_index(n, -m);
        for (int k = 0; k < used; ++k) {
          const Vector rotated = c[k] * cosine - s[k] * sine;
          s[k] = s[k] * cosine + c[k] * sine;
          c[k] = rotated;
        }
      }
    }
  }

  /// From a target a lane to a coefficient a lane, so that rows are written along their length; wide vectors by halves.
  void write(const Tile& tile, bool antipode, int used, double* rows) const {
    constexpr int halves = width_of<Vector> / lanes;
    const int nc = coefficient_count(p), stride = plan.column_stride();
    const int latitude = antipode ? target.mirror(tile.latitude) : tile.latitude;
    for (int half = 0; half < halves; ++half) {
      const int first = tile.first + half * lanes + (antipode ? target.nlon / 2 : 0);
      const int targets = std::min(lanes, tile.targets - half * lanes);
      double* to[lanes];
      for (int lane = 0; lane < targets; ++lane)
        to[lane] = rows + (std::ptrdiff_t(latitude) * target.nlon + (first + lane) % target.nlon) * used * stride;
      const Lane* from = reinterpret_cast<const Lane*>(back.get()) + half;
      const auto write_block = [&](int nm, int k, Lane a, Lane b, Lane c, Lane d) {
        Lane block[lanes] = {a, b, c, d};
        transpose(block);
        const std::ptrdiff_t at = std::ptrdiff_t(k) * stride + nm;
        for (int lane = 0; lane < targets; ++lane) store_lane(to[lane] + at, block[lane]);
      };
      constexpr int next = components * halves;
      int nm = 0;
      for (; nm + lanes <= nc; nm += lanes, from += lanes * next)
        for (int k = 0; k < used; ++k) {
          const Lane* v = from + k * halves;
          write_block(nm, k, v[0], v[next], v[2 * next], v[3 * next]);
        }
      for (; nm < stride; nm += lanes, from += lanes * next)
        for (int k = 0; k < used; ++k) {
          const auto at = [&](int e) { return nm + e < nc ? from[e * next + k * halves] : Lane{}; };
          write_block(nm, k, at(0), at(1), at(2), at(3));
        }
    }
  }

  /// Of the targets, in the frame of which they are poles, and of their antipodes.
  [[gnu::always_inline]] void find_targets() {
    for (int d = 0; d < 3; ++d) target_x[0][d] = target_x[1][d] = Vector{};
    for (int n = 0; n <= p; ++n)
      for (int d = 0; d < 3; ++d) {
        const Vector at_pole = std::sqrt((2 * n + 1) / (4 * pi)) * pole.get()[3 * coefficient_index(n, 0) + d];
        target_x[0][d] += at_pole;
        target_x[1][d] += n % 2 == 0 ? at_pole : -at_pole;
      }
  }

  /// Rows of the collocation operator for the targets of a tile and their antipodes, in the original frame.
  void of_tile(const Tile& tile, const Coefficients& x, bool with_double, double* rows) {
    const int half = source.half, used = with_double ? components : components / 2;
    run_apart<Vector>([&]() __attribute__((always_inline)) {
      to_pole(tile, x);
      along_latitudes();
      find_targets();
    });
    for (int i = 0; i < half; ++i) {
      const int members = source.mirror(i) == i ? 1 : 2;
      run_apart<Vector>([&]() __attribute__((always_inline)) {
        spectra_of(i);
        for (int lat = 0; lat < members; ++lat) points_of(lat);
      });
      for (const bool antipode : {false, true}) {
        run_apart<Vector>([&]() __attribute__((always_inline)) { fold_kernels(i, antipode, with_double); });
        run_apart<Vector>([&]() __attribute__((always_inline)) {
          fourier_analysis(source, source_rows, folded.get(), spectrum[antipode].get(), i, used);
        });
      }
    }
    for (const bool antipode : {false, true}) {
      run_apart<Vector>([&]() __attribute__((always_inline)) {
        legendre_analysis(source, source_rows, spectrum[antipode].get(), functionals.get(), used);
      });
      const int latitude = antipode ? target.mirror(tile.latitude) : tile.latitude;
      const int first = tile.first + antipode * target.nlon / 2;
      run_apart<Vector>([&]() __attribute__((always_inline)) { from_pole(latitude, first, used); });
      write(tile, antipode, used, rows);
    }
  }
};

/// [target latitude][target longitude][component][nm]: components of column_stride() numbers, 12 or (S alone) 6.
RawVector<double> LayerPotentials::Plan::rows_of(const Coefficients& x, bool with_double) const {
  const int used = with_double ? components : components / 2;
  RawVector<double> rows(std::size_t(target.nlat) * target.nlon * used * column_stride());
  struct Scratch {
    std::optional<Rows<WideLane>> eight;
    Rows<Lane> four;
  };
  const auto scratch = [&] {
    Scratch made{{}, Rows<Lane>(*this)};
    if (wide) made.eight.emplace(*this);
    return made;
  };
  parallel_for_with(int(tiles.size()), scratch, [&](Scratch& mine, int k) {
    const auto& tile = tiles[std::size_t(k)];
    if (tile.wide)
      mine.eight->of_tile(tile, x, with_double, rows.data());
    else
      mine.four.of_tile(tile, x, with_double, rows.data());
  });
  return rows;
}

}  // namespace sim
