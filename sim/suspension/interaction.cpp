#include "sim/suspension/interaction.h"

#include "sim/core/divided.h"
#include "sim/layers/kernels.h"
#include "sim/layers/source_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

namespace sim {

namespace {

/// What all ranks know of the grids of a vesicle.
struct Outlines {
  std::vector<Outline> coarse, fine;
};
void transfer(Parcel& parcel, Box& box) { parcel(box.low), parcel(box.high); }

/// Vesicles of which targets may need more than the far field of another, both ways.
std::vector<PairPlan> candidates(const Outlines& outlines, const InteractionOptions& options, bool only_near) {
  std::vector<Box> boxes;
  double coarse_spacing = 0, fine_spacing = 0;
  Box all = empty_box();
  for (std::size_t i = 0; i < outlines.fine.size(); ++i) {
    const Outline &coarse = outlines.coarse[i], &fine = outlines.fine[i];
    boxes.push_back(united(fine.box, coarse.box));
    all = united(all, boxes.back());
    coarse_spacing = std::max(coarse_spacing, coarse.spacing);
    fine_spacing = std::max(fine_spacing, fine.spacing);
  }
  const double reach = only_near                     ? options.near_spacings * fine_spacing
                       : options.coarse_spacings > 0 ? options.coarse_spacings * coarse_spacing
                                                     : (all.high - all.low).norm();
  std::vector<PairPlan> pairs;
  for (const ImagePair& p : near_images(boxes, reach, options.far.cell)) {
    const Vec3 shift = p.shift(options.far.cell);
    pairs.push_back({p.first, p.second, p.image, shift, {}, {}, {}});
    pairs.push_back({p.second, p.first, -p.image, -shift, {}, {}, {}});
  }
  const auto key = [](const PairPlan& p) { return std::tuple(p.target, p.source, p.image[0], p.image[1], p.image[2]); };
  std::sort(pairs.begin(), pairs.end(), [&](const PairPlan& a, const PairPlan& b) { return key(a) < key(b); });
  return pairs;
}

NearOrder near_order(const InteractionOptions& options, int degree) {
  constexpr double finest = 1e-6;  // the least tolerance of a run
  NearOrder order = near_order_for(degree, std::max(options.far.tolerance, finest));
  if (options.near_order.latitudes > 0) order.latitudes = options.near_order.latitudes;
  if (options.near_order.longitudes > 0) order.longitudes = options.near_order.longitudes;
  return order;
}

/// A vesicle as near points and rows ask of it.
struct NearSource {
  const Coefficients& position;
  PointSampler surface;
  const RotationPlan& rotation;
  const NearRule& rule;
  SourceTiles tiles;
};

/// Sorts the targets of a pair: those that need the fine grid, and those that need rows.
void fill(PairPlan& pair, const Interaction& w, const NearSource& source_surface, const InteractionOptions& options,
          bool only_near) {
  const int j = pair.source;
  const Sources& s = w.sources[j];
  const Matrix& targets = w.far.groups[pair.target].points;
  const auto& [position, surface, rotation, rule, tiles] = source_surface;
  const double reach = options.near_spacings * s.spacing.maxCoeff();
  const double coarse_reach = only_near ? 0 : options.coarse_spacings * (*w.far.sources)[j].spacing.maxCoeff();
  for (int k = 0; k < int(targets.rows()); ++k) {
    const Vec3 x = targets.row(k).transpose() - pair.shift;  // the image as seen from where its vesicle is
    const double to_box = distance(s.box, x);
    if (only_near ? to_box >= reach : coarse_reach > 0 && to_box >= coarse_reach) continue;
    if (options.near_rule && to_box < reach) {
      const auto [source, away] = nearest_source(tiles, x);
      if (away < (options.near_spacings + 1) * s.spacing[source]) {
        const NearestPoint nearest = nearest_point(surface, x, grid_direction(*w.source_basis[j], source));
        if (nearest.inside)
          throw std::domain_error(pair.target == j ? fmt::format("vesicle {} crosses its own image", j)
                                                   : fmt::format("vesicle {} crosses vesicle {}", pair.target, j));
        if (nearest.distance < options.near_spacings * s.spacing[source]) {
          pair.near.push_back(k);
          pair.rows.push_back(near_row(rule, rotation, position, x, nearest, w.dual[j]));
          continue;
        }
      }
    }
    if (!only_near) pair.fine.push_back(k);
  }
}

/// Targets of all pairs, whose smooth coarse value does not count.
std::vector<Exclusion> exclusions(const std::vector<PairPlan>& pairs) {
  std::vector<Exclusion> all;
  for (const PairPlan& pair : pairs) {
    Exclusion e{pair.target, pair.source, {}, pair.image};
    std::merge(pair.fine.begin(), pair.fine.end(), pair.near.begin(), pair.near.end(), std::back_inserter(e.targets));
    all.push_back(std::move(e));
  }
  return all;
}

/// Weighted densities as the fast sum takes them.
FastStrengths strengths_of(const Sources& s, const SourceDensities& density) {
  FastStrengths strengths;
  strengths.force = stokeslet_factor * (density.force.array().colwise() * s.area.array()).matrix().transpose();
  if (density.dual.size() == 0) return strengths;
  strengths.dual.resize(6, s.area.size());
  const Points n = stresslet_factor * s.normals.transpose(), u = density.dual.transpose();
  int c = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b, ++c)
      strengths.dual.row(c) = 0.5 * (n.row(a).cwiseProduct(u.row(b)) + n.row(b).cwiseProduct(u.row(a)));
  return strengths;
}

/// Of sources whose points the fast sum has, what makes strengths of densities, if there are any.
void keep_weights(Sources& s, bool strengths, bool dual) {
  s.points.resize(0, 3);
  s.spacing.resize(0);
  if (!strengths) s.area.resize(0);
  if (!strengths || !dual) s.normals.resize(0, 3);
}

FastInteraction plan_fast(Plans& plans, Interaction& w, std::span<const Coefficients> positions,
                          const FastChoice& choice, const std::vector<Exclusion>& excluded, const Outlines& outlines,
                          double tolerance) {
  const auto n = static_cast<int>(positions.size());
  const Ranks& ranks = w.division.whole() ? alone : *w.division.ranks;
  FastInteraction fast;
  fast.spread.resize(std::size_t(n));
  for (const Coefficients& x : positions)
    fast.spread_basis.push_back(&plans.basis(x.order, spread_order(x.order, choice.finer)));
  const auto spread = [&](int k) {
    fast.spread[std::size_t(k)] = make_sources(*fast.spread_basis[std::size_t(k)], positions[std::size_t(k)]);
  };
  FastOutlines boxes{std::vector<Box>(std::size_t(n)), {}, {}};
  divided_for(
      w.division, n,
      [&](int k) {
        spread(k);
        boxes.coarse[std::size_t(k)] = fast.spread[std::size_t(k)].box;
      },
      [&](Parcel& parcel, int k) { transfer(parcel, boxes.coarse[std::size_t(k)]); });
  std::vector<char> mine;
  for (std::size_t k = 0; k < std::size_t(n); ++k) {
    mine.push_back(w.division.mine(int(k)));
    boxes.both.push_back(united(boxes.coarse[k], outlines.fine[k].box));
    boxes.groups.push_back(outlines.coarse[k].box);
  }
  const bool dual = std::any_of(w.dual.begin(), w.dual.end(), [](char d) { return d != 0; });
  fast.sum = plans.with_fast_parts([&](FastParts& parts) {
    FastNeeds needs = needs_of(choice.setting, boxes, mine, parts, ranks);
    for (const PairPlan& pair : w.pairs) needs.pairs[std::size_t(pair.source)] = 1;
    std::vector<FastBody> bodies(static_cast<std::size_t>(n));
    std::vector<FastGroup> groups(static_cast<std::size_t>(n));
    parallel_for(n, [&](int i) {
      const auto k = std::size_t(i);
      groups[k] = {mine[k] ? Points(w.far.groups[k].points.transpose()) : Points(3, 0), i, mine[k] != 0};
      bodies[k] = {Points(3, 0), Points(3, 0), 0, w.division.whole() ? 0 : w.division.owner[k]};
      if (!mine[k] && !needs.mesh[k] && !needs.pairs[k]) return;
      if (!mine[k]) spread(i);
      bodies[k].coarse = fast.spread[k].points.transpose();
      if (!mine[k] && !needs.pairs[k]) return;
      if (w.sources[k].points.rows() == 0) w.sources[k] = make_sources(*w.source_basis[k], positions[k]);
      bodies[k].fine = w.sources[k].points.transpose();
      bodies[k].fine_within = coarse_limit(tolerance) * fast.spread[k].spacing.maxCoeff();
    });
    return plan_fast_sum(choice.setting, std::move(bodies), std::move(groups), excluded, dual, parts, ranks);
  });
  fast.finely.resize(std::size_t(n));
  for (const PairLists::Group& group : fast.sum.pairs.groups)
    for (const PairLists::Segment& segment : group.segments)
      if (segment.level == 1) fast.finely[std::size_t(segment.body)] = 1;
  parallel_for(n, [&](int i) {
    const auto k = std::size_t(i);
    keep_weights(fast.spread[k], true, w.dual[k]);
    keep_weights(w.sources[k], fast.finely[k], w.dual[k]);
  });
  return fast;
}

/// Tells the owners of all vesicles who needs their densities.
void ask_for_densities(Interaction& w) {
  if (w.division.whole()) return;
  const Ranks& ranks = *w.division.ranks;
  std::vector<std::vector<double>> messages(static_cast<std::size_t>(ranks.count));
  for (std::size_t k = 0; k < w.dual.size(); ++k)
    if (w.felt[k] && !w.division.mine(int(k))) messages[std::size_t(w.division.owner[k])].push_back(double(k));
  for (const auto& numbers : ranks.exchanged(messages)) {
    std::vector<int>& asked = w.asked_by.emplace_back();
    for (const double k : numbers) asked.push_back(static_cast<int>(k));
  }
}

}  // namespace

Interaction plan_interaction(Plans& plans, std::span<const Coefficients> positions, std::span<const Material> materials,
                             const InteractionOptions& options) {
  Interaction w;
  w.division = options.division;
  const int n = int(positions.size());
  if (n == 0 || (n < 2 && !options.far.cell)) return w;
  for (int i = 0; i < n; ++i) {
    const int p = positions[i].order;
    w.source_basis.push_back(&plans.basis(p, smooth_order(p, options.source_order)));
    w.target_basis.push_back(&plans.basis(p, p + 1));
    w.dual.push_back(materials[i].viscosity_contrast != 1);
  }
  w.sources.resize(n);
  std::vector<Sources> coarse(n);
  Outlines outlines{std::vector<Outline>(std::size_t(n)), std::vector<Outline>(std::size_t(n))};
  divided_for(
      w.division, n,
      [&](int i) {
        w.sources[i] = make_sources(*w.source_basis[i], positions[i]);
        coarse[i] = make_sources(*w.target_basis[i], positions[i]);
        outlines.coarse[i] = outline_of(coarse[i]);
        outlines.fine[i] = outline_of(w.sources[i]);
      },
      [&](Parcel& parcel, int i) {
        for (Outline* outline : {&outlines.coarse[i], &outlines.fine[i]})
          transfer(parcel, outline->box), parcel(outline->spacing);
      });
  std::vector<TargetGroup> groups;
  for (int i = 0; i < n; ++i) groups.push_back({coarse[i].points, i});
  // Without a cell sums may be direct, and the choice looks at the points of all.
  if (!options.far.cell)
    parallel_for(n, [&](int i) {
      if (!w.division.mine(i)) coarse[i] = make_sources(*w.target_basis[i], positions[i]);
    });
  std::vector<int> orders;
  double fine_points = 0;
  for (int i = 0; i < n; ++i) {
    orders.push_back(positions[i].order);
    fine_points += w.source_basis[i]->points();
  }
  const bool dual = std::any_of(w.dual.begin(), w.dual.end(), [](char d) { return d != 0; });
  const std::optional<FastChoice> fast = choose_fast({orders, outlines.coarse, fine_points, dual, coarse}, options.far);
  if (fast) coarse.clear();
  w.far = plan_far_field(std::make_shared<const std::vector<Sources>>(std::move(coarse)), std::move(groups));
  const bool only_near = fast.has_value();
  w.pairs = candidates(outlines, options, only_near);
  Division of_pairs{w.division.ranks, {}};
  if (!w.division.whole())
    for (const PairPlan& pair : w.pairs) of_pairs.owner.push_back(w.division.owner[pair.target]);
  std::map<int, NearRule> rules;  // by degree
  for (const Coefficients& x : positions)
    if (!rules.contains(x.order)) rules.emplace(x.order, near_rule(x.order, near_order(options, x.order)));
  std::vector<std::optional<NearSource>> near(static_cast<std::size_t>(n));  // of whom this rank's vesicles are near
  for (const PairPlan& pair : w.pairs)
    if (const int j = pair.source; w.division.mine(pair.target) && !near[j]) {
      if (!w.division.mine(j)) w.sources[j] = make_sources(*w.source_basis[j], positions[j]);
      near[j].emplace(NearSource{positions[j], PointSampler(positions[j]), plans.rotation(positions[j].order),
                                 rules.at(positions[j].order), make_tiles(*w.source_basis[j], w.sources[j])});
    }
  divided_for(of_pairs, int(w.pairs.size()),
              [&](int k) { fill(w.pairs[k], w, *near[w.pairs[k].source], options, only_near); });
  std::erase_if(w.pairs, [](const PairPlan& pair) { return pair.fine.empty() && pair.near.empty(); });
  w.pairs.shrink_to_fit();  // of those of all
  const std::vector<Exclusion> excluded = exclusions(w.pairs);
  if (fast) {
    w.fast = std::make_shared<const FastInteraction>(
        plan_fast(plans, w, positions, *fast, excluded, outlines, options.far.tolerance));
    for (const Sources& s : w.fast->spread) w.felt.push_back(s.area.size() > 0);
  } else {
    exclude(w.far, excluded);
    w.felt.assign(std::size_t(n), 1);
  }
  ask_for_densities(w);
  return w;
}

namespace {

/// What all see of all but the near pairs: points x 3 a vesicle.
std::vector<Matrix> fast_far_velocity(const Interaction& w, std::span<const Densities> densities) {
  const FastInteraction& fast = *w.fast;
  const std::size_t n = densities.size();
  std::vector<FastStrengths> spread(n), fine(n);
  parallel_for(int(n), [&](int i) {
    const auto j = std::size_t(i);
    if (!w.felt[j]) return;
    const auto strengths = [&](const Basis& basis, const Sources& sources) {
      return strengths_of(sources, {basis.synthesize(densities[j].force).values,
                                    w.dual[j] ? basis.synthesize(densities[j].dual).values : Matrix()});
    };
    spread[j] = strengths(*fast.spread_basis[j], fast.spread[j]);
    if (fast.finely[j]) fine[j] = strengths(*w.source_basis[j], w.sources[j]);
  });
  const std::vector<Points> velocity = fast_velocity(fast.sum, std::move(spread), std::move(fine));
  std::vector<Matrix> result;
  for (const Points& u : velocity) result.emplace_back(u.transpose());
  return result;
}

/// The densities of other ranks' vesicles that this one's feel.
void hand_round(const Interaction& w, std::vector<Densities>& densities) {
  if (w.division.whole()) return;
  const auto carry = [&](Parcel& parcel, int k) {
    parcel(densities[k].force);
    if (w.dual[k]) parcel(densities[k].dual);
  };
  std::vector<std::vector<double>> messages;
  for (const std::vector<int>& asked : w.asked_by) {
    Parcel parcel;
    for (const int k : asked) carry(parcel, k);
    messages.emplace_back(parcel.numbers().begin(), parcel.numbers().end());
  }
  messages = w.division.ranks->exchanged(messages);
  std::vector<Parcel> theirs;
  for (const auto& one : messages) theirs.emplace_back(one);
  for (int k = 0; k < int(densities.size()); ++k)
    if (w.felt[k] && !w.division.mine(k)) carry(theirs[std::size_t(w.division.owner[k])], k);
}

}  // namespace

std::vector<Coefficients> induced_velocity(const Interaction& w, std::vector<Densities> densities) {
  const int n = int(densities.size());
  hand_round(w, densities);
  std::vector<SourceDensities> coarse(n), fine(n);
  std::vector<Matrix> velocity;
  if (w.fast) {
    velocity = fast_far_velocity(w, densities);
  } else {
    std::vector<char> finely(n);  // few need both
    for (const PairPlan& pair : w.pairs) finely[pair.source] = finely[pair.source] || !pair.fine.empty();
    parallel_for(n, [&](int j) {
      const auto sample = [&](const Basis& basis, SourceDensities& samples) {
        samples.force = basis.synthesize(densities[j].force).values;
        if (w.dual[j]) samples.dual = basis.synthesize(densities[j].dual).values;
      };
      sample(*w.target_basis[j], coarse[j]);
      if (finely[j]) sample(*w.source_basis[j], fine[j]);
    });
    velocity = far_velocity(w.far, coarse);
  }
  std::vector<Coefficients> result(n);
  parallel_for(n, [&](int i) {
    if (!w.division.mine(i)) return;
    const Matrix& targets = w.far.groups[i].points;
    auto pair = std::partition_point(w.pairs.begin(), w.pairs.end(), [i](const PairPlan& p) { return p.target < i; });
    for (; pair != w.pairs.end() && pair->target == i; ++pair) {
      const int j = pair->source;
      if (!pair->fine.empty()) {
        Matrix sum = Matrix::Zero(Eigen::Index(pair->fine.size()), 3);
        add_direct_sum(w.sources[j], fine[j], targets(pair->fine, Eigen::seqN(0, 3)), sum);
        for (std::size_t k = 0; k < pair->fine.size(); ++k) velocity[i].row(pair->fine[k]) += sum.row(Eigen::Index(k));
      }
      for (std::size_t k = 0; k < pair->near.size(); ++k) {
        Vec3 v = apply_row(pair->rows[k].single, densities[j].force.values);
        if (w.dual[j]) v += apply_row(pair->rows[k].dual, densities[j].dual.values);
        velocity[i].row(pair->near[k]) += v.transpose();
      }
    }
    result[i] = w.target_basis[i]->analyze(velocity[i]);
  });
  return result;
}

}  // namespace sim
