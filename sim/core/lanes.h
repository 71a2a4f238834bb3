// Vectors of numbers that the processor handles at once: four of double or eight of single precision.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <new>

namespace sim {

constexpr int lanes = 4;
using Lane = double __attribute__((vector_size(lanes * sizeof(double))));

/// Twice as many, for code that is compiled for AVX-512 beside the instruction set of the rest and run where
/// has_wide_lanes(): never where the rest cannot multiply and add at once, as this code does and rounds differently.
using WideLane = double __attribute__((vector_size(2 * lanes * sizeof(double))));
template <class Vector>
constexpr int width_of = int(sizeof(Vector) / sizeof(double));

#if defined(__x86_64__) && defined(__FMA__)
#if defined(__clang__)
#define TANKTREAD_WIDE [[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,avx512cd")]]
#else  // takes half the width where it may choose, unless told
#define TANKTREAD_WIDE [[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,avx512cd,prefer-vector-width=512")]]
#endif
inline bool has_wide_lanes() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd");
}
#else
#define TANKTREAD_WIDE
inline bool has_wide_lanes() { return false; }
#endif

/// How many things a loop takes at once; the bits are the same.
enum class LaneCount { four, widest };

/// Runs a step in a function of its own, which has the instruction set of its vectors. The step, and what it calls with
/// vectors, must be inlined into it ([[gnu::always_inline]]), and gives no vectors by value.
template <class Step>
[[gnu::noinline]] void run_with_lanes(const Step& step) {
  step();
}
template <class Step>
TANKTREAD_WIDE [[gnu::noinline]] void run_with_wide_lanes(const Step& step) {
  step();
}
template <class Vector, class Step>
void run_apart(const Step& step) {
  if constexpr (lanes < width_of<Vector>)
    run_with_wide_lanes(step);
  else
    run_with_lanes(step);
}

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
template <class Vector>
struct BufferOf {
  explicit BufferOf(std::size_t n) : data(new (std::align_val_t(64)) Vector[n]) {}
  struct Free {
    void operator()(Vector* p) const { ::operator delete[](p, std::align_val_t(64)); }
  };
  std::unique_ptr<Vector[], Free> data;
  [[gnu::always_inline]] Vector* get() const { return data.get(); }
};
using LaneBuffer = BufferOf<Lane>;

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

/// v = its roots. Wide vectors are given by reference, since others pass them otherwise.
template <class Vector>
[[gnu::always_inline]] inline void take_root(Vector& v) {
  for (unsigned i = 0; i < sizeof v / sizeof v[0]; ++i) v[i] = std::sqrt(v[i]);
}
template <class Vector>
Vector lane_sqrt(Vector v) {
  take_root(v);
  return v;
}

/// Any address, any width.
template <class Vector>
[[gnu::always_inline]] inline void load(const double* from, Vector& v) {
  __builtin_memcpy(&v, from, sizeof v);
}

}  // namespace sim
