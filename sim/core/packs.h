// A few SIMD vectors at once, as registers hold them.
#pragma once

#include "sim/core/lanes.h"

namespace sim {

/// One to four vectors as named members, which compilers keep in registers where arrays would go through memory.
template <int W, class Vector = Lane>
struct Pack {
  Vector a{}, b{}, c{}, d{};

  [[gnu::always_inline]] static Pack load(const Vector* x) {
    Pack v;
    v.a = x[0];
    if constexpr (W > 1) v.b = x[1];
    if constexpr (W > 2) v.c = x[2];
    if constexpr (W > 3) v.d = x[3];
    return v;
  }
  [[gnu::always_inline]] void store(Vector* x) const {
    x[0] = a;
    if constexpr (W > 1) x[1] = b;
    if constexpr (W > 2) x[2] = c;
    if constexpr (W > 3) x[3] = d;
  }
  [[gnu::always_inline]] void add(double k, const Vector* x) {
    a += k * x[0];
    if constexpr (W > 1) b += k * x[1];
    if constexpr (W > 2) c += k * x[2];
    if constexpr (W > 3) d += k * x[3];
  }
  [[gnu::always_inline]] void add(double k, const Pack& x) {
    a += k * x.a;
    if constexpr (W > 1) b += k * x.b;
    if constexpr (W > 2) c += k * x.c;
    if constexpr (W > 3) d += k * x.d;
  }
  [[gnu::always_inline]] friend Pack operator+(const Pack& x, const Pack& y) {
    return {x.a + y.a, x.b + y.b, x.c + y.c, x.d + y.d};
  }
  [[gnu::always_inline]] friend Pack operator-(const Pack& x, const Pack& y) {
    return {x.a - y.a, x.b - y.b, x.c - y.c, x.d - y.d};
  }
};

/// Sums over the lanes of each of four vectors.
inline Lane lane_sums(Lane a, Lane b, Lane c, Lane d) {
  const Lane u = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Lane v = __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(u, v, 0, 1, 4, 5) + __builtin_shufflevector(u, v, 2, 3, 6, 7);
}

}  // namespace sim
