#include "sim/suspension/velocity.h"

#include "sim/core/parallel.h"
#include "sim/membrane/cell.h"
#include "sim/suspension/loads.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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

/// How points see one membrane, or an image of it in a periodic cell.
struct View {
  int source = 0;
  Vec3 shift = Vec3::Zero();                                                           ///< of the image
  std::vector<int> near;                                                               ///< by the near rule
  std::array<std::vector<int>, std::tuple_size_v<decltype(FlowSource::finer)>> finer;  ///< by finer grids
  std::vector<Vec3> start;          ///< for the near ones: where to look
  std::vector<int> coarse, spread;  ///< of an image: by the coarse grid, or that which is spread on the mesh
};

/// A point on a membrane.
struct Touching {
  int point;
  Vec3 velocity;  ///< of the membrane there
};

/// The rest of a block of points sees the coarse grids, or what the mesh has of all images.
struct PointBlock {
  Matrix points;
  std::vector<View> views;  ///< by membrane; in a cell, of the images near the block
  Vector distance;          ///< to the nearest membrane
  std::vector<int> within;  ///< the view whose membrane contains the point, -1 outside all
  std::vector<Touching> touching;

  explicit PointBlock(Matrix all)
      : points(std::move(all)),
        distance(Vector::Constant(points.rows(), std::numeric_limits<double>::infinity())),
        within(std::size_t(points.rows()), -1) {}
};

/// By how much the background flow at a point is faster than where the point has been moved from.
Vec3 faster_by(const FlowField& field, const Vec3& x, const Vec3& shift) {
  if (shift.isZero()) return Vec3::Zero();
  Matrix both(2, 3);
  both.row(0) = x.transpose();
  both.row(1) = (x - shift).transpose();
  const Matrix u = background_velocity(field.flows, field.time, both);
  return (u.row(0) - u.row(1)).transpose();
}

/// Sorts one point of a block, near a membrane: from the finest rule to the coarse grid, whose list it returns.
/// halvings of the spacing: 0 for the coarse grid.
int sort_point(const FlowField& field, PointBlock& block, int number, int k, const Vec3& x) {
  View& view = block.views[std::size_t(number)];
  const Sources& coarse = (*field.coarse)[std::size_t(view.source)];
  const auto [at, away] = nearest_source(field.sources[std::size_t(view.source)].tiles, x);
  // The membrane may come nearer between source points: the nearest is at most half a diagonal of a cell off.
  const double spacing = coarse.spacing[at], distance = away - 0.71 * spacing;
  std::size_t halvings = 0;
  while (halvings <= view.finer.size() && distance < field.options.spacings * std::ldexp(spacing, -int(halvings)))
    ++halvings;
  if (halvings > view.finer.size()) {
    view.near.push_back(k);
    view.start.push_back(field.sources[std::size_t(view.source)].directions.row(at).transpose());
    return int(halvings);
  }
  if (halvings > 0) view.finer[halvings - 1].push_back(k);
  block.distance[k] = std::min(block.distance[k], distance);
  if ((x - coarse.points.row(at).transpose()).dot(coarse.normals.row(at)) < 0) block.within[k] = number;
  return int(halvings);
}

/// Sorts points by how far they are from each membrane.
PointBlock sorted(const FlowField& field, Matrix points) {
  PointBlock block(std::move(points));
  block.views.resize(field.sources.size());
  for (int j = 0; j < int(field.sources.size()); ++j) {
    block.views[std::size_t(j)].source = j;
    for (int k = 0; k < int(block.points.rows()); ++k) sort_point(field, block, j, k, block.points.row(k).transpose());
  }
  return block;
}

/// The same in a periodic cell, for the images within the cut-off of the mesh.
PointBlock sorted_among_images(const FlowField& field, Matrix points) {
  const FlowImages& images = *field.images;
  PointBlock block(std::move(points));
  const Box around{block.points.colwise().minCoeff().transpose(), block.points.colwise().maxCoeff().transpose()};
  for (int j = 0; j < int(field.sources.size()); ++j) {
    const Sources& coarse = (*field.coarse)[std::size_t(j)];
    const Sources& spread = images.spread[std::size_t(j)].sources;
    const Box box = united(coarse.box, spread.box);
    const double spread_from = images.spread_limit * spread.spacing.maxCoeff();
    const double reach = std::max(images.cutoff, (field.options.spacings + 0.71) * coarse.spacing.maxCoeff());
    block.distance = block.distance.cwiseMin(reach);
    for (const Vec3& shift : near_shifts(images.sides, box, around, reach)) {
      const int number = int(block.views.size());
      View& view = block.views.emplace_back();
      view.source = j;
      view.shift = shift;
      for (int k = 0; k < int(block.points.rows()); ++k) {
        const Vec3 x = block.points.row(k).transpose() - shift;
        const double to_box = distance(box, x);
        if (to_box >= reach) continue;
        if (to_box > spread_from) {
          view.spread.push_back(k);
          block.distance[k] = std::min(block.distance[k], to_box);
        } else if (sort_point(field, block, number, k, x) == 0) {
          view.coarse.push_back(k);
        }
      }
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

/// What a grid of a membrane, or of an image of it, makes at some points of a block, added to u.
void add_grid(const Sources& sources, const SourceDensities& densities, const Vec3& shift, const PointBlock& block,
              const std::vector<int>& list, Matrix& u) {
  if (list.empty()) return;
  Matrix sum = Matrix::Zero(Eigen::Index(list.size()), 3);
  const Matrix points = block.points(list, Eigen::seqN(0, 3)).rowwise() - shift.transpose();
  add_direct_sum(sources, densities, points, sum);
  for (std::size_t k = 0; k < list.size(); ++k) u.row(list[k]) += sum.row(Eigen::Index(k));
}

/// What a membrane makes at points near it, added to u.
void add_near(const FlowField& field, int number, PointBlock& block, Matrix& u) {
  const View& view = block.views[std::size_t(number)];
  const FlowSource& source = field.sources[std::size_t(view.source)];
  constexpr double touching =
      1e-7;  // of the vesicle's size: nearer, the velocity is the membrane's to all digits wanted
  const Box& box = (*field.coarse)[std::size_t(view.source)].box;
  const PointSampler surface(source.position);
  const NearRule rule = near_rule(source.rotation->order(), field.options.near_order);
  for (std::size_t n = 0; n < view.near.size(); ++n) {
    const int k = view.near[n];
    const Vec3 x = block.points.row(k).transpose() - view.shift;
    const NearestPoint nearest = nearest_point(surface, x, view.start[n]);
    block.distance[k] = std::min(block.distance[k], nearest.distance);
    if (nearest.inside) block.within[k] = number;
    if (nearest.distance < touching * (box.high - box.low).norm()) {
      block.touching.push_back({k, sample_points(source.velocity, nearest.parameter.transpose()).row(0).transpose() +
                                       faster_by(field, block.points.row(k).transpose(), view.shift)});
      continue;
    }
    u.row(k) += near_velocity(rule, *source.rotation, source.position, x, nearest, source.densities.force,
                              source.viscosity_contrast != 1 ? &source.densities.dual : nullptr)
                    .transpose();
  }
  for (std::size_t l = 0; l < view.finer.size(); ++l)
    add_grid(source.finer[l].sources, source.finer[l].densities, view.shift, block, view.finer[l], u);
}

/// ... an image, in place of the smooth part that the mesh has of it.
void add_image(const FlowField& field, int number, PointBlock& block, Matrix& u) {
  const View& view = block.views[std::size_t(number)];
  const auto source = std::size_t(view.source);
  std::vector<int> all = excluded(view);
  all.insert(all.end(), view.coarse.begin(), view.coarse.end());
  all.insert(all.end(), view.spread.begin(), view.spread.end());
  if (all.empty()) return;
  Matrix taken = Matrix::Zero(Eigen::Index(all.size()), 3);
  const Matrix points = block.points(all, Eigen::seqN(0, 3)).rowwise() - view.shift.transpose();
  take_smooth(*field.images, view.source, points, taken);
  for (std::size_t k = 0; k < all.size(); ++k) u.row(all[k]) += taken.row(Eigen::Index(k));
  const SpreadSurface& spread = field.images->spread[source];
  add_grid(spread.sources, spread.densities, view.shift, block, view.spread, u);
  add_grid((*field.coarse)[source], field.coarse_densities[source], view.shift, block, view.coarse, u);
  add_near(field, number, block, u);
}

/// What all membranes make at the points of each block but for what is near, points x 3.
std::vector<Matrix> far_part(const FlowField& field, const std::vector<PointBlock>& all) {
  if (field.images) {
    std::vector<Matrix> seen(all.size());
    parallel_for(int(all.size()),
                 [&](int b) { seen[std::size_t(b)] = smooth_velocity(*field.images, all[std::size_t(b)].points); });
    return seen;
  }
  std::vector<TargetGroup> groups;
  std::vector<Exclusion> exclusions;
  for (int b = 0; b < int(all.size()); ++b) {
    groups.push_back({all[std::size_t(b)].points, -1});
    for (const View& view : all[std::size_t(b)].views)
      if (std::vector<int> list = excluded(view); !list.empty())
        exclusions.push_back({b, view.source, std::move(list)});
  }
  FarField far = plan_far_field(field.coarse, std::move(groups));
  exclude(far, exclusions);
  return far_velocity(far, field.coarse_densities);
}

}  // namespace

FlowField flow_field(Plans& plans, const Scene& scene, const State& state, const FlowFieldOptions& options) {
  const int n = int(state.vesicles.size());
  FlowField field{scene.flows, state.time, std::vector<FlowSource>(n), {}, {}, {}, options};
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
    source.tiles = make_tiles(plans.basis(p, order), whole.sources);
    coarse.push_back(std::move(whole.sources));
    field.coarse_densities.push_back(std::move(whole.densities));
    parallel_for(int(source.finer.size()), [&](int k) { source.finer[k] = level(plans, source, order << (k + 1)); });
  }
  field.coarse = std::make_shared<const std::vector<Sources>>(std::move(coarse));
  const CellSides cell = cell_at(scene, state.time);
  if (!cell || n == 0) return field;
  std::vector<Coefficients> positions;
  std::vector<const Coefficients*> forces, duals;
  for (const FlowSource& source : field.sources) {
    positions.push_back(source.position);
    forces.push_back(&source.densities.force);
    duals.push_back(source.viscosity_contrast != 1 ? &source.densities.dual : nullptr);
  }
  field.images =
      std::make_shared<const FlowImages>(flow_images(plans, positions, forces, duals, *cell, options.tolerance));
  return field;
}

FlowSamples velocity_at(const FlowField& field, const Matrix& points) {
  const int count = int(points.rows()), n = int(field.sources.size());
  FlowSamples samples{background_velocity(field.flows, field.time, points), std::vector<int>(count, -1),
                      Vector::Constant(count, std::numeric_limits<double>::infinity())};
  if (n == 0) return samples;
  constexpr int size = 64;
  const int blocks = (count + size - 1) / size;
  std::vector<std::optional<PointBlock>> made(blocks);
  parallel_for(blocks, [&](int b) {
    Matrix part = points.middleRows(b * size, std::min(count - b * size, size));
    made[b] = field.images ? sorted_among_images(field, std::move(part)) : sorted(field, std::move(part));
  });
  std::vector<PointBlock> all;
  for (std::optional<PointBlock>& block : made) all.push_back(std::move(*block));
  const std::vector<Matrix> seen = far_part(field, all);
  parallel_for(blocks, [&](int b) {
    PointBlock& block = all[b];
    const int first = b * size;
    Matrix u = samples.velocity.middleRows(first, block.points.rows()) + seen[b];
    for (int number = 0; number < int(block.views.size()); ++number)
      field.images ? add_image(field, number, block, u) : add_near(field, number, block, u);
    for (int k = 0; k < int(block.points.rows()); ++k) {
      if (block.within[k] < 0) continue;
      const View& view = block.views[std::size_t(block.within[k])];
      const FlowSource& source = field.sources[std::size_t(view.source)];
      const Vec3 x = block.points.row(k).transpose();
      const Vec3 rigid = source.rigid.at(x - view.shift) + faster_by(field, x, view.shift);
      u.row(k) += (source.viscosity_contrast - 1) * rigid.transpose();
      u.row(k) /= source.viscosity_contrast;
      samples.within[std::size_t(first) + std::size_t(k)] = view.source;
    }
    for (const Touching& t : block.touching) u.row(t.point) = t.velocity.transpose();
    samples.velocity.middleRows(first, u.rows()) = u;
    samples.distance.segment(first, u.rows()) = block.distance;
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
