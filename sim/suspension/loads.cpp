#include "sim/suspension/loads.h"

#include "sim/core/parallel.h"
#include "sim/membrane/cell.h"
#include "sim/surface/dealias.h"

#include <limits>

namespace sim {

namespace {

/// The vesicles of a state as the operators take them.
struct Bodies {
  std::vector<Material> materials;
  std::vector<Coefficients> positions;
  std::vector<double> upsamplings;
  std::vector<std::optional<PinnedTension>> pinned;
  SuspensionOptions options;
};

Bodies bodies_of(Plans& plans, const Scene& scene, const State& state) {
  const NumericsParameters& n = scene.numerics;
  Bodies b;
  std::vector<AreaVolume> sizes;
  for (std::size_t i = 0; i < state.vesicles.size(); ++i) {
    const VesicleParameters& v = scene.vesicles.at(i);
    const Coefficients& x = b.positions.emplace_back(state.vesicles[i].position);
    b.materials.push_back({v.viscosity_contrast, v.bending_modulus, v.density_difference});
    sizes.push_back(area_volume(plans.basis(x.order, measure_order(x.order)), x));
    b.upsamplings.push_back(n.upsampling > 0 ? n.upsampling : upsampling_rate(plans, x, n.aliasing_tolerance));
  }
  b.pinned = pinned_tensions(plans, scene.flows, scene.buoyancy.gravity, b.materials, b.positions, sizes);
  b.options = suspension_options(n, smallest_radius(sizes), 1e-7, cell_at(scene, state.time));
  return b;
}

/// The part of the force of a membrane that depends on how it moves; the tension of a sphere answers to the rest of its
/// motion beside the rigid one.
Coefficients moving_force(const Sheet& m, const Motion& motion) {
  return implicit_force(m, 0, {without_rigid_part(m.body, motion.velocity), motion.tension});
}

}  // namespace

std::vector<Load> loads_of(Plans& plans, const Scene& scene, const State& state, bool hold_spheres) {
  const Bodies b = bodies_of(plans, scene, state);
  const auto n = static_cast<int>(b.positions.size());
  const std::vector<Coefficients> repelled =
      repulsion_forces(plans, b.positions, b.options.repulsion, b.options.interaction.far.cell);
  std::vector<Load> loads(n);
  parallel_for(n, [&](int i) {
    const VesicleState& v = state.vesicles[i];
    const Sheet m = freeze_sheet(plans, b.materials[i], v.position, b.upsamplings[i], {},
                                 hold_spheres ? b.pinned[i] : std::nullopt);
    Coefficients force = known_force(m, scene.buoyancy.gravity);
    force.values += moving_force(m, {v.velocity, v.tension}).values;
    loads[i] = {std::move(force), m.body, v.velocity};
    if (!repelled.empty()) loads[i].force.values += repelled[i].values;
  });
  return loads;
}

std::vector<Load> solved_loads(Plans& plans, const Scene& scene, const State& state) {
  const Bodies b = bodies_of(plans, scene, state);
  const Suspension s = freeze_suspension(plans, b.materials, b.positions, b.upsamplings, b.options, {}, b.pinned);
  const auto r = suspension_forcing(s, scene.flows, state.time, scene.buoyancy.gravity);
  const auto n = static_cast<int>(s.membranes.size());
  std::vector<Motion> motions;
  for (const VesicleState& v : state.vesicles) motions.push_back({v.velocity, v.tension});
  std::vector<char> converged(n, 1);
  const bool others_act = !s.interaction.none();
  constexpr double residual = 1e-8;
  // Vesicle by vesicle, with what the others do as known from the sweep before: what is wrong with a saved state is
  // mostly its own, and coupled solves sum over all pairs in each iteration.
  for (int sweep = 0; sweep < (others_act ? 3 : 1); ++sweep) {
    std::vector<Coefficients> forces(n), others;
    for (int i = 0; i < n; ++i) forces[i] = moving_force(*s.membranes[i], motions[i]);
    if (others_act) others = interaction_of(s, forces, motions);
    parallel_for(n, [&](int i) {
      const Membrane& m = *s.membranes[i];
      // The rigid motion solves the homogeneous equations for itself.
      const Matrix rigid = rigid_velocity(m.body, rigid_part(m.body, motions[i].velocity)).values;
      Coefficients forcing{m.order(), r[i].values - rigid};
      if (others_act) forcing.values += others[i].values;
      Motion guess = motions[i];
      guess.velocity.values -= rigid;
      Solve solve = solve_system(m, 0, forcing, guess, residual);
      motions[i] = std::move(solve.motion);
      motions[i].velocity.values += rigid;
      converged[i] = solve.converged;
    });
  }
  std::vector<Load> loads(n);
  parallel_for(n, [&](int i) {
    const Membrane& m = *s.membranes[i];
    Coefficients force = known_force(m, scene.buoyancy.gravity);
    force.values += moving_force(m, motions[i]).values;
    if (!s.repulsion.empty()) force.values += s.repulsion[i].values;
    if (!converged[i]) force.values.setConstant(std::numeric_limits<double>::quiet_NaN());
    loads[i] = {std::move(force), m.body, std::move(motions[i].velocity)};
  });
  return loads;
}

}  // namespace sim
