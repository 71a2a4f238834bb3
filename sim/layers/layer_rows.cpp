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

/// The z-rotation by phi of four targets, one a lane: cos(m phi), sin(m phi).
struct LayerPotentials::Plan::Turn {
  std::vector<Lane> cosine, sine;
};

LayerPotentials::Plan::Turn LayerPotentials::Plan::turn_of(int tile) const {
  Turn turn{std::vector<Lane>(p + 1), std::vector<Lane>(p + 1)};
  for (int m = 0; m <= p; ++m)
    for (int lane = 0; lane < lanes; ++lane) {
      const double angle = 2 * pi * ((std::int64_t(m) * (tile * lanes + lane)) % target.nlon) / target.nlon;
      turn.cosine[m][lane] = std::cos(angle);
      turn.sine[m][lane] = std::sin(angle);
    }
  return turn;
}

/// Positions in the frame whose pole is the target: the z-rotation, then that by theta. [nm][3]
LaneBuffer LayerPotentials::Plan::to_pole(int latitude, const Turn& turn, const Coefficients& x) const {
  const int nc = coefficient_count(p);
  LaneBuffer turned(3 * nc), pole(3 * nc);
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
    multiply({n + 1, n + 1, w.cosine.data(), n + 1, identity3.data(), identity3.data()}, 3, turned.get() + centre,
             pole.get() + centre);
    if (n > 0)
      multiply({n, n, w.sine.data(), n, down3.data(), down3.data()}, 3, turned.get() + centre - 3,
               pole.get() + centre - 3);
  }
  return pole;
}

/// Legendre synthesis of x and x_theta at the source latitudes: [parity][block, m][value or slope, half][3].
LaneBuffer LayerPotentials::Plan::along_latitudes(const LaneBuffer& pole) const {
  const int half = source.half, spectra = source_rows.count;
  LaneBuffer x_lat(std::size_t(2) * spectra * 2 * half * 3);
  std::vector<int> in(p + 2);
  for (int b = 0; b < 4; ++b)
    for (std::size_t k = 0; k < source.blocks[b].m.size(); ++k)
      for (int parity = 0; parity < 2; ++parity) {
        const int m = source.blocks[b].m[k], sign = b < 2 ? 1 : -1, count = (p - m - parity + 2) / 2;
        Lane* out = x_lat.get() + std::ptrdiff_t(parity * spectra + source_rows.first[b] + int(k)) * 2 * half * 3;
        if (count <= 0) {
          std::fill(out, out + 2 * half * 3, Lane{});
          continue;
        }
        for (int c = 0; c < count; ++c) in[c] = 3 * coefficient_index(m + parity + 2 * c, sign * m);
        multiply({2 * half, count, source.synthesis[parity][m].data(), count, in.data(), identity3.data()}, 3,
                 pole.get(), out);
      }
  return x_lat;
}

/// Memory for one pair of source latitudes after the other.
struct LayerPotentials::Plan::Scratch {
  LaneBuffer modes, quarter, folded;
  std::vector<SourcePoint> points;  ///< [latitude of the pair][orbit][member]
  std::vector<Lane> samples;
};

/// Fourier synthesis at source latitude i (lat = 0) or its mirror (1): x, x_theta and x_phi of four blocks at a quarter
/// of the longitudes.
void LayerPotentials::Plan::quarter_of(const LaneBuffer& x_lat, int i, int lat, Scratch& scratch) const {
  const int half = source.half, spectra = source_rows.count, orbits = int(source.orbits.size());
  const double lat_sign = lat == 0 ? 1 : -1;
  // Value and slope of (block, m) at this latitude from the two parities of n - m: P is even for parity 0, P' odd.
  const auto at = [&](int block, int k, int slope, int d) {
    const Lane* even = x_lat.get() + std::ptrdiff_t(source_rows.first[block] + k) * 2 * half * 3;
    const Lane* odd = x_lat.get() + std::ptrdiff_t(spectra + source_rows.first[block] + k) * 2 * half * 3;
    const int at_row = (slope * half + i) * 3 + d;
    return slope == 0 ? even[at_row] + lat_sign * odd[at_row] : lat_sign * even[at_row] + odd[at_row];
  };
  Lane* modes = scratch.modes.get();
  for (int b = 0; b < 4; ++b) {
    const int count = int(source.blocks[b].m.size()), partner = b < 2 ? b + 2 : b - 2;
    // d/dphi turns sin(m phi) coefficients s into cosines m s, and cosines c into sines -m c; m keeps its parity.
    for (int k = 0; k < count; ++k) {
      const int m = source.blocks[b].m[k];
      // Among the even m the cosines start at 0, the sines at 2.
      const int k_partner = m == 0 ? -1 : b == 0 ? k - 1 : b == 2 ? k + 1 : k;
      for (int d = 0; d < 3; ++d) {
        modes[9 * k + d] = at(b, k, 0, d);
        modes[9 * k + 3 + d] = at(b, k, 1, d);
        modes[9 * k + 6 + d] = m == 0 ? Lane{} : (b < 2 ? double(m) : -double(m)) * at(partner, k_partner, 0, d);
      }
    }
    Lane* out = scratch.quarter.get() + std::ptrdiff_t(b) * orbits * 9;
    if (count == 0) {
      std::fill(out, out + orbits * 9, Lane{});
      continue;
    }
    multiply({orbits, count, source.blocks[b].transposed.data(), count, identity9.data(), identity9.data()}, 9, modes,
             out);
  }
}

/// From the quarter to all longitudes of that latitude: points and normals.
void LayerPotentials::Plan::unfold_points(int lat, Scratch& scratch) const {
  const int orbits = int(source.orbits.size());
  for (int l = 0; l < orbits; ++l)
    for (int member = 0; member < 4; ++member) {
      if (source.orbits[l].index[member] < 0) continue;
      Lane v[9];
      for (int c = 0; c < 9; ++c) {
        v[c] = Lane{};
        for (int b = 0; b < 4; ++b) v[c] += fold_sign[b][member] * scratch.quarter.get()[(b * orbits + l) * 9 + c];
      }
      SourcePoint& y = scratch.points[(std::size_t(lat) * orbits + l) * 4 + member];
      for (int d = 0; d < 3; ++d) {
        y.x[d] = v[d];
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        y.n[d] = v[3 + e] * v[6 + f] - v[3 + f] * v[6 + e];
      }
      y.area = lane_sqrt(y.n[0] * y.n[0] + y.n[1] * y.n[1] + y.n[2] * y.n[2]);
    }
}

/// Kernels of a pair of latitudes, folded.
void LayerPotentials::Plan::fold_kernels(int i, const Lane* target_x, bool with_double, Scratch& scratch) const {
  const int orbits = int(source.orbits.size()), members = source.mirror(i) == i ? 1 : 2;
  for (int l = 0; l < orbits; ++l) {
    for (int lat = 0; lat < 2; ++lat)
      for (int member = 0; member < 4; ++member) {
        Lane* out = scratch.samples.data() + (lat * 4 + member) * components;
        if (lat >= members || source.orbits[l].index[member] < 0)
          std::fill(out, out + components, Lane{});
        else
          kernels(target_x, scratch.points[(std::size_t(lat) * orbits + l) * 4 + member],
                  singular_weight[lat == 0 ? i : source.mirror(i)], with_double, out);
      }
    fold(scratch.samples.data(), scratch.folded.get() + l * components, std::ptrdiff_t(orbits) * components,
         with_double ? components : components / 2);
  }
}

/// Functionals in the pole's frame as functionals in the original one: W^T, then the z-rotation. [nm][component]
LaneBuffer LayerPotentials::Plan::from_pole(int latitude, const Turn& turn, const LaneBuffer& pole, int used) const {
  LaneBuffer back(std::size_t(components) * coefficient_count(p));
  for (int n = 0; n <= p; ++n) {
    const Rotation& w = rotations[latitude][n];
    const int centre = components * coefficient_index(n, 0);
    multiply({n + 1, n + 1, w.cosine_t.data(), n + 1, identity12.data(), identity12.data()}, used, pole.get() + centre,
             back.get() + centre);
    if (n > 0)
      multiply({n, n, w.sine_t.data(), n, down12.data(), down12.data()}, used, pole.get() + centre - components,
               back.get() + centre - components);
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
  return back;
}

/// From a target a lane to a coefficient a lane, so that rows are written along their length.
void LayerPotentials::Plan::write_rows(const LaneBuffer& back, int tile, int used, double* rows) const {
  const int nc = coefficient_count(p), stride = column_stride(), targets = std::min(lanes, target.nlon - tile * lanes);
  for (int nm = 0; nm < stride; nm += lanes)
    for (int k = 0; k < used; ++k) {
      Lane block[lanes];
      for (int e = 0; e < lanes; ++e) block[e] = nm + e < nc ? back.get()[components * (nm + e) + k] : Lane{};
      transpose(block);
      for (int lane = 0; lane < targets; ++lane)
        __builtin_memcpy(rows + (std::ptrdiff_t(lane) * used + k) * stride + nm, &block[lane], sizeof(Lane));
    }
}

/// Rows of the collocation operator for the four targets (theta_latitude, phi of `tile`), in the original frame:
/// rows[target longitude][component][nm], strides column_stride() and 12 or (S alone) 6 column_stride().
void LayerPotentials::Plan::rows_of_tile(int latitude, int tile, const Coefficients& x, bool with_double,
                                         double* rows) const {
  const int half = source.half, used = with_double ? components : components / 2, orbits = int(source.orbits.size());
  const Turn turn = turn_of(tile);
  const LaneBuffer pole = to_pole(latitude, turn, x), x_lat = along_latitudes(pole);
  Lane target_x[3] = {};
  for (int n = 0; n <= p; ++n)
    for (int d = 0; d < 3; ++d)
      target_x[d] += std::sqrt((2 * n + 1) / (4 * pi)) * pole.get()[3 * coefficient_index(n, 0) + d];

  LaneBuffer spectrum(std::size_t(2) * source_rows.count * half * components);
  Scratch scratch{LaneBuffer(std::size_t(p / 2 + 1) * 9), LaneBuffer(std::size_t(4) * orbits * 9),
                  LaneBuffer(std::size_t(8) * orbits * components),
                  std::vector<SourcePoint>(std::size_t(2) * orbits * 4), std::vector<Lane>(8 * components)};
  for (int i = 0; i < half; ++i) {
    const int members = source.mirror(i) == i ? 1 : 2;
    for (int lat = 0; lat < members; ++lat) {
      quarter_of(x_lat, i, lat, scratch);
      unfold_points(lat, scratch);
    }
    fold_kernels(i, target_x, with_double, scratch);
    fourier_analysis(source, source_rows, scratch.folded.get(), spectrum.get(), i, used);
  }
  LaneBuffer in_pole_frame(std::size_t(components) * coefficient_count(p));
  legendre_analysis(source, source_rows, spectrum.get(), in_pole_frame.get(), used);
  write_rows(from_pole(latitude, turn, in_pole_frame, used), tile, used, rows);
}

}  // namespace sim
