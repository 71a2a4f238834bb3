#include "sim/stepping/evaluate.h"

#include "sim/core/divided.h"
#include "sim/measures/diagnostics.h"
#include "sim/membrane/sliding.h"
#include "sim/stepping/multistep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace sim {

Geometry measured_geometry(Plans& plans, const Coefficients& x) {
  return geometry(plans.basis(x.order, measure_order(x.order)), x);
}

namespace {

/// Velocity of the points of the grid.
Coefficients rate_of_points(const VesicleState& v) { return {v.velocity.order, v.velocity.values + v.sliding.values}; }

/// A motion as it is saved: of a sphere only tensions of zero mean are determined.
Motion determined(const VesicleDynamics& v, const Basis& basis, const Geometry& g, Motion motion) {
  if (!is_sphere({v.area, v.volume})) return motion;
  const Matrix sigma = basis.synthesize(motion.tension).values;
  motion.tension.values(0, 0) -= integrate(g, sigma.col(0)) / g.dA.sum() * std::sqrt(4 * std::numbers::pi);
  return motion;
}

/// What is saved of a vesicle that moves so.
VesicleState saved_vesicle(const VesicleDynamics& v, bool first, Motion motion) {
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
  if (first) out.velocity_before = rate_of_points(out);
  return out;
}

void transfer(Parcel& parcel, VesicleState& v) {
  for (Coefficients* field :
       {&v.position, &v.velocity, &v.tension, &v.labels, &v.position_before, &v.velocity_before, &v.sliding})
    parcel(*field);
  parcel(v.tracers), parcel(v.relabelled), parcel(v.labels_laid), parcel(v.labels_laid_time);
}

/// Through so many levels goes the polynomial of the step after a state: those of its formula and one more.
int points_between(const Dynamics& before) { return before.control.order + 2; }

}  // namespace

void transfer(Parcel& parcel, State& state) {
  std::size_t count = state.vesicles.size();
  parcel(state.step), parcel(state.time), parcel(count);
  state.vesicles.resize(count);
  for (VesicleState& v : state.vesicles) transfer(parcel, v);
}

Attempt<Correction> correction_of(const Model& s, const VesicleDynamics& v, const Coefficients& x, const Geometry& g) {
  const AreaVolume size{v.area, v.volume};
  Correction c = is_sphere(size) ? volume_correction(s.plans, x, g, v.area, v.volume)
                                 : area_volume_correction(s.plans, x, g, v.area, v.volume);
  if (!c.converged || c.largest > 0.1 * area_radius(size))
    return Rejection{fmt::format("the area and volume correction failed (shift {:.1e})", c.largest)};
  return c;
}

Attempt<State> evaluate(const Model& s, const Dynamics& d) {
  return within_domain([&]() -> Attempt<State> {
    const auto x = positions(d);
    const Suspension suspension = freeze(s, d, d.time, x, motions(d));
    const auto r = suspension_forcing(suspension, s.scene.flows, d.time, s.scene.buoyancy.gravity);
    Attempt<SuspensionSolve> result = solve(s, suspension, 0, r, motions(d), frames(d), solve_tolerance(s.scene), d);
    if (!result) return result.rejection();
    State state{d.step, d.time, std::vector<VesicleState>(d.vesicles.size())};
    std::vector<Motion>& motion = result->motions;
    divided_for(
        suspension.division, int(d.vesicles.size()),
        [&](int k) {
          const Membrane& m = *suspension.membranes[k];
          motion[k] = determined(d.vesicles[k], m.bases.field, m.geometry, std::move(motion[k]));
        },
        [&](Parcel& parcel, int k) { parcel(motion[k].velocity), parcel(motion[k].tension); });
    for (std::size_t k = 0; k < motion.size(); ++k)
      state.vesicles[k] = saved_vesicle(d.vesicles[k], d.saves == 0, std::move(motion[k]));
    return state;
  });
}

namespace {

/// One vesicle in the step that led from one state of a run to the next.
struct Passage {
  const Model& s;
  const VesicleDynamics &before, &after;
  int points;
  double dt;
  std::optional<SlidingPath> path;  ///< of a grid that slides
  std::optional<LabelsBetween> labels;

  Passage(const Model& model, const VesicleDynamics& from, const VesicleDynamics& to, int levels, double length)
      : s(model), before(from), after(to), points(levels), dt(length) {
    if (!grid_slides(s.scene)) return;
    path = sliding_path(before, dt, after.position, after.sliding);
    if (before.labels_laid == after.labels_laid) labels.emplace(s.plans, *path, before.labels, -dt, after.labels, 0);
  }

  Attempt<VesicleState> at(double earlier) const {
    std::vector<Level> levels = carried_levels(after, before.frame, dt, dt - earlier);
    levels.resize(std::min(levels.size(), std::size_t(points)));
    std::vector<double> times;
    for (const Level& level : levels) times.push_back(level.time);
    const std::vector<double> weights = lagrange(times, 0);
    Coefficients x = combined(levels, weights, &Level::position);
    if (s.scene.numerics.correction) {
      const Attempt<Correction> correction = correction_of(s, after, x, measured_geometry(s.plans, x));
      if (!correction) return correction.rejection();
      x.values += correction->shift.values;
    }
    Motion motion{combined(levels, weights, &Level::velocity), combined(levels, weights, &Level::tension)};
    motion.velocity.values += frame_velocity(rigid_body(x), before.frame.from(dt - earlier)).values;
    VesicleState out = saved_vesicle(after, false,
                                     determined(after, s.plans.basis(x.order, measure_order(x.order)),
                                                measured_geometry(s.plans, x), std::move(motion)));
    out.position = std::move(x);
    out.sliding = combined(levels, weights, &Level::sliding);
    if (path && earlier > 0) {
      out.labels = labels ? labels->at(-earlier) : slid_labels(s.plans, *path, before.labels, -dt, -earlier);
      out.tracers = slid_points(*path, before.tracers, -dt, -earlier);
      out.labels_laid = before.labels_laid;
      out.labels_laid_time = before.labels_laid_time;
    }
    return out;
  }
};

}  // namespace

Attempt<std::vector<State>> interpolated(const Model& s, const Dynamics& before, const Dynamics& after,
                                         std::span<const double> times) {
  return within_domain([&]() -> Attempt<std::vector<State>> {
    const int n = int(after.vesicles.size()), count = int(times.size());
    std::vector<std::vector<Attempt<VesicleState>>> vesicles(n);
    const auto pass = [&](int k) {
      const Passage passage(s, before.vesicles[k], after.vesicles[k], points_between(before), after.time - before.time);
      for (const double time : times) vesicles[k].push_back(passage.at(after.time - time));
    };
    divided_for(divided(s.ranks, n), n, pass, [&](Parcel& parcel, int k) {
      vesicles[k].resize(std::size_t(count), VesicleState{});
      for (auto& one : vesicles[k]) transfer(parcel, one, [](Parcel& p, VesicleState& v) { transfer(p, v); });
    });
    std::vector<State> states;
    for (int i = 0; i < count; ++i) {
      states.push_back({after.step, times[i], {}});
      for (int k = 0; k < n; ++k) {
        if (!vesicles[k][i]) return vesicles[k][i].rejection();
        VesicleState v = std::move(*vesicles[k][i]);
        if (i > 0) {
          const VesicleState& earlier = states[i - 1].vesicles[k];
          v.position_before = earlier.position;
          v.velocity_before = rate_of_points(earlier);
        }
        states.back().vesicles.push_back(std::move(v));
      }
    }
    return states;
  });
}

void expect(const Model& s, Dynamics& d, const State& state) {
  const bool slides = grid_slides(s.scene);
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    VesicleDynamics& v = d.vesicles[k];
    v.motion = {state.vesicles[k].velocity, state.vesicles[k].tension};
    const Basis& basis = s.plans.basis(v.position.order, measure_order(v.position.order));
    const Geometry g = geometry(basis, v.position);
    const RigidBody body = rigid_body(v.position);
    v.frame.motion = shape_motion(body, g, basis.synthesize(v.motion.velocity).values);
    if (!slides) continue;
    const Coefficients rest{v.position.order, Matrix::Zero(v.position.values.rows(), 3)};
    v.sliding = sliding_velocity(
        {basis, g, body, v.position, v.motion.velocity, area_radius({v.area, v.volume}), v.frame.drift, 0}, rest, 1e-6);
  }
}

void mark_saved(Dynamics& d, const State& state) {
  ++d.saves;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    d.vesicles[k].saved_position = state.vesicles[k].position;
    d.vesicles[k].saved_velocity = rate_of_points(state.vesicles[k]);
  }
}

}  // namespace sim
