#include "sim/membrane/forces.h"

#include "sim/surface/rows.h"

namespace sim {

Matrix curvature_gradient(const ForceBases& bases, const Geometry& g) {
  return surface_gradient(g, bases.full.first(bases.full.analyze(g.H)));
}

Vector curvature_change(const Basis& basis, const Geometry& g, const Matrix& gradient, const Matrix& displacement) {
  const Vector psi = row_products(displacement, g.n);
  const SecondDerivatives d = basis.derivatives(basis.analyze(psi));
  return 0.5 * surface_laplacian(g, d).array() + (2 * g.H.array().square() - g.K.array()) * psi.array() +
         row_products(displacement, gradient).array();
}

// Eq. (33b)
Vector bending_magnitude(const Basis& basis, const Geometry& g, double modulus, const Vector& h) {
  if (modulus == 0) return Vector::Zero(h.size());
  const SecondDerivatives d = basis.derivatives(basis.analyze(h));
  return -modulus * (surface_laplacian(g, d).array() + 2 * h.array() * (g.H.array().square() - g.K.array()));
}

Matrix along_normal(const Geometry& g, const Vector& magnitude) { return scaled_rows(magnitude, g.n); }

Matrix bending_force(const ForceBases& bases, const Geometry& g, double modulus) {
  return along_normal(g, bending_magnitude(bases.full, g, modulus, g.H));
}

// Eq. (33c)
Matrix tension_force(const ForceBases& bases, const Geometry& g, const Coefficients& sigma) {
  const FirstDerivatives s = bases.field.first(sigma);
  return surface_gradient(g, s) + along_normal(g, 2 * g.H.cwiseProduct(s.value.col(0)));
}

}  // namespace sim
