// Flexible GMRES without restart, preconditioned from the right: the residual it reports is the true one, and the
// preconditioner may differ from one application to the next.
#pragma once

#include "sim/core/types.h"

#include <functional>

namespace sim {

using LinearMap = std::function<Vector(const Vector&)>;
/// Where a process holds a part of the unknowns only, the product must be that of all parts.
using InnerProduct = std::function<double(const Vector&, const Vector&)>;
inline double plain_product(const Vector& a, const Vector& b) { return a.dot(b); }

struct GmresResult {
  Vector solution;
  int iterations = 0;
  double residual = 0;  ///< |b - A x| / |b|, from the recurrence
  bool converged = false;
};

/// Solves A x = b from `guess` to |b - A x| <= tolerance |b|, in the norm of the inner product; `inverse` approximates
/// A^-1.
GmresResult gmres(const LinearMap& A, const LinearMap& inverse, const Vector& b, const Vector& guess, double tolerance,
                  int most_iterations, const InnerProduct& product = plain_product);

}  // namespace sim
