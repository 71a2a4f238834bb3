// Fourier sums at the four longitudes {f, -f, pi - f, pi + f} of an orbit, for a few SIMD vectors: under the mirrors
// cosines and sines of even and odd m are even or odd, which leaves a quarter of the products.
#pragma once

#include "sim/core/packs.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace sim {

/// Appends to a table the row of one longitude 2 pi l / longitudes: at m the factors of the cosine, at p + m of the
/// sine, of a derivative in phi; for the first derivative those by which the other kind's coefficients enter.
inline void append_fourier_row(std::vector<double>& table, int p, int l, int longitudes, int derivative) {
  using std::numbers::pi;
  table.resize(table.size() + std::size_t(2 * p + 1));
  double* row = table.data() + table.size() - (2 * p + 1);
  for (int m = 0; m <= p; ++m) {
    // The angle is reduced by whole turns first, so that mirrored columns agree to the last bit.
    const double angle = 2 * pi * double((std::int64_t(m) * l) % longitudes) / longitudes,
                 k = (m == 0 ? 1 / std::sqrt(2 * pi) : 1 / std::sqrt(pi)) * std::pow(m, derivative);
    row[m] = (derivative == 2 ? -k : k) * std::cos(angle);
    if (m > 0) row[p + m] = (derivative == 0 ? k : -k) * std::sin(angle);
  }
}

/// Samples of W vectors at the members f, -f, pi - f and pi + f of an orbit.
template <int W, class Vector = Lane>
struct Mirrored {
  Pack<W, Vector> member[4];
};

/// Fourier sums; `table` is the orbit's row of the Fourier table, cosine and sine rows are counted from m = 0.
template <int W, class Vector>
[[gnu::always_inline]] inline Mirrored<W, Vector> fourier_sums(const double* table, int p, int degree, bool mean,
                                                               const Vector* cosines, const Vector* sines,
                                                               std::ptrdiff_t row) {
  using Sum = Pack<W, Vector>;
  Sum cos_even, cos_odd, sin_even, sin_odd;
  const Vector* x = cosines;
  const Vector* y = sines;
  if (mean) cos_even.add(table[0], x);
  int m = 1;
  for (; m < degree; m += 2) {
    cos_odd.add(table[m], x + row);
    sin_odd.add(table[p + m], y + row);
    x += 2 * row;
    y += 2 * row;
    cos_even.add(table[m + 1], x);
    sin_even.add(table[p + m + 1], y);
  }
  if (m == degree) {
    cos_odd.add(table[m], x + row);
    sin_odd.add(table[p + m], y + row);
  }
  const Sum even = cos_even + cos_odd, odd = cos_even - cos_odd, s = sin_even + sin_odd, t = sin_even - sin_odd;
  return {{even + s, even - s, odd - t, odd + t}};
}

}  // namespace sim
