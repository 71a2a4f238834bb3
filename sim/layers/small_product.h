// C = A B for a small constant matrix A and rows of B that are a few SIMD vectors wide: the one inner loop of
// operator assembly. Each lane holds one of several targets, so every step of the assembly is such a product and none
// needs a shuffle.
#pragma once

#include "sim/core/packs.h"

#include <cstddef>

namespace sim {

/// Where rows start, in vectors: at equal distances, or as listed.
struct EqualRows {
  std::ptrdiff_t distance;
  std::ptrdiff_t operator[](int row) const { return row * distance; }
};
using ListedRows = const int*;

/// A is rows x depth, row-major.
struct SmallMatrix {
  int rows, depth;
  const double* values;
};

template <int R, class Vector, class RowsB, class RowsC>
[[gnu::always_inline]] inline void product_rows(const SmallMatrix& m, int row, const Vector* b, RowsB b_row, Vector* c,
                                                RowsC c_row) {
  using Sum = Pack<3, Vector>;
  Sum s, t, u, v;
  const double* a0 = m.values + std::ptrdiff_t(row) * m.depth;
  const double* a2 = a0 + 2 * std::ptrdiff_t(m.depth);
  for (int k = 0; k < m.depth; ++k) {
    const Sum x = Sum::load(b + b_row[k]);
    s.add(a0[k], x);
    if constexpr (R > 1) t.add(a0[m.depth + k], x);
    if constexpr (R > 2) u.add(a2[k], x);
    if constexpr (R > 3) v.add(a2[m.depth + k], x);
  }
  s.store(c + c_row[row]);
  if constexpr (R > 1) t.store(c + c_row[row + 1]);
  if constexpr (R > 2) u.store(c + c_row[row + 2]);
  if constexpr (R > 3) v.store(c + c_row[row + 3]);
}

/// C = A B, each row of B and C being `width` vectors, a multiple of 3.
template <class Vector, class RowsB, class RowsC>
[[gnu::always_inline]] inline void multiply(const SmallMatrix& m, int width, const Vector* b, RowsB b_row, Vector* c,
                                            RowsC c_row) {
  int row = 0;
  const auto all = [&]<int R>() __attribute__((always_inline)) {
    for (int w = 0; w < width; w += 3) product_rows<R>(m, row, b + w, b_row, c + w, c_row);
    row += R;
  };
  while (const int left = m.rows - row) {  // panels as even as possible: 5 rows are 3 and 2
    if (left >= 10 || left % 4 == 0 || left == 7)
      all.template operator()<4>();
    else if (left >= 3)
      all.template operator()<3>();
    else if (left == 2)
      all.template operator()<2>();
    else
      all.template operator()<1>();
  }
}

}  // namespace sim
