// The kernels of the single and double layer as the sum of a smooth part, which has no wave numbers beyond K, and a
// residual part, which is negligible beyond a cut-off. Lengths are in units of the cut-off, so that c = K is the only
// parameter: the error of the split is near 13 exp(-0.95 c).
//
// With Phi = r the kernels are S = (I lap - grad grad) Phi and T_ijk = (delta_ij d_k + delta_jk d_i + delta_ki d_j) lap
// Phi
// - 2 d_i d_j d_k Phi. The smooth part multiplies their Fourier transforms by H(k) = psi(k/K) - (k/2K) psi'(k/K), and 0
// beyond K, with the prolate function psi: H = 1 + O(k^4). In space, for r = x - y, a force f and a symmetric Q,
//   S f = A f + C r (r.f)          D Q = 2 e Q r + [e tr Q + g (r.Q r)] r
// with A = 1/r, C = 1/r^3, e = 0, g = 1/r^5 for the whole kernels.
#pragma once

#include "sim/fast/prolate.h"

#include <array>

namespace sim {

enum class Radial { even, outer, cross, dual };  ///< A, C, e, g

class KernelSplit {
 public:
  /// `accuracy`: of the polynomials, relative to the kernel at the cut-off.
  KernelSplit(double wave_number, double accuracy);

  double wave_number() const { return wave_number_; }  ///< K, in units of one over the cut-off
  double multiplier(double k) const;                   ///< H
  /// A, C, e and g of the smooth part are polynomials of this even degree in 2 r^2 - 1, r < 1.
  int degree() const { return degree_; }
  const std::vector<double>& polynomial(Radial part) const { return polynomials_[static_cast<std::size_t>(part)]; }
  static constexpr int least_degree = 8, most_degree = 24;

 private:
  double wave_number_;
  std::vector<double> multiplier_;  ///< Chebyshev series
  int degree_ = least_degree;
  std::array<std::vector<double>, 4> polynomials_;
};

}  // namespace sim
