// A Gauss-Legendre x uniform grid folded by its mirror symmetries: north-south, phi -> -phi and phi -> pi - phi.
// Separable synthesis and analysis on it need a quarter of the Fourier and half of the Legendre products.
#pragma once

#include "sim/sphere/fourier_sums.h"
#include "sim/sphere/legendre.h"

#include <array>

namespace sim {

/// Longitudes of a grid of nlon points fall into orbits {f, -f, pi-f, pi+f} of a quarter; cosines and sines of even and
/// odd m are even or odd under the two mirrors, which leaves four products of a quarter of the size.
struct Quarter {
  int index[4];  ///< of f, -f, pi - f, pi + f; -1 where the orbit has no separate such member
};

/// Fourier and Legendre tables of one grid for degree p, folded by all mirror symmetries of the grid.
struct FoldedGrid {
  int p, nlat, nlon, half;  ///< half: latitudes of the northern half, the equator included
  std::vector<Quarter> orbits;
  struct Block {  ///< one of cos/sin x even/odd m
    std::vector<int> m;
    std::vector<double> table;  ///< m x orbits: basis function at the orbit's first longitude
  };
  std::array<Block, 4> blocks;       ///< cos even, cos odd, sin even, sin odd
  std::vector<double> longitude[2];  ///< the basis functions there and their derivatives: rows of fourier_sums()
  std::vector<std::vector<double>> legendre[2];   ///< [parity of n-m][m]: (n) x half, values, without weights
  std::vector<std::vector<double>> synthesis[2];  ///< [parity][m]: (2 half) x (n): values, then derivatives
  Vector theta, weight;                           ///< of all latitudes; Gauss-Legendre

  FoldedGrid(int degree, int grid_order);
  int mirror(int i) const { return nlat - 1 - i; }
};

}  // namespace sim
