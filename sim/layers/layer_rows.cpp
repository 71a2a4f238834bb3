#include "sim/layers/layer_plan.h"

#include "sim/layers/kernels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

using std::numbers::pi;

struct SourcePoint {
  Lane x[3], n[3], area;  ///< position, area-weighted normal x_t x x_f, its length
};

/// Stokes kernels at the four targets of a tile, with the weight and |n| or n of the source, n = x_t x x_f.
void kernels(const Lane* target, const SourcePoint& y, double weight, bool with_double, Lane* out) {
  const Lane r0 = target[0] - y.x[0], r1 = target[1] - y.x[1], r2 = target[2] - y.x[2];
  const Lane r[3] = {r0, r1, r2}, inverse = 1.0 / lane_sqrt(r0 * r0 + r1 * r1 + r2 * r2);
  const KernelTensor<Lane> single = stokeslet(inverse, y.area * (weight * stokeslet_factor));
  outer_components(single.outer, r, out);
  for (const int diagonal : {0, 3, 5}) out[diagonal] += single.even;
  if (!with_double) return;
  const Lane rn = r0 * y.n[0] + r1 * y.n[1] + r2 * y.n[2];
  outer_components(stresslet(inverse, Lane(rn * (weight * stresslet_factor))), r, out + 6);
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

LayerPotentials::Plan::Turn LayerPotentials::Plan::turn_of(int first) const {
  Turn turn{std::vector<Lane>(p + 1), std::vector<Lane>(p + 1)};
  for (int m = 0; m <= p; ++m)
    for (int lane = 0; lane < lanes; ++lane) {
      const double angle = 2 * pi * ((std::int64_t(m) * (first + lane)) % target.nlon) / target.nlon;
      turn.cosine[m][lane] = std::cos(angle);
      turn.sine[m][lane] = std::sin(angle);
    }
  return turn;
}

/// Memory of one thread for one tile after the other.
struct LayerPotentials::Plan::Scratch {
  LaneBuffer turned, pole;          ///< [nm][3]
  LaneBuffer x_lat;                 ///< [parity][block, m][value or slope, half][3]
  LaneBuffer spectra;               ///< [latitude of a pair][cosines of m = 0.., then sines of m = 1..][x, x_theta]
  std::vector<SourcePoint> points;  ///< [latitude of the pair][orbit][member]
  LaneBuffer samples, folded;       ///< of the kernels
  LaneBuffer spectrum[2];           ///< of the kernels: of the targets, of their antipodes
  LaneBuffer functionals, back;     ///< [nm][component], in the pole's frame and in the original one
  std::vector<int> rows;

  explicit Scratch(const Plan& plan)
      : turned(3 * std::size_t(coefficient_count(plan.p))),
        pole(3 * std::size_t(coefficient_count(plan.p))),
        x_lat(std::size_t(2) * plan.source_rows.count * 2 * plan.source.half * 3),
        spectra(std::size_t(2) * (2 * plan.p + 1) * 6),
        points(std::size_t(2) * plan.source.orbits.size() * 4),
        samples(8 * components),
        folded(std::size_t(8) * plan.source.orbits.size() * components),
        spectrum{LaneBuffer(std::size_t(2) * plan.source_rows.count * plan.source.half * components),
                 LaneBuffer(std::size_t(2) * plan.source_rows.count * plan.source.half * components)},
        functionals(std::size_t(components) * coefficient_count(plan.p)),
        back(std::size_t(components) * coefficient_count(plan.p)),
        rows(std::size_t(plan.p) + 2) {}
};

/// Positions in the frame whose pole is the target: the z-rotation, then that by theta. [nm][3]
void LayerPotentials::Plan::to_pole(int latitude, const Turn& turn, const Coefficients& x, Scratch& scratch) const {
  const LaneBuffer &turned = scratch.turned, &pole = scratch.pole;
  for (int n = 0; n <= p; ++n)
    for (int m = 0; m <= n; ++m)
      for (int d = 0; d < 3; ++d) {
        const double c = x.values(coefficient_index(n, m), d), s_m = x.values(coefficient_index(n, -m), d);
        if (m == 0) {
          turned.get()[3 * coefficient_index(n, 0) + d] = c + 0 * turn.cosine[0];
        } else {
          turned.get()[3 * coefficient_index(n, m) + d] = c * turn.cosine[m] + s_m * turn.sine[m];
          turned.get()[3 * coefficient_index(n, -m) + d] = s_m * turn.cosine[m] - c * turn.sine[m];
        }
      }
  // Sines stand in reverse order of m, hence the row lists.
  for (int n = 0; n <= p; ++n) {
    const Rotation& w = rotations[latitude][n];
    const int centre = 3 * coefficient_index(n, 0);
    multiply({n + 1, n + 1, w.cosine.data()}, 3, turned.get() + centre, EqualRows{3}, pole.get() + centre,
             EqualRows{3});
    multiply({n, n, w.sine.data()}, 3, turned.get() + centre - 3, EqualRows{-3}, pole.get() + centre - 3,
             EqualRows{-3});
  }
}

/// Legendre synthesis of x and x_theta at the source latitudes.
void LayerPotentials::Plan::along_latitudes(Scratch& scratch) const {
  const int half = source.half, spectra = source_rows.count;
  std::vector<int>& in = scratch.rows;
  for (int b = 0; b < 4; ++b)
    for (std::size_t k = 0; k < source.blocks[b].m.size(); ++k)
      for (int parity = 0; parity < 2; ++parity) {
        const int m = source.blocks[b].m[k], sign = b < 2 ? 1 : -1, count = (p - m - parity + 2) / 2;
        Lane* out =
            scratch.x_lat.get() + std::ptrdiff_t(parity * spectra + source_rows.first[b] + int(k)) * 2 * half * 3;
        if (count <= 0) {
          std::fill(out, out + 2 * half * 3, Lane{});
          continue;
        }
        for (int c = 0; c < count; ++c) in[c] = 3 * coefficient_index(m + parity + 2 * c, sign * m);
        multiply({2 * half, count, source.synthesis[parity][m].data()}, 3, scratch.pole.get(), ListedRows(in.data()),
                 out, EqualRows{3});
      }
}

/// Longitude spectra of x and x_theta at source latitude i and its mirror, where P is even in z for an even n - m and
/// P' odd.
void LayerPotentials::Plan::spectra_of(int i, Scratch& scratch) const {
  const std::ptrdiff_t half = source.half, row = 2 * half * 3, odd = source_rows.count * row;
  Lane* here = scratch.spectra.get();
  Lane* there = here + std::ptrdiff_t(2 * p + 1) * 6;
  for (int b = 0; b < 4; ++b)
    for (std::size_t k = 0; k < source.blocks[b].m.size(); ++k) {
      const Lane* value = scratch.x_lat.get() + (source_rows.first[b] + std::ptrdiff_t(k)) * row + i * 3;
      const Lane* slope = value + half * 3;
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
void LayerPotentials::Plan::points_of(int lat, Scratch& scratch) const {
  const int orbits = int(source.orbits.size()), width = 2 * p + 1;
  const Lane* cosines = scratch.spectra.get() + std::ptrdiff_t(lat) * width * 6;
  const Lane* sines = cosines + std::ptrdiff_t(p) * 6;
  for (int l = 0; l < orbits; ++l) {
    const double* row = source.longitude[0].data() + std::ptrdiff_t(l) * width;
    const double* slopes = source.longitude[1].data() + std::ptrdiff_t(l) * width;
    const Mirrored<3> x = fourier_sums<3>(row, p, p, true, cosines, sines, 6);
    const Mirrored<3> t = fourier_sums<3>(row, p, p, true, cosines + 3, sines + 3, 6);
    const Mirrored<3> f = fourier_sums<3>(slopes, p, p, false, sines, cosines, 6);
    for (int member = 0; member < 4; ++member) {
      if (source.orbits[l].index[member] < 0) continue;
      const Pack<3>&x_t = t.member[member], &x_f = f.member[member];
      SourcePoint& y = scratch.points[(std::size_t(lat) * orbits + l) * 4 + member];
      x.member[member].store(y.x);
      y.n[0] = x_t.b * x_f.c - x_t.c * x_f.b;
      y.n[1] = x_t.c * x_f.a - x_t.a * x_f.c;
      y.n[2] = x_t.a * x_f.b - x_t.b * x_f.a;
      y.area = lane_sqrt(y.n[0] * y.n[0] + y.n[1] * y.n[1] + y.n[2] * y.n[2]);
    }
  }
}

/// Kernels of a pair of latitudes, folded. In the frame of the antipode, half a turn about the x-axis further, the
/// point (t, f) is (pi - t, -f), and its normal is the same.
void LayerPotentials::Plan::fold_kernels(int i, const Lane* target_x, bool antipode, bool with_double,
                                         Scratch& scratch) const {
  const int orbits = int(source.orbits.size()), members = source.mirror(i) == i ? 1 : 2;
  for (int l = 0; l < orbits; ++l) {
    const auto& index = source.orbits[l].index;
    for (int lat = 0; lat < 2; ++lat)
      for (int member = 0; member < 4; ++member) {
        Lane* out = scratch.samples.get() + (lat * 4 + member) * components;
        if (lat >= members || index[member] < 0) {
          std::fill(out, out + components, Lane{});
          continue;
        }
        const int there = antipode ? members - 1 - lat : lat;
        const int turned = antipode && index[member ^ 1] >= 0 ? member ^ 1 : member;
        kernels(target_x, scratch.points[(std::size_t(there) * orbits + l) * 4 + turned],
                singular_weight[lat == 0 ? i : source.mirror(i)], with_double, out);
      }
    fold(scratch.samples.get(), scratch.folded.get() + l * components, std::ptrdiff_t(orbits) * components,
         with_double ? components : components / 2);
  }
}

/// Functionals in the pole's frame as functionals in the original one: W^T, then the z-rotation.
void LayerPotentials::Plan::from_pole(int latitude, const Turn& turn, int used, Scratch& scratch) const {
  const LaneBuffer &pole = scratch.functionals, &back = scratch.back;
  for (int n = 0; n <= p; ++n) {
    const Rotation& w = rotations[latitude][n];
    const int centre = components * coefficient_index(n, 0);
    multiply({n + 1, n + 1, w.cosine_t.data()}, used, pole.get() + centre, EqualRows{components}, back.get() + centre,
             EqualRows{components});
    multiply({n, n, w.sine_t.data()}, used, pole.get() + centre - components, EqualRows{-components},
             back.get() + centre - components, EqualRows{-components});
  }
  for (int n = 0; n <= p; ++n)
    for (int m = 1; m <= n; ++m) {
      Lane* c = back.get() + components * coefficient_index(n, m);
      Lane* s_m = back.get() + components * coefficient_index(n, -m);
      for (int k = 0; k < used; ++k) {
        const Lane turned = c[k] * turn.cosine[m] - s_m[k] * turn.sine[m];
        s_m[k] = s_m[k] * turn.cosine[m] + c[k] * turn.sine[m];
        c[k] = turned;
      }
    }
}

/// From a target a lane to a coefficient a lane, so that rows are written along their length.
void LayerPotentials::Plan::write_rows(const Lane* back, const Tile& tile, bool antipode, int used,
                                       double* rows) const {
  const int nc = coefficient_count(p), stride = column_stride();
  const int latitude = antipode ? target.mirror(tile.latitude) : tile.latitude;
  const int first = tile.tile * lanes + (antipode ? target.nlon / 2 : 0);
  double* to[lanes];
  for (int lane = 0; lane < tile.targets; ++lane)
    to[lane] = rows + (std::ptrdiff_t(latitude) * target.nlon + (first + lane) % target.nlon) * used * stride;
  const auto write = [&](int nm, int k, Lane a, Lane b, Lane c, Lane d) {
    Lane block[lanes] = {a, b, c, d};
    transpose(block);
    const std::ptrdiff_t at = std::ptrdiff_t(k) * stride + nm;
    for (int lane = 0; lane < tile.targets; ++lane) store_lane(to[lane] + at, block[lane]);
  };
  int nm = 0;
  for (; nm + lanes <= nc; nm += lanes) {
    const Lane* from = back + components * nm;
    for (int k = 0; k < used; ++k)
      write(nm, k, from[k], from[components + k], from[2 * components + k], from[3 * components + k]);
  }
  for (; nm < stride; nm += lanes)
    for (int k = 0; k < used; ++k) {
      const auto at = [&](int e) { return nm + e < nc ? back[components * (nm + e) + k] : Lane{}; };
      write(nm, k, at(0), at(1), at(2), at(3));
    }
}

/// Rows of the collocation operator for the four targets of a tile and their antipodes, in the original frame.
void LayerPotentials::Plan::rows_of_tile(const Tile& tile, const Coefficients& x, bool with_double, double* rows,
                                         Scratch& scratch) const {
  const int half = source.half, used = with_double ? components : components / 2;
  to_pole(tile.latitude, turns[tile.tile], x, scratch);
  along_latitudes(scratch);
  Lane target_x[2][3] = {};  // at the poles of the frame
  for (int n = 0; n <= p; ++n)
    for (int d = 0; d < 3; ++d) {
      const Lane at_pole = std::sqrt((2 * n + 1) / (4 * pi)) * scratch.pole.get()[3 * coefficient_index(n, 0) + d];
      target_x[0][d] += at_pole;
      target_x[1][d] += n % 2 == 0 ? at_pole : -at_pole;
    }
  for (int i = 0; i < half; ++i) {
    const int members = source.mirror(i) == i ? 1 : 2;
    spectra_of(i, scratch);
    for (int lat = 0; lat < members; ++lat) points_of(lat, scratch);
    for (const int side : {0, 1}) {
      fold_kernels(i, target_x[side], side == 1, with_double, scratch);
      fourier_analysis(source, source_rows, scratch.folded.get(), scratch.spectrum[side].get(), i, used);
    }
  }
  for (const int side : {0, 1}) {
    legendre_analysis(source, source_rows, scratch.spectrum[side].get(), scratch.functionals.get(), used);
    if (side == 0)
      from_pole(tile.latitude, turns[tile.tile], used, scratch);
    else
      from_pole(target.mirror(tile.latitude), opposite_turns[tile.tile], used, scratch);
    write_rows(scratch.back.get(), tile, side == 1, used, rows);
  }
}

/// [target latitude][target longitude][component][nm]: components of column_stride() numbers, 12 or (S alone) 6.
RawVector<double> LayerPotentials::Plan::rows_of(const Coefficients& x, bool with_double) const {
  const int used = with_double ? components : components / 2;
  RawVector<double> rows(std::size_t(target.nlat) * target.nlon * used * column_stride());
#pragma omp parallel
  {
    Scratch scratch(*this);
#pragma omp for schedule(static)
    for (std::size_t k = 0; k < tiles.size(); ++k) rows_of_tile(tiles[k], x, with_double, rows.data(), scratch);
  }
  return rows;
}

}  // namespace sim
