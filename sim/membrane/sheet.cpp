#include "sim/membrane/sheet.h"

#include "sim/surface/dealias.h"

#include <cmath>
#include <numbers>

namespace sim {

Sheet freeze_sheet(Plans& plans, const Material& material, const Coefficients& position, double upsampling,
                   const Coefficients& expected_tension, std::optional<PinnedTension> pinned) {
  const int p = position.order, q = upsampled(p, upsampling);
  const ForceBases bases{plans.basis(p, q), plans.basis(q, q)};
  Geometry g = geometry(bases.field, position);
  const double area = g.dA.sum(), radius = std::sqrt(area / (4 * std::numbers::pi));
  Vector stretched = Vector::Zero(bases.field.points());
  if (pinned)
    stretched.setConstant(pinned->tension);
  else if (expected_tension.values.size() > 0)
    stretched = bases.field.synthesize(resized(expected_tension, p)).values.col(0).cwiseMax(0);
  const double mean_stretched = integrate(g, stretched) / area;
  Matrix gradient = curvature_gradient(bases, g);
  // Degree p would leave the ripples of degree p + 1, ... without stiffness; with p + 2 and p + 4 runs agree with the
  // full q.
  const Basis& ripples = plans.basis(std::min(q, p + 4), q);
  return {bases,
          ripples,
          material,
          std::move(g),
          radius,
          rigid_body(position),
          std::move(gradient),
          std::move(stretched),
          mean_stretched,
          pinned};
}

double step_of(const Sheet& m, double c) { return c == 0 && m.pinned ? m.pinned->time : c; }

Coefficients divergence(const Sheet& m, const Coefficients& velocity) {
  const FirstDerivatives u = m.bases.field.slopes(velocity);
  Coefficients d = m.bases.field.analyze(surface_divergence(m.geometry, u.t, u.f));
  d.values.bottomRows(2 * m.order() + 1).setZero();
  return d;
}

Matrix buoyancy_force(const Sheet& m, const Vec3& gravity) {
  // Heights are taken from the middle: a constant in g.x is a constant pressure, which moves nothing, but costs digits.
  const Vector height = m.geometry.x.value * gravity;
  const double middle = m.geometry.dA.dot(height) / m.geometry.dA.sum();
  return (m.geometry.n.array().colwise() * (m.material.density_difference * (height.array() - middle))).matrix();
}

namespace {

/// What a displacement (points x 3) adds to the bending force and, by the expected tension, to the tension force; along
/// n.
Vector displacement_magnitude(const Sheet& m, const Vector& bent) {
  return bending_magnitude(m.ripples, m.geometry, m.material.bending_modulus, bent) +
         2 * m.stretched.cwiseProduct(bent);
}

}  // namespace

Coefficients implicit_force(const Sheet& m, double c, const Motion& y) {
  const Geometry& g = m.geometry;
  const FirstDerivatives sigma = m.bases.field.first(y.tension);
  Vector along = 2 * g.H.cwiseProduct(sigma.value.col(0));  // (33c)
  c = step_of(m, c);
  if (c != 0) {
    const Matrix velocity = m.bases.field.synthesize(y.velocity).values;
    along += displacement_magnitude(m, c * curvature_change(m.ripples, g, m.curvature_gradient, velocity));
  }
  Matrix force = surface_gradient(g, sigma);
  for (int d = 0; d < 3; ++d) force.col(d).array() += along.array() * g.n.col(d).array();
  return m.bases.field.analyze(force);
}

Coefficients known_force(const Sheet& m, const Vec3& gravity, const Coefficients& displacement) {
  Matrix force = bending_force(m.bases, m.geometry, m.material.bending_modulus);
  if (displacement.values.size() > 0) {
    const Matrix moved = m.bases.field.synthesize(displacement).values;
    const Vector bent = curvature_change(m.ripples, m.geometry, m.curvature_gradient, moved);
    force += along_normal(m.geometry, displacement_magnitude(m, bent));
  }
  if (m.material.density_difference != 0) force += buoyancy_force(m, gravity);
  if (m.pinned) {
    const double mean = integrate(m.geometry, m.geometry.H) / m.geometry.dA.sum();
    force += along_normal(m.geometry, Vector(2 * m.pinned->tension * (m.geometry.H.array() - mean)));
  }
  return m.bases.field.analyze(force);
}

}  // namespace sim
