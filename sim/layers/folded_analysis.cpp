#include "sim/layers/folded_analysis.h"

#include <algorithm>

namespace sim {

SpectrumRows::SpectrumRows(const FoldedGrid& g) {
  for (int b = 0; b < 4; ++b) {
    first[b] = count;
    count += int(g.blocks[b].m.size());
  }
  for (int k = 0; k < std::max(int(g.orbits.size()), g.half); ++k) consecutive.push_back(components * k);
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
  std::vector<int> rows;
  for (int parity = 0; parity < 2; ++parity)
    for (int b = 0; b < 4; ++b) {
      const int count = int(g.blocks[b].m.size());
      if (count == 0) continue;
      rows.clear();
      for (int k = 0; k < count; ++k)
        rows.push_back(((parity * r.count + r.first[b] + k) * g.half + latitude) * components);
      const SmallProduct product{count, orbits, g.blocks[b].table.data(), orbits, r.consecutive.data(), rows.data()};
      multiply(product, width, folded + std::ptrdiff_t(parity * 4 + b) * orbits * components, spectrum);
    }
}

void legendre_analysis(const FoldedGrid& g, const SpectrumRows& r, const Lane* spectrum, Lane* out, int width) {
  std::vector<int> rows;
  for (int b = 0; b < 4; ++b)
    for (std::size_t k = 0; k < g.blocks[b].m.size(); ++k)
      for (int parity = 0; parity < 2; ++parity) {
        const int m = g.blocks[b].m[k], sign = b < 2 ? 1 : -1;
        rows.clear();
        for (int n = m + parity; n <= g.p; n += 2) rows.push_back(coefficient_index(n, sign * m) * components);
        if (rows.empty()) continue;
        const SmallProduct product{int(rows.size()),     g.half,     g.legendre[parity][m].data(), g.half,
                                   r.consecutive.data(), rows.data()};
        multiply(product, width,
                 spectrum + std::ptrdiff_t(parity * r.count + r.first[b] + int(k)) * g.half * components, out);
      }
}

}  // namespace sim
