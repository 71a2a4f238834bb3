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

Box scaled(const Box& box, double cutoff) { return is_empty(box) ? box : Box{box.low / cutoff, box.high / cutoff}; }

std::optional<Eigen::Matrix3d> scaled_cell(const FastSetting& s) {
  if (!s.cell) return std::nullopt;
  return *s.cell / s.cutoff;
}

Vec3 middle_of(const Box& box) { return 0.5 * (box.low + box.high); }

/// That holds the boxes of all ranks.
Box united_of_ranks(const Box& mine, const Ranks& ranks) {
  if (ranks.count == 1) return mine;
  const std::array<double, 6> corners{mine.low[0], mine.low[1], mine.low[2], mine.high[0], mine.high[1], mine.high[2]};
  Box all = empty_box();
  for (const auto& theirs : ranks.gathered(corners))
    all = united(all, {{theirs.at(0), theirs.at(1), theirs.at(2)}, {theirs.at(3), theirs.at(4), theirs.at(5)}});
  return all;
}

/// The points of some targets go to the ranks in whose slabs they lie; here are those that came, by rank.
Points sent_home(const Points& points, std::span<const int> home, const Ranks& ranks,
                 std::vector<Eigen::Index>& count) {
  std::vector<std::vector<double>> messages(static_cast<std::size_t>(ranks.count));
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    std::vector<double>& message = messages[std::size_t(home[std::size_t(k)])];
    message.insert(message.end(), points.col(k).begin(), points.col(k).end());
  }
  messages = ranks.exchanged(messages);
  Eigen::Index total = 0;
  for (const auto& message : messages) {
    count.push_back(static_cast<Eigen::Index>(message.size()) / 3);
    total += count.back();
  }
  Points all(3, total);
  double* to = all.data();
  for (const auto& message : messages) to = std::copy(message.begin(), message.end(), to);
  return all;
}

}  // namespace

FastNeeds needs_of(const FastSetting& setting, const FastOutlines& outlines, std::span<const char> wanted,
                   FastParts& parts, const Ranks& ranks) {
  FastNeeds needs{std::vector<char>(outlines.coarse.size(), 1), std::vector<char>(outlines.coarse.size(), 1)};
  if (ranks.count == 1) return needs;
  Box all = empty_box();
  std::vector<Box> bodies, groups;
  for (const Box& box : outlines.coarse) all = united(all, scaled(box, setting.cutoff));
  for (const Box& box : outlines.both) bodies.push_back(scaled(box, setting.cutoff));
  for (std::size_t g = 0; g < outlines.groups.size(); ++g) {
    const Box box = scaled(outlines.groups[g], setting.cutoff);
    all = united(all, box);
    groups.push_back(wanted[g] ? box : empty_box());
  }
  renew(parts, setting, all.high - all.low);
  for (std::size_t j = 0; j < outlines.coarse.size(); ++j)
    needs.mesh[j] = parts.mesh->reaches_slab(scaled(outlines.coarse[j], setting.cutoff), middle_of(all), ranks);
  needs.pairs = near_bodies(bodies, groups, scaled_cell(setting));
  return needs;
}

FastSum plan_fast_sum(const FastSetting& setting, std::vector<FastBody> bodies, std::vector<FastGroup> groups,
                      const std::vector<Exclusion>& exclusions, bool dual, FastParts& parts, const Ranks& ranks) {
  std::vector<const Points*> sources, targets;
  const Points nothing(3, 0);
  FastSum sum;
  sum.arms.resize(bodies.size());
  for (std::size_t j = 0; j < bodies.size(); ++j) {
    FastBody& body = bodies[j];
    body.coarse /= setting.cutoff;
    body.fine /= setting.cutoff;
    body.fine_within /= setting.cutoff;
    sources.push_back(&body.coarse);
    sum.owner.push_back(body.owner);
    if (dual && setting.cell && body.owner == ranks.rank && body.coarse.cols() > 0)
      sum.arms[j] = body.coarse.colwise() - middle_of(box_of(body.coarse));
  }
  for (FastGroup& group : groups) {
    group.points /= setting.cutoff;
    targets.push_back(group.wanted ? &group.points : &nothing);
    sum.wanted.push_back(group.wanted);
  }
  const Points y = joined(sources), x = joined(targets);
  const Box all = united_of_ranks(united(box_of(y), box_of(x)), ranks);
  const Vec3 middle = middle_of(all);
  renew(parts, setting, all.high - all.low);
  Points corners(3, 2);
  corners << all.low, all.high;
  parts.mesh->homes(corners, middle, ranks);  // points that find no place on the mesh are refused by all ranks, or none
  sum.setting = setting;
  sum.dual = dual;
  sum.split = parts.split;
  sum.mesh = parts.mesh;
  sum.ranks = &ranks;
  sum.sources = parts.mesh->place_sources(y, middle, dual, ranks);
  if (ranks.count == 1) {
    sum.targets = parts.mesh->place_targets(x, middle);
  } else {
    sum.home = parts.mesh->homes(x, middle, ranks);
    sum.targets = parts.mesh->place_targets(sent_home(x, sum.home, ranks, sum.read_for), middle);
  }
  sum.pairs = plan_pairs(bodies, groups, exclusions, setting.single_precision, scaled_cell(setting));
  sum.first_source = firsts(sources);
  sum.first_target = firsts(targets);
  return sum;
}

namespace {

/// Velocities that were read off the mesh here go to the ranks whose targets they are; theirs come back.
Points handed_over(const FastSum& sum, const Points& read) {
  const Ranks& ranks = *sum.ranks;
  std::vector<std::vector<double>> messages;
  const double* from = read.data();
  for (const Eigen::Index count : sum.read_for) {
    messages.emplace_back(from, from + 3 * count);
    from += 3 * count;
  }
  messages = ranks.exchanged(messages);
  std::vector<std::size_t> next(messages.size());
  Points velocity(3, sum.first_target.back());
  for (Eigen::Index k = 0; k < velocity.cols(); ++k) {
    const auto home = static_cast<std::size_t>(sum.home[std::size_t(k)]);
    for (int c = 0; c < 3; ++c) velocity(c, k) = messages[home].at(next[home]++);
  }
  return velocity;
}

/// Of all bodies of all ranks, added in their order: in free space the force, in a cell sum y tr Q, y from the middle
/// of the body; and whether there are double layers.
struct Totals {
  Vec3 sum = Vec3::Zero();
  bool dual = false;
};
Totals totals_of(const FastSum& sum, std::span<const FastStrengths> strengths) {
  const Ranks& ranks = *sum.ranks;
  std::vector<double> mine{0};
  for (std::size_t j = 0; j < strengths.size(); ++j) {
    const FastStrengths& s = strengths[j];
    if (s.dual.cols() > 0) mine[0] = 1;
    if (sum.owner[j] != ranks.rank) continue;
    Vec3 of_body = Vec3::Zero();
    if (!sum.setting.cell) of_body = s.force.rowwise().sum();
    for (Eigen::Index k = 0; sum.setting.cell && k < s.dual.cols(); ++k)
      of_body += sum.arms[j].col(k) * (s.dual(0, k) + s.dual(3, k) + s.dual(5, k));
    mine.insert(mine.end(), of_body.begin(), of_body.end());
  }
  Totals totals;
  if (mine[0] != 0 && !sum.dual) throw std::invalid_argument("the fast sum was planned without double layers");
  if (sum.setting.cell && !sum.dual) return totals;  // nothing to ask for
  std::vector<std::vector<double>> all;
  if (ranks.count > 1)
    all = ranks.gathered(mine);
  else
    all.push_back(std::move(mine));
  std::vector<std::size_t> next(all.size(), 1);
  for (const auto& one : all) totals.dual = totals.dual || one.at(0) != 0;
  for (const int owner : sum.owner)
    for (int c = 0; c < 3; ++c) totals.sum[c] += all[std::size_t(owner)].at(next[std::size_t(owner)]++);
  return totals;
}

}  // namespace

std::vector<Points> fast_velocity(const FastSum& sum, std::vector<FastStrengths> coarse,
                                  std::vector<FastStrengths> fine) {
  const double per_length = 1 / sum.setting.cutoff, per_area = per_length * per_length;
  const auto bodies = static_cast<int>(coarse.size());
  parallel_for(bodies, [&](int j) {
    for (std::vector<FastStrengths>* all : {&coarse, &fine}) {
      (*all)[std::size_t(j)].force *= per_length;
      (*all)[std::size_t(j)].dual *= per_area;
    }
  });
  const Totals totals = totals_of(sum, coarse);
  const Eigen::Index count = sum.first_source.back();
  MeshStrengths strengths{Points(3, count), Tensors::Zero(6, totals.dual ? count : 0), totals.dual, totals.sum};
  parallel_for(bodies, [&](int j) {
    const FastStrengths& s = coarse[std::size_t(j)];
    const Eigen::Index first = sum.first_source[std::size_t(j)];
    strengths.force.middleCols(first, s.force.cols()) = s.force;
    if (s.dual.cols() > 0) strengths.dual.middleCols(first, s.dual.cols()) = s.dual;
  });
  Points whole = Points::Zero(3, static_cast<Eigen::Index>(sum.targets.point.size()));
  sum.mesh->add_velocity(sum.sources, strengths, sum.targets, whole, *sum.ranks);
  if (sum.ranks->count > 1) whole = handed_over(sum, whole);
  if (sum.setting.cell && totals.dual) {
    const double volume = std::abs(sum.setting.cell->determinant()) * std::pow(per_length, 3);
    whole.colwise() -= 4 * std::numbers::pi / (3 * volume) * totals.sum;
  }
  std::vector<Points> velocity;
  for (std::size_t g = 0; g < sum.wanted.size(); ++g)
    velocity.emplace_back(whole.middleCols(sum.first_target[g], sum.first_target[g + 1] - sum.first_target[g]));
  add_pairs(sum.pairs, *sum.split, totals.dual, coarse, fine, velocity);
  return velocity;
}

}  // namespace sim
