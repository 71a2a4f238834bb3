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
  Vector r = norm(guess) == 0 ? b : Vector(b - A(guess));  // by the product: all processes decide alike
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
  std::vector<std::vector<double>> columns;  // of the upper triangle
  std::vector<double> g{beta}, cosine, sine;
  int k = 0;
  while (k < most_iterations && result.residual > tolerance) {
    directions.push_back(inverse(basis[k]));
    Vector w = A(directions[k]);
    // Modified Gram-Schmidt, one row at a time; then the Givens rotations of the earlier columns.
    std::vector<double> h(std::size_t(k) + 1);
    for (int i = 0; i <= k; ++i) {
      h[i] = product(w, basis[i]);
      w -= h[i] * basis[i];
    }
    const double length = norm(w);
    for (int i = 0; i < k; ++i) {
      const double above = h[i], below = h[i + 1];
      h[i] = cosine[i] * above + sine[i] * below;
      h[i + 1] = cosine[i] * below - sine[i] * above;
    }
    const double radius = std::hypot(h[k], length);
    if (!std::isfinite(radius) || radius == 0) break;
    cosine.push_back(h[k] / radius);
    sine.push_back(length / radius);
    h[k] = radius;
    g.push_back(-sine[k] * g[k]);
    g[k] *= cosine[k];
    columns.push_back(std::move(h));
    ++k;
    result.residual = std::abs(g[k]) / scale;
    if (length <= 1e-300) break;
    basis.push_back(w / length);
  }
  result.iterations = k;
  for (int i = k - 1; i >= 0; --i) {  // back substitution, column by column
    const double y = g[i] / columns[i][i];
    for (int j = 0; j < i; ++j) g[j] -= y * columns[i][j];
    result.solution += y * directions[i];
  }
  result.converged = result.residual <= tolerance;
  return result;
}

}  // namespace sim
