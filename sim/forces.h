// Membrane forces on the fluid, linear in the new position or tension (33), with the geometry held fixed:
//   H+ = (E x+_ff - 2F x+_tf + G x+_tt).n / (2 W^2)                         (33a)
//   f_b = -kappa_b (Laplacian H+ + 2 H+ (H^2 - K)) n                        (33b); at x+ = x it is the full force (2a)
//   f_sigma = sigma Laplacian x + grad sigma = 2 H sigma n + grad sigma      (33c), (2b)
// f_b is minus the variation of E = kappa_b int H^2 dA, so kappa_b is twice Helfrich's modulus.
#pragma once

#include "geometry.h"

namespace sim {

/// Bases of one vesicle: `field` carries degree p on the upsampled q-grid, `full` the degree q itself (for H).
struct ForceBases {
  const Basis& field;
  const Basis& full;
};

/// Eq. (33a) on the grid.
Vector linear_mean_curvature(const Geometry&, const SecondDerivatives& x_plus);

/// Force density on the grid, points x 3: bending of x+ (with modulus) plus tension sigma, both of degree <= p.
Matrix membrane_force(const ForceBases&, const Geometry&, double bending_modulus, const Coefficients& x_plus,
                      const Coefficients& sigma);

/// Eq. (33b): points x 3.
Matrix bending_force(const ForceBases&, const Geometry&, double bending_modulus, const Coefficients& x_plus);
/// Eq. (33c): points x 3.
Matrix tension_force(const ForceBases&, const Geometry&, const Coefficients& sigma);

}  // namespace sim
