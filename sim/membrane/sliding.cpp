#include "sim/membrane/sliding.h"

#include "sim/layers/product_matrix.h"
#include "sim/surface/rows.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace sim {

namespace {

constexpr double smallness = 0.1;      // eps: with 1 the grid follows half as well, with 0.01 the iterations double
constexpr double tangentiality = 100;  // L: with 10 a part along n is left that shows in the shape

/// Of every row of coefficients of degree p.
Vector degree_weights(int p) {
  Vector a(coefficient_count(p));
  for (int n = 0; n <= p; ++n)
    for (int m = -n; m <= n; ++m) a[coefficient_index(n, m)] = std::pow(double(n) / p, 4);
  return a;
}

/// The degrees <= p of (w.n) n, by transforms or, where these cost more, by one matrix for all iterations.
std::function<Matrix(const Matrix&)> normal_part(const Basis& basis, const Matrix& n) {
  constexpr int most_dense = 12;  // at p = 16 transforms are faster: the matrix has 4 MB
  if (basis.order() > most_dense)
    return [&basis, &n](const Matrix& w) -> Matrix {
      const Matrix on_grid = basis.synthesize({basis.order(), w}).values;
      return basis.analyze(scaled_rows(row_products(on_grid, n), n)).values;
    };
  Matrix tensor(n.rows(), 6);
  for (int d = 0, column = 0; d < 3; ++d)
    for (int e = d; e < 3; ++e) tensor.col(column++) = n.col(d).cwiseProduct(n.col(e));
  return [matrix = product_matrix(basis, tensor)](const Matrix& w) -> Matrix {
    return matrix.apply({matrix.order, w}).values;
  };
}

double product(const Matrix& a, const Matrix& b) { return a.cwiseProduct(b).sum(); }

}  // namespace

Coefficients sliding_velocity(const SlidingProblem& s, const Coefficients& guess, double tolerance) {
  const int p = s.basis.order();
  const Vector a = degree_weights(p);
  const RigidMotion rigid = shape_motion(s.body, s.geometry, s.basis.synthesize(s.velocity).values);
  const Matrix within = s.velocity.values - rigid_velocity(s.body, rigid).values;
  const double strain = (s.gradient + s.gradient.transpose()).norm() / 2;
  const double rate = std::max(motion_rate({p, within}, s.radius), strain / 2);
  const Vector diagonal = a.array() * (1 + rate * s.c) + smallness;
  const auto along_normal = normal_part(s.basis, s.geometry.n);
  const auto apply = [&](const Matrix& w) -> Matrix {
    return diagonal.asDiagonal() * w + tangentiality * along_normal(w);
  };
  const Matrix right = -(a.asDiagonal() * (within + rate * s.position.values));
  const Vector inverse = (diagonal.array() + tangentiality / 3).inverse();
  Matrix w = guess.values, rest = right - apply(w);
  Matrix z = inverse.asDiagonal() * rest, direction = z;
  const double enough = tolerance * tolerance * right.squaredNorm();
  constexpr int most = 300;
  double descent = product(rest, z);
  for (int k = 0; k < most && descent > 0 && rest.squaredNorm() > enough; ++k) {
    const Matrix image = apply(direction);
    const double step = descent / product(direction, image);
    w += step * direction;
    rest -= step * image;
    z = inverse.asDiagonal() * rest;
    const double next = product(rest, z);
    direction = z + next / descent * direction;
    descent = next;
  }
  return {p, w};
}

double motion_rate(const Coefficients& velocity, double length) {
  const Eigen::Index rest = velocity.values.rows() - 1;
  return velocity.values.bottomRows(rest).norm() / std::sqrt(4 * std::numbers::pi) / length;
}

}  // namespace sim
