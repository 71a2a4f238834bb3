#include "sim/fast/fast_sum.h"

#include "sim/core/cells.h"
#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sim {

FastSetting fast_setting(double tolerance, bool dual) {
  FastSetting s;
  // Measured with random points: the split errs by 6 exp(-0.95 c) in S, by three times as much in D; windows by less.
  s.wave_number = std::ceil(2 * (std::log(6 / tolerance) / 0.95 + (dual ? 1 : 0))) / 2;
  s.accuracy = tolerance / 10;
  s.window = std::clamp(static_cast<int>(std::ceil((s.wave_number + (dual ? 2 : 0)) / 4)) * 2, 4, Window::most);
  s.oversampling = 1.2;
  constexpr double rounding = 1e-5;  // errors of sums in single precision are some 2e-6
  s.single_precision = tolerance >= rounding;
  return s;
}

namespace {

Points joined(std::span<const Points* const> parts) {
  Eigen::Index count = 0, at = 0;
  for (const Points* p : parts) count += p->cols();
  Points all(3, count);
  for (const Points* p : parts) {
    all.middleCols(at, p->cols()) = *p;
    at += p->cols();
  }
  return all;
}

std::vector<Eigen::Index> firsts(std::span<const Points* const> parts) {
  std::vector<Eigen::Index> first{0};
  for (const Points* p : parts) first.push_back(first.back() + p->cols());
  return first;
}

void renew(FastParts& parts, const FastSetting& s, const Vec3& sides) {
  const bool same_split =
      parts.split && parts.setting.wave_number == s.wave_number && parts.setting.accuracy == s.accuracy;
  const bool same_window =
      same_split && parts.setting.window == s.window && parts.setting.oversampling == s.oversampling;
  if (!same_split) parts.split = std::make_shared<const KernelSplit>(s.wave_number, s.accuracy);
  if (!same_window) parts.window = std::make_shared<const Window>(s.window, *parts.split, s.oversampling);
  if (s.cell) {
    const bool same_cell = parts.setting.cell && *parts.setting.cell / parts.setting.cutoff == *s.cell / s.cutoff;
    if (!same_window || !same_cell)
      parts.mesh = std::make_shared<const Mesh>(*parts.split, *parts.window, s.oversampling, *s.cell / s.cutoff);
    parts.nodes = {};
  } else {
    const auto nodes = Mesh::nodes_for(sides, Mesh::spacing(s.wave_number, s.oversampling), s.window);
    if (!same_window || nodes != parts.nodes)
      parts.mesh = std::make_shared<const Mesh>(*parts.split, *parts.window, s.oversampling, nodes);
    parts.nodes = nodes;
  }
  parts.setting = s;
}

}  // namespace

FastSum plan_fast_sum(const FastSetting& setting, const std::vector<FastBody>& bodies,
                      const std::vector<FastGroup>& groups, const std::vector<Exclusion>& exclusions, bool dual,
                      FastParts& parts, const Ranks& ranks) {
  std::vector<FastBody> scaled_bodies = bodies;
  std::vector<FastGroup> scaled_groups = groups;
  std::vector<const Points*> sources, targets;
  std::vector<char> wanted;
  std::vector<int> owner;
  for (FastBody& body : scaled_bodies) {
    body.coarse /= setting.cutoff;
    body.fine /= setting.cutoff;
    body.fine_within /= setting.cutoff;
    sources.push_back(&body.coarse);
  }
  for (FastGroup& group : scaled_groups) {
    group.points /= setting.cutoff;
    targets.push_back(&group.points);
    wanted.push_back(group.wanted);
    owner.push_back(group.owner);
  }
  const Points y = joined(sources), x = joined(targets);
  const Vec3 low = y.rowwise().minCoeff().cwiseMin(x.rowwise().minCoeff()),
             high = y.rowwise().maxCoeff().cwiseMax(x.rowwise().maxCoeff()), middle = 0.5 * (low + high);
  renew(parts, setting, high - low);
  std::optional<Eigen::Matrix3d> cell;
  if (setting.cell) cell = *setting.cell / setting.cutoff;
  return {setting,
          dual,
          parts.split,
          parts.mesh,
          parts.mesh->place_sources(y, middle, dual, ranks),
          parts.mesh->place_targets(x, middle, ranks),
          plan_pairs(scaled_bodies, scaled_groups, exclusions, setting.single_precision, cell),
          firsts(sources),
          firsts(targets),
          std::move(wanted),
          std::move(owner),
          &ranks};
}

namespace {

/// Velocities go from the ranks that read them off the mesh to those that own their points, by ascending point.
void hand_over(const FastSum& sum, Points& velocity) {
  const Ranks& ranks = *sum.ranks;
  const auto each_point = [&](auto&& at) {
    for (std::size_t g = 0; g < sum.owner.size(); ++g)
      for (Eigen::Index k = sum.first_target[g]; k < sum.first_target[g + 1]; ++k)
        at(static_cast<std::size_t>(sum.targets.home[std::size_t(k)]), static_cast<std::size_t>(sum.owner[g]), k);
  };
  const auto here = static_cast<std::size_t>(ranks.rank);
  std::vector<std::vector<double>> messages(static_cast<std::size_t>(ranks.count));
  each_point([&](std::size_t home, std::size_t owner, Eigen::Index k) {
    if (home != here || owner == here) return;
    for (int c = 0; c < 3; ++c) messages[owner].push_back(velocity(c, k));
  });
  messages = ranks.exchanged(messages);
  std::vector<std::size_t> read(messages.size());
  each_point([&](std::size_t home, std::size_t owner, Eigen::Index k) {
    if (owner != here || home == here) return;
    for (int c = 0; c < 3; ++c) velocity(c, k) = messages[home][read[home]++];
  });
}

}  // namespace

std::vector<Points> fast_velocity(const FastSum& sum, std::span<const FastStrengths> coarse,
                                  std::span<const FastStrengths> fine) {
  const double per_length = 1 / sum.setting.cutoff, per_area = per_length * per_length;
  const auto bodies = static_cast<int>(coarse.size());
  std::vector<FastStrengths> scaled_coarse(coarse.begin(), coarse.end()), scaled_fine(fine.begin(), fine.end());
  bool dual = false;
  for (const FastStrengths& s : coarse) dual = dual || s.dual.cols() > 0;
  if (dual && !sum.dual) throw std::invalid_argument("the fast sum was planned without double layers");
  Points force(3, sum.first_source.back());
  Tensors tensors = Tensors::Zero(6, dual ? sum.first_source.back() : 0);
  parallel_for(bodies, [&](int j) {
    for (std::vector<FastStrengths>* all : {&scaled_coarse, &scaled_fine}) {
      (*all)[std::size_t(j)].force *= per_length;
      (*all)[std::size_t(j)].dual *= per_area;
    }
    const FastStrengths& s = scaled_coarse[std::size_t(j)];
    const Eigen::Index first = sum.first_source[std::size_t(j)];
    force.middleCols(first, s.force.cols()) = s.force;
    if (s.dual.cols() > 0) tensors.middleCols(first, s.dual.cols()) = s.dual;
  });
  Points whole = Points::Zero(3, sum.first_target.back());
  sum.mesh->add_velocity(sum.sources, force, tensors, sum.targets, whole, *sum.ranks);
  if (sum.ranks->count > 1) hand_over(sum, whole);
  if (sum.setting.cell && dual) {
    Vec3 moment = Vec3::Zero();
    for (std::size_t j = 0; j < scaled_coarse.size(); ++j) {
      const PairLists::Level& level = sum.pairs.bodies[j].levels[0];
      const Tensors& q = scaled_coarse[j].dual;
      for (Eigen::Index k = 0; k < std::min(q.cols(), level.points.cols()); ++k) {
        const Eigen::Index point = level.patches.order[std::size_t(k)];
        moment += level.points.col(k) * (q(0, point) + q(3, point) + q(5, point));
      }
    }
    const double volume = std::abs(sum.setting.cell->determinant()) * std::pow(per_length, 3);
    whole.colwise() -= 4 * std::numbers::pi / (3 * volume) * moment;
  }
  std::vector<Points> velocity;
  for (std::size_t g = 0; g < sum.wanted.size(); ++g)
    velocity.emplace_back(
        sum.wanted[g] ? Points(whole.middleCols(sum.first_target[g], sum.first_target[g + 1] - sum.first_target[g]))
                      : Points(3, 0));
  add_pairs(sum.pairs, *sum.split, scaled_coarse, scaled_fine, velocity);
  return velocity;
}

}  // namespace sim
