// The prolate spheroidal function psi_0 of bandwidth c on [-1, 1]: of all functions on an interval the one whose
// Fourier transform is most concentrated, in |k| < c. It serves twice: to split the kernels and as the window that
// spreads points on a mesh. Computed as a series in Legendre polynomials of even degree (an eigenvector of a
// tridiagonal matrix).
#pragma once

#include <vector>

namespace sim {

/// Gauss-Legendre rule on [-1, 1] in extended precision.
struct GaussRule {
  std::vector<long double> node, weight;
};
GaussRule gauss_rule(int count);

class Prolate {
 public:
  explicit Prolate(double bandwidth);
  struct Value {
    double value, slope;
  };
  /// Scaled to 1 at 0; x in [-1, 1].
  Value operator()(double x) const;

 private:
  std::vector<double> series_;  ///< of P_0, P_2, P_4, ...
};

}  // namespace sim
