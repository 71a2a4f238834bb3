#include "sim/layers/far_field.h"

#include "sim/core/parallel.h"
#include "sim/layers/kernels.h"

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

namespace {

/// Weighted densities, once: S f + D u without the factors of the kernels.
struct Strengths {
  Matrix y, f, u, n;  ///< [3][source]; u and n are empty without a double layer

  Strengths(const Sources& s, const SourceDensities& density) : y(s.points.transpose()), f(3, s.points.rows()) {
    for (int d = 0; d < 3; ++d)
      f.row(d) = (stokeslet_factor * density.force.col(d).array() * s.area.array()).matrix().transpose();
    if (density.dual.size() == 0) return;
    u = density.dual.transpose();
    n = s.normals.transpose() * stresslet_factor;
  }
};

/// Sums at as many targets as there are lanes, of which the last may be the same.
template <class Vector>
[[gnu::always_inline]] inline void sum_at(const Strengths& s, const Vector* t, Vector* v) {
  const bool dual = s.u.size() > 0;
  const double *y = s.y.data(), *f = s.f.data(), *u = s.u.data(), *n = s.n.data();
  Vector v0{}, v1{}, v2{};
  for (Eigen::Index at = 0; at < s.y.size(); at += 3) {
    const Vector r0 = t[0] - y[at], r1 = t[1] - y[at + 1], r2 = t[2] - y[at + 2];
    Vector distance = r0 * r0 + r1 * r1 + r2 * r2;
    take_root(distance);
    const Vector inverse = 1.0 / distance;
    const KernelTensor<Vector> g = stokeslet(inverse, 1.0);
    Vector along = g.outer * (r0 * f[at] + r1 * f[at + 1] + r2 * f[at + 2]);
    if (dual) {
      const Vector rn = r0 * n[at] + r1 * n[at + 1] + r2 * n[at + 2], ru = r0 * u[at] + r1 * u[at + 1] + r2 * u[at + 2];
      Vector outer;
      stresslet(inverse, rn, outer);
      along += outer * ru;
    }
    v0 += f[at] * g.even + along * r0;
    v1 += f[at + 1] * g.even + along * r1;
    v2 += f[at + 2] * g.even + along * r2;
  }
  v[0] = v0;
  v[1] = v1;
  v[2] = v2;
}

template <class Vector>
void add_at(const Strengths& s, const Matrix& points, Eigen::Index first, Matrix& velocity) {
  constexpr int width = width_of<Vector>;
  Vector t[3], v[3];
  for (int d = 0; d < 3; ++d) {
    double x[width];
    for (int lane = 0; lane < width; ++lane) x[lane] = points(std::min(first + lane, points.rows() - 1), d);
    __builtin_memcpy(&t[d], x, sizeof x);
  }
  run_apart<Vector>([&]() __attribute__((always_inline)) { sum_at(s, t, v); });
  for (int lane = 0; lane < width && first + lane < points.rows(); ++lane)
    for (int d = 0; d < 3; ++d) velocity(first + lane, d) += v[d][lane];
}

}  // namespace

void add_direct_sum(const Sources& s, const SourceDensities& density, const Matrix& points, Matrix& velocity,
                    LaneCount most) {
  const Strengths strengths(s, density);
  // A target a lane, sources in order: the result does not depend on how targets are split.
  const bool wide = most == LaneCount::widest && has_wide_lanes();
  for (Eigen::Index first = 0, count = points.rows(); first < count;) {
    if (wide && count - first > lanes) {
      add_at<WideLane>(strengths, points, first, velocity);
      first += width_of<WideLane>;
    } else {
      add_at<Lane>(strengths, points, first, velocity);
      first += lanes;
    }
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
