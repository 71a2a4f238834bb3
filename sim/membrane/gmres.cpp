#include "sim/membrane/gmres.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sim {

namespace {

/// The orthonormal basis of the search space, and a vector that is to become the next of it.
class OrthonormalBasis {
 public:
  OrthonormalBasis(Eigen::Index size, const InnerProducts& products) : size_(size), products_(products) {}

  const Vector& last() const { return last_; }

  /// Appends v / length.
  void append(const Vector& v, double length) {
    if (count_ % vectors_at_once == 0) vectors_.emplace_back(size_, vectors_at_once);
    last_ = v / length;
    vectors_.back().col(count_++ % vectors_at_once) = last_;
  }

  /// w less its part in the space; the coefficients of that part, and what is left of the length.
  std::pair<Vector, double> orthogonalise(Vector& w) {
    Vector h = subtract_part(w);
    // Of what is left, its square comes with the products: it is hardly changed by the second time.
    const Vector more = subtract_part(w);
    const double square = more[count_] - more.head(count_).squaredNorm();
    return {h.head(count_) + more.head(count_), std::sqrt(std::max(square, 0.0))};
  }

 private:
  /// The coefficients, and as the last number the square of w before.
  Vector subtract_part(Vector& w) {
    if (count_ % vectors_at_once == 0) {
      vectors_.emplace_back(w);
    } else {
      vectors_.back().col(count_ % vectors_at_once) = w;
    }
    Vector h = products_(vectors_, count_ + 1, w);
    if (count_ % vectors_at_once == 0) vectors_.pop_back();
    // Element by element in the order of the vectors: the bits do not depend on which elements a process holds.
    const auto v = [&](int i) { return vectors_[std::size_t(i / vectors_at_once)].col(i % vectors_at_once); };
    int i = 0;
    for (; i + 4 <= count_; i += 4)
      w = (((w - h[i] * v(i)) - h[i + 1] * v(i + 1)) - h[i + 2] * v(i + 2)) - h[i + 3] * v(i + 3);
    for (; i < count_; ++i) w -= h[i] * v(i);
    return h;
  }

  Eigen::Index size_;
  const InnerProducts& products_;
  std::vector<Matrix> vectors_;
  int count_ = 0;
  Vector last_;
};

}  // namespace

Vector products_of_rows(std::span<const Matrix> vectors, int count, const Vector& with, Eigen::Index first,
                        Eigen::Index rows) {
  Vector products(count);
  for (int at = 0; at < count; at += vectors_at_once) {
    const int columns = std::min(vectors_at_once, count - at);
    const Matrix& some = vectors[std::size_t(at / vectors_at_once)];
    products.segment(at, columns).noalias() =
        some.block(first, 0, rows, columns).transpose() * with.segment(first, rows);
  }
  return products;
}

GmresResult gmres(const LinearMap& A, const LinearMap& inverse, const Vector& b, const Vector& guess, double tolerance,
                  int most_iterations, const InnerProducts& products) {
  const auto norm = [&](const Vector& v) {
    const Matrix one = v;
    return std::sqrt(products({&one, 1}, 1, v)[0]);
  };
  GmresResult result{guess, 0, 0, false, {}};
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
  OrthonormalBasis basis(b.size(), products);
  basis.append(r, beta);
  std::vector<Vector> directions;
  std::vector<Vector> columns;  // of the upper triangle
  std::vector<double> g{beta}, cosine, sine;
  int k = 0;
  while (k < most_iterations && result.residual > tolerance) {
    result.residuals.push_back(result.residual);
    directions.push_back(inverse(basis.last()));
    Vector w = A(directions[k]);
    auto [h, length] = basis.orthogonalise(w);
    for (int i = 0; i < k; ++i) {  // the Givens rotations of the earlier columns
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
    basis.append(w, length);
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
