#include "sim/suspension/interaction.h"

#include "sim/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sim {

namespace {

/// Vesicles of which targets may need more than the coarse grid of another, both ways.
std::vector<PairPlan> candidates(const Interaction& w, double coarse_spacings) {
  const std::vector<Sources>& coarse = *w.far.sources;
  std::vector<Box> boxes;
  double spacing = 0;
  for (std::size_t i = 0; i < w.sources.size(); ++i) {
    boxes.push_back(united(w.sources[i].box, coarse[i].box));
    spacing = std::max(spacing, coarse[i].spacing.maxCoeff());
  }
  Box all = boxes.front();
  for (const Box& box : boxes) all = united(all, box);
  const double reach = coarse_spacings > 0 ? coarse_spacings * spacing : (all.high - all.low).norm();
  std::vector<PairPlan> pairs;
  for (const auto& [i, j] : near_pairs(boxes, reach)) {
    pairs.push_back({i, j, {}, {}, {}, {}});
    pairs.push_back({j, i, {}, {}, {}, {}});
  }
  std::sort(pairs.begin(), pairs.end(), [](const PairPlan& a, const PairPlan& b) {
    return std::pair(a.target, a.source) < std::pair(b.target, b.source);
  });
  return pairs;
}

/// Sorts the targets of a pair: those that need the fine grid, and those that need rows.
void fill(PairPlan& pair, const Interaction& w, std::span<const Coefficients> positions, const RotationPlan& rotation,
          const InteractionOptions& options) {
  const int j = pair.source;
  const Sources& s = w.sources[j];
  const Matrix& targets = w.far.groups[pair.target].points;
  const double reach = options.near_spacings * s.spacing.maxCoeff();
  const double coarse_reach = options.coarse_spacings * (*w.far.sources)[j].spacing.maxCoeff();
  for (int k = 0; k < int(targets.rows()); ++k) {
    const Vec3 x = targets.row(k).transpose();
    const double to_box = distance(s.box, x);
    if (coarse_reach > 0 && to_box >= coarse_reach) continue;
    if (options.near_rule && to_box < reach) {
      const auto [source, away] = nearest_source(s, x);
      if (away < (options.near_spacings + 1) * s.spacing[source]) {
        const NearestPoint nearest = nearest_point(positions[j], x, grid_direction(*w.source_basis[j], source));
        if (nearest.inside) throw std::domain_error(fmt::format("vesicle {} crosses vesicle {}", pair.target, j));
        if (nearest.distance < options.near_spacings * s.spacing[source]) {
          pair.near.push_back(k);
          pair.rows.push_back(near_row(rotation, positions[j], x, nearest, options.near_order, w.dual[j]));
          pair.nearest.push_back(nearest);
          continue;
        }
      }
    }
    pair.fine.push_back(k);
  }
}

/// Targets of all pairs, whose smooth coarse value does not count.
std::vector<Exclusion> exclusions(const std::vector<PairPlan>& pairs) {
  std::vector<Exclusion> all;
  for (const PairPlan& pair : pairs) {
    Exclusion e{pair.target, pair.source, {}};
    std::merge(pair.fine.begin(), pair.fine.end(), pair.near.begin(), pair.near.end(), std::back_inserter(e.targets));
    all.push_back(std::move(e));
  }
  return all;
}

}  // namespace

Interaction plan_interaction(Plans& plans, std::span<const Coefficients> positions, std::span<const Material> materials,
                             const InteractionOptions& options) {
  Interaction w;
  const int n = int(positions.size());
  if (n < 2) return w;
  std::vector<const RotationPlan*> rotations;
  for (int i = 0; i < n; ++i) {
    const int p = positions[i].order;
    w.source_basis.push_back(&plans.basis(p, smooth_order(p, options.source_order)));
    w.target_basis.push_back(&plans.basis(p, p + 1));
    rotations.push_back(&plans.rotation(p));
    w.dual.push_back(materials[i].viscosity_contrast != 1);
  }
  w.sources.resize(n);
  std::vector<Sources> coarse(n);
  parallel_for(n, [&](int i) {
    w.sources[i] = make_sources(*w.source_basis[i], positions[i]);
    coarse[i] = make_sources(*w.target_basis[i], positions[i]);
  });
  std::vector<TargetGroup> groups;
  for (int i = 0; i < n; ++i) groups.push_back({coarse[i].points, i});
  w.far = plan_far_field(std::make_shared<const std::vector<Sources>>(std::move(coarse)), std::move(groups));
  w.pairs = candidates(w, options.coarse_spacings);
  parallel_for(int(w.pairs.size()),
               [&](int k) { fill(w.pairs[k], w, positions, *rotations[w.pairs[k].source], options); });
  std::erase_if(w.pairs, [](const PairPlan& pair) { return pair.fine.empty() && pair.near.empty(); });
  exclude(w.far, exclusions(w.pairs));
  return w;
}

std::vector<Coefficients> induced_velocity(const Interaction& w, std::span<const Densities> densities) {
  const int n = int(densities.size());
  std::vector<SourceDensities> coarse(n), fine(n);
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
  std::vector<Matrix> velocity = far_velocity(w.far, coarse);
  std::vector<Coefficients> result(n);
  parallel_for(n, [&](int i) {
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

std::vector<Coefficients> repulsion(const Interaction& w, double strength, double range) {
  const std::size_t n = w.far.groups.size();
  std::vector<Matrix> force;
  for (const TargetGroup& group : w.far.groups) force.push_back(Matrix::Zero(group.points.rows(), 3));
  for (const PairPlan& pair : w.pairs)
    for (std::size_t k = 0; k < pair.near.size(); ++k) {
      const NearestPoint& nearest = pair.nearest[k];
      const int row = pair.near[k];
      force[pair.target].row(row) +=
          strength * std::exp(-nearest.distance / range) *
          (w.far.groups[pair.target].points.row(row) - nearest.position.transpose()).normalized();
    }
  std::vector<Coefficients> result;
  for (std::size_t i = 0; i < n; ++i) result.push_back(w.target_basis[i]->analyze(force[i]));
  return result;
}

}  // namespace sim
