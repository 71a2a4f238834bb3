// Wave numbers of the spherical harmonics on a surface: its Laplacian, restricted to each degree.
//
// On the unit sphere the rotations L = s x grad keep a degree n, and L.L f = -n(n+1) f. The inverse metric of a
// surface, rotated by a right angle in the tangent plane of the parameter sphere, is fitted by a constant matrix C,
// so that
//   Laplacian f ~ sum_ab C_ab L_a L_b f,
// exact for a sphere, and for an ellipsoid up to the factor by which its area is stretched. Each degree then has 2n+1
// orthonormal modes with their own wave numbers: long waves along a prolate, short ones around it.
#pragma once

#include "sim/layers/plans.h"
#include "sim/surface/geometry.h"

namespace sim {

struct SurfaceWaves {
  const Basis& basis;           ///< degree p + 1 on its own grid: u.n of a velocity of degree p reaches that far
  Matrix n;                     ///< unit normals on that grid, points x 3
  std::vector<Matrix> modes;    ///< of degree n = 0..p+1: (2n+1) x (2n+1), one mode a column
  std::vector<Vector> numbers;  ///< their wave numbers k, 1/length
};

SurfaceWaves surface_waves(Plans&, const Coefficients& position);

/// Per degree, from `first` on, the matrix that multiplies each mode by gain(k).
template <class Gain>
std::vector<Matrix> mode_filter(const SurfaceWaves& w, Gain&& gain, int first = 0) {
  std::vector<Matrix> blocks;
  for (std::size_t n = first; n < w.modes.size(); ++n)
    blocks.push_back(w.modes[n] * w.numbers[n].unaryExpr(gain).asDiagonal() * w.modes[n].transpose());
  return blocks;
}

/// Effect of truncation on normal fields at the upper edge of the spectrum: psi n with psi of degrees `first` to
/// p + 1 is truncated at degree p, and this is the inner product of the rest, (n psi_a)_p . (n psi_b)_p, over the
/// parameter sphere. Degrees well below p are not affected and would give the unit matrix; of degrees p and p + 1
/// about half is left.
Matrix truncated_overlap(const SurfaceWaves&, int first);

}  // namespace sim
