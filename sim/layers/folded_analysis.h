// Analysis of the 12 kernel components on a folded grid: samples -> sums over mirrors -> Fourier -> Legendre ->
// coefficients.
#pragma once

#include "sim/layers/folded_grid.h"
#include "sim/layers/small_product.h"

#include <array>
#include <vector>

namespace sim {

constexpr int components = 12;  ///< six of S, six of D

/// Row of (parity, block, m) among the intermediate spectra: latitude parity is the outermost index.
struct SpectrumRows {
  std::array<int, 4> first{};
  int count = 0;
  std::vector<std::vector<int>> coefficients;  ///< [row, parity of n - m]: where its degrees n stand among [nm][12]
  explicit SpectrumRows(const FoldedGrid&);
};

/// Adds 12 components of one sample to the eight folded sums it belongs to. Latitude parity: even sum and odd
/// difference. samples: [2 latitudes][4 members][12], zero where there is none; folded: [parity][block] strided by
/// `stride`.
template <class Vector>
[[gnu::always_inline]] inline void fold(const Vector* samples, Vector* folded, std::ptrdiff_t stride, int width) {
  for (int c = 0; c < width; ++c) {
    Vector sum[2][4];
    for (int lat = 0; lat < 2; ++lat) {
      const Vector* v = samples + (lat * 4) * components + c;
      const Vector a = v[0] + v[components], d = v[0] - v[components];
      const Vector e = v[2 * components] + v[3 * components], g = v[2 * components] - v[3 * components];
      sum[lat][0] = a + e;  // cos even
      sum[lat][1] = a - e;  // cos odd
      sum[lat][2] = d - g;  // sin even: f, -(-f), -(pi-f), +(pi+f)
      sum[lat][3] = d + g;  // sin odd:  f, -(-f), +(pi-f), -(pi+f)
    }
    for (int b = 0; b < 4; ++b) {
      folded[b * stride + c] = sum[0][b] + sum[1][b];
      folded[(4 + b) * stride + c] = sum[0][b] - sum[1][b];
    }
  }
}

/// Folded samples [latitude parity][block][orbit][12] -> spectrum rows at one latitude,
/// [latitude parity][block, m][half][12]. `width`: how many of the 12 are needed.
template <class Vector>
[[gnu::always_inline]] inline void fourier_analysis(const FoldedGrid& g, const SpectrumRows& r, const Vector* folded,
                                                    Vector* spectrum, int latitude, int width) {
  const int orbits = int(g.orbits.size());
  for (int parity = 0; parity < 2; ++parity)
    for (int b = 0; b < 4; ++b)
      multiply({int(g.blocks[b].m.size()), orbits, g.blocks[b].table.data()}, width,
               folded + std::ptrdiff_t(parity * 4 + b) * orbits * components, EqualRows{components},
               spectrum + (std::ptrdiff_t(parity * r.count + r.first[b]) * g.half + latitude) * components,
               EqualRows{std::ptrdiff_t(g.half) * components});
}

/// Spectrum as above -> coefficients [nm][12].
template <class Vector>
[[gnu::always_inline]] inline void legendre_analysis(const FoldedGrid& g, const SpectrumRows& r, const Vector* spectrum,
                                                     Vector* out, int width) {
  for (int b = 0; b < 4; ++b)
    for (std::size_t k = 0; k < g.blocks[b].m.size(); ++k)
      for (int parity = 0; parity < 2; ++parity) {
        const int m = g.blocks[b].m[k], at = r.first[b] + int(k);
        const std::vector<int>& rows = r.coefficients[2 * std::size_t(at) + std::size_t(parity)];
        multiply({int(rows.size()), g.half, g.legendre[parity][m].data()}, width,
                 spectrum + std::ptrdiff_t(parity * r.count + at) * g.half * components, EqualRows{components}, out,
                 ListedRows(rows.data()));
      }
}

}  // namespace sim
