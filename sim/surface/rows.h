// Products of vectors given as rows, points x 3, column by column.
#pragma once

#include "sim/core/types.h"

namespace sim {

/// a.b of every point: an expression, to be used or stored while a and b are there.
inline auto row_products(const Matrix& a, const Matrix& b) {
  return a.col(0).cwiseProduct(b.col(0)) + a.col(1).cwiseProduct(b.col(1)) + a.col(2).cwiseProduct(b.col(2));
}

/// Each row of a times the entry of s.
inline Matrix scaled_rows(const Vector& s, const Matrix& a) {
  Matrix r(a.rows(), a.cols());
  for (Eigen::Index d = 0; d < a.cols(); ++d) r.col(d).array() = s.array() * a.col(d).array();
  return r;
}

/// The sum over the points of a b^T, for few columns: one dot product each, where a general product would pack its
/// operands first.
template <class A, class B>
auto sum_of_products(const A& a, const B& b) {
  return a.transpose().lazyProduct(b);
}

/// s a + t b, row by row.
inline Matrix sum_of_rows(const Vector& s, const Matrix& a, const Vector& t, const Matrix& b) {
  Matrix r(a.rows(), a.cols());
  for (Eigen::Index d = 0; d < a.cols(); ++d)
    r.col(d).array() = s.array() * a.col(d).array() + t.array() * b.col(d).array();
  return r;
}

}  // namespace sim
