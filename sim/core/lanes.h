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

/// Uninitialised memory of a function's own: on the stack, unless it is long.
template <class T, std::size_t few>
class Scratch {
 public:
  explicit Scratch(std::size_t n) {
    if (n > few) long_.reset(new (std::align_val_t(64)) T[n]);
    data_ = n > few ? long_.get() : reinterpret_cast<T*>(few_);
  }
  Scratch(const Scratch&) = delete;
  T* get() const { return data_; }

 private:
  struct Free {
    void operator()(T* p) const { ::operator delete[](p, std::align_val_t(64)); }
  };
  alignas(64) std::byte few_[few * sizeof(T)];
  std::unique_ptr<T[], Free> long_;
  T* data_;
};
using LaneScratch = Scratch<Lane, 4096>;

template <class Vector>
Vector lane_sqrt(Vector v) {
  Vector r{};
  for (unsigned i = 0; i < sizeof v / sizeof v[0]; ++i) r[i] = std::sqrt(v[i]);
  return r;
}

}  // namespace sim
