#include "sim/suspension/suspension.h"

#include "sim/core/divided.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace sim {

namespace {

constexpr double four_pi = 4 * std::numbers::pi;

}  // namespace

double area_radius(const AreaVolume& size) { return std::sqrt(size.area / four_pi); }

double straining_rate(Plans& plans, std::span<const FlowParameters> flows, const Vec3& gravity,
                      std::span<const Material> materials, std::span<const Coefficients> positions,
                      std::span<const AreaVolume> sizes) {
  std::vector<FlowParameters> steady(flows.begin(), flows.end());
  for (FlowParameters& flow : steady) flow.time_factor = "constant";
  double rate = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const double radius = area_radius(sizes[k]);
    const Basis& basis = plans.basis(positions[k].order, positions[k].order + 1);
    const Coefficients u = basis.analyze(background_velocity(steady, 0, basis.synthesize(positions[k]).values));
    const Coefficients strain = without_rigid_part(rigid_body(positions[k]), u);
    rate = std::max({rate, strain.values.norm() / std::sqrt(four_pi) / radius,
                     materials[k].bending_modulus / std::pow(radius, 3),
                     std::abs(materials[k].density_difference) * gravity.norm() * radius});
  }
  return rate;
}

bool is_sphere(const AreaVolume& size) { return reduced_volume(size.area, size.volume) > 1 - 2e-6; }

std::vector<std::optional<PinnedTension>> pinned_tensions(Plans& plans, std::span<const FlowParameters> flows,
                                                          const Vec3& gravity, std::span<const Material> materials,
                                                          std::span<const Coefficients> positions,
                                                          std::span<const AreaVolume> sizes) {
  std::vector<std::optional<PinnedTension>> pinned(positions.size());
  if (std::none_of(sizes.begin(), sizes.end(), is_sphere)) return pinned;
  // Out of round by 0.7e-5 radii; more stiffness costs iterations. In an instantaneous problem a tenth of the time in
  // which the flow strains the sphere gives the same iterations as a usual step.
  constexpr double stiffness = 1e5, share = 0.1;
  const double rate = straining_rate(plans, flows, gravity, materials, positions, sizes);
  for (std::size_t k = 0; k < positions.size(); ++k)
    if (is_sphere(sizes[k]))
      pinned[k] = PinnedTension{stiffness * rate * area_radius(sizes[k]), rate > 0 ? share / rate : 0};
  return pinned;
}

double smallest_radius(std::span<const AreaVolume> sizes) {
  double least = std::numeric_limits<double>::infinity();
  for (const AreaVolume& size : sizes) least = std::min(least, area_radius(size));
  return least;
}

double repulsion_range(const NumericsParameters& n, double smallest_radius) {
  return n.repulsion_range.value_or(default_repulsion_range * smallest_radius);
}

SuspensionOptions suspension_options(const NumericsParameters& n, double smallest_radius, double tolerance,
                                     const CellSides& cell) {
  // Quadrature near vesicles errs by 3e-7.
  constexpr double finest = 1e-8, coarsest = 1e-3;
  SuspensionOptions options;
  options.source_order = n.source_order;
  options.interaction.source_order = n.interaction_order;
  options.interaction.near_rule = n.near_rule;
  options.interaction.near_order = {n.near_latitudes, n.near_longitudes};
  options.interaction.far = {n.far_field, std::clamp(tolerance, finest, coarsest), cell};
  options.repulsion = {n.repulsion_strength, repulsion_range(n, smallest_radius)};
  return options;
}

Suspension freeze_suspension(Plans& plans, std::span<const Material> materials, std::span<const Coefficients> positions,
                             std::span<const double> upsamplings, const SuspensionOptions& options,
                             std::span<const Coefficients> expected_tensions,
                             std::span<const std::optional<PinnedTension>> pinned) {
  const int n = int(positions.size());
  std::vector<std::optional<Membrane>> frozen(n);
  const auto freeze = [&](int i) {
    frozen[i].emplace(freeze_membrane(plans, materials[i], positions[i], upsamplings[i], options.source_order,
                                      expected_tensions.empty() ? Coefficients{} : expected_tensions[i],
                                      pinned.empty() ? std::nullopt : pinned[i]));
  };
  if (n == 1) {
    if (options.interaction.division.mine(0)) freeze(0);  // the threads then share the assembly
  } else {
    divided_for(options.interaction.division, n, freeze);
  }
  Suspension s{
      {}, plan_interaction(plans, positions, materials, options.interaction), {}, options.interaction.division};
  s.repulsion =
      repulsion_forces(plans, positions, options.repulsion, options.interaction.far.cell, options.interaction.division);
  s.membranes = std::move(frozen);
  return s;
}

std::vector<Coefficients> interaction_of(const Suspension& s, std::span<const Coefficients> forces,
                                         std::span<const Motion> motions) {
  const int n = int(forces.size());
  std::vector<Densities> densities(n);
  divided_for(s.division, n, [&](int k) {
    const Coefficients& f = forces[k];
    densities[k] = {f, {f.order, Matrix::Zero(f.values.rows(), 3)}};
    if (const Membrane& m = *s.membranes[k]; !motions.empty())
      densities[k].dual = dual_density(m.body, m.material.viscosity_contrast, motions[k].velocity);
  });
  return induced_velocity(s.interaction, std::move(densities));
}

std::vector<Coefficients> suspension_forcing(const Suspension& s, std::span<const FlowParameters> flows, double time,
                                             const Vec3& gravity, std::span<const Coefficients> displacements) {
  const int n = int(s.membranes.size());
  std::vector<Coefficients> forces(n), r(n);
  divided_for(s.division, n, [&](int i) {
    const Membrane& m = *s.membranes[i];
    forces[i] = displacements.empty() ? known_force(m, gravity) : known_force(m, gravity, displacements[i]);
    if (!s.repulsion.empty()) forces[i].values += s.repulsion[i].values;
    r[i] = m.bases.field.analyze(background_velocity(flows, time, m.geometry.x.value));
    r[i].values += m.layers.single.apply(forces[i]).values;
  });
  if (!s.interaction.none()) {
    const std::vector<Coefficients> others = interaction_of(s, forces);
    for (int i = 0; i < n; ++i)
      if (s.division.mine(i)) r[i].values += others[i].values;
  }
  return r;
}

namespace {

/// Splits the packed unknowns of this rank's bodies; nothing for those of other ranks, whose blocks have no size.
std::vector<Vector> split(std::span<const Block> blocks, const Vector& y) {
  std::vector<Vector> parts;
  Eigen::Index at = 0;
  for (const Block& block : blocks) {
    parts.push_back(y.segment(at, block.size));
    at += block.size;
  }
  return parts;
}

Vector join(const std::vector<Vector>& parts) {
  Eigen::Index size = 0, at = 0;
  for (const Vector& part : parts) size += part.size();
  Vector y(size);
  for (const Vector& part : parts) {
    y.segment(at, part.size()) = part;
    at += part.size();
  }
  return y;
}

/// Of all ranks' unknowns: a number a vesicle and pair, added in the order of the vesicles, so that the bits of the sum
/// do not depend on who has which.
Vector products_of_parts(std::span<const Block> blocks, const Division& division, std::span<const Matrix> vectors,
                         int count, const Vector& with) {
  const auto each = std::size_t(count);
  std::vector<double> products(blocks.size() * each);
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!division.mine(int(i))) continue;
    Vector::Map(&products[i * each], count) = products_of_rows(vectors, count, with, at, blocks[i].size);
    at += blocks[i].size;
  }
  share(division, products, each);
  Vector sums = Vector::Zero(count);
  for (std::size_t i = 0; i < blocks.size(); ++i) sums += Vector::Map(&products[i * each], count);
  return sums;
}

/// Left-hand side of the coupled system. What each block by itself makes of its part goes into `searched`, if given.
Vector apply_blocks(std::span<const Block> blocks, const Interaction& interaction, const Division& division,
                    const Vector& y, std::span<Searched> searched) {
  const int n = int(blocks.size());
  const std::vector<Vector> parts = split(blocks, y);
  std::vector<Densities> densities(n);
  std::vector<Coefficients> velocity(n);
  divided_for(division, n, [&](int i) {
    Trial trial = blocks[i].trial(parts[i]);
    densities[i] = std::move(trial.densities);
    velocity[i] = std::move(trial.own_velocity);
    if (searched.empty()) return;
    searched[i].directions.push_back(parts[i]);
    if (!interaction.none()) searched[i].images.push_back(blocks[i].rows(parts[i], velocity[i]));
  });
  if (!interaction.none()) {
    const std::vector<Coefficients> others = induced_velocity(interaction, std::move(densities));
    for (int i = 0; i < n; ++i)
      if (division.mine(i)) velocity[i].values += others[i].values;
  }
  std::vector<Vector> rows(n);
  divided_for(division, n, [&](int i) {
    rows[i] = blocks[i].rows(parts[i], velocity[i]);
    if (!searched.empty() && interaction.none()) searched[i].images.push_back(rows[i]);
  });
  return join(rows);
}

Vector precondition_blocks(std::span<const Block> blocks, const Division& division, const Lessons& known,
                           const Vector& y) {
  std::vector<Vector> parts = split(blocks, y);
  divided_for(division, int(blocks.size()), [&](int i) {
    parts[i] = precondition(known.empty() ? nullptr : known[i].get(), blocks[i].precondition, parts[i]);
  });
  return join(parts);
}

}  // namespace

SuspensionSolve solve_suspension(const Suspension& s, double c, std::span<const Coefficients> forcing,
                                 std::span<const Motion> guess, double tolerance, Preconditioner kind,
                                 std::span<const RigidMotion> frames, const Lessons& known) {
  const int n = int(s.membranes.size());
  std::vector<Block> blocks(n);
  std::vector<Vector> right(n), start(n);
  std::vector<Coefficients> rigid(n);
  // A rigid motion solves the homogeneous equations for itself: (39) maps it to itself and every other vesicle to
  // nothing.
  const auto prepare = [&](int i) {
    const Membrane& m = *s.membranes[i];
    blocks[i] = vesicle_block(m, c, kind, !s.interaction.none());
    rigid[i] = frames.empty() ? Coefficients{m.order(), Matrix::Zero(coefficient_count(m.order()), 3)}
                              : rigid_velocity(m.body, frames[i]);
    right[i] = system_right(m, {m.order(), forcing[i].values - rigid[i].values});
    start[i] = packed({{m.order(), guess[i].velocity.values - rigid[i].values}, guess[i].tension});
    if (m.pinned) start[i][start[i].size() - coefficient_count(m.order())] = 0;
  };
  divided_for(s.division, n, prepare);
  constexpr int most_iterations = 300;
  const bool learns = c > 0;  // an instantaneous problem has no next one
  std::vector<Searched> searched(n);
  bool searches = false;  // the guess is none of the directions
  const auto apply = [&](const Vector& y) {
    return apply_blocks(blocks, s.interaction, s.division, y,
                        learns && searches ? std::span(searched) : std::span<Searched>{});
  };
  const auto inverse = [&](const Vector& y) {
    searches = true;
    return precondition_blocks(blocks, s.division, known, y);
  };
  const GmresResult result = gmres(apply, inverse, join(right), join(start), tolerance, most_iterations,
                                   [&](std::span<const Matrix> vectors, int count, const Vector& with) {
                                     return products_of_parts(blocks, s.division, vectors, count, with);
                                   });
  SuspensionSolve solve{std::vector<Motion>(n), result.iterations, result.residual, result.converged, Lessons(n)};
  const std::size_t use = telling(result.residuals);
  const auto learn = [&](int i) {
    solve.learned[i] = learned(known.empty() ? nullptr : known[i].get(), searched[i], use, directions_kept(n));
  };
  if (learns) divided_for(s.division, n, learn);
  const std::vector<Vector> parts = split(blocks, result.solution);
  for (int i = 0; i < n; ++i) {
    if (!s.division.mine(i)) continue;
    solve.motions[i] = unpacked(parts[i], s.membranes[i]->order());
    solve.motions[i].velocity.values += rigid[i].values;
  }
  return solve;
}

}  // namespace sim
