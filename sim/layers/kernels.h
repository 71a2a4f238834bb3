// The two kernels of Stokes flow, once: for single points (T = double), four targets at a time (T = Lane) and whole
// arrays. With r = x - y from the source to the target, viscosity 1 and the sign of the double layer as in (5),
// corrected:
//   G_ij(r) = (delta_ij / |r| + r_i r_j / |r|^3) / 8 pi          the Stokeslet, Eq. (4)
//   T_ij(r) = 3/(4 pi) (r.n) r_i r_j / |r|^5                     the stresslet on a surface with the normal n, Eq. (5)
// Both are of the form  even delta_ij + outer r_i r_j.
#pragma once

#include <numbers>

namespace sim {

/// Weights of the sources carry these, so that they cost nothing in an inner loop.
inline constexpr double stokeslet_factor = 1 / (8 * std::numbers::pi), stresslet_factor = 3 / (4 * std::numbers::pi);

template <class T>
struct KernelTensor {
  T even, outer;
};

/// G times a weight; inverse: 1/|r|. Without stokeslet_factor.
template <class T, class Weight>
[[gnu::always_inline]] inline KernelTensor<T> stokeslet(const T& inverse, const Weight& weight) {
  const T even = weight * inverse;
  return {even, even * (inverse * inverse)};
}

/// The outer part of T for the given r.n, in which the weight may be; the even one is 0. Without stresslet_factor.
template <class T>
[[gnu::always_inline]] inline void stresslet(const T& inverse, const T& rn, T& outer) {
  const T square = inverse * inverse;
  outer = rn * (square * square * inverse);
}
template <class T>
T stresslet(const T& inverse, const T& rn) {
  T outer;
  stresslet(inverse, rn, outer);
  return outer;
}

/// The six distinct components xx, xy, xz, yy, yz, zz of the outer part.
template <class T>
[[gnu::always_inline]] inline void outer_components(const T& outer, const T (&r)[3], T* out) {
  const T x = outer * r[0], y = outer * r[1];
  out[0] = x * r[0];
  out[1] = x * r[1];
  out[2] = x * r[2];
  out[3] = y * r[1];
  out[4] = y * r[2];
  out[5] = outer * r[2] * r[2];
}

}  // namespace sim
