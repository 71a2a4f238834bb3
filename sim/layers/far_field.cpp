#include "sim/layers/far_field.h"

#include "sim/core/parallel.h"
#include "sim/layers/kernels.h"
#include "sim/layers/small_product.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sim {

Sources make_sources(const Basis& basis, const Coefficients& x) {
  const FirstDerivatives d = basis.first(x);
  Sources s;
  s.points = d.value;
  s.normals.resize(basis.points(), 3);
  s.area.resize(basis.points());
  s.spacing.resize(basis.points());
  const double step = std::numbers::pi / basis.latitudes();
  for (Eigen::Index k = 0; k < basis.points(); ++k) {
    const Vec3 t = d.t.row(k).transpose(), f = d.f.row(k).transpose();
    const Vec3 n = t.cross(f) * basis.weights()[k] / basis.sin_theta()[k];
    s.normals.row(k) = n.transpose();
    s.area[k] = n.norm();
    s.spacing[k] = step * std::max(t.norm(), f.norm() / basis.sin_theta()[k]);
  }
  s.box = {s.points.colwise().minCoeff().transpose(), s.points.colwise().maxCoeff().transpose()};
  return s;
}

int smooth_order(int p, int wanted) { return std::max(p + 1, wanted > 0 ? wanted : int(std::ceil(std::pow(p, 1.5)))); }

FarField plan_far_field(std::shared_ptr<const std::vector<Sources>> sources, std::vector<TargetGroup> groups) {
  FarField far{std::move(sources), std::move(groups), {}};
  far.partial.resize(far.groups.size());
  return far;
}

namespace {

/// 0 ... count - 1 without some.
std::vector<int> others(int count, const std::vector<int>& without) {
  std::vector<int> all(count), rest;
  std::iota(all.begin(), all.end(), 0);
  std::set_difference(all.begin(), all.end(), without.begin(), without.end(), std::back_inserter(rest));
  return rest;
}

}  // namespace

void exclude(FarField& far, const std::vector<Exclusion>& exclusions) {
  for (auto& list : far.partial) list.clear();
  for (const Exclusion& e : exclusions)
    far.partial[e.group].push_back({e.surface, others(static_cast<int>(far.groups[e.group].points.rows()), e.targets)});
  for (auto& list : far.partial)
    std::sort(list.begin(), list.end(),
              [](const PartialView& a, const PartialView& b) { return a.surface < b.surface; });
}

void add_direct_sum(const Sources& s, const SourceDensities& density, const Matrix& points, Matrix& velocity) {
  const Eigen::Index count = points.rows(), sources = s.points.rows();
  const bool dual = density.dual.size() > 0;
  // Weighted densities once; four targets a lane, sources in order: the result does not depend on how targets are
  // split.
  Matrix f(3, sources), u, n, y = s.points.transpose();
  for (int d = 0; d < 3; ++d)
    f.row(d) = (stokeslet_factor * density.force.col(d).array() * s.area.array()).matrix().transpose();
  if (dual) {
    u = density.dual.transpose();
    n = s.normals.transpose() * stresslet_factor;
  }
  for (Eigen::Index first = 0; first < count; first += lanes) {
    Lane t[3], v[3] = {};
    for (int d = 0; d < 3; ++d) {
      double x[lanes];
      for (int lane = 0; lane < lanes; ++lane) x[lane] = points(std::min(first + lane, count - 1), d);
      __builtin_memcpy(&t[d], x, sizeof x);
    }
    for (Eigen::Index k = 0; k < sources; ++k) {
      const Lane r0 = t[0] - y(0, k), r1 = t[1] - y(1, k), r2 = t[2] - y(2, k);
      const Lane rr = r0 * r0 + r1 * r1 + r2 * r2, inverse = 1.0 / lane_sqrt(rr);
      const KernelTensor<Lane> g = stokeslet(inverse, 1.0);
      Lane along = g.outer * (r0 * f(0, k) + r1 * f(1, k) + r2 * f(2, k));
      if (dual) {
        const Lane rn = r0 * n(0, k) + r1 * n(1, k) + r2 * n(2, k), ru = r0 * u(0, k) + r1 * u(1, k) + r2 * u(2, k);
        along += stresslet(inverse, rn) * ru;
      }
      v[0] += f(0, k) * g.even + along * r0;
      v[1] += f(1, k) * g.even + along * r1;
      v[2] += f(2, k) * g.even + along * r2;
    }
    for (int lane = 0; lane < lanes && first + lane < count; ++lane)
      for (int d = 0; d < 3; ++d) velocity(first + lane, d) += v[d][lane];
  }
}

std::vector<Matrix> far_velocity(const FarField& far, std::span<const SourceDensities> densities) {
  std::vector<Matrix> velocity(far.groups.size());
  const std::vector<Sources>& sources = *far.sources;
  parallel_for(static_cast<int>(far.groups.size()), [&](int i) {
    const TargetGroup& group = far.groups[i];
    velocity[i] = Matrix::Zero(group.points.rows(), 3);
    auto partial = far.partial[i].begin();
    for (int j = 0; j < static_cast<int>(sources.size()); ++j) {
      const bool some = partial != far.partial[i].end() && partial->surface == j;
      const PartialView* view = some ? &*partial++ : nullptr;
      if (j == group.surface) continue;
      if (!view) {
        add_direct_sum(sources[j], densities[j], group.points, velocity[i]);
        continue;
      }
      if (view->targets.empty()) continue;
      Matrix sum = Matrix::Zero(static_cast<Eigen::Index>(view->targets.size()), 3);
      add_direct_sum(sources[j], densities[j], group.points(view->targets, Eigen::seqN(0, 3)), sum);
      for (std::size_t k = 0; k < view->targets.size(); ++k)
        velocity[i].row(view->targets[k]) += sum.row(static_cast<Eigen::Index>(k));
    }
  });
  return velocity;
}

}  // namespace sim
