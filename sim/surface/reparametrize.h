// Reparametrization (Appendix A): grid points move along the membrane so that the high degrees of x become small.
//
// The paper moves points in the tangent plane and lets them leave the surface. Here the new parametrisation is kept
// as a map of the sphere, s = map(s'), and y(s') = x(map(s')): points stay on the surface exactly, and everything
// that is a function of the material point (history, velocity, tension, labels) is transported by the same map,
// f'(s') = f(map(s')). Descent on E(y) = sum a_n |y_n|^2 with a_n = 0 below p/2, 0.1 up to p, and 1 beyond p, which
// truncation will remove.
#pragma once

#include "sim/layers/plans.h"

namespace sim {

/// Step on the parameter sphere that moves a point of the surface by the tangential part of `shift` (least squares):
/// along e1 and e2, tangents of the sphere, along which the position has the derivatives a and b.
Vec3 parameter_shift(const Vec3& e1, const Vec3& e2, const Vec3& a, const Vec3& b, const Vec3& shift);

/// s = map(s'): the normalised sum of these coefficients (3 fields, of the degree of the grid it was found on).
struct Relabelling {
  Coefficients map;
  double high_before = 0, high_after = 0;  ///< norm of the degrees >= p/2 relative to x without its mean
  double lost = 0;                         ///< likewise of the degrees beyond p afterwards: the truncation error
};

/// Share of the degrees n >= p/2 in x without its mean.
double high_degree_share(const Coefficients& position);

/// Descends until the projected gradient has fallen to `stop` of its first value, or for `most` iterations.
Relabelling relabel(Plans&, const Coefficients& position, int grid_order, double stop = 0.05, int most = 12);

/// map(s') at given parameters s' (rows of unit vectors), and at the points of a grid.
Matrix mapped(const Relabelling&, const Matrix& parameters);
Matrix mapped(const Relabelling&, const Basis&);

/// f(map(s')) projected on the degree of f.
Coefficients pulled_back(Plans&, const Relabelling&, const Coefficients& f);

/// Parameters s' (rows of unit vectors) of the points of `after` nearest to before(s), s given as rows; the search
/// starts at the inverse of the map.
Matrix carried_points(const Relabelling&, const Coefficients& before, const Coefficients& after,
                      const Matrix& parameters);

}  // namespace sim
