// Dealiasing: the grid on which a surface of degree p is differentiated (Algorithm 1, Eqs. (28), (29)).
#pragma once

#include "sim/layers/plans.h"
#include "sim/surface/geometry.h"

namespace sim {

/// Mean curvature computed on the q-grid and restricted to degree p.
Coefficients mean_curvature(Plans&, const Coefficients& position, int grid_order);

/// Order of a grid finer than that of degree p by a rate of so much, which may be broken.
int upsampled(int p, double rate);

/// Algorithm 1, in steps of a half, where the paper goes in whole ones: smallest rate v = 2, 5/2, ... for which the
/// mean curvature of degree p changes by less than `tolerance` (relative, Eq. (28)) from rate v - 1/2 to v; `most` when
/// none does.
double upsampling_rate(Plans&, const Coefficients& position, double tolerance, double most = 8);

/// Share of the mean curvature's spectrum in its last quarter of degrees, n > 3p/4: a measure of resolution. The mean
/// is excluded; a spectrum below a hundredth of the mean counts as that large. `geometry`: of a surface of degree p,
/// on the grid of `basis`.
double curvature_tail(const Basis& basis, const Geometry& geometry);

}  // namespace sim
