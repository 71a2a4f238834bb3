// C = A B for a small constant matrix A and rows of B that are a few SIMD vectors wide: the one inner loop of
// operator assembly. Each lane holds one of four targets, so every step of the assembly is such a product and none
// needs a shuffle.
#pragma once

#include "sim/core/lanes.h"

#include <cstddef>

namespace sim {

/// Rows of B and C start at b + b_row[k] and c + c_row[m] (in vectors); A is rows x depth, row-major, leading dimension
/// a_ld.
struct SmallProduct {
  int rows, depth;
  const double* a;
  int a_ld;
  const int* b_row;
  const int* c_row;
};

template <int R>
inline void product_rows(const SmallProduct& s, int row, const Lane* b, Lane* c) {
  Lane acc[R][3] = {};
  const double* a = s.a + std::ptrdiff_t(row) * s.a_ld;
  for (int k = 0; k < s.depth; ++k) {
    const Lane* bk = b + s.b_row[k];
    const Lane b0 = bk[0], b1 = bk[1], b2 = bk[2];
    for (int r = 0; r < R; ++r) {
      const double x = a[std::ptrdiff_t(r) * s.a_ld + k];
      acc[r][0] += x * b0;
      acc[r][1] += x * b1;
      acc[r][2] += x * b2;
    }
  }
  for (int r = 0; r < R; ++r) {
    Lane* out = c + s.c_row[row + r];
    out[0] = acc[r][0];
    out[1] = acc[r][1];
    out[2] = acc[r][2];
  }
}

/// C = A B, each row of B and C being `width` vectors, a multiple of 3.
inline void multiply(const SmallProduct& s, int width, const Lane* b, Lane* c) {
  for (int w = 0; w < width; w += 3) {
    int row = 0;
    for (; row + 4 <= s.rows; row += 4) product_rows<4>(s, row, b + w, c + w);
    switch (s.rows - row) {
      case 3:
        product_rows<3>(s, row, b + w, c + w);
        break;
      case 2:
        product_rows<2>(s, row, b + w, c + w);
        break;
      case 1:
        product_rows<1>(s, row, b + w, c + w);
        break;
      default:
        break;
    }
  }
}

}  // namespace sim
