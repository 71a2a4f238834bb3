#include "sim/suspension/flow_images.h"

#include "sim/core/parallel.h"
#include "sim/layers/kernels.h"
#include "sim/suspension/far_choice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

/// Weighted densities in units of the cut-off, as the fast sum takes them.
FastStrengths strengths_of(const Sources& s, const SourceDensities& density, double cutoff) {
  FastStrengths strengths;
  strengths.force = stokeslet_factor / cutoff * (density.force.array().colwise() * s.area.array()).matrix().transpose();
  if (density.dual.size() == 0) return strengths;
  strengths.dual.resize(6, s.points.rows());
  const Points n = stresslet_factor / (cutoff * cutoff) * s.normals.transpose(), u = density.dual.transpose();
  int c = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b, ++c)
      strengths.dual.row(c) = 0.5 * (n.row(a).cwiseProduct(u.row(b)) + n.row(b).cwiseProduct(u.row(a)));
  return strengths;
}

/// What makes the double layer 0 outside a body that moves as a whole (fast_sum.h).
Vec3 mean_of_double_layers(const std::vector<SpreadSurface>& surfaces, double volume) {
  Vec3 moment = Vec3::Zero();
  for (const SpreadSurface& s : surfaces) {
    if (s.strengths.dual.cols() == 0) continue;
    const Vec3 middle = s.points.rowwise().mean();
    for (Eigen::Index k = 0; k < s.points.cols(); ++k) {
      const auto q = s.strengths.dual.col(k);
      moment += (s.points.col(k) - middle) * (q[0] + q[3] + q[5]);
    }
  }
  return 4 * std::numbers::pi / (3 * volume) * moment;
}

}  // namespace

FlowImages flow_images(Plans& plans, std::span<const Coefficients> positions,
                       std::span<const Coefficients* const> forces, std::span<const Coefficients* const> duals,
                       const Eigen::Matrix3d& sides, double tolerance) {
  const auto n = static_cast<int>(positions.size());
  std::vector<int> orders;
  std::vector<Outline> coarse(positions.size());
  double fine_points = 0;
  for (const Coefficients& x : positions) {
    orders.push_back(x.order);
    fine_points += grid_points(smooth_order(x.order));
  }
  const bool dual = std::any_of(duals.begin(), duals.end(), [](const Coefficients* c) { return c != nullptr; });
  parallel_for(n, [&](int i) {
    const auto k = std::size_t(i);
    coarse[k] = outline_of(make_sources(plans.basis(orders[k], orders[k] + 1), positions[k]));
  });
  FarOptions far;
  far.tolerance = tolerance;
  far.cell = sides;
  const FastChoice choice = choose_fast({orders, coarse, fine_points, dual}, far).value();
  const double cutoff = choice.setting.cutoff;

  FlowImages images{sides, cutoff, coarse_limit(tolerance), {}, {}, {}, std::vector<SpreadSurface>(positions.size())};
  std::vector<FastBody> bodies(positions.size());
  parallel_for(n, [&](int i) {
    const auto k = std::size_t(i);
    const Basis& basis = plans.basis(orders[k], spread_order(orders[k], choice.finer));
    SpreadSurface& s = images.spread[k];
    s.sources = make_sources(basis, positions[k]);
    s.densities.force = basis.synthesize(*forces[k]).values;
    if (duals[k]) s.densities.dual = basis.synthesize(*duals[k]).values;
    s.points = s.sources.points.transpose() / cutoff;
    s.strengths = strengths_of(s.sources, s.densities, cutoff);
    bodies[k].coarse = s.sources.points.transpose();
  });
  // Split and mesh are those of a fast sum to no targets but one.
  const std::vector<FastGroup> nowhere{{Points(Points::Zero(3, 1)), -1}};
  plans.with_fast_parts([&](FastParts& parts) {
    const FastSum sum = plan_fast_sum(choice.setting, bodies, nowhere, {}, dual, parts);
    images.split = sum.split;
    images.mesh = sum.mesh;
  });
  Eigen::Index count = 0;
  for (const SpreadSurface& s : images.spread) count += s.points.cols();
  Points points(3, count);
  MeshStrengths strengths{Points(3, count), Tensors::Zero(6, dual ? count : 0), dual};
  Eigen::Index first = 0;
  for (const SpreadSurface& s : images.spread) {
    const Eigen::Index own = s.points.cols();
    points.middleCols(first, own) = s.points;
    strengths.force.middleCols(first, own) = s.strengths.force;
    if (s.strengths.dual.cols() > 0) strengths.dual.middleCols(first, own) = s.strengths.dual;
    first += own;
  }
  images.smooth = images.mesh->velocity_of(images.mesh->place_sources(points, Vec3::Zero(), dual), strengths);
  images.smooth.everywhere =
      -mean_of_double_layers(images.spread, std::abs(sides.determinant()) / (cutoff * cutoff * cutoff));
  return images;
}

Matrix smooth_velocity(const FlowImages& images, const Matrix& points) {
  const Points scaled = points.transpose() / images.cutoff;
  Points velocity = Points::Zero(3, points.rows());
  images.mesh->add_velocity(images.smooth, images.mesh->place_targets(scaled, Vec3::Zero()), velocity);
  return velocity.transpose();
}

void take_smooth(const FlowImages& images, int surface, const Matrix& points, Matrix& velocity) {
  const SpreadSurface& s = images.spread[std::size_t(surface)];
  const Points scaled = points.transpose() / images.cutoff;
  Points all = velocity.transpose();
  subtract_smooth(*images.split, s.points, s.strengths, scaled, all);
  velocity = all.transpose();
}

std::vector<Vec3> near_shifts(const Eigen::Matrix3d& sides, const Box& moved, const Box& fixed, double reach) {
  const Eigen::Matrix3d inverse = sides.inverse();
  const Vec3 away = inverse * (0.5 * (fixed.low + fixed.high) - 0.5 * (moved.low + moved.high));
  const double radius = 0.5 * ((fixed.high - fixed.low).norm() + (moved.high - moved.low).norm()) + reach;
  Eigen::Vector3i low, high;
  for (int d = 0; d < 3; ++d) {
    const double room = radius * inverse.row(d).norm();
    low[d] = static_cast<int>(std::ceil(away[d] - room));
    high[d] = static_cast<int>(std::floor(away[d] + room));
  }
  std::vector<Vec3> shifts;
  for (int a = low[0]; a <= high[0]; ++a)
    for (int b = low[1]; b <= high[1]; ++b)
      for (int c = low[2]; c <= high[2]; ++c) {
        const Vec3 shift = sides * Vec3(a, b, c);
        if (distance(Box{moved.low + shift, moved.high + shift}, fixed) < reach) shifts.push_back(shift);
      }
  return shifts;
}

}  // namespace sim
