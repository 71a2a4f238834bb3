// The spectral preconditioner of section 3.5, corrected, and with the wave numbers k of the surface in place of n/R.
#pragma once

#include "sim/membrane/membrane.h"

namespace sim {

/// Approximate inverses of the diagonal blocks of (39), degree by degree:
///   velocity: 1/alpha along the membrane, 1/(alpha + g) along its normal, g = c (kappa_b k^3/8 + sigma k/4)
///   tension:  1/l_n, l_n = n(n+1)(2n^2+2n-1)/((2n-1)(2n+1)(2n+3)), with n(n+1) = (kR)^2, l_0 = 1.
/// Velocities are truncated at degree p, which keeps only about half of normal fields of degree p and p + 1, so
/// 1/(alpha + g) is far from the inverse of alpha + N g N^T (N: psi -> psi n, truncated). Where the highest waves are
/// stiff, the full Woodbury formula 1/alpha - N (alpha/g + N^T N)^{-1} N^T / alpha is used for the last degrees.
struct SpectralInverse {
  double alpha;
  std::vector<Matrix> normal;   ///< 1/alpha minus the inverse for normal velocities, per degree; empty for c = 0
  Matrix edge;                  ///< the same for all higher degrees, as one matrix; may be empty
  std::vector<Matrix> tension;  ///< per degree
};
SpectralInverse spectral_inverse(const Membrane&, double c);
Coefficients precondition_velocity(const Membrane&, const SpectralInverse&, const Coefficients& u);
Coefficients precondition_tension(const SpectralInverse&, const Coefficients& sigma);
/// Both, packed.
Vector precondition(const Membrane&, const SpectralInverse&, const Vector&);

}  // namespace sim
