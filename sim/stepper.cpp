#include "stepper.h"

#include "dealias.h"
#include "norms.h"
#include "shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace sim {

namespace {

constexpr double four_pi = 4 * std::numbers::pi;

/// x+ = h + c u with everything frozen at `frozen`.
Advance implicit_step(const Setting& s, const VesicleDynamics& v, const Material& material, const Coefficients& frozen,
                      const Coefficients& history, double c, double time, const Motion& guess) {
  const Membrane m = freeze_membrane(s.plans, material, frozen, v.upsampling, s.scene.numerics.source_order);
  const Coefficients r = forcing(m, s.scene.flows, time, s.scene.buoyancy.gravity, history);
  const Solve solve = solve_system(m, c, r, guess, s.scene.numerics.gmres_tolerance);
  if (!solve.converged)
    throw StepFailure(fmt::format("the linear solver stopped at a relative residual of {:.1e} after {} iterations",
                                  solve.residual, solve.iterations));
  return {{frozen.order, history.values + c * solve.motion.velocity.values}, solve.motion, solve.iterations, solve.residual};
}

Advance backward_euler(const Setting& s, const VesicleDynamics& v, const Material& material, const Coefficients& x,
                       double time, double dt, const Motion& guess) {
  return implicit_step(s, v, material, x, x, dt, time + dt, guess);
}

Advance globally_implicit(const Setting& s, const Dynamics& d, std::size_t k, double dt) {
  const VesicleDynamics& v = d.vesicles[k];
  return backward_euler(s, v, s.materials[k], v.position, d.time, dt, v.motion);
}

Advance bdf2(const Setting& s, const Dynamics& d, std::size_t k, double dt) {
  const VesicleDynamics& v = d.vesicles[k];
  const Material& material = s.materials[k];
  if (!d.history) {
    const Advance whole = backward_euler(s, v, material, v.position, d.time, dt, v.motion);
    const Advance half = backward_euler(s, v, material, v.position, d.time, dt / 2, v.motion);
    Advance last = backward_euler(s, v, material, half.position, d.time + dt / 2, dt / 2, half.motion);
    last.position.values = 2 * last.position.values - whole.position.values;
    last.iterations += whole.iterations + half.iterations;
    last.residual = std::max({whole.residual, half.residual, last.residual});
    return last;
  }
  const double r = dt / d.dt_before;
  const Coefficients frozen{v.position.order, v.position.values + r * v.displacement.values};
  const Coefficients history{v.position.order, v.position.values + r * r / (1 + 2 * r) * v.displacement.values};
  return implicit_step(s, v, material, frozen, history, dt * (1 + r) / (1 + 2 * r), d.time + dt, v.motion);
}

double energy_of(Plans& plans, const Coefficients& x) {
  return measures(geometry(plans.basis(x.order, measure_order(x.order)), x)).h_squared / four_pi;
}

/// Moves the grid points along the membrane and carries everything that belongs to the material. False: it would not pay.
bool relabel_vesicle(const Setting& s, VesicleDynamics& v) {
  const int p = v.position.order;
  const Relabelling r = relabel(s.plans, v.position, std::max(2 * p, v.labels.order));
  // Truncating the relabelled surface is an error that stays; a relabelling must lose little of the shape.
  constexpr double least_gain = 0.9, most_lost = 0.05;
  if (r.high_after > least_gain * r.high_before || r.lost > most_lost * (r.high_before - r.high_after)) {
    v.high_share = r.high_before;
    return false;
  }
  const Coefficients before = v.position;
  for (Coefficients* c : {&v.position, &v.displacement, &v.motion.velocity, &v.motion.tension, &v.labels,
                          &v.saved_position, &v.saved_velocity})
    *c = pulled_back(s.plans, r, *c);
  v.tracers = carried_points(s.plans, r, before, v.position, v.tracers);
  v.high_share = high_degree_share(v.position);
  ++v.relabelled;
  return true;
}

bool relabelling_due(const std::string& mode, const VesicleDynamics& v) {
  if (mode == "off") return false;
  if (mode == "always") return true;
  constexpr double growth = 1.5, negligible = 5e-3;
  return high_degree_share(v.position) > std::max(growth * v.high_share, negligible);
}

/// Shifts x to the area and volume of the start; returns the longest shift.
double correct(const Setting& s, VesicleDynamics& v) {
  const Correction c = area_volume_correction(s.plans, v.position, v.area, v.volume);
  if (!c.converged || c.largest > 0.1 * std::sqrt(v.area / four_pi))
    throw StepFailure(fmt::format("the area and volume correction failed (shift {:.1e})", c.largest));
  v.position.values += c.shift.values;
  return c.largest;
}

void check_step(const NumericsParameters& n, const Coefficients& before, const Coefficients& after, Plans& plans,
                double energy_before) {
  if (!after.values.allFinite()) throw StepFailure("a position is not finite");
  const Basis& basis = plans.basis(after.order, measure_order(after.order));
  const double change = area_volume(basis, after).area / area_volume(basis, before).area - 1;
  if (!(std::abs(change) <= n.step_area_bound))
    throw StepFailure(fmt::format("the area changed by {:.2g} % in one step", 100 * change));
  const double energy = energy_of(plans, after);
  if (!(std::abs(energy - energy_before) <= n.step_energy_bound * energy_before))
    throw StepFailure(fmt::format("the bending energy jumped from {:.4g} to {:.4g}", energy_before, energy));
}

}  // namespace

const std::vector<CatalogueRow<SchemeFunction>>& scheme_catalogue() {
  static const std::vector<CatalogueRow<SchemeFunction>> table{
      {"bdf2", "second order, geometry extrapolated to the new time", {}, bdf2},
      {"globally-implicit", "first order, the paper's backward Euler", {}, globally_implicit},
  };
  return table;
}

Setting make_setting(const Scene& scene, Plans& plans) {
  Setting s{scene, plans, {}};
  for (const VesicleParameters& v : scene.vesicles)
    s.materials.push_back({v.viscosity_contrast, v.bending_modulus, v.density_difference});
  return s;
}

Dynamics initial_dynamics(const Setting& s) {
  if (s.scene.vesicles.size() != 1)
    throw std::invalid_argument(fmt::format("the scene has {} vesicles; flows of exactly one can be computed so far",
                                            s.scene.vesicles.size()));
  Dynamics d;
  d.dt_limit = s.scene.time.step;
  for (const VesicleParameters& parameters : s.scene.vesicles) {
    VesicleDynamics v;
    v.position = initial_position(parameters);
    const int p = v.position.order;
    v.displacement = v.saved_velocity = v.motion.velocity = {p, Matrix::Zero(coefficient_count(p), 3)};
    v.motion.tension = {p, Matrix::Zero(coefficient_count(p), 1)};
    v.saved_position = v.position;
    const int label_order = s.scene.numerics.label_order;
    v.labels = fresh_labels(label_order > 0 ? label_order : std::max(2 * p, 24));
    v.tracers = tracer_directions();
    const AreaVolume av = area_volume(s.plans.basis(p, measure_order(p)), v.position);
    v.area = av.area;
    v.volume = av.volume;
    v.energy = energy_of(s.plans, v.position);
    const NumericsParameters& n = s.scene.numerics;
    v.upsampling = n.upsampling > 0 ? n.upsampling : upsampling_rate(s.plans, v.position, n.aliasing_tolerance);
    v.upsampling_due = 1;
    v.tail = curvature_tail(s.plans, v.position, v.upsampling * p);
    v.high_share = high_degree_share(v.position);
    d.vesicles.push_back(std::move(v));
  }
  return d;
}

Step take_step(const Setting& s, const Dynamics& before, double dt) {
  const NumericsParameters& n = s.scene.numerics;
  const SchemeFunction scheme = find_row(scheme_catalogue(), s.scene.time.scheme)->function;
  Step step{before, {}};
  Dynamics& d = step.dynamics;
  d.step = before.step + 1;
  d.time = before.time + dt;
  step.record.step = double(d.step);
  step.record.dt = dt;
  step.record.gap = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) try {
      VesicleDynamics& v = d.vesicles[k];
      Advance advance = scheme(s, before, k, dt);
      check_step(n, v.position, advance.position, s.plans, v.energy);
      v.displacement.values = advance.position.values - v.position.values;
      v.position = std::move(advance.position);
      v.motion = std::move(advance.motion);
      VesicleStep record;
      if (n.correction) record.correction = correct(s, v);
      if (relabelling_due(n.reparametrization, v) && relabel_vesicle(s, v)) {
        record.relabelled = 1;
        if (n.correction) record.correction = std::max(record.correction, correct(s, v));
        if (labels_wound_up(v.labels)) {
          v.labels = fresh_labels(v.labels.order);
          ++v.labels_laid;
          v.labels_laid_time = d.time;
        }
      }
      v.energy = energy_of(s.plans, v.position);
      if (n.upsampling == 0 && d.time >= v.upsampling_due) {
        v.upsampling = upsampling_rate(s.plans, v.position, n.aliasing_tolerance);
        v.upsampling_due = d.time + 1;
      }
      const AreaVolume av = area_volume(s.plans.basis(v.position.order, measure_order(v.position.order)), v.position);
      record.area_error = av.area / v.area - 1;
      record.volume_error = av.volume / v.volume - 1;
      record.energy = v.energy;
      record.upsampling = v.upsampling;
      record.tail = v.tail = curvature_tail(s.plans, v.position, v.upsampling * v.position.order);
      step.record.iterations += advance.iterations;
      step.record.residual = std::max(step.record.residual, advance.residual);
      step.record.vesicles.push_back(record);
    } catch (const std::domain_error& error) {
      throw StepFailure(error.what());
    }
  d.dt_before = dt;
  d.history = true;
  step.record.time = d.time;
  return step;
}

State evaluate(const Setting& s, const Dynamics& d) {
  State state{d.step, d.time, {}};
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    const VesicleDynamics& v = d.vesicles[k];
    const Membrane m =
        freeze_membrane(s.plans, s.materials[k], v.position, v.upsampling, s.scene.numerics.source_order);
    const Coefficients r = forcing(m, s.scene.flows, d.time, s.scene.buoyancy.gravity, v.position);
    Solve solve = solve_system(m, 0, r, v.motion, s.scene.numerics.gmres_tolerance);
    if (!solve.converged)
      throw StepFailure(fmt::format("the velocity of vesicle {} could not be solved for (relative residual {:.1e})", k,
                                    solve.residual));
    if (reduced_volume(v.area, v.volume) > 1 - 1e-9) {  // a sphere: only tensions of zero mean are determined
      const Matrix sigma = m.bases.field.synthesize(solve.motion.tension).values;
      solve.motion.tension.values(0, 0) -=
          integrate(m.geometry, sigma.col(0)) / m.geometry.dA.sum() * std::sqrt(four_pi);
    }
    VesicleState out{v.position, solve.motion.velocity, solve.motion.tension, v.labels, v.tracers, v.saved_position,
                     v.saved_velocity, v.relabelled, v.labels_laid, v.labels_laid_time};
    if (d.saves == 0) out.velocity_before = out.velocity;
    state.vesicles.push_back(std::move(out));
  }
  return state;
}

void mark_saved(Dynamics& d, const State& state) {
  ++d.saves;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    d.vesicles[k].saved_position = state.vesicles[k].position;
    d.vesicles[k].saved_velocity = state.vesicles[k].velocity;
  }
}

std::string resolution_warning(const Setting& s, const Dynamics& d, std::size_t k) {
  const VesicleDynamics& v = d.vesicles[k];
  return fmt::format(
      "vesicle {}: order {} does not resolve the shape well ({:.0f} % of the mean curvature's spectrum lies in its last "
      "quarter; bound {:.0f} %); try order {}",
      k, v.position.order, 100 * v.tail, 100 * s.scene.numerics.tail_warning, v.position.order * 3 / 2);
}

std::vector<std::string> resolution_warnings(const Setting& s, const Dynamics& d) {
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k)
    if (d.vesicles[k].tail > s.scene.numerics.tail_warning) warnings.push_back(resolution_warning(s, d, k));
  return warnings;
}

}  // namespace sim
