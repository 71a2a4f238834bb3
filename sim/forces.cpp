#include "forces.h"

namespace sim {

Vector linear_mean_curvature(const Geometry& g, const SecondDerivatives& x) {
  Vector h = Vector::Zero(g.H.size());
  for (int d = 0; d < 3; ++d)
    h.array() += 0.5 * g.n.col(d).array() *
                 (g.lap_ff.array() * x.ff.col(d).array() + g.lap_tf.array() * x.tf.col(d).array() +
                  g.lap_tt.array() * x.tt.col(d).array());
  return h;
}

namespace {

/// Amount of the bending force along n.
Vector bending_magnitude(const ForceBases& bases, const Geometry& g, double modulus, const Coefficients& x_plus) {
  const Vector h = linear_mean_curvature(g, bases.field.curvatures(x_plus));
  const SecondDerivatives curvature = bases.full.second(bases.full.analyze(h));
  return -modulus * (surface_laplacian(g, curvature).array() + 2 * h.array() * (g.H.array().square() - g.K.array()));
}

Matrix along_normal(const Geometry& g, const Vector& magnitude) {
  return (g.n.array().colwise() * magnitude.array()).matrix();
}

}  // namespace

Matrix bending_force(const ForceBases& bases, const Geometry& g, double modulus, const Coefficients& x_plus) {
  return along_normal(g, bending_magnitude(bases, g, modulus, x_plus));
}

Matrix tension_force(const ForceBases& bases, const Geometry& g, const Coefficients& sigma) {
  const FirstDerivatives s = bases.field.first(sigma);
  return surface_gradient(g, s) + along_normal(g, 2 * g.H.cwiseProduct(s.value.col(0)));
}

Matrix membrane_force(const ForceBases& bases, const Geometry& g, double modulus, const Coefficients& x_plus,
                      const Coefficients& sigma) {
  Matrix f = tension_force(bases, g, sigma);
  if (modulus != 0) f += bending_force(bases, g, modulus, x_plus);
  return f;
}

}  // namespace sim
