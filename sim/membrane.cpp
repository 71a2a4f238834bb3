#include "membrane.h"

#include <cmath>
#include <numbers>

namespace sim {

namespace {

constexpr int most_iterations = 200;  ///< the corrected diagonal takes 20 to 40

}  // namespace

Membrane freeze_membrane(Plans& plans, const Material& material, const Coefficients& position, int upsampling,
                         int source_order) {
  const int p = position.order, q = upsampling * p;
  const ForceBases bases{plans.basis(p, q), plans.basis(q, q)};
  Geometry g = geometry(bases.field, position);
  LayerMatrices layers = plans.layers(p, source_order).assemble(position, material.viscosity_contrast != 1);
  const double radius = std::sqrt(g.dA.sum() / (4 * std::numbers::pi));
  return {bases, material, std::move(g), std::move(layers), radius};
}

Vector packed(const Motion& m) {
  Vector y(m.velocity.values.size() + m.tension.values.size());
  y << m.velocity.values.reshaped(), m.tension.values.reshaped();
  return y;
}

Motion unpacked(const Vector& y, int order) {
  const int nc = coefficient_count(order);
  return {{order, y.head(3 * nc).reshaped(nc, 3)}, {order, y.tail(nc)}};
}

Coefficients divergence(const Membrane& m, const Coefficients& velocity) {
  const FirstDerivatives u = m.bases.field.slopes(velocity);
  return m.bases.field.analyze(Matrix(surface_divergence(m.geometry, u.t, u.f)));
}

Matrix buoyancy_force(const Membrane& m, const Vec3& gravity) {
  // Heights are taken from the middle: a constant in g.x is a constant pressure, which moves nothing, but costs digits.
  const Vector height = m.geometry.x.value * gravity;
  const double middle = m.geometry.dA.dot(height) / m.geometry.dA.sum();
  return (m.geometry.n.array().colwise() * (m.material.density_difference * (height.array() - middle))).matrix();
}

Coefficients implicit_force(const Membrane& m, double c, const Motion& y) {
  if (c == 0) return m.bases.field.analyze(tension_force(m.bases, m.geometry, y.tension));
  return m.bases.field.analyze(
      membrane_force(m.bases, m.geometry, c * m.material.bending_modulus, y.velocity, y.tension));
}

Coefficients known_force(const Membrane& m, const Vec3& gravity, const Coefficients& position) {
  Matrix force = Matrix::Zero(m.bases.field.points(), 3);
  if (m.material.bending_modulus != 0)
    force += bending_force(m.bases, m.geometry, m.material.bending_modulus, position);
  if (m.material.density_difference != 0) force += buoyancy_force(m, gravity);
  return m.bases.field.analyze(force);
}

Coefficients layer_velocity(const Membrane& m, const Coefficients& force, const Coefficients& velocity) {
  Coefficients v = m.layers.single.apply(force);
  if (m.layers.dual.order >= 0) v.values += (1 - m.material.viscosity_contrast) * m.layers.dual.apply(velocity).values;
  return v;
}

Vector system_rows(const Membrane& m, const Coefficients& u, const Coefficients& v) {
  const Motion rows{{m.order(), m.material.alpha() * u.values - v.values}, divergence(m, v)};
  Vector out = packed(rows);
  out.tail(coefficient_count(m.order())) *= -1;
  return out;
}

Vector apply_system(const Membrane& m, double c, const Vector& unknowns) {
  const Motion y = unpacked(unknowns, m.order());
  return system_rows(m, y.velocity, layer_velocity(m, implicit_force(m, c, y), y.velocity));
}

Vector preconditioner(const Membrane& m, double c) {
  const int p = m.order(), nc = coefficient_count(p);
  Vector d(4 * nc);
  for (int n = 0; n <= p; ++n) {
    const double nn = n, l = n == 0 ? 1 : nn * (nn + 1) * (2 * nn * nn + 2 * nn - 1) / ((2 * nn - 1) * (2 * nn + 1) * (2 * nn + 3));
    const double stiffness = c * m.material.bending_modulus * nn * nn * nn / (8 * std::pow(m.radius, 3));
    for (int row = n * n; row < (n + 1) * (n + 1); ++row) {
      for (int f = 0; f < 3; ++f) d[f * nc + row] = 1 / (m.material.alpha() + stiffness);
      d[3 * nc + row] = m.radius / l;
    }
  }
  return d;
}

Coefficients forcing(const Membrane& m, std::span<const FlowParameters> flows, double time, const Vec3& gravity,
                     const Coefficients& history) {
  Coefficients r = m.bases.field.analyze(background_velocity(flows, time, m.geometry.x.value));
  r.values += m.layers.single.apply(known_force(m, gravity, history)).values;
  return r;
}

Solve solve_system(const Membrane& m, double c, const Coefficients& r, const Motion& guess, double tolerance) {
  const Vector b = packed({r, divergence(m, r)}), diagonal = preconditioner(m, c);
  const GmresResult result = gmres([&](const Vector& y) { return apply_system(m, c, y); },
                                   [&](const Vector& y) { return Vector(diagonal.cwiseProduct(y)); }, b, packed(guess),
                                   tolerance, most_iterations);
  return {unpacked(result.solution, m.order()), result.iterations, result.residual, result.converged};
}

namespace {

Coefficients tension_velocity(const Membrane& m, const Coefficients& sigma) {
  return m.layers.single.apply(m.bases.field.analyze(tension_force(m.bases, m.geometry, sigma)));
}

}  // namespace

Solve solve_tension(const Membrane& m, const Coefficients& r, const Motion& guess, double tolerance) {
  const int p = m.order(), nc = coefficient_count(p);
  const Vector diagonal = preconditioner(m, 0).tail(nc);
  const GmresResult result = gmres(
      [&](const Vector& y) { return Vector(-divergence(m, tension_velocity(m, {p, y})).values.col(0)); },
      [&](const Vector& y) { return Vector(diagonal.cwiseProduct(y)); }, divergence(m, r).values.col(0),
      guess.tension.values.col(0), tolerance, most_iterations);
  const Coefficients sigma{p, result.solution};
  const Coefficients u{p, (r.values + tension_velocity(m, sigma).values) / m.material.alpha()};
  return {{u, sigma}, result.iterations, result.residual, result.converged};
}

Solve solve_position(const Membrane& m, double c, const Coefficients& r, const Motion& known, double tolerance) {
  const int p = m.order(), nc = coefficient_count(p);
  const Vector diagonal = preconditioner(m, c).head(3 * nc);
  const Motion no_tension{{}, {p, Matrix::Zero(nc, 1)}};
  const auto left = [&](const Vector& y) {
    const Coefficients u{p, y.reshaped(nc, 3)};
    const Coefficients v = layer_velocity(m, implicit_force(m, c, {u, no_tension.tension}), u);
    return Vector((m.material.alpha() * u.values - v.values).reshaped());
  };
  const Matrix right = r.values + tension_velocity(m, known.tension).values;
  const GmresResult result =
      gmres(left, [&](const Vector& y) { return Vector(diagonal.cwiseProduct(y)); }, right.reshaped(),
            known.velocity.values.reshaped(), tolerance, most_iterations);
  return {{{p, result.solution.reshaped(nc, 3)}, known.tension}, result.iterations, result.residual, result.converged};
}

}  // namespace sim
