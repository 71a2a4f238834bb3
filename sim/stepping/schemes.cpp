#include "sim/stepping/schemes.h"

#include "sim/core/divided.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace sim {

namespace {

/// Half of dt times the change of velocity over the step: dt^2/2 x'' to leading order, the local error of Euler's
/// rules.
double euler_error(const VesicleDynamics& v, const Motion& after, double dt) {
  return size_of(v, dt / 2 * (after.velocity.values - v.motion.velocity.values));
}

Coefficients no_sliding(int order) { return {order, Matrix::Zero(coefficient_count(order), 3)}; }

/// u+ solves (38) with everything frozen at x_n.
Attempt<Advance> globally_implicit(const StepProblem& problem) {
  const Model& s = problem.model;
  const Dynamics& d = problem.before;
  const double dt = problem.dt, time = d.time + dt;
  const auto x = positions(d);
  const Suspension suspension = freeze(s, d, d.time, x, motions(d));
  const auto r = suspension_forcing(suspension, problem.flows, time, s.scene.buoyancy.gravity);
  Attempt<SuspensionSolve> result = solve(s, suspension, dt, r, motions(d), frames(d), solve_tolerance(s.scene), d);
  if (!result) return result.rejection();
  Advance a{std::vector<Moved>(x.size()), result->iterations, result->residual, suspension.division,
            std::move(result->learned)};
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!a.division.mine(int(k))) continue;
    Motion& motion = result->motions[k];
    const Frame frame = frame_of(*suspension.membranes[k], motion.velocity, problem.flows, time);
    const double error = euler_error(d.vesicles[k], motion, dt);
    Coefficients moved{x[k].order, x[k].values + dt * motion.velocity.values};
    a.vesicles[k] = {std::move(moved), std::move(motion), no_sliding(x[k].order), frame, {}, 0, error};
  }
  return a;
}

/// The three schemes that solve vesicle by vesicle: what the others do is that of x_n, sigma_n, u_n.
Attempt<Advance> block_scheme(const StepProblem& problem,
                              Solve (*solve_self)(const Membrane&, double dt, const Coefficients& r, const Motion&,
                                                  double)) {
  const Model& s = problem.model;
  const Dynamics& d = problem.before;
  const double dt = problem.dt;
  const auto x = positions(d);
  const Suspension suspension = freeze(s, d, d.time, x, motions(d));
  std::vector<Coefficients> r = suspension_forcing(suspension, problem.flows, d.time + dt, s.scene.buoyancy.gravity);
  if (!suspension.interaction.none()) {
    std::vector<Coefficients> tension(x.size());
    for (std::size_t k = 0; k < x.size(); ++k)
      if (const auto& m = suspension.membranes[k]) tension[k] = implicit_force(*m, 0, d.vesicles[k].motion);
    const std::vector<Coefficients> others = interaction_of(suspension, tension, motions(d));
    for (std::size_t k = 0; k < x.size(); ++k)
      if (suspension.membranes[k]) r[k].values += others[k].values;
  }
  Advance a{std::vector<Moved>(x.size()), 0, 0, suspension.division};
  std::vector<Solve> solves(x.size());
  const auto move = [&](int k) {
    const Membrane& m = *suspension.membranes[k];
    // As in solve_suspension(): the rigid motion solves the homogeneous equations for itself.
    const Matrix rigid = frame_velocity(m.body, d.vesicles[k].frame).values;
    Motion guess = d.vesicles[k].motion;
    guess.velocity.values -= rigid;
    Solve self = solve_self(m, dt, {r[k].order, r[k].values - rigid}, guess, solve_tolerance(s.scene));
    if (!self.converged) {
      solves[k] = std::move(self);
      return;
    }
    self.motion.velocity.values += rigid;
    Coefficients moved{x[k].order, x[k].values + dt * self.motion.velocity.values};
    const Frame frame = frame_of(m, self.motion.velocity, problem.flows, d.time + dt);
    const double error = euler_error(d.vesicles[k], self.motion, dt);
    a.vesicles[k] = {std::move(moved), std::move(self.motion), no_sliding(x[k].order), frame, {}, 0, error};
    solves[k] = std::move(self);
  };
  // One by one: threads share the products of each.
  const auto move_all = [&](int) {
    for (int k = 0; k < int(x.size()); ++k)
      if (a.division.mine(k)) move(k);
  };
  divided_for(divided(s.ranks, s.ranks.count), s.ranks.count, move_all, [&](Parcel& parcel, int rank) {
    for (std::size_t k = 0; k < x.size(); ++k)
      if (!a.division.whole() && a.division.owner[k] == rank)
        parcel(solves[k].iterations), parcel(solves[k].residual), parcel(solves[k].converged);
  });
  for (const Solve& self : solves) {
    if (!self.converged) return not_converged(self.residual, self.iterations);
    a.iterations += self.iterations;
    a.residual = std::max(a.residual, self.residual);
  }
  return a;
}

Attempt<Advance> block_implicit(const StepProblem& problem) { return block_scheme(problem, solve_system); }

Attempt<Advance> block_jacobi(const StepProblem& problem) {
  return block_scheme(problem,
                      [](const Membrane& m, double c, const Coefficients& r, const Motion& guess, double tolerance) {
                        Solve tension = solve_tension(m, r, guess, tolerance);
                        if (!tension.converged) return tension;
                        Solve position = solve_position(m, c, r, tension.motion, tolerance);
                        position.iterations += tension.iterations;
                        return position;
                      });
}

Attempt<Advance> explicit_position(const StepProblem& problem) {
  return block_scheme(problem, [](const Membrane& m, double, const Coefficients& r, const Motion& guess,
                                  double tolerance) { return solve_tension(m, r, guess, tolerance); });
}

/// Fixed steps: of the given order as soon as there is a past.
template <int order>
Attempt<Advance> bdf(const StepProblem& problem) {
  return bdf_step(problem, order, Extrapolation::as_order, order);
}

Attempt<Advance> adaptive(const StepProblem& problem) {
  return bdf_step(problem, problem.before.control.order, Extrapolation::one_more, highest_order + 1);
}

}  // namespace

const std::vector<CatalogueRow<Scheme>>& scheme_catalogue() {
  static const std::vector<CatalogueRow<Scheme>> table{
      {"adaptive",
       "steps and orders 1 to 4 that follow a tolerance",
       {},
       {.advance = adaptive, .past_levels = highest_order + 1, .order = highest_order, .slides = true}},
      {"bdf2", "second order, fixed steps", {}, {.advance = bdf<2>, .past_levels = 2, .order = 2, .slides = true}},
      {"bdf3", "third order, fixed steps", {}, {.advance = bdf<3>, .past_levels = 3, .order = 3, .slides = true}},
      {"bdf4", "fourth order, fixed steps", {}, {.advance = bdf<4>, .past_levels = 4, .order = 4, .slides = true}},
      {"globally-implicit", "first order, the paper's backward Euler", {}, {.advance = globally_implicit}},
      {"block-implicit", "first order, the others' forces lag", {}, {.advance = block_implicit}},
      {"block-jacobi", "first order, tension then implicit position", {}, {.advance = block_jacobi}},
      {"explicit", "first order, tension then explicit position", {}, {.advance = explicit_position}},
  };
  return table;
}

std::string_view scheme_name(const Scene& scene) {
  if (scene.time.scheme) return *scene.time.scheme;
  return steps_adapt(scene.time) ? "adaptive" : "bdf2";
}

const Scheme& scheme_of(const Scene& scene) {
  const auto* row = find_row(scheme_catalogue(), scheme_name(scene));
  if (!row) throw std::invalid_argument(fmt::format("'{}' is not a scheme", scheme_name(scene)));
  return row->function;
}

bool grid_slides(const Scene& scene) { return scheme_of(scene).slides && scene.numerics.reparametrization == "moving"; }

}  // namespace sim
