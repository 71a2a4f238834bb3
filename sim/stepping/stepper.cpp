#include "sim/stepping/stepper.h"

#include "sim/surface/dealias.h"
#include "sim/core/digits.h"
#include "sim/suspension/gap.h"
#include "sim/sphere/norms.h"
#include "sim/core/parallel.h"
#include "sim/surface/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <type_traits>

namespace sim {

namespace {

constexpr double four_pi = 4 * std::numbers::pi;
constexpr double upsampling_steps = 10;  ///< Algorithm 1 runs anew after a time of so many whole steps

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
  carry(s.plans, r, v);
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

/// Shifts x to the area and volume of the start, and its past along with it if the scheme says so; the longest shift.
Attempt<double> correct(const Setting& s, const Scheme& scheme, VesicleDynamics& v, const Geometry& g) {
  const Correction c = is_sphere({v.area, v.volume}) ? volume_correction(s.plans, v.position, g, v.area, v.volume)
                                                   : area_volume_correction(s.plans, v.position, g, v.area, v.volume);
  if (!c.converged || c.largest > 0.1 * std::sqrt(v.area / four_pi))
    return Rejection{fmt::format("the area and volume correction failed (shift {:.1e})", c.largest)};
  v.position.values += c.shift.values;
  if (scheme.past_corrected) move_along(v.history, c.shift);
  return c.largest;
}

/// Why a step must not have led to this geometry, if so.
std::optional<Rejection> objection(const NumericsParameters& n, const Geometry& after, double area_before, double energy_before) {
  const double change = after.dA.sum() / area_before - 1;
  if (!(std::abs(change) <= n.step_area_bound))
    return Rejection{fmt::format("the area changed by {:.2g} % in one step", 100 * change)};
  const double energy = energy_of(after);
  if (!(std::abs(energy - energy_before) <= n.step_energy_bound * energy_before))
    return Rejection{fmt::format("the bending energy jumped from {:.4g} to {:.4g}", energy_before, energy)};
  return std::nullopt;
}

/// Geometry refuses surfaces that are none, and crossings: a step that leads to one is rejected.
template <class F>
auto within_domain(F&& f) -> decltype(f()) try {
  return f();
} catch (const std::domain_error& error) {
  return Rejection{error.what()};
}

}  // namespace

double longest_step(const Scene& scene) {
  // Measured on a tank-treading prolate: 20 steps a period leave 1 % of the amplitude.
  constexpr double steps_a_period = 20;
  double longest = scene.time.step;
  for (const FlowParameters& flow : scene.flows)
    if (const double frequency = oscillation(flow); frequency > 0)
      longest = std::min(longest, 1 / (steps_a_period * frequency));
  return longest;
}

namespace {

/// x := c + R (x - c)/|x - c|, the sphere of the given volume.
void make_round(Coefficients& x, double volume) {
  const double radius = std::cbrt(3 * volume / four_pi);
  const Basis basis(x.order, 2 * x.order + 8);
  const Vec3 centre = rigid_body(x).centre;
  Matrix arms = basis.synthesize(x).values.rowwise() - centre.transpose();
  arms.rowwise().normalize();
  const Coefficients round = basis.analyze(Matrix(radius * arms));
  x = round;
  x.values.row(0) += std::sqrt(four_pi) * centre.transpose();
}

/// What a vesicle starts with that no step has moved yet, or that other flows take from now on: the frame of the flow.
void start_anew(const Setting& s, double time, VesicleDynamics& v) {
  const Basis& basis = s.plans.basis(v.position.order, v.position.order + 1);
  const Matrix points = basis.synthesize(v.position).values;
  const RigidBody body = rigid_body(v.position);
  const Coefficients flow = basis.analyze(background_velocity(s.scene.flows, time, points));
  v.frame = {rigid_part(body, flow), mean_gradient(body, flow)};
  v.motion.velocity = rigid_velocity(body, v.frame.motion);
  const NumericsParameters& n = s.scene.numerics;
  v.upsampling = n.upsampling > 0 ? n.upsampling : upsampling_rate(s.plans, v.position, n.aliasing_tolerance);
  v.upsampling_due = time + upsampling_steps * s.scene.time.step;
}

/// Longest step from a start: four until flows are switched again. A nearly round vesicle uses up its excess area in a time of sqrt(1 - nu) over the rate of
/// straining; a quarter of it suits all contrasts from 0.1 on.
double start_step(const Setting& s, const Dynamics& d) {
  const std::vector<AreaVolume> all = sizes(d);
  const double rate = straining_rate(s.plans, s.scene.flows, s.scene.buoyancy.gravity, s.materials, positions(d), all);
  constexpr double nearly_round = 0.02;
  double longest = std::min(longest_step(s.scene), (next_switch(s.scene.flows, d.time) - d.time) / 4);
  for (const AreaVolume& size : all)
    if (const double excess = 1 - reduced_volume(size.area, size.volume); excess < nearly_round && !is_sphere(size))
      longest = std::min(longest, 0.25 * std::sqrt(excess) / rate);
  return longest;
}

}  // namespace

Dynamics initial_dynamics(const Setting& s) {
  if (s.scene.vesicles.empty()) throw std::invalid_argument("the scene has no vesicle");
  Dynamics d;
  for (const VesicleParameters& parameters : s.scene.vesicles) {
    VesicleDynamics v;
    v.position = initial_position(parameters);
    const int p = v.position.order;
    if (const Measures given = measures(measured_geometry(s.plans, v.position)); is_sphere({given.area, given.volume}))
      make_round(v.position, given.volume);
    const int label_order = s.scene.numerics.label_order;
    v.labels = fresh_labels(label_order > 0 ? label_order : std::max(2 * p, 24));
    v.tracers = tracer_directions();
    v.saved_position = v.position;
    visit(v, [&]<class Member>(Part part, Member& member) {  // fields that nothing is known of yet
      if constexpr (std::is_same_v<Member, Coefficients>)
        if (member.values.size() == 0) member = {p, Matrix::Zero(coefficient_count(p), part == Part::scalar ? 1 : 3)};
    });
    const Geometry g = measured_geometry(s.plans, v.position);
    const Measures measured = measures(g);
    v.area = measured.area;
    v.volume = measured.volume;
    v.energy = measured.h_squared / four_pi;
    v.tail = curvature_tail(s.plans.basis(p, measure_order(p)), g);
    v.high_share = high_degree_share(v.position);
    start_anew(s, 0, v);
    d.vesicles.push_back(std::move(v));
  }
  if (const Gap gap = smallest_gap(s.plans, positions(d)); gap.crossing)
    throw std::invalid_argument(fmt::format("vesicles {} and {} overlap", gap.first, gap.second));
  else if (gap.distance < gap_floor(s, d))
    throw std::invalid_argument(fmt::format("vesicles {} and {} are {:.3g} apart, less than numerics.gap_floor = {:.3g}",
                                            gap.first, gap.second, gap.distance, gap_floor(s, d)));
  d.dt_limit = start_step(s, d);
  if (s.scene.time.scheme == "explicit")
    for (std::size_t k = 0; k < d.vesicles.size(); ++k)
      if (is_sphere({d.vesicles[k].area, d.vesicles[k].volume}))
        throw std::invalid_argument(fmt::format("vesicle {} is a sphere, which the scheme 'explicit' cannot hold in shape; take "
                                                "another time.scheme",
                                                k));
  return d;
}

namespace {

/// Checks, correction, relabelling and renewal of one vesicle after its scheme has moved it.
Attempt<VesicleStep> finish_vesicle(const Setting& s, VesicleDynamics& v, Moved moved, double time) {
  const NumericsParameters& n = s.scene.numerics;
  const Scheme& scheme = scheme_of(s.scene);
  if (!moved.position.values.allFinite()) return Rejection{"a position is not finite"};
  const int p = moved.position.order;
  const Basis& measured = s.plans.basis(p, measure_order(p));
  const Geometry there = geometry(measured, moved.position);
  if (auto rejection = objection(n, there, n.correction ? v.area : area_volume(measured, v.position).area, v.energy))
    return *rejection;
  v.position = std::move(moved.position);
  v.motion = std::move(moved.motion);
  v.frame = moved.frame;
  v.history = std::move(moved.history);
  VesicleStep record;
  const auto correct_to = [&](const Geometry& g) -> std::optional<Rejection> {
    const Attempt<double> shift = correct(s, scheme, v, g);
    if (!shift) return shift.rejection();
    record.correction = std::max(record.correction, *shift);
    return std::nullopt;
  };
  if (n.correction)
    if (auto rejection = correct_to(there)) return *rejection;
  if (relabelling_due(n.reparametrization, v) && relabel_vesicle(s, v)) {
    record.relabelled = 1;
    if (n.correction)
      if (auto rejection = correct_to(measured_geometry(s.plans, v.position))) return *rejection;
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
    v.upsampling_due = time + upsampling_steps * s.scene.time.step;
  }
  record.area_error = after.area / v.area - 1;
  record.volume_error = after.volume / v.volume - 1;
  record.energy = v.energy;
  record.upsampling = v.upsampling;
  record.tail = v.tail = curvature_tail(measured, now);
  return record;
}

/// Finishes all vesicles; of several rejections that of the first vesicle counts.
std::optional<Rejection> finish_vesicles(const Setting& s, Dynamics& d, Advance& advance, StepRecord& record) {
  const int n = int(d.vesicles.size());
  record.vesicles.resize(n);
  std::vector<std::optional<Rejection>> rejections(n);
  parallel_for(n, [&](int k) {
    const Attempt<VesicleStep> finished =
        within_domain([&] { return finish_vesicle(s, d.vesicles[k], std::move(advance.vesicles[k]), d.time); });
    if (finished) record.vesicles[k] = *finished;
    else rejections[k] = finished.rejection();
  });
  for (const auto& rejection : rejections)
    if (rejection) return rejection;
  return std::nullopt;
}

}  // namespace

Attempt<Step> take_step(const Setting& s, const Dynamics& before, double dt) {
  const auto flows = acting_flows(s.scene.flows, before.time, before.time + dt);
  Attempt<Advance> advance = within_domain([&] { return scheme_of(s.scene).advance({s, before, dt, flows}); });
  if (!advance) return advance.rejection();
  Step step{before, {}};
  Dynamics& d = step.dynamics;
  StepRecord& record = step.record;
  d.time = before.time + dt;
  if (auto rejection = finish_vesicles(s, d, *advance, record)) return *rejection;
  const Gap gap = smallest_gap(s.plans, positions(d));
  if (gap.crossing || gap.distance < gap_floor(s, d))
    return Rejection{fmt::format("vesicles {} and {} {}", gap.first, gap.second,
                                 gap.crossing ? "would cross" : fmt::format("would come within {:.2g}", gap.distance))};
  d.step = before.step + 1;
  record.step = double(d.step);
  record.dt = dt;
  record.time = d.time;
  record.gap = gap.distance;
  record.iterations = advance->iterations;
  record.residual = advance->residual;
  return step;
}

Attempt<State> evaluate(const Setting& s, const Dynamics& d) {
  return within_domain([&]() -> Attempt<State> {
    const auto x = positions(d);
    const Suspension suspension = freeze(s, d, x);
    const auto r = suspension_forcing(suspension, s.scene.flows, d.time, s.scene.buoyancy.gravity);
    Attempt<SuspensionSolve> result = solve(s, suspension, 0, r, motions(d), frames(d));
    if (!result) return result.rejection();
    State state{d.step, d.time, {}};
    for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
      const VesicleDynamics& v = d.vesicles[k];
      const Membrane& m = suspension.membranes[k];
      Motion& motion = result->motions[k];
      if (is_sphere({v.area, v.volume})) {  // only tensions of zero mean are determined
        const Matrix sigma = m.bases.field.synthesize(motion.tension).values;
        motion.tension.values(0, 0) -= integrate(m.geometry, sigma.col(0)) / m.geometry.dA.sum() * std::sqrt(four_pi);
      }
      VesicleState out{v.position, motion.velocity, motion.tension, v.labels, v.tracers, v.saved_position,
                       v.saved_velocity, v.relabelled, v.labels_laid, v.labels_laid_time};
      if (d.saves == 0) out.velocity_before = out.velocity;
      state.vesicles.push_back(std::move(out));
    }
    return state;
  });
}

Attempt<Dynamics> begun_anew(const Setting& s, Dynamics d) {
  d.dt_limit = start_step(s, d);
  d.calm = 0;
  for (VesicleDynamics& v : d.vesicles) {
    v.history = {};
    start_anew(s, d.time, v);
  }
  const Attempt<State> now = evaluate(s, d);
  if (!now) return now.rejection();
  expect(s, d, *now);
  return d;
}

void expect(const Setting& s, Dynamics& d, const State& state) {
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    VesicleDynamics& v = d.vesicles[k];
    v.motion = {state.vesicles[k].velocity, state.vesicles[k].tension};
    const Basis& basis = s.plans.basis(v.position.order, measure_order(v.position.order));
    v.frame.motion = shape_motion(rigid_body(v.position), geometry(basis, v.position), basis.synthesize(v.motion.velocity).values);
  }
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
  const auto [tail, bound] = told_apart(100 * v.tail, 100 * s.scene.numerics.tail_warning);
  return fmt::format(
      "vesicle {}: order {} does not resolve the shape well ({} % of the mean curvature's spectrum lies in its last "
      "quarter; bound {} %); try order {}",
      k, v.position.order, tail, bound, v.position.order * 3 / 2);
}

namespace {

/// The table of the scene that a flow stands in, and the keys that give it a strength.
std::string still_flow_warning(const Scene& scene, std::size_t k) {
  const FlowParameters& flow = scene.flows[k];
  const std::string table = scene.flows.size() > 1 ? fmt::format("[[flow]] {}", k) : "[flow]";
  if (flow.time_factor == "step" && (flow.from >= flow.until || flow.from >= scene.time.end || flow.until <= 0))
    return fmt::format("{}: '{}' never acts: from = {}, until = {}, time.end = {}", table, flow.kind, flow.from, flow.until,
                       scene.time.end);
  std::string keys;
  for (std::string_view key : find_row(flow_catalogue(), flow.kind)->keys)
    if (key != "planar") keys += fmt::format("{}flow.{}", keys.empty() ? "" : " or ", key);
  return fmt::format("{}: '{}' moves nothing, its strength is 0; give {}", table, flow.kind, keys);
}

}  // namespace

std::vector<std::string> scene_warnings(const Setting& s, const Dynamics& d) {
  const Scene& scene = s.scene;
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < scene.flows.size(); ++k)
    if (scene.flows[k].kind != "none" && scene.time.end > 0 && !moves(scene.flows[k], scene.time.end))
      warnings.push_back(still_flow_warning(scene, k));
  if (const double longest = longest_step(scene); longest < scene.time.step)
    warnings.push_back(fmt::format("a flow oscillates {:.3g} times in a step of {:.3g}; steps of {:.3g} are taken, 20 a period",
                                   scene.time.step / (20 * longest), scene.time.step, longest));
  for (std::size_t k = 0; k < d.vesicles.size(); ++k)
    if (d.vesicles[k].tail > scene.numerics.tail_warning) warnings.push_back(resolution_warning(s, d, k));
  return warnings;
}

}  // namespace sim
