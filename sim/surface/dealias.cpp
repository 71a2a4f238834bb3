#include "sim/surface/dealias.h"

#include "sim/sphere/norms.h"

#include <algorithm>
#include <cmath>

namespace sim {

Coefficients mean_curvature(Plans& plans, const Coefficients& position, int grid_order) {
  const Basis& basis = plans.basis(position.order, grid_order);
  return basis.analyze(Matrix(geometry(basis, position).H));
}

int upsampled(int p, double rate) { return int(std::ceil(rate * p)); }

double upsampling_rate(Plans& plans, const Coefficients& position, double tolerance, double most) {
  constexpr double least = 2, step = 0.5;  // products of two fields are of degree 2p
  const int p = position.order;
  Coefficients before = mean_curvature(plans, position, upsampled(p, least - step));
  for (double rate = least; rate <= most; rate += step) {
    Coefficients now = mean_curvature(plans, position, upsampled(p, rate));
    if ((now.values - before.values).norm() <= tolerance * now.values.norm()) return rate;
    before = std::move(now);
  }
  return most;
}

double curvature_tail(const Basis& basis, const Geometry& geometry) {
  // Near a sphere there is hardly a spectrum beside the mean: what is a hundredth of that needs no resolution of its
  // own.
  constexpr double negligible = 1e-2;
  const Coefficients h = basis.analyze(Matrix(geometry.H));
  const double whole = std::max(band_norm(h, 1, h.order), negligible * modular_norm(h, 0));
  return whole > 0 ? band_norm(h, 3 * basis.order() / 4 + 1, h.order) / whole : 0;
}

}  // namespace sim
