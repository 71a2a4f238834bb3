#include "sim/layers/layer_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sim {

LayerPotentials::Plan::Plan(int order, int source_order, bool wide_lanes)
    : p(order),
      q(order + 1),
      s(source_order > 0 ? source_order : order + 1),
      target(order, order + 1),
      source(order, source_order > 0 ? source_order : order + 1),
      target_rows(target),
      source_rows(source),
      longitudes(target.nlon + target.nlon / 2 + width_of<WideLane>),
      wide(wide_lanes && has_wide_lanes()) {
  if (s < p) throw std::invalid_argument("LayerPotentials: the source order must be at least p");
  for (int k = 0; k <= s; ++k) {
    const double t = source.theta[k], z = std::cos(t);
    double p0 = 1, p1 = z, sum = 1 + z;
    for (int n = 2; n <= s; ++n) {
      const double p2 = ((2 * n - 1) * z * p1 - (n - 1) * p0) / n;
      sum += p2;
      p0 = p1;
      p1 = p2;
    }
    singular_weight.push_back(source.weight[k] * std::numbers::pi / (s + 1) * sum * 2 * std::sin(t / 2) / std::sin(t));
  }
  for (int m = 0; m <= p; ++m)
    for (int j = 0; j < longitudes; ++j) {
      const double angle = 2 * std::numbers::pi * double((std::int64_t(m) * j) % target.nlon) / target.nlon;
      cosine.push_back(std::cos(angle));
      sine.push_back(std::sin(angle));
    }
  for (int i = 0; i < target.half; ++i) {
    const int own = target.mirror(i) == i ? target.nlon / 2 : target.nlon;  // the equator is its own antipode
    for (int first = 0; first < own;) {
      const bool eight = wide && own - first > lanes;
      const int targets = std::min(eight ? width_of<WideLane> : lanes, own - first);
      tiles.push_back({i, first, targets, eight});
      first += targets;
    }
  }
  // W_i: the basis at points turned by Ry(theta_i), projected on a p-grid, where the product is integrated exactly.
  const Basis basis(p, p);
  const Matrix direction = grid_directions(basis);
  Matrix turned(basis.points(), 3);
  const Matrix projection = basis_functions(p, direction).transpose() * basis.weights().asDiagonal();
  for (int i = 0; i <= q; ++i) {
    const double c = std::cos(target.theta[i]), sn = std::sin(target.theta[i]);
    turned << c * direction.col(0) + sn * direction.col(2), direction.col(1),
        c * direction.col(2) - sn * direction.col(0);
    const Matrix values = basis_functions(p, turned);
    std::vector<Rotation> all;
    for (int n = 0; n <= p; ++n) {
      const Matrix w = projection.middleRows(n * n, 2 * n + 1) * values.middleCols(n * n, 2 * n + 1);
      Rotation r{std::vector<double>((n + 1) * (n + 1)), std::vector<double>(n * n), {}, {}};
      r.cosine_t = r.cosine;
      r.sine_t = r.sine;
      for (int a = 0; a <= n; ++a)
        for (int b = 0; b <= n; ++b) {
          r.cosine[a * (n + 1) + b] = r.cosine_t[b * (n + 1) + a] = w(n + a, n + b);
          if (a > 0 && b > 0) r.sine[(a - 1) * n + b - 1] = r.sine_t[(b - 1) * n + a - 1] = w(n - a, n - b);
        }
      all.push_back(std::move(r));
    }
    rotations.push_back(std::move(all));
  }
}

}  // namespace sim
