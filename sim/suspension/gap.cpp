#include "sim/suspension/gap.h"

#include "sim/core/divided.h"
#include "sim/layers/near.h"
#include "sim/layers/source_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace sim {

double winding(const Sources& s, const Vec3& x) {
  double sum = 0;
  for (Eigen::Index k = 0; k < s.points.rows(); ++k) {
    const Vec3 r = s.points.row(k).transpose() - x;
    sum += s.normals.row(k).dot(r) / std::pow(r.squaredNorm(), 1.5);
  }
  return sum / (4 * std::numbers::pi);
}

namespace {

/// Two parameters on two surfaces.
struct Approach {
  Vec3 s, t;
  double distance = 0;
};

/// Slope and curvature of |x(s) + shift - y(t)|^2 / 2 along great circles through s and t.
struct Bowl {
  Eigen::Vector4d slope;
  Eigen::Matrix4d curvature;
};
Bowl bowl(const PointTangents& x, const PointTangents& y, const Vec3& shift) {
  const Vec3 d = x.x + shift - y.x;
  Eigen::Matrix<double, 3, 4> tangents;
  tangents << x.a, x.b, -y.a, -y.b;
  Bowl b{tangents.transpose() * d, tangents.transpose() * tangents};
  b.curvature(0, 0) += x.aa.dot(d);
  b.curvature(1, 1) += x.bb.dot(d);
  b.curvature(0, 1) = b.curvature(1, 0) += x.ab.dot(d);
  b.curvature(2, 2) -= y.aa.dot(d);
  b.curvature(3, 3) -= y.bb.dot(d);
  b.curvature(2, 3) = b.curvature(3, 2) -= y.ab.dot(d);
  return b;
}

/// Newton's method for the least distance of the first surface, shifted, from the second; a step that does not come
/// nearer is halved.
Approach nearest_approach(const PointSampler& first, const PointSampler& second, const Vec3& shift, Approach at) {
  PointTangents x = first.tangents(at.s), y = second.tangents(at.t);
  at.distance = (x.x + shift - y.x).norm();
  for (int iteration = 0; iteration < 30; ++iteration) {
    const auto [slope, curvature] = bowl(x, y, shift);
    // Directions of negative or no curvature are walked down by their size.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(curvature);
    const Eigen::Vector4d size =
        eigen.eigenvalues().cwiseAbs().cwiseMax(1e-6 * eigen.eigenvalues().cwiseAbs().maxCoeff());
    Eigen::Vector4d step = -eigen.eigenvectors() * (eigen.eigenvectors().transpose() * slope).cwiseQuotient(size);
    if (step.norm() > 0.2) step *= 0.2 / step.norm();
    bool nearer = false;
    for (int half = 0; half < 20 && !nearer; ++half, step /= 2) {
      Approach trial{(at.s + step[0] * x.e1 + step[1] * x.e2).normalized(),
                     (at.t + step[2] * y.e1 + step[3] * y.e2).normalized()};
      const PointTangents u = first.tangents(trial.s), v = second.tangents(trial.t);
      trial.distance = (u.x + shift - v.x).norm();
      if (trial.distance < at.distance) {
        nearer = at.distance - trial.distance > 1e-14 * at.distance;
        at = trial;
        if (!nearer) return at;
        x = u;
        y = v;
      }
    }
    if (!nearer) break;
  }
  return at;
}

/// A surface with the source grid on which gaps are looked for.
struct Surface {
  PointSampler sampler;
  const Basis& basis;
  Sources sources;
  SourceTiles tiles;
};

/// The nearest pair of source points of a surface, shifted, and another one.
struct NearestSources {
  double distance;
  Eigen::Index first = 0, second = 0;
};
NearestSources nearest_sources(const Surface& a, const Vec3& shift, const Surface& b) {
  NearestSources nearest{std::numeric_limits<double>::infinity()};
  for (Eigen::Index k = 0; k < a.sources.points.rows(); ++k) {
    const Vec3 x = a.sources.points.row(k).transpose() + shift;
    if (distance(b.sources.box, x) >= nearest.distance) continue;
    if (const auto [l, d] = nearest_source(b.tiles, x, nearest.distance); l >= 0) nearest = {d, k, l};
  }
  return nearest;
}

/// Does one hold points of the other? Their boxes overlap.
bool overlaps(const Sources& a, const Vec3& shift, const Sources& b) {
  const Vec3 first = a.points.row(0).transpose() + shift, second = b.points.row(0).transpose() - shift;
  if (winding(b, first) > 0.5 || winding(a, second) > 0.5) return true;
  for (Eigen::Index k = 0; k < a.points.rows(); k += 7)
    if (const Vec3 x = a.points.row(k).transpose() + shift; distance(b.box, x) == 0 && winding(b, x) > 0.9) return true;
  return false;
}

/// Of a surface, shifted, and another one: the nearest pair of source points, then Newton on the two spectral surfaces.
Gap gap_between(const Surface& a, const Vec3& shift, const Surface& b, int first, int second) {
  const NearestSources nearest = nearest_sources(a, shift, b);
  Gap gap{nearest.distance, first, second, false};
  const double spacing = b.sources.spacing[nearest.second];
  if (nearest.distance < 3 * std::max(a.sources.spacing[nearest.first], spacing)) {
    const Approach approach = nearest_approach(
        a.sampler, b.sampler, shift,
        {grid_direction(a.basis, nearest.first), grid_direction(b.basis, nearest.second), nearest.distance});
    const Vec3 x = a.sampler.position(approach.s) + shift;
    gap.distance = approach.distance;
    // Where they cross, the least distance is zero up to rounding and has no side.
    constexpr double touching = 1e-5;  // of the spacing: what the search for a zero distance leaves
    gap.crossing = gap.distance < touching * spacing || nearest_point(b.sampler, x, approach.t).inside;
  }
  // Where boxes overlap one surface may hold the other, or they may cross by far.
  const Box box{a.sources.box.low + shift, a.sources.box.high + shift};
  if (!gap.crossing && distance(box, b.sources.box) == 0) gap.crossing = overlaps(a.sources, shift, b.sources);
  if (gap.crossing) gap.distance = 0;
  return gap;
}

Surface searched(Plans& plans, const Coefficients& position) {
  const Basis& basis = plans.basis(position.order, smooth_order(position.order));
  Sources sources = make_sources(basis, position);
  SourceTiles tiles = make_tiles(basis, sources);
  return {PointSampler(position), basis, std::move(sources), std::move(tiles)};
}

/// The surfaces of a suspension with all that a search for gaps asks of them. Each rank has those near its own ones.
struct Search {
  Plans& plans;
  std::span<const Coefficients> positions;
  Division division;                             ///< of the vesicles
  std::vector<std::optional<Surface>> surfaces;  ///< as far as they have been asked for
  std::vector<Box> boxes;                        ///< of all
  CellSides cell;
  double spacing = 0;  ///< largest of the source grids
  double extent = 0;   ///< some two membranes, or all, are no farther apart

  void ask_for(int k) { surfaces[std::size_t(k)].emplace(searched(plans, positions[std::size_t(k)])); }
};

Search search_among(Plans& plans, std::span<const Coefficients> positions, const CellSides& cell, const Ranks& ranks) {
  const int n = int(positions.size());
  std::vector<Vec3> places;
  std::vector<double> weights;
  for (const Coefficients& x : positions) {
    places.emplace_back(x.values.row(0).transpose());
    weights.push_back(plans.basis(x.order, smooth_order(x.order)).points());
  }
  Search search{plans, positions, divided(ranks, places, weights), {}, {}, cell};
  search.surfaces.resize(n);
  search.boxes.resize(n);
  std::vector<double> spacings(n);
  divided_for(
      search.division, n,
      [&](int i) {
        search.ask_for(i);
        search.boxes[i] = search.surfaces[i]->sources.box;
        spacings[i] = search.surfaces[i]->sources.spacing.maxCoeff();
      },
      [&](Parcel& parcel, int i) { parcel(search.boxes[i].low), parcel(search.boxes[i].high), parcel(spacings[i]); });
  Box all = search.boxes[0];
  for (const Box& box : search.boxes) all = united(all, box);
  search.spacing = *std::max_element(spacings.begin(), spacings.end());
  search.extent = cell ? cell->colwise().norm().minCoeff() : (all.high - all.low).norm();
  return search;
}

/// Of all pairs whose boxes are no farther apart than `reach`.
std::vector<Gap> gaps_of_pairs(Search& search, double reach) {
  const auto pairs = near_images(search.boxes, reach, search.cell);
  std::vector<Gap> gaps(pairs.size());
  Division of_pairs{search.division.ranks, {}};
  std::vector<int> missing;
  if (!search.division.whole())
    for (const ImagePair& pair : pairs) {
      of_pairs.owner.push_back(search.division.owner[pair.first]);
      if (search.division.mine(pair.first) && !search.surfaces[pair.second]) missing.push_back(pair.second);
    }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  parallel_for(int(missing.size()), [&](int i) { search.ask_for(missing[i]); });
  const auto look = [&](int k) {
    const ImagePair& pair = pairs[k];
    const Surface &first = *search.surfaces[pair.first], &second = *search.surfaces[pair.second];
    gaps[k] = gap_between(second, pair.shift(search.cell), first, pair.first, pair.second);
  };
  divided_for(of_pairs, int(pairs.size()), look, [&](Parcel& parcel, int k) {
    Gap& gap = gaps[k];
    parcel(gap.distance), parcel(gap.first), parcel(gap.second), parcel(gap.crossing);
  });
  return gaps;
}

}  // namespace

std::string pair_name(const Gap& gap) {
  return gap.first == gap.second ? fmt::format("vesicle {} and its own image", gap.first)
                                 : fmt::format("vesicles {} and {}", gap.first, gap.second);
}

Gap smallest_gap(Plans& plans, std::span<const Coefficients> positions, const CellSides& cell, const Ranks& ranks) {
  Gap best{std::numeric_limits<double>::infinity(), -1, -1, false};
  if (positions.empty() || (positions.size() < 2 && !cell)) return best;
  Search search = search_among(plans, positions, cell, ranks);
  // Pairs whose boxes are farther apart than the least gap found so far cannot have a smaller one.
  for (double reach = search.spacing;; reach *= 4) {
    const bool last = reach > search.extent;
    for (const Gap& gap : gaps_of_pairs(search, search.cell ? std::min(reach, search.extent) : reach))
      if (gap.distance < best.distance) best = gap;
    if (best.distance <= reach || last) return best;
  }
}

Gap gap_of_two(Plans& plans, const Coefficients& first, const Coefficients& second) {
  return gap_between(searched(plans, second), Vec3::Zero(), searched(plans, first), 0, 1);
}

std::vector<double> gaps_to_neighbours(Plans& plans, std::span<const Coefficients> positions, double reach,
                                       const CellSides& cell, const Ranks& ranks) {
  std::vector<double> least(positions.size(), std::numeric_limits<double>::infinity());
  if (positions.size() < 2 && !cell) return least;
  Search search = search_among(plans, positions, cell, ranks);
  for (const Gap& gap : gaps_of_pairs(search, reach))
    for (const int k : {gap.first, gap.second}) least[k] = std::min(least[k], gap.distance);
  return least;
}

}  // namespace sim
