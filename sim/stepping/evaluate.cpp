#include "sim/stepping/evaluate.h"

#include "sim/measures/diagnostics.h"
#include "sim/membrane/sliding.h"
#include "sim/stepping/multistep.h"
#include "sim/surface/correction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

Geometry measured_geometry(Plans& plans, const Coefficients& x) {
  return geometry(plans.basis(x.order, measure_order(x.order)), x);
}

namespace {

/// What is saved of a vesicle that moves so.
VesicleState saved_vesicle(const Dynamics& d, std::size_t k, const Basis& basis, const Geometry& g, Motion motion) {
  const VesicleDynamics& v = d.vesicles[k];
  if (is_sphere({v.area, v.volume})) {  // only tensions of zero mean are determined
    const Matrix sigma = basis.synthesize(motion.tension).values;
    motion.tension.values(0, 0) -= integrate(g, sigma.col(0)) / g.dA.sum() * std::sqrt(4 * std::numbers::pi);
  }
  VesicleState out;
  out.position = v.position;
  out.velocity = std::move(motion.velocity);
  out.tension = std::move(motion.tension);
  out.labels = v.labels;
  out.tracers = v.tracers;
  out.position_before = v.saved_position;
  out.velocity_before = v.saved_velocity;
  out.sliding = v.sliding;
  out.relabelled = v.relabelled;
  out.labels_laid = v.labels_laid;
  out.labels_laid_time = v.labels_laid_time;
  if (d.saves == 0) out.velocity_before.values = out.velocity.values + out.sliding.values;
  return out;
}

/// A position with the area and volume of the start, as near as they can be had.
Coefficients corrected(const Model& s, const VesicleDynamics& v) {
  const Geometry g = measured_geometry(s.plans, v.position);
  const Correction c = is_sphere({v.area, v.volume}) ? volume_correction(s.plans, v.position, g, v.area, v.volume)
                                                     : area_volume_correction(s.plans, v.position, g, v.area, v.volume);
  Coefficients x = v.position;
  if (c.converged) x.values += c.shift.values;
  return x;
}

/// Through so many levels goes the polynomial of the step after a state: those of its formula and one more.
int points_between(const Dynamics& before) { return before.control.order + 2; }

}  // namespace

Attempt<State> evaluate(const Model& s, const Dynamics& d) {
  return within_domain([&]() -> Attempt<State> {
    const auto x = positions(d);
    const Suspension suspension = freeze(s, d, x, motions(d));
    const auto r = suspension_forcing(suspension, s.scene.flows, d.time, s.scene.buoyancy.gravity);
    Attempt<SuspensionSolve> result = solve(s, suspension, 0, r, motions(d), frames(d));
    if (!result) return result.rejection();
    State state{d.step, d.time, {}};
    for (std::size_t k = 0; k < d.vesicles.size(); ++k)
      state.vesicles.push_back(saved_vesicle(d, k, suspension.membranes[k].bases.field,
                                             suspension.membranes[k].geometry, std::move(result->motions[k])));
    return state;
  });
}

State interpolated(const Model& s, const Dynamics& before, const Dynamics& after, double time) {
  Dynamics d = after;
  d.time = time;
  const double dt = after.time - before.time;
  const bool slides = scheme_of(s.scene).slides && s.scene.numerics.reparametrization == "moving";
  State state{d.step, time, {}};
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    VesicleDynamics& v = d.vesicles[k];
    const Frame& frame = before.vesicles[k].frame;
    std::vector<Level> levels = carried_levels(after.vesicles[k], frame, time - after.time);
    levels.resize(
        std::min(levels.size(), std::size_t(after.vesicles[k].history.levels.empty() ? 1 : points_between(before))));
    std::vector<double> times;
    for (const Level& level : levels) times.push_back(level.time);
    const std::vector<double> weights = lagrange(times, 0);
    v.position = combined(levels, weights, &Level::position);
    if (s.scene.numerics.correction) v.position = corrected(s, v);
    v.sliding = combined(levels, weights, &Level::sliding);
    v.motion = {combined(levels, weights, &Level::velocity), combined_tension(levels, weights)};
    v.motion.velocity.values += frame_velocity(rigid_body(v.position), frame).values;
    if (slides && time < after.time) {
      v.labels_laid = before.vesicles[k].labels_laid;
      v.labels_laid_time = before.vesicles[k].labels_laid_time;
      const SlidingPath path =
          sliding_path(before.vesicles[k], dt, after.vesicles[k].position, after.vesicles[k].sliding);
      v.labels = slid_labels(s.plans, path, before.vesicles[k].labels, -dt, time - after.time);
      v.tracers = slid_points(path, before.vesicles[k].tracers, -dt, time - after.time);
    }
    const Geometry g = measured_geometry(s.plans, v.position);
    state.vesicles.push_back(
        saved_vesicle(d, k, s.plans.basis(v.position.order, measure_order(v.position.order)), g, v.motion));
  }
  return state;
}

void expect(const Model& s, Dynamics& d, const State& state) {
  const bool slides = scheme_of(s.scene).slides && s.scene.numerics.reparametrization == "moving";
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    VesicleDynamics& v = d.vesicles[k];
    v.motion = {state.vesicles[k].velocity, state.vesicles[k].tension};
    const Basis& basis = s.plans.basis(v.position.order, measure_order(v.position.order));
    const Geometry g = geometry(basis, v.position);
    const RigidBody body = rigid_body(v.position);
    v.frame.motion = shape_motion(body, g, basis.synthesize(v.motion.velocity).values);
    if (!slides) continue;
    const double radius = std::sqrt(v.area / (4 * std::numbers::pi));
    const Coefficients rest{v.position.order, Matrix::Zero(v.position.values.rows(), 3)};
    v.sliding = sliding_velocity({basis, g, body, v.position, v.motion.velocity, radius, v.frame.drift, 0}, rest, 1e-6);
  }
}

void mark_saved(Dynamics& d, const State& state) {
  ++d.saves;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    d.vesicles[k].saved_position = state.vesicles[k].position;
    d.vesicles[k].saved_velocity = state.vesicles[k].velocity;
    d.vesicles[k].saved_velocity.values += state.vesicles[k].sliding.values;
  }
}

}  // namespace sim
