// Associated Legendre functions and Gauss-Legendre rules, the latitude half of the spherical harmonics (8).
#pragma once

#include "sim/core/types.h"

namespace sim {

/// Nodes theta_i = arccos z_i, ascending in theta, and weights of the n-point Gauss-Legendre rule in z on [-1, 1].
struct GaussLegendre {
  Vector theta, weight;
};
GaussLegendre gauss_legendre(int n);

/// Column of P_nm, 0 <= m <= n, in a table over all degrees up to p, ordered by m, then n: contiguous in n for one m.
constexpr int legendre_index(int p, int n, int m) { return m * (p + 1) - m * (m - 1) / 2 + (n - m); }
constexpr int legendre_count(int p) { return (p + 1) * (p + 2) / 2; }

/// P_nm(cos theta), normalised to unit square integral over cos(theta) and all P_mm >= 0,
/// with first and second derivatives in theta: theta.size() x legendre_count(p).
struct LegendreTable {
  int order = 0;
  Matrix value, d1, d2;
};
/// Three-term recurrence in n, started from P_mm; derivatives by the ladder in m,
/// 2 P_nm' = sqrt((n+m)(n-m+1)) P_n,m-1 - sqrt((n-m)(n+m+1)) P_n,m+1, which has no pole: any theta in [0, pi].
/// `derivatives`: how many are wanted; the others stay empty.
LegendreTable legendre_table(int p, const Vector& theta, int derivatives = 2);

/// Factor that gives cos(m phi) and sin(m phi) a unit square integral over phi.
double longitude_norm(int m);

}  // namespace sim
