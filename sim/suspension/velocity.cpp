#include "sim/suspension/velocity.h"

#include "sim/core/parallel.h"
#include "sim/suspension/loads.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sim {

namespace {

FlowSource::Level level(Plans& plans, const FlowSource& source, int order) {
  const Basis& basis = plans.basis(source.position.order, order);
  FlowSource::Level l;
  l.sources = make_sources(basis, source.position);
  l.densities.force = basis.synthesize(source.densities.force).values;
  if (source.viscosity_contrast != 1) l.densities.dual = basis.synthesize(source.densities.dual).values;
  return l;
}

/// How points see one membrane.
struct View {
  std::vector<int> near;                                                               ///< by the near rule
  std::array<std::vector<int>, std::tuple_size_v<decltype(FlowSource::finer)>> finer;  ///< by finer grids
  std::vector<Vec3> start;  ///< for the near ones: where to look
};

/// The rest of a block of points sees the coarse grids.
struct PointBlock {
  Matrix points;
  std::vector<View> views;                     ///< by membrane
  Vector distance;                             ///< to the nearest membrane
  std::vector<int> within;                     ///< the vesicle that contains the point, -1 outside all
  std::vector<std::pair<int, Vec3>> touching;  ///< points on a membrane, and its velocity there
};

/// Sorts points by how far they are from each membrane.
PointBlock sorted(const FlowField& field, Matrix points) {
  const int count = int(points.rows());
  PointBlock block{std::move(points),
                   std::vector<View>(field.sources.size()),
                   Vector::Constant(count, std::numeric_limits<double>::infinity()),
                   std::vector<int>(count, -1),
                   {}};
  for (std::size_t j = 0; j < field.sources.size(); ++j) {
    const Sources& coarse = (*field.coarse)[j];
    View& view = block.views[j];
    for (int k = 0; k < count; ++k) {
      const Vec3 x = block.points.row(k).transpose();
      const auto [at, away] = nearest_source(coarse, x);
      // The membrane may come nearer between source points: the nearest is at most half a diagonal of a cell off.
      const double spacing = coarse.spacing[at], distance = away - 0.71 * spacing;
      std::size_t halvings = 0;
      while (halvings <= view.finer.size() && distance < field.options.spacings * std::ldexp(spacing, -int(halvings)))
        ++halvings;
      if (halvings > view.finer.size()) {
        view.near.push_back(k);
        view.start.push_back(field.sources[j].directions.row(at).transpose());
        continue;
      }
      if (halvings > 0) view.finer[halvings - 1].push_back(k);
      block.distance[k] = std::min(block.distance[k], distance);
      if ((x - coarse.points.row(at).transpose()).dot(coarse.normals.row(at)) < 0) block.within[k] = int(j);
    }
  }
  return block;
}

/// All points of a block that do not see the coarse grid of membrane j.
std::vector<int> excluded(const View& view) {
  std::vector<int> all = view.near;
  for (const auto& list : view.finer) all.insert(all.end(), list.begin(), list.end());
  std::sort(all.begin(), all.end());
  return all;
}

/// What membrane j makes at points near it, added to u.
void add_near(const FlowField& field, int j, PointBlock& block, Matrix& u) {
  const FlowSource& source = field.sources[j];
  const View& view = block.views[j];
  constexpr double touching =
      1e-7;  // of the vesicle's size: nearer, the velocity is the membrane's to all digits wanted
  const Box& box = (*field.coarse)[j].box;
  const PointSampler surface(source.position);
  const NearRule rule = near_rule(source.rotation->order(), field.options.near_order);
  for (std::size_t n = 0; n < view.near.size(); ++n) {
    const int k = view.near[n];
    const Vec3 x = block.points.row(k).transpose();
    const NearestPoint nearest = nearest_point(surface, x, view.start[n]);
    block.distance[k] = std::min(block.distance[k], nearest.distance);
    if (nearest.inside) block.within[k] = j;
    if (nearest.distance < touching * (box.high - box.low).norm()) {
      block.touching.emplace_back(k, sample_points(source.velocity, nearest.parameter.transpose()).row(0).transpose());
      continue;
    }
    u.row(k) += near_velocity(rule, *source.rotation, source.position, x, nearest, source.densities.force,
                              source.viscosity_contrast != 1 ? &source.densities.dual : nullptr)
                    .transpose();
  }
  for (std::size_t l = 0; l < view.finer.size(); ++l) {
    const std::vector<int>& list = view.finer[l];
    if (list.empty()) continue;
    Matrix sum = Matrix::Zero(Eigen::Index(list.size()), 3);
    add_direct_sum(source.finer[l].sources, source.finer[l].densities, block.points(list, Eigen::seqN(0, 3)), sum);
    for (std::size_t k = 0; k < list.size(); ++k) u.row(list[k]) += sum.row(Eigen::Index(k));
  }
}

}  // namespace

FlowField flow_field(Plans& plans, const Scene& scene, const State& state, const FlowFieldOptions& options) {
  if (scene.cell.size)
    throw std::invalid_argument("velocities of the fluid between the vesicles of a periodic [cell] are not computed");
  const int n = int(state.vesicles.size());
  FlowField field{scene.flows, state.time, std::vector<FlowSource>(n), {}, {}, options};
  std::vector<Sources> coarse;
  std::vector<Load> loads = loads_of(plans, scene, state, options.hold_spheres);
  for (int i = 0; i < n; ++i) {
    const VesicleState& v = state.vesicles[i];
    const int p = v.position.order;
    FlowSource& source = field.sources[i];
    source.position = v.position;
    source.velocity = v.velocity;
    source.viscosity_contrast = scene.vesicles[i].viscosity_contrast;
    source.densities.force = std::move(loads[i].force);
    source.rigid = rigid_part(loads[i].body, v.velocity);
    source.densities.dual = dual_density(loads[i].body, source.viscosity_contrast, v.velocity);
    source.rotation = &plans.rotation(p);
    const int order = std::max(2 * p, 24);
    source.directions = grid_directions(plans.basis(p, order));
    FlowSource::Level whole = level(plans, source, order);
    coarse.push_back(std::move(whole.sources));
    field.coarse_densities.push_back(std::move(whole.densities));
    parallel_for(int(source.finer.size()), [&](int k) { source.finer[k] = level(plans, source, order << (k + 1)); });
  }
  field.coarse = std::make_shared<const std::vector<Sources>>(std::move(coarse));
  return field;
}

FlowSamples velocity_at(const FlowField& field, const Matrix& points) {
  const int count = int(points.rows()), n = int(field.sources.size());
  FlowSamples samples{background_velocity(field.flows, field.time, points), std::vector<int>(count, -1),
                      Vector::Constant(count, std::numeric_limits<double>::infinity())};
  if (n == 0) return samples;
  constexpr int size = 64;
  const int blocks = (count + size - 1) / size;
  std::vector<PointBlock> all(blocks);
  parallel_for(blocks,
               [&](int b) { all[b] = sorted(field, points.middleRows(b * size, std::min(count - b * size, size))); });
  std::vector<TargetGroup> groups;
  std::vector<Exclusion> exclusions;
  for (int b = 0; b < blocks; ++b) {
    groups.push_back({all[b].points, -1});
    for (int j = 0; j < n; ++j)
      if (std::vector<int> list = excluded(all[b].views[j]); !list.empty())
        exclusions.push_back({b, j, std::move(list)});
  }
  FarField far = plan_far_field(field.coarse, std::move(groups));
  exclude(far, exclusions);
  const std::vector<Matrix> seen = far_velocity(far, field.coarse_densities);
  parallel_for(blocks, [&](int b) {
    PointBlock& block = all[b];
    const int first = b * size;
    Matrix u = samples.velocity.middleRows(first, block.points.rows()) + seen[b];
    for (int j = 0; j < n; ++j) add_near(field, j, block, u);
    for (int k = 0; k < int(block.points.rows()); ++k)
      if (const int within = block.within[k]; within >= 0) {
        const FlowSource& source = field.sources[within];
        u.row(k) += (source.viscosity_contrast - 1) * source.rigid.at(block.points.row(k).transpose()).transpose();
        u.row(k) /= source.viscosity_contrast;
      }
    for (const auto& [k, own] : block.touching) u.row(k) = own.transpose();
    samples.velocity.middleRows(first, u.rows()) = u;
    samples.distance.segment(first, u.rows()) = block.distance;
    std::copy(block.within.begin(), block.within.end(), samples.within.begin() + first);
  });
  return samples;
}

Vec3 centroid_velocity(Plans& plans, const VesicleState& v) {
  const Basis& basis = plans.basis(v.position.order, 2 * v.position.order + 8);
  const Geometry g = geometry(basis, v.position);
  const Vector outflow = basis.synthesize(v.velocity).values.cwiseProduct(g.n).rowwise().sum().cwiseProduct(g.dA);
  const Measures whole = measures(g);
  // The membrane keeps its volume up to the truncation error: what is left over must not act at a distance.
  return (g.x.value.rowwise() - whole.centroid.transpose()).transpose() * outflow / whole.volume;
}

}  // namespace sim
