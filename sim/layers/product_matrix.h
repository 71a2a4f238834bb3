// Products with a symmetric tensor field A, projected, as dense Galerkin matrices in the form of a layer matrix:
//   (w -> degrees <= p of A w),   [A_de]_ab = oint Y_a A_de Y_b dOmega,
// by the quadrature of a grid. In longitude Y_a Y_b are a few waves of m + m' and |m - m'|, so that each latitude
// needs only the spectrum of A there, up to 2p: O(p^5) in total, as much as a few products with the matrix.
#pragma once

#include "sim/layers/layer_potentials.h"

namespace sim {

/// `tensor`: its components xx, xy, xz, yy, yz, zz on the grid of the basis, points x 6. The basis has the degree p.
LayerMatrix product_matrix(const Basis&, const Matrix& tensor);

}  // namespace sim
