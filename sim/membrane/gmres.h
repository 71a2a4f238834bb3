// Flexible GMRES without restart, preconditioned from the right: the residual it reports is the true one, and the
// preconditioner may differ from one application to the next.
//
// The basis is made orthogonal by the classical Gram-Schmidt process, twice over ("twice is enough", Giraud, Langou,
// Rozloznik and van den Eshof 2005): as orthogonal as rounding allows, and all products with a new vector are taken at
// once, so that processes that have parts of the vectors exchange numbers twice an iteration, however long the basis.
#pragma once

#include "sim/core/types.h"

#include <functional>
#include <span>
#include <vector>

namespace sim {

using LinearMap = std::function<Vector(const Vector&)>;

/// Vectors side by side: the columns of matrices of so many columns each.
inline constexpr int vectors_at_once = 8;
/// Inner products of the first `count` of many vectors with one. Where a process holds a part of the unknowns only, the
/// products must be those of all parts.
using InnerProducts = std::function<Vector(std::span<const Matrix> vectors, int count, const Vector& with)>;
/// Of a part of each vector: `rows` of them from row `first`.
Vector products_of_rows(std::span<const Matrix> vectors, int count, const Vector& with, Eigen::Index first,
                        Eigen::Index rows);
inline Vector plain_products(std::span<const Matrix> vectors, int count, const Vector& with) {
  return products_of_rows(vectors, count, with, 0, with.size());
}

struct GmresResult {
  Vector solution;
  int iterations = 0;
  double residual = 0;  ///< |b - A x| / |b|, from the recurrence
  bool converged = false;
  std::vector<double> residuals;  ///< in each direction's turn, before it
};

/// Solves A x = b from `guess` to |b - A x| <= tolerance |b|, in the norm of the inner product; `inverse` approximates
/// A^-1.
GmresResult gmres(const LinearMap& A, const LinearMap& inverse, const Vector& b, const Vector& guess, double tolerance,
                  int most_iterations, const InnerProducts& products = plain_products);

}  // namespace sim
