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

}  // namespace sim
