#include "sim/membrane/block.h"

#include <memory>

namespace sim {

Block vesicle_block(const Membrane& m, double c, Preconditioner kind, bool felt) {
  Block block;
  block.size = 4 * coefficient_count(m.order());
  block.trial = [&m, c, felt](const Vector& y) {
    const Motion motion = unpacked(y, m.order());
    Trial trial{{implicit_force(m, c, motion), {}}, {}};
    if (felt) trial.densities.dual = dual_density(m.body, m.material.viscosity_contrast, motion.velocity);
    trial.own_velocity = layer_velocity(m, trial.densities.force, motion.velocity);
    return trial;
  };
  block.rows = [&m](const Vector& y, const Coefficients& velocity) {
    return system_rows(m, unpacked(y, m.order()), velocity);
  };
  const auto inverse = std::make_shared<const SpectralInverse>(spectral_inverse(m, c));
  if (kind == Preconditioner::spectral) {
    block.precondition = [&m, inverse](const Vector& y) { return precondition(m, *inverse, y); };
  } else {
    block.precondition = [&m, c, inverse](const Vector& y) {
      constexpr double loose = 1e-3;  // GMRES is flexible; tighter inner solves save no outer iteration
      constexpr int most = 60;
      return gmres([&](const Vector& v) { return apply_system(m, c, v); },
                   [&](const Vector& v) { return precondition(m, *inverse, v); }, y, Vector::Zero(y.size()), loose,
                   most)
          .solution;
    };
  }
  return block;
}

namespace {

constexpr int most_iterations = 200;  ///< the spectral preconditioner takes 15 to 35

}  // namespace

Solve solve_system(const Membrane& m, double c, const Coefficients& r, const Motion& guess, double tolerance) {
  const Vector b = system_right(m, r);
  const SpectralInverse inverse = spectral_inverse(m, c);
  const GmresResult result =
      gmres([&](const Vector& y) { return apply_system(m, c, y); },
            [&](const Vector& y) { return precondition(m, inverse, y); }, b, packed(guess), tolerance, most_iterations);
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
  const GmresResult result = gmres(
      left,
      [&](const Vector& y) {
        return Vector(precondition_tension(inverse, {p, y}).values.col(0));
      },
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
  const GmresResult result = gmres(
      left,
      [&](const Vector& y) {
        return Vector(precondition_velocity(m, inverse, {p, y.reshaped(nc, 3)}).values.reshaped());
      },
      right.reshaped(), known.velocity.values.reshaped(), tolerance, most_iterations);
  return {{{p, result.solution.reshaped(nc, 3)}, known.tension}, result.iterations, result.residual, result.converged};
}

}  // namespace sim
