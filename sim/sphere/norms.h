// Norms of spectral coefficients (18)-(21) and of the tail of a spectrum.
#pragma once

#include "sim/core/types.h"

#include <cmath>

namespace sim {

/// Eq. (18): E_n of all fields together.
inline double modular_norm(const Coefficients& c, int n) { return c.values.middleRows(n * n, 2 * n + 1).norm(); }

/// Eqs. (19), (20): l2 norm of the degrees first..last.
inline double band_norm(const Coefficients& c, int first, int last) {
  if (first > last) return 0;
  return c.values.middleRows(first * first, (last + 1) * (last + 1) - first * first).norm();
}

/// Share of the degrees from `first` on in the spectrum without its mean.
inline double tail_share(const Coefficients& c, int first) {
  const double whole = band_norm(c, 1, c.order);
  return whole > 0 ? band_norm(c, first, c.order) / whole : 0;
}

}  // namespace sim
