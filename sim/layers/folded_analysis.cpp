#include "sim/layers/folded_analysis.h"

namespace sim {

SpectrumRows::SpectrumRows(const FoldedGrid& g) {
  for (int b = 0; b < 4; ++b) {
    first[b] = count;
    count += int(g.blocks[b].m.size());
  }
  for (int b = 0; b < 4; ++b)
    for (const int m : g.blocks[b].m)
      for (int parity = 0; parity < 2; ++parity) {
        coefficients.emplace_back();
        for (int n = m + parity; n <= g.p; n += 2)
          coefficients.back().push_back(coefficient_index(n, b < 2 ? m : -m) * components);
      }
}

void fold(const Lane* samples, Lane* folded, std::ptrdiff_t stride, int width) {
  for (int c = 0; c < width; ++c) {
    Lane sum[2][4];
    for (int lat = 0; lat < 2; ++lat) {
      const Lane* v = samples + (lat * 4) * components + c;
      const Lane a = v[0] + v[components], d = v[0] - v[components];
      const Lane e = v[2 * components] + v[3 * components], g = v[2 * components] - v[3 * components];
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

void fourier_analysis(const FoldedGrid& g, const SpectrumRows& r, const Lane* folded, Lane* spectrum, int latitude,
                      int width) {
  const int orbits = int(g.orbits.size());
  for (int parity = 0; parity < 2; ++parity)
    for (int b = 0; b < 4; ++b)
      multiply({int(g.blocks[b].m.size()), orbits, g.blocks[b].table.data()}, width,
               folded + std::ptrdiff_t(parity * 4 + b) * orbits * components, EqualRows{components},
               spectrum + (std::ptrdiff_t(parity * r.count + r.first[b]) * g.half + latitude) * components,
               EqualRows{std::ptrdiff_t(g.half) * components});
}

void legendre_analysis(const FoldedGrid& g, const SpectrumRows& r, const Lane* spectrum, Lane* out, int width) {
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
