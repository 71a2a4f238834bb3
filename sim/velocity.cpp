#include "velocity.h"

#include "dealias.h"
#include "parallel.h"

#include <cmath>
#include <limits>

namespace sim {

namespace {

FlowSource::Level level(Plans& plans, const FlowSource& source, int order) {
  const Basis& basis = plans.basis(source.position.order, order);
  FlowSource::Level l;
  l.sources = make_sources(basis, source.position);
  l.force = basis.synthesize(source.densities.force).values;
  if (source.viscosity_contrast != 1) l.dual = basis.synthesize(source.densities.dual).values;
  return l;
}

/// What one membrane contributes at one point.
struct Contribution {
  Vec3 velocity = Vec3::Zero();
  double distance = std::numeric_limits<double>::infinity();
  bool within = false;
  bool on_membrane = false;  ///< velocity is then the membrane's own
};

Contribution near_contribution(const FlowSource& source, const Vec3& x, const Vec3& start, const FlowFieldOptions& options) {
  Contribution c;
  const NearestPoint nearest = nearest_point(source.position, x, start);
  c.distance = nearest.distance;
  c.within = nearest.inside;
  constexpr double touching = 1e-7;  // of the vesicle's size: nearer, the velocity is the membrane's to all digits wanted
  if (nearest.distance < touching * (source.levels[0].sources.high - source.levels[0].sources.low).norm()) {
    c.on_membrane = true;
    c.velocity = sample_points(source.velocity, nearest.parameter.transpose()).row(0).transpose();
    return c;
  }
  c.velocity = near_velocity(*source.rotation, source.position, x, nearest, options.near_order, source.densities.force,
                             source.viscosity_contrast != 1 ? &source.densities.dual : nullptr);
  return c;
}

/// Contributions of one membrane at all points: those that see it on one grid are summed together.
std::vector<Contribution> contributions(const FlowSource& source, const Matrix& points, const FlowFieldOptions& options) {
  std::vector<Contribution> all(points.rows());
  std::array<std::vector<Eigen::Index>, std::tuple_size_v<decltype(FlowSource::levels)>> lists;
  const Sources& coarse = source.levels[0].sources;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const Vec3 x = points.row(k).transpose();
    const auto [at, away] = nearest_source(coarse, x);
    // The membrane may come nearer between source points: the nearest is at most half a diagonal of a cell off.
    const double spacing = coarse.spacing[at], distance = away - 0.71 * spacing;
    std::size_t l = 0;
    while (l < lists.size() && distance < options.spacings * std::ldexp(spacing, -static_cast<int>(l))) ++l;
    if (l == lists.size()) {
      all[k] = near_contribution(source, x, source.directions.row(at).transpose(), options);
      continue;
    }
    lists[l].push_back(k);
    all[k].distance = distance;
    all[k].within = (x - coarse.points.row(at).transpose()).dot(coarse.normals.row(at)) < 0;
  }
  for (std::size_t l = 0; l < lists.size(); ++l) {
    if (lists[l].empty()) continue;
    const FlowSource::Level& level = source.levels[l];
    Matrix sum = Matrix::Zero(Eigen::Index(lists[l].size()), 3);
    add_direct_sum(level.sources, level.force, level.dual.size() ? &level.dual : nullptr, points(lists[l], Eigen::seqN(0, 3)), sum);
    for (std::size_t k = 0; k < lists[l].size(); ++k) all[lists[l][k]].velocity = sum.row(Eigen::Index(k)).transpose();
  }
  return all;
}

}  // namespace

FlowField flow_field(Plans& plans, const Scene& scene, const State& state, const FlowFieldOptions& options) {
  const int n = int(state.vesicles.size());
  const NumericsParameters& numerics = scene.numerics;
  FlowField field{scene.flows, state.time, std::vector<FlowSource>(n), options};
  std::vector<Material> materials;
  std::vector<Coefficients> positions;
  std::vector<AreaVolume> sizes;
  for (int i = 0; i < n; ++i) {
    const VesicleParameters& v = scene.vesicles[i];
    materials.push_back({v.viscosity_contrast, v.bending_modulus, v.density_difference});
    positions.push_back(state.vesicles[i].position);
    sizes.push_back(area_volume(plans.basis(positions[i].order, measure_order(positions[i].order)), positions[i]));
  }
  const auto pinned = pinned_tensions(plans, scene.flows, scene.buoyancy.gravity, materials, positions, sizes);
  std::vector<Coefficients> repelled;
  if (n > 1 && numerics.repulsion_strength > 0) {
    const InteractionOptions interaction{numerics.interaction_order, numerics.near_rule, {numerics.near_latitudes, numerics.near_longitudes}};
    repelled = repulsion(plan_interaction(plans, positions, materials, interaction), numerics.repulsion_strength,
                         numerics.repulsion_range.value_or(default_repulsion_range * smallest_radius(sizes)));
  }
  for (int i = 0; i < n; ++i) {  // the threads share the work inside
    const VesicleState& v = state.vesicles[i];
    const int p = v.position.order;
    const int rate = numerics.upsampling > 0 ? numerics.upsampling
                                             : upsampling_rate(plans, v.position, numerics.aliasing_tolerance);
    const Membrane m = freeze_membrane(plans, materials[i], v.position, rate, numerics.source_order, {},
                                       options.hold_spheres ? pinned[i] : std::nullopt);
    FlowSource& source = field.sources[i];
    source.position = v.position;
    source.velocity = v.velocity;
    source.viscosity_contrast = materials[i].viscosity_contrast;
    source.densities.force = known_force(m, scene.buoyancy.gravity);
    source.rigid = rigid_part(m.body, v.velocity);
    const Motion rest{without_rigid_part(m.body, v.velocity), v.tension};
    source.densities.force.values += implicit_force(m, 0, rest).values;
    if (!repelled.empty()) source.densities.force.values += repelled[i].values;
    source.densities.dual = dual_density(m.body, source.viscosity_contrast, v.velocity);
    source.rotation = &plans.rotation(p);
    const int coarse = std::max(2 * p, 24);
    source.directions = grid_directions(plans.basis(p, coarse));
    parallel_for(int(source.levels.size()), [&](int k) { source.levels[k] = level(plans, source, coarse << k); });
  }
  return field;
}

FlowSamples velocity_at(const FlowField& field, const Matrix& points) {
  const int count = int(points.rows());
  FlowSamples samples{background_velocity(field.flows, field.time, points), std::vector<int>(count, -1),
                      Vector::Constant(count, std::numeric_limits<double>::infinity())};
  constexpr int block = 64;
  parallel_for((count + block - 1) / block, [&](int b) {
    const int first = b * block, size = std::min(count - first, block);
    const Matrix here = points.middleRows(first, size);
    Matrix u = samples.velocity.middleRows(first, size);
    Vector contrast = Vector::Ones(size);
    std::vector<std::pair<int, Vec3>> touching;
    for (std::size_t j = 0; j < field.sources.size(); ++j) {
      const std::vector<Contribution> all = contributions(field.sources[j], here, field.options);
      for (int k = 0; k < size; ++k) {
        if (all[k].on_membrane) touching.push_back({k, all[k].velocity});
        u.row(k) += all[k].velocity.transpose();
        samples.distance[first + k] = std::min(samples.distance[first + k], all[k].distance);
        if (!all[k].within) continue;
        const FlowSource& source = field.sources[j];
        samples.within[first + k] = int(j);
        contrast[k] = source.viscosity_contrast;
        u.row(k) += (source.viscosity_contrast - 1) * source.rigid.at(here.row(k).transpose()).transpose();
      }
    }
    u.array().colwise() /= contrast.array();
    for (const auto& [k, own] : touching) u.row(k) = own.transpose();
    samples.velocity.middleRows(first, size) = u;
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
