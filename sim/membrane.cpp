#include "membrane.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

constexpr int most_iterations = 200;  ///< the spectral preconditioner takes 15 to 35

}  // namespace

Membrane freeze_membrane(Plans& plans, const Material& material, const Coefficients& position, int upsampling,
                         int source_order, const Coefficients& expected_tension, std::optional<PinnedTension> pinned) {
  const int p = position.order, q = upsampling * p;
  const ForceBases bases{plans.basis(p, q), plans.basis(q, q)};
  Geometry g = geometry(bases.field, position);
  LayerMatrices layers = plans.layers(p, source_order).assemble(position, material.viscosity_contrast != 1);
  const double area = g.dA.sum(), radius = std::sqrt(area / (4 * std::numbers::pi));
  Vector stretched = Vector::Zero(bases.field.points());
  if (pinned)
    stretched.setConstant(pinned->tension);
  else if (expected_tension.values.size() > 0)
    stretched = bases.field.synthesize(resized(expected_tension, p)).values.col(0).cwiseMax(0);
  const double mean_stretched = integrate(g, stretched) / area;
  Matrix gradient = curvature_gradient(bases, g);
  // Degree p would leave the ripples of degree p + 1, ... without stiffness; with p + 2 and p + 4 runs agree with the full q.
  const Basis& ripples = plans.basis(std::min(q, p + 4), q);
  return {bases, ripples, material, std::move(g), std::move(layers), radius, rigid_body(position), std::move(gradient),
          std::move(stretched), mean_stretched, surface_waves(plans, position), pinned};
}

Vector packed(const Motion& m) {
  Vector y(m.velocity.values.size() + m.tension.values.size());
  y << m.velocity.values.reshaped(), m.tension.values.reshaped();
  y.tail(2 * m.tension.order + 1).setZero();  // a tension carried through a relabelling has a highest degree
  return y;
}

Motion unpacked(const Vector& y, int order) {
  const int nc = coefficient_count(order);
  return {{order, y.head(3 * nc).reshaped(nc, 3)}, {order, y.tail(nc)}};
}

Coefficients divergence(const Membrane& m, const Coefficients& velocity) {
  const FirstDerivatives u = m.bases.field.slopes(velocity);
  Coefficients d = m.bases.field.analyze(Matrix(surface_divergence(m.geometry, u.t, u.f)));
  d.values.bottomRows(2 * m.order() + 1).setZero();
  return d;
}

Matrix buoyancy_force(const Membrane& m, const Vec3& gravity) {
  // Heights are taken from the middle: a constant in g.x is a constant pressure, which moves nothing, but costs digits.
  const Vector height = m.geometry.x.value * gravity;
  const double middle = m.geometry.dA.dot(height) / m.geometry.dA.sum();
  return (m.geometry.n.array().colwise() * (m.material.density_difference * (height.array() - middle))).matrix();
}

namespace {

/// c of the instantaneous problem of a pinned tension.
double step_of(const Membrane& m, double c) { return c == 0 && m.pinned ? m.pinned->time : c; }

/// What a displacement (points x 3) adds to the bending force and, by the expected tension, to the tension force; along n.
Vector displacement_magnitude(const Membrane& m, const Vector& bent) {
  return bending_magnitude(m.ripples, m.geometry, m.material.bending_modulus, bent) + 2 * m.stretched.cwiseProduct(bent);
}

}  // namespace

Coefficients implicit_force(const Membrane& m, double c, const Motion& y) {
  Matrix force = tension_force(m.bases, m.geometry, y.tension);
  c = step_of(m, c);
  if (c != 0) {
    const Matrix displacement = c * m.bases.field.synthesize(y.velocity).values;
    const Vector bent = curvature_change(m.ripples, m.geometry, m.curvature_gradient, displacement);
    force += along_normal(m.geometry, displacement_magnitude(m, bent));
  }
  return m.bases.field.analyze(force);
}

Coefficients known_force(const Membrane& m, const Vec3& gravity, const Coefficients& displacement) {
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

Coefficients double_layer(const Membrane& m, const Coefficients& velocity) {
  Coefficients v{m.order(), {}};
  if (m.layers.dual.order < 0) return v;
  const Coefficients rigid = rigid_velocity(m.body, rigid_part(m.body, velocity));
  v.values = m.layers.dual.apply({velocity.order, velocity.values - rigid.values}).values - 0.5 * rigid.values;
  v.values *= 1 - m.material.viscosity_contrast;
  return v;
}

Coefficients dual_density(const RigidBody& body, double viscosity_contrast, const Coefficients& velocity) {
  if (viscosity_contrast == 1) return {velocity.order, Matrix::Zero(velocity.values.rows(), 3)};
  Coefficients d = without_rigid_part(body, velocity);
  d.values *= 1 - viscosity_contrast;
  return d;
}

Coefficients layer_velocity(const Membrane& m, const Coefficients& force, const Coefficients& velocity) {
  Coefficients v = m.layers.single.apply(force);
  if (m.layers.dual.order >= 0) v.values += double_layer(m, velocity).values;
  return v;
}

Vector system_rows(const Membrane& m, const Motion& y, const Coefficients& v) {
  Vector rows = packed({{m.order(), m.material.alpha() * y.velocity.values - v.values}, divergence(m, v)});
  const Eigen::Index nc = coefficient_count(m.order());
  rows.tail(nc) *= -m.radius;
  if (m.pinned) rows[rows.size() - nc] = y.tension.values(0, 0);
  return rows;
}

Vector system_right(const Membrane& m, const Coefficients& r) {
  Vector right = packed({r, divergence(m, r)});
  const Eigen::Index nc = coefficient_count(m.order());
  right.tail(nc) *= m.radius;
  if (m.pinned) right[right.size() - nc] = 0;
  return right;
}

Vector apply_system(const Membrane& m, double c, const Vector& unknowns) {
  const Motion y = unpacked(unknowns, m.order());
  return system_rows(m, y, layer_velocity(m, implicit_force(m, c, y), y.velocity));
}

SpectralInverse spectral_inverse(const Membrane& m, double c) {
  const double alpha = m.material.alpha(), R = m.radius, kappa = m.material.bending_modulus, sigma = m.mean_stretched;
  SpectralInverse inverse{alpha, {}, {}, {}};
  c = step_of(m, c);
  if (c != 0) {
    // On a plane a normal traction of wave number k moves it at 1/(4k), and bending answers a ripple with kappa_b k^4/2.
    const auto stiffness = [&](double k) { return c * (kappa * k * k * k / 8 + sigma * k / 4); };
    inverse.normal = mode_filter(m.waves, [&](double k) { return 1 / (alpha + stiffness(k)) - 1 / alpha; });
    // With less stiffness the edge costs more than the iterations it saves. At a step of c = 0.3 six degrees are also enough where
    // the normal turns quickly (oblate and biconcave from nu = 0.5); four are not. With c kappa_b = 0.1 and more an oblate of
    // nu = 0.6 takes up to a sixth more iterations than without an edge, a prolate up to two fifths fewer.
    constexpr double stiff = 8;
    constexpr int edge_degrees = 6;
    const int first = m.order() + 2 - edge_degrees;
    if (first > 0 && stiffness(m.waves.numbers.back().maxCoeff()) > stiff * alpha) {
      Matrix whole = truncated_overlap(m.waves, first);
      // On a very long body the fitted Laplacian may give some modes no wave number at all: they count as soft ones.
      const double least = 1e-3 * alpha;
      const std::vector<Matrix> soft =
          mode_filter(m.waves, [&](double k) { return alpha / std::max(stiffness(k), least); }, first);
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

void filter(Matrix& field, const std::vector<Matrix>& blocks, int order) {
  for (int n = 0; n <= order; ++n)
    field.middleRows(n * n, 2 * n + 1) = (blocks[n] * field.middleRows(n * n, 2 * n + 1)).eval();
}

}  // namespace

Coefficients precondition_velocity(const Membrane& m, const SpectralInverse& inverse, const Coefficients& u) {
  const int p = m.order(), nc = coefficient_count(p);
  Coefficients out{p, u.values / inverse.alpha};
  if (inverse.normal.empty()) return out;
  const Basis& basis = m.waves.basis;
  const Matrix values = basis.synthesize(resized(u, p + 1)).values;
  Coefficients along = basis.analyze(Matrix(values.cwiseProduct(m.waves.n).rowwise().sum()));
  filter(along.values, inverse.normal, int(inverse.normal.size()) - 1);
  auto last = along.values.bottomRows(inverse.edge.rows());
  last = (inverse.edge * last).eval();
  const Vector less = basis.synthesize(along).values.col(0);
  out.values += basis.analyze(Matrix((m.waves.n.array().colwise() * less.array()).matrix())).values.topRows(nc);
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

Solve solve_system(const Membrane& m, double c, const Coefficients& r, const Motion& guess, double tolerance) {
  const Vector b = system_right(m, r);
  const SpectralInverse inverse = spectral_inverse(m, c);
  const GmresResult result = gmres([&](const Vector& y) { return apply_system(m, c, y); },
                                   [&](const Vector& y) { return precondition(m, inverse, y); }, b, packed(guess),
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
  Coefficients known = r;
  if (m.layers.dual.order >= 0) known.values += double_layer(m, guess.velocity).values;
  const SpectralInverse inverse = spectral_inverse(m, 0);
  const auto left = [&](const Vector& y) {
    Vector rows = -m.radius * divergence(m, tension_velocity(m, {p, y})).values.col(0);
    if (m.pinned) rows[0] = y[0];
    return rows;
  };
  const GmresResult result =
      gmres(left, [&](const Vector& y) { return Vector(precondition_tension(inverse, {p, y}).values.col(0)); },
            system_right(m, known).tail(nc), packed(guess).tail(nc), tolerance, most_iterations);
  const Coefficients sigma{p, result.solution};
  const Coefficients u{p, (known.values + tension_velocity(m, sigma).values) / m.material.alpha()};
  return {{u, sigma}, result.iterations, result.residual, result.converged};
}

Solve solve_position(const Membrane& m, double c, const Coefficients& r, const Motion& known, double tolerance) {
  const int p = m.order(), nc = coefficient_count(p);
  const SpectralInverse inverse = spectral_inverse(m, c);
  const Motion no_tension{{}, {p, Matrix::Zero(nc, 1)}};
  const auto left = [&](const Vector& y) {
    const Coefficients u{p, y.reshaped(nc, 3)};
    const Coefficients v = layer_velocity(m, implicit_force(m, c, {u, no_tension.tension}), u);
    return Vector((m.material.alpha() * u.values - v.values).reshaped());
  };
  const Matrix right = r.values + tension_velocity(m, known.tension).values;
  const GmresResult result =
      gmres(left, [&](const Vector& y) { return Vector(precondition_velocity(m, inverse, {p, y.reshaped(nc, 3)}).values.reshaped()); }, right.reshaped(),
            known.velocity.values.reshaped(), tolerance, most_iterations);
  return {{{p, result.solution.reshaped(nc, 3)}, known.tension}, result.iterations, result.residual, result.converged};
}

}  // namespace sim
