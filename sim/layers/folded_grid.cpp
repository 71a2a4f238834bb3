#include "sim/layers/folded_grid.h"

#include <cmath>
#include <numbers>

namespace sim {

namespace {

using std::numbers::pi;

}  // namespace

FoldedGrid::FoldedGrid(int degree, int grid_order)
    : p(degree), nlat(grid_order + 1), nlon(2 * grid_order + 2), half((nlat + 1) / 2) {
  const GaussLegendre rule = gauss_legendre(nlat);
  theta = rule.theta;
  weight = rule.weight;
  for (int l = 0; 4 * l <= nlon; ++l) {
    Quarter quarter{{l, (nlon - l) % nlon, nlon / 2 - l, nlon / 2 + l}};
    if (l == 0) quarter.index[1] = quarter.index[3] = -1;
    if (4 * l == nlon) quarter.index[2] = quarter.index[3] = -1;
    orbits.push_back(quarter);
    for (int derivative = 0; derivative < 2; ++derivative)
      append_fourier_row(longitude[derivative], p, l, nlon, derivative);
  }
  for (int m = 0; m <= p; ++m) blocks[m % 2].m.push_back(m);
  for (int m = 1; m <= p; ++m) blocks[2 + m % 2].m.push_back(m);
  for (int b = 0; b < 4; ++b) {
    Block& block = blocks[b];
    const std::size_t rows = block.m.size(), columns = orbits.size();
    block.table.resize(rows * columns);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t l = 0; l < columns; ++l) {
        const int m = block.m[r];
        const double angle = 2 * pi * double(m) * double(l) / nlon,
                     k = m == 0 ? 1 / std::sqrt(2 * pi) : 1 / std::sqrt(pi);
        block.table[r * columns + l] = k * (b < 2 ? std::cos(angle) : std::sin(angle));
      }
  }
  const LegendreTable table = legendre_table(p, theta);
  for (int parity = 0; parity < 2; ++parity)
    for (int m = 0; m <= p; ++m) {
      const int count = (p - m - parity + 2) / 2;
      std::vector<double> analysis(std::size_t(count) * half), synth(std::size_t(2 * half) * count);
      for (int k = 0; k < count; ++k)
        for (int i = 0; i < half; ++i) {
          const int column = legendre_index(p, m + parity + 2 * k, m);
          analysis[std::size_t(k) * half + i] = table.value(i, column);
          synth[std::size_t(i) * count + k] = table.value(i, column);
          synth[std::size_t(half + i) * count + k] = table.d1(i, column);
        }
      legendre[parity].push_back(std::move(analysis));
      synthesis[parity].push_back(std::move(synth));
    }
}

}  // namespace sim
