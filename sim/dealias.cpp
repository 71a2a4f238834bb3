#include "dealias.h"

#include "norms.h"

namespace sim {

Coefficients mean_curvature(Plans& plans, const Coefficients& position, int grid_order) {
  const Basis& basis = plans.basis(position.order, grid_order);
  return basis.analyze(Matrix(geometry(basis, position).H));
}

int upsampling_rate(Plans& plans, const Coefficients& position, double tolerance, int most) {
  const int p = position.order;
  Coefficients before = mean_curvature(plans, position, p);
  for (int rate = 2; rate <= most; ++rate) {
    Coefficients now = mean_curvature(plans, position, rate * p);
    if ((now.values - before.values).norm() <= tolerance * now.values.norm()) return rate;
    before = std::move(now);
  }
  return most;
}

double curvature_tail(const Basis& basis, const Geometry& geometry) {
  return tail_share(basis.analyze(Matrix(geometry.H)), 3 * basis.order() / 4 + 1);
}

}  // namespace sim
