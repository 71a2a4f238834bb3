// Membrane forces on the fluid, linear in the new position or tension (33), with the geometry held fixed. With the
// displacement d = x+ - x of the material points and psi = d.n:
//   H+ = H + (Laplacian psi + (4 H^2 - 2 K) psi) / 2 + d.grad H                (in place of (33a))
//   f_b = -kappa_b (Laplacian H+ + 2 H+ (H^2 - K)) n                           (33b); at x+ = x it is the full force
//   (2a) f_sigma = sigma Laplacian x + grad sigma = 2 H sigma n + grad sigma        (33c), (2b)
// H+ is the first variation of H at a material point. The paper's (33a), E x+_ff - 2F x+_tf + G x+_tt along n, also
// equals H at x+ = x, but lacks the first derivatives of the Laplacian, which makes it singular at the poles, and the
// terms without derivatives. f_b is minus the variation of E = kappa_b int H^2 dA, so kappa_b is twice Helfrich's
// modulus.
#pragma once

#include "sim/surface/geometry.h"

namespace sim {

/// Bases of one vesicle: `field` has degree p on the upsampled q-grid, `full` degree q itself (for H).
struct ForceBases {
  const Basis& field;
  const Basis& full;
};

/// grad H on the grid, points x 3.
Matrix curvature_gradient(const ForceBases&, const Geometry&);

/// H+ - H on the grid for a displacement given there (points x 3), to first order; the basis resolves d.n.
Vector curvature_change(const Basis&, const Geometry&, const Matrix& curvature_gradient, const Matrix& displacement);

/// Eq. (33b) along n, for the mean curvature h given on the grid; the basis resolves h.
Vector bending_magnitude(const Basis&, const Geometry&, double bending_modulus, const Vector& h);

/// A force of the given magnitude along n: points x 3.
Matrix along_normal(const Geometry&, const Vector& magnitude);

/// Eq. (2a): points x 3.
Matrix bending_force(const ForceBases&, const Geometry&, double bending_modulus);
/// Eq. (33c) for a tension of degree p: points x 3.
Matrix tension_force(const ForceBases&, const Geometry&, const Coefficients& sigma);

}  // namespace sim
