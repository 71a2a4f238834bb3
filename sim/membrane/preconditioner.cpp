#include "sim/membrane/preconditioner.h"

#include "sim/surface/rows.h"

#include <algorithm>
#include <cmath>

namespace sim {

SpectralInverse spectral_inverse(const Membrane& m, double c) {
  const double alpha = m.material.alpha(), R = m.radius, kappa = m.material.bending_modulus, sigma = m.mean_stretched;
  SpectralInverse inverse{alpha, {}, {}, {}};
  c = step_of(m, c);
  if (c != 0) {
    // On a plane a normal traction of wave number k moves it at 1/(4k), and bending answers a ripple with kappa_b
    // k^4/2.
    const auto stiffness = [&](double k) { return c * (kappa * k * k * k / 8 + sigma * k / 4); };
    inverse.normal = mode_filter(m.waves, [&](double k) { return 1 / (alpha + stiffness(k)) - 1 / alpha; });
    // With less stiffness the edge costs more than the iterations it saves. At a step of c = 0.3 six degrees are also
    // enough where the normal turns quickly (oblate and biconcave from nu = 0.5); four are not. With c kappa_b = 0.1
    // and more an oblate of nu = 0.6 takes up to a sixth more iterations than without an edge, a prolate up to two
    // fifths fewer.
    constexpr double stiff = 8;
    constexpr int edge_degrees = 6;
    const int first = m.order() + 2 - edge_degrees;
    if (first > 0 && stiffness(m.waves.numbers.back().maxCoeff()) > stiff * alpha) {
      Matrix whole = truncated_overlap(m.waves, first);
      // On a very long body the fitted Laplacian may give some modes no wave number at all: they count as soft ones.
      const double least = 1e-3 * alpha;
      const std::vector<Matrix> soft = mode_filter(
          m.waves, [&](double k) { return alpha / std::max(stiffness(k), least); }, first);
      for (int n = first; n <= m.order() + 1; ++n) {
        const int at = n * n - first * first, size = 2 * n + 1;
        whole.block(at, at, size, size) += soft[n - first];
      }
      inverse.edge = -whole.llt().solve(Matrix::Identity(whole.rows(), whole.cols())) / alpha;
      inverse.normal.resize(first);
    }
  }
  inverse.tension = mode_filter(m.waves, [&](double k) {
    const double n = std::sqrt(k * k * R * R + 0.25) - 0.5;
    if (n < 0.5) return 1.0;
    return (2 * n - 1) * (2 * n + 1) * (2 * n + 3) / (n * (n + 1) * (2 * n * n + 2 * n - 1));
  });
  return inverse;
}

namespace {

/// Degree by degree, of one field.
void filter(Matrix& field, const std::vector<Matrix>& blocks, int order) {
  const Vector before = field.topRows(coefficient_count(order));
  for (int n = 0; n <= order; ++n)
    field.col(0).segment(n * n, 2 * n + 1).noalias() = blocks[n] * before.segment(n * n, 2 * n + 1);
}

}  // namespace

Coefficients precondition_velocity(const Membrane& m, const SpectralInverse& inverse, const Coefficients& u) {
  const int p = m.order(), nc = coefficient_count(p);
  Coefficients out{p, u.values / inverse.alpha};
  if (inverse.normal.empty()) return out;
  const Basis& basis = m.waves.basis;
  const Matrix values = basis.synthesize(resized(u, p + 1)).values;
  Coefficients along = basis.analyze(row_products(values, m.waves.n));
  filter(along.values, inverse.normal, int(inverse.normal.size()) - 1);
  auto last = along.values.bottomRows(inverse.edge.rows());
  last = (inverse.edge * last).eval();
  const Vector less = basis.synthesize(along).values.col(0);
  out.values += basis.analyze(scaled_rows(less, m.waves.n)).values.topRows(nc);
  return out;
}

Coefficients precondition_tension(const SpectralInverse& inverse, const Coefficients& sigma) {
  Coefficients out = sigma;
  filter(out.values, inverse.tension, sigma.order);
  return out;
}

Vector precondition(const Membrane& m, const SpectralInverse& inverse, const Vector& y) {
  const Motion r = unpacked(y, m.order());
  return packed({precondition_velocity(m, inverse, r.velocity), precondition_tension(inverse, r.tension)});
}

}  // namespace sim
