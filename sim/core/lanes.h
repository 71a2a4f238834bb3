// Vectors of numbers that the processor handles at once: four of double or eight of single precision.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <new>

namespace sim {

constexpr int lanes = 4;
using Lane = double __attribute__((vector_size(lanes * sizeof(double))));

template <class Real>
struct LaneType;
template <>
struct LaneType<double> {
  using type = Lane;
  static constexpr int count = lanes;
};
template <>
struct LaneType<float> {
  static constexpr int count = 2 * lanes;
  using type = float __attribute__((vector_size(count * sizeof(float))));
};
template <class Real>
using LaneOf = typename LaneType<Real>::type;
template <class Real>
constexpr int lane_count = LaneType<Real>::count;

/// Any address, not only those of whole vectors.
template <class Real>
LaneOf<Real> load_lane(const Real* from) {
  LaneOf<Real> v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
template <class Real>
void store_lane(Real* to, LaneOf<Real> v) {
  __builtin_memcpy(to, &v, sizeof v);
}

/// Uninitialised aligned memory for vectors.
struct LaneBuffer {
  explicit LaneBuffer(std::size_t n) : data(new (std::align_val_t(64)) Lane[n]) {}
  struct Free {
    void operator()(Lane* p) const { ::operator delete[](p, std::align_val_t(64)); }
  };
  std::unique_ptr<Lane[], Free> data;
  Lane* get() const { return data.get(); }
};

/// One to four vectors as named members, which compilers keep in registers where arrays would go through memory.
template <int W>
struct Pack {
  Lane a{}, b{}, c{}, d{};

  static Pack load(const Lane* x) {
    Pack v;
    v.a = x[0];
    if constexpr (W > 1) v.b = x[1];
    if constexpr (W > 2) v.c = x[2];
    if constexpr (W > 3) v.d = x[3];
    return v;
  }
  void store(Lane* x) const {
    x[0] = a;
    if constexpr (W > 1) x[1] = b;
    if constexpr (W > 2) x[2] = c;
    if constexpr (W > 3) x[3] = d;
  }
  void add(double k, const Lane* x) {
    a += k * x[0];
    if constexpr (W > 1) b += k * x[1];
    if constexpr (W > 2) c += k * x[2];
    if constexpr (W > 3) d += k * x[3];
  }
  void add(double k, const Pack& x) {
    a += k * x.a;
    if constexpr (W > 1) b += k * x.b;
    if constexpr (W > 2) c += k * x.c;
    if constexpr (W > 3) d += k * x.d;
  }
  friend Pack operator+(const Pack& x, const Pack& y) { return {x.a + y.a, x.b + y.b, x.c + y.c, x.d + y.d}; }
  friend Pack operator-(const Pack& x, const Pack& y) { return {x.a - y.a, x.b - y.b, x.c - y.c, x.d - y.d}; }
};

/// Sums over the lanes of each of four vectors.
inline Lane lane_sums(Lane a, Lane b, Lane c, Lane d) {
  const Lane u = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Lane v = __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(u, v, 0, 1, 4, 5) + __builtin_shufflevector(u, v, 2, 3, 6, 7);
}

template <class Vector>
Vector lane_sqrt(Vector v) {
  Vector r{};
  for (unsigned i = 0; i < sizeof v / sizeof v[0]; ++i) r[i] = std::sqrt(v[i]);
  return r;
}

}  // namespace sim
