#include "stepper.h"

#include "dealias.h"
#include "norms.h"
#include "parallel.h"
#include "shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace sim {

namespace {

constexpr double four_pi = 4 * std::numbers::pi;

std::vector<int> upsamplings(const Dynamics& d) {
  std::vector<int> rates;
  for (const VesicleDynamics& v : d.vesicles) rates.push_back(v.upsampling);
  return rates;
}

std::vector<Coefficients> positions(const Dynamics& d) {
  std::vector<Coefficients> x;
  for (const VesicleDynamics& v : d.vesicles) x.push_back(v.position);
  return x;
}

std::vector<Motion> motions(const Dynamics& d) {
  std::vector<Motion> m;
  for (const VesicleDynamics& v : d.vesicles) m.push_back(v.motion);
  return m;
}

Suspension freeze(const Setting& s, const Dynamics& d, std::span<const Coefficients> frozen) {
  const NumericsParameters& n = s.scene.numerics;
  SuspensionOptions options{n.source_order, {n.interaction_order, n.near_rule, {n.near_latitudes, n.near_longitudes}},
                            n.repulsion_strength, n.repulsion_range};
  std::vector<Coefficients> expected;
  if (n.implicit_tension)
    for (const VesicleDynamics& v : d.vesicles) expected.push_back(v.motion.tension);
  return freeze_suspension(s.plans, s.materials, frozen, upsamplings(d), options, expected);
}

void require_converged(const char* what, bool converged, double residual, int iterations) {
  if (!converged)
    throw StepFailure(fmt::format("the {} stopped at a relative residual of {:.1e} after {} iterations", what, residual,
                                  iterations));
}

SuspensionSolve solve(const Setting& s, const Suspension& suspension, double c, std::span<const Coefficients> r,
                      std::span<const Motion> guess) {
  const Preconditioner kind =
      s.scene.numerics.preconditioner == "block" ? Preconditioner::block : Preconditioner::spectral;
  SuspensionSolve result = solve_suspension(suspension, c, r, guess, s.scene.numerics.gmres_tolerance, kind);
  require_converged("linear solver", result.converged, result.residual, result.iterations);
  return result;
}

/// x+ = h + c u with everything frozen at `frozen`, h = frozen + `behind` (none: zero), and the flow taken at `time`.
Advance implicit_step(const Setting& s, const Dynamics& d, std::span<const Coefficients> frozen,
                      std::span<const Coefficients> behind, double c, double time, std::span<const Motion> guess) {
  const Suspension suspension = freeze(s, d, frozen);
  const auto r = suspension_forcing(suspension, s.scene.flows, time, s.scene.buoyancy.gravity, behind);
  SuspensionSolve result = solve(s, suspension, c, r, guess);
  Advance a{{}, std::move(result.motions), result.iterations, result.residual};
  for (std::size_t k = 0; k < frozen.size(); ++k) {
    a.positions.push_back({frozen[k].order, frozen[k].values + c * a.motions[k].velocity.values});
    if (!behind.empty()) a.positions[k].values += behind[k].values;
  }
  return a;
}

Advance globally_implicit(const Setting& s, const Dynamics& d, double dt) {
  const auto x = positions(d);
  return implicit_step(s, d, x, {}, dt, d.time + dt, motions(d));
}

/// One step of backward Euler extrapolated from two half ones: how BDF2 starts.
Advance extrapolated_euler(const Setting& s, const Dynamics& d, double dt) {
  const auto x = positions(d);
  const Advance whole = implicit_step(s, d, x, {}, dt, d.time + dt, motions(d));
  const Advance half = implicit_step(s, d, x, {}, dt / 2, d.time + dt / 2, motions(d));
  Advance last = implicit_step(s, d, half.positions, {}, dt / 2, d.time + dt, half.motions);
  for (std::size_t k = 0; k < x.size(); ++k)
    last.positions[k].values = 2 * last.positions[k].values - whole.positions[k].values;
  last.iterations += whole.iterations + half.iterations;
  last.residual = std::max({whole.residual, half.residual, last.residual});
  return last;
}

Advance bdf2(const Setting& s, const Dynamics& d, double dt) {
  if (!d.history) return extrapolated_euler(s, d, dt);
  const double r = dt / d.dt_before;
  std::vector<Coefficients> frozen, behind;
  for (const VesicleDynamics& v : d.vesicles) {
    frozen.push_back({v.position.order, v.position.values + r * v.displacement.values});
    behind.push_back({v.position.order, (r * r / (1 + 2 * r) - r) * v.displacement.values});
  }
  return implicit_step(s, d, frozen, behind, dt * (1 + r) / (1 + 2 * r), d.time + dt, motions(d));
}

/// The three schemes that solve vesicle by vesicle: what the others do is that of x_n, sigma_n, u_n.
Advance block_scheme(const Setting& s, const Dynamics& d, double dt,
                     Solve (*solve_self)(const Membrane&, double dt, const Coefficients& r, const Motion&, double)) {
  const auto x = positions(d);
  const Suspension suspension = freeze(s, d, x);
  std::vector<Coefficients> r = suspension_forcing(suspension, s.scene.flows, d.time + dt, s.scene.buoyancy.gravity);
  if (x.size() > 1) {
    std::vector<Coefficients> tension;
    for (std::size_t k = 0; k < x.size(); ++k)
      tension.push_back(implicit_force(suspension.membranes[k], 0, d.vesicles[k].motion));
    const std::vector<Coefficients> others = interaction_of(suspension, tension, motions(d));
    for (std::size_t k = 0; k < x.size(); ++k) r[k].values += others[k].values;
  }
  Advance a;
  for (std::size_t k = 0; k < x.size(); ++k) {
    Solve self = solve_self(suspension.membranes[k], dt, r[k], d.vesicles[k].motion, s.scene.numerics.gmres_tolerance);
    require_converged("linear solver", self.converged, self.residual, self.iterations);
    a.positions.push_back({x[k].order, x[k].values + dt * self.motion.velocity.values});
    a.motions.push_back(std::move(self.motion));
    a.iterations += self.iterations;
    a.residual = std::max(a.residual, self.residual);
  }
  return a;
}

Advance block_implicit(const Setting& s, const Dynamics& d, double dt) {
  return block_scheme(s, d, dt, solve_system);
}

Advance block_jacobi(const Setting& s, const Dynamics& d, double dt) {
  return block_scheme(s, d, dt, [](const Membrane& m, double c, const Coefficients& r, const Motion& guess, double tolerance) {
    const Solve tension = solve_tension(m, r, guess, tolerance);
    if (!tension.converged) return tension;
    Solve position = solve_position(m, c, r, tension.motion, tolerance);
    position.iterations += tension.iterations;
    return position;
  });
}

Advance explicit_position(const Setting& s, const Dynamics& d, double dt) {
  return block_scheme(s, d, dt, [](const Membrane& m, double, const Coefficients& r, const Motion& guess, double tolerance) {
    return solve_tension(m, r, guess, tolerance);
  });
}

Geometry measured_geometry(Plans& plans, const Coefficients& x) {
  return geometry(plans.basis(x.order, measure_order(x.order)), x);
}

double energy_of(const Geometry& g) { return integrate(g, g.H.cwiseAbs2()) / four_pi; }

/// Moves the grid points along the membrane and carries everything that belongs to the material. False: it would not pay.
bool relabel_vesicle(const Setting& s, VesicleDynamics& v) {
  const int p = v.position.order;
  const Relabelling r = relabel(s.plans, v.position, 2 * p);
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
  v.tracers = carried_points(r, before, v.position, v.tracers);
  v.high_share = high_degree_share(v.position);
  ++v.relabelled;
  return true;
}

bool relabelling_due(const std::string& mode, const VesicleDynamics& v) {
  if (mode == "off") return false;
  if (mode == "always") return true;
  constexpr double growth = 2, negligible = 1e-2;
  return high_degree_share(v.position) > std::max(growth * v.high_share, negligible);
}

/// Shifts x to the area and volume of the start; returns the longest shift.
double correct(const Setting& s, VesicleDynamics& v, const Geometry& g) {
  const Correction c = area_volume_correction(s.plans, v.position, g, v.area, v.volume);
  if (!c.converged || c.largest > 0.1 * std::sqrt(v.area / four_pi))
    throw StepFailure(fmt::format("the area and volume correction failed (shift {:.1e})", c.largest));
  v.position.values += c.shift.values;
  return c.largest;
}

/// `after`: the geometry that the step has led to.
void check_step(const NumericsParameters& n, const Geometry& after, double area_before, double energy_before) {
  const double change = after.dA.sum() / area_before - 1;
  if (!(std::abs(change) <= n.step_area_bound))
    throw StepFailure(fmt::format("the area changed by {:.2g} % in one step", 100 * change));
  const double energy = energy_of(after);
  if (!(std::abs(energy - energy_before) <= n.step_energy_bound * energy_before))
    throw StepFailure(fmt::format("the bending energy jumped from {:.4g} to {:.4g}", energy_before, energy));
}

}  // namespace

const std::vector<CatalogueRow<SchemeFunction>>& scheme_catalogue() {
  static const std::vector<CatalogueRow<SchemeFunction>> table{
      {"bdf2", "second order, geometry extrapolated to the new time", {}, bdf2},
      {"globally-implicit", "first order, the paper's backward Euler", {}, globally_implicit},
      {"block-implicit", "first order, the others' forces lag", {}, block_implicit},
      {"block-jacobi", "first order, tension then implicit position", {}, block_jacobi},
      {"explicit", "first order, tension then explicit position", {}, explicit_position},
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
  if (s.scene.vesicles.empty()) throw std::invalid_argument("the scene has no vesicle");
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
    const Geometry g = measured_geometry(s.plans, v.position);
    const Measures measured = measures(g);
    v.area = measured.area;
    v.volume = measured.volume;
    v.energy = measured.h_squared / four_pi;
    const NumericsParameters& n = s.scene.numerics;
    v.upsampling = n.upsampling > 0 ? n.upsampling : upsampling_rate(s.plans, v.position, n.aliasing_tolerance);
    v.upsampling_due = 1;
    v.tail = curvature_tail(s.plans.basis(p, measure_order(p)), g);
    v.high_share = high_degree_share(v.position);
    d.vesicles.push_back(std::move(v));
  }
  if (const Gap gap = smallest_gap(s.plans, positions(d)); gap.crossing)
    throw std::invalid_argument(fmt::format("vesicles {} and {} overlap", gap.first, gap.second));
  else if (gap.distance < s.scene.numerics.gap_floor)
    throw std::invalid_argument(fmt::format("vesicles {} and {} are {:.3g} apart, less than numerics.gap_floor = {:.3g}",
                                            gap.first, gap.second, gap.distance, s.scene.numerics.gap_floor));
  return d;
}

namespace {

/// Checks, correction, relabelling and renewal of one vesicle after its scheme has moved it.
VesicleStep finish_vesicle(const Setting& s, VesicleDynamics& v, Coefficients position, Motion motion, double time) {
  const NumericsParameters& n = s.scene.numerics;
  if (!position.values.allFinite()) throw StepFailure("a position is not finite");
  const int p = position.order;
  const Basis& measured = s.plans.basis(p, measure_order(p));
  const Geometry moved = geometry(measured, position);
  check_step(n, moved, n.correction ? v.area : area_volume(measured, v.position).area, v.energy);
  v.displacement.values = position.values - v.position.values;
  v.position = std::move(position);
  v.motion = std::move(motion);
  VesicleStep record;
  if (n.correction) record.correction = correct(s, v, moved);
  if (relabelling_due(n.reparametrization, v) && relabel_vesicle(s, v)) {
    record.relabelled = 1;
    if (n.correction) record.correction = std::max(record.correction, correct(s, v, measured_geometry(s.plans, v.position)));
    if (labels_wound_up(v.labels)) {
      v.labels = fresh_labels(v.labels.order);
      ++v.labels_laid;
      v.labels_laid_time = time;
    }
  }
  const Geometry now = measured_geometry(s.plans, v.position);
  const Measures after = measures(now);
  v.energy = after.h_squared / four_pi;
  if (n.upsampling == 0 && time >= v.upsampling_due) {
    v.upsampling = upsampling_rate(s.plans, v.position, n.aliasing_tolerance);
    v.upsampling_due = time + 1;
  }
  record.area_error = after.area / v.area - 1;
  record.volume_error = after.volume / v.volume - 1;
  record.energy = v.energy;
  record.upsampling = v.upsampling;
  record.tail = v.tail = curvature_tail(measured, now);
  return record;
}

}  // namespace

Step take_step(const Setting& s, const Dynamics& before, double dt) {
  const SchemeFunction scheme = find_row(scheme_catalogue(), s.scene.time.scheme)->function;
  Step step{before, {}};
  Dynamics& d = step.dynamics;
  StepRecord& record = step.record;
  try {
    Advance advance = scheme(s, before, dt);
    d.time = before.time + dt;
    record.vesicles.resize(d.vesicles.size());
    parallel_for(int(d.vesicles.size()), [&](int k) {
      record.vesicles[k] =
          finish_vesicle(s, d.vesicles[k], std::move(advance.positions[k]), std::move(advance.motions[k]), d.time);
    });
    const Gap gap = smallest_gap(s.plans, positions(d));
    if (gap.crossing || gap.distance < s.scene.numerics.gap_floor)
      throw StepFailure(fmt::format("vesicles {} and {} {}", gap.first, gap.second,
                                    gap.crossing ? "would cross" : fmt::format("would come within {:.2g}", gap.distance)));
    record.gap = gap.distance;
    record.iterations = advance.iterations;
    record.residual = advance.residual;
  } catch (const std::domain_error& error) {
    throw StepFailure(error.what());
  }
  d.step = before.step + 1;
  d.dt_before = dt;
  d.history = true;
  record.step = double(d.step);
  record.dt = dt;
  record.time = d.time;
  return step;
}

State evaluate(const Setting& s, const Dynamics& d) try {
  const auto x = positions(d);
  const Suspension suspension = freeze(s, d, x);
  const auto r = suspension_forcing(suspension, s.scene.flows, d.time, s.scene.buoyancy.gravity);
  SuspensionSolve result = solve(s, suspension, 0, r, motions(d));
  State state{d.step, d.time, {}};
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    const VesicleDynamics& v = d.vesicles[k];
    const Membrane& m = suspension.membranes[k];
    Motion& motion = result.motions[k];
    if (reduced_volume(v.area, v.volume) > 1 - 1e-9) {  // a sphere: only tensions of zero mean are determined
      const Matrix sigma = m.bases.field.synthesize(motion.tension).values;
      motion.tension.values(0, 0) -= integrate(m.geometry, sigma.col(0)) / m.geometry.dA.sum() * std::sqrt(four_pi);
    }
    VesicleState out{v.position, motion.velocity, motion.tension, v.labels, v.tracers, v.saved_position,
                     v.saved_velocity, v.relabelled, v.labels_laid, v.labels_laid_time};
    if (d.saves == 0) out.velocity_before = out.velocity;
    state.vesicles.push_back(std::move(out));
  }
  return state;
} catch (const std::domain_error& error) {
  throw StepFailure(error.what());
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
