#include "suspension.h"

#include "parallel.h"

#include <optional>

namespace sim {

Suspension freeze_suspension(Plans& plans, std::span<const Material> materials, std::span<const Coefficients> positions,
                             std::span<const int> upsamplings, const SuspensionOptions& options,
                             std::span<const Coefficients> expected_tensions) {
  const int n = int(positions.size());
  std::vector<std::optional<Membrane>> frozen(n);
  const auto freeze = [&](int i) {
    frozen[i].emplace(freeze_membrane(plans, materials[i], positions[i], upsamplings[i], options.source_order,
                                      expected_tensions.empty() ? Coefficients{} : expected_tensions[i]));
  };
  if (n == 1) {
    freeze(0);  // the threads then share the assembly
  } else {
    parallel_for(n, freeze);
  }
  Suspension s{{}, plan_interaction(plans, positions, materials, options.interaction), {}};
  if (n > 1 && options.repulsion_strength > 0)
    s.repulsion = repulsion(s.interaction, options.repulsion_strength, options.repulsion_range);
  for (auto& m : frozen) s.membranes.push_back(std::move(*m));
  return s;
}

std::vector<Coefficients> interaction_of(const Suspension& s, std::span<const Coefficients> forces,
                                         std::span<const Motion> motions) {
  std::vector<Densities> densities;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const Coefficients& f = forces[k];
    densities.push_back({f, {f.order, Matrix::Zero(f.values.rows(), 3)}});
    if (!motions.empty())
      densities[k].dual.values = (1 - s.membranes[k].material.viscosity_contrast) * motions[k].velocity.values;
  }
  return induced_velocity(s.interaction, densities);
}

std::vector<Coefficients> suspension_forcing(const Suspension& s, std::span<const FlowParameters> flows, double time,
                                             const Vec3& gravity, std::span<const Coefficients> displacements) {
  const int n = int(s.membranes.size());
  std::vector<Coefficients> forces(n), r(n);
  parallel_for(n, [&](int i) {
    const Membrane& m = s.membranes[i];
    forces[i] = displacements.empty() ? known_force(m, gravity) : known_force(m, gravity, displacements[i]);
    if (!s.repulsion.empty()) forces[i].values += s.repulsion[i].values;
    r[i] = m.bases.field.analyze(background_velocity(flows, time, m.geometry.x.value));
    r[i].values += m.layers.single.apply(forces[i]).values;
  });
  if (n > 1) {
    const std::vector<Coefficients> others = interaction_of(s, forces);
    for (int i = 0; i < n; ++i) r[i].values += others[i].values;
  }
  return r;
}

namespace {

/// Splits the packed unknowns of all vesicles.
std::vector<Vector> split(const Suspension& s, const Vector& y) {
  std::vector<Vector> parts;
  Eigen::Index at = 0;
  for (const Membrane& m : s.membranes) {
    const Eigen::Index size = 4 * coefficient_count(m.order());
    parts.push_back(y.segment(at, size));
    at += size;
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

}  // namespace

SuspensionSolve solve_suspension(const Suspension& s, double c, std::span<const Coefficients> forcing,
                                 std::span<const Motion> guess, double tolerance, Preconditioner kind) {
  const int n = int(s.membranes.size());
  const auto apply = [&](const Vector& y) {
    const std::vector<Vector> parts = split(s, y);
    std::vector<Densities> densities(n);
    std::vector<Motion> motions(n);
    std::vector<Coefficients> velocity(n);
    parallel_for(n, [&](int i) {
      const Membrane& m = s.membranes[i];
      motions[i] = unpacked(parts[i], m.order());
      densities[i].force = implicit_force(m, c, motions[i]);
      densities[i].dual = {m.order(), (1 - m.material.viscosity_contrast) * motions[i].velocity.values};
      velocity[i] = layer_velocity(m, densities[i].force, motions[i].velocity);
    });
    if (n > 1) {
      const std::vector<Coefficients> others = induced_velocity(s.interaction, densities);
      for (int i = 0; i < n; ++i) velocity[i].values += others[i].values;
    }
    std::vector<Vector> rows(n);
    parallel_for(n, [&](int i) { rows[i] = system_rows(s.membranes[i], motions[i].velocity, velocity[i]); });
    return join(rows);
  };
  std::vector<SpectralInverse> inverses;
  std::vector<Vector> right, start;
  for (int i = 0; i < n; ++i) {
    inverses.push_back(spectral_inverse(s.membranes[i], c));
    right.push_back(packed({forcing[i], divergence(s.membranes[i], forcing[i])}));
    start.push_back(packed(guess[i]));
  }
  const auto by_spectrum = [&](const Vector& y) {
    std::vector<Vector> parts = split(s, y);
    parallel_for(n, [&](int i) { parts[i] = precondition(s.membranes[i], inverses[i], parts[i]); });
    return join(parts);
  };
  const auto by_block = [&](const Vector& y) {
    constexpr double loose = 1e-3;  // GMRES is flexible; tighter inner solves save no outer iteration
    const std::vector<Vector> parts = split(s, y);
    std::vector<Vector> solved(n);
    parallel_for(n, [&](int i) {
      const Membrane& m = s.membranes[i];
      solved[i] = gmres([&](const Vector& v) { return apply_system(m, c, v); },
                        [&](const Vector& v) { return precondition(m, inverses[i], v); }, parts[i],
                        Vector::Zero(parts[i].size()), loose, 60)
                      .solution;
    });
    return join(solved);
  };
  constexpr int most_iterations = 300;
  const GmresResult result = gmres(apply, kind == Preconditioner::block ? LinearMap(by_block) : LinearMap(by_spectrum),
                                   join(right), join(start), tolerance, most_iterations);
  SuspensionSolve solve{{}, result.iterations, result.residual, result.converged};
  const std::vector<Vector> parts = split(s, result.solution);
  for (int i = 0; i < n; ++i) solve.motions.push_back(unpacked(parts[i], s.membranes[i].order()));
  return solve;
}

}  // namespace sim
