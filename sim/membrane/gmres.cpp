#include "sim/membrane/gmres.h"

#include <cmath>

namespace sim {

GmresResult gmres(const LinearMap& A, const LinearMap& inverse, const Vector& b, const Vector& guess, double tolerance,
                  int most_iterations, const InnerProduct& product) {
  const auto norm = [&](const Vector& v) { return std::sqrt(product(v, v)); };
  GmresResult result{guess, 0, 0, false};
  const double scale = norm(b);
  if (scale == 0) {
    result.solution.setZero();
    result.converged = true;
    return result;
  }
  Vector r = guess.isZero(0) ? b : Vector(b - A(guess));
  double beta = norm(r);
  if (beta > scale) {  // a guess that is worse than none costs digits
    r = b;
    beta = scale;
    result.solution.setZero();
  }
  result.residual = beta / scale;
  if (!std::isfinite(beta)) return result;
  if (result.residual <= tolerance) {
    result.converged = true;
    return result;
  }
  std::vector<Vector> basis{r / beta}, directions;
  Matrix h = Matrix::Zero(most_iterations + 1, most_iterations);
  Vector g = Vector::Zero(most_iterations + 1), cosine(most_iterations), sine(most_iterations);
  g[0] = beta;
  int k = 0;
  while (k < most_iterations && result.residual > tolerance) {
    directions.push_back(inverse(basis[k]));
    Vector w = A(directions[k]);
    // Modified Gram-Schmidt, one row at a time; then the Givens rotations of the earlier columns.
    for (int i = 0; i <= k; ++i) {
      h(i, k) = product(w, basis[i]);
      w -= h(i, k) * basis[i];
    }
    const double length = norm(w);
    h(k + 1, k) = length;
    for (int i = 0; i < k; ++i) {
      const double above = h(i, k), below = h(i + 1, k);
      h(i, k) = cosine[i] * above + sine[i] * below;
      h(i + 1, k) = cosine[i] * below - sine[i] * above;
    }
    const double radius = std::hypot(h(k, k), h(k + 1, k));
    if (!std::isfinite(radius) || radius == 0) break;
    cosine[k] = h(k, k) / radius;
    sine[k] = h(k + 1, k) / radius;
    h(k, k) = radius;
    h(k + 1, k) = 0;
    g[k + 1] = -sine[k] * g[k];
    g[k] *= cosine[k];
    ++k;
    result.residual = std::abs(g[k]) / scale;
    if (length <= 1e-300) break;
    basis.push_back(w / length);
  }
  result.iterations = k;
  const Vector y = h.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(g.head(k));
  for (int i = 0; i < k; ++i) result.solution += y[i] * directions[i];
  result.converged = result.residual <= tolerance;
  return result;
}

}  // namespace sim
