#include "sim/stepping/schemes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace sim {

namespace {

std::vector<int> upsamplings(const Dynamics& d) {
  std::vector<int> rates;
  for (const VesicleDynamics& v : d.vesicles) rates.push_back(v.upsampling);
  return rates;
}

Rejection not_converged(double residual, int iterations) {
  return {fmt::format("the linear solver stopped at a relative residual of {:.1e} after {} iterations", residual,
                      iterations)};
}

/// Root of the mean square over the parameter sphere, in area radii of the vesicle.
double size_of(const VesicleDynamics& v, const Matrix& difference) {
  return difference.norm() / std::sqrt(v.area);  // of an orthonormal basis: the mean is over 4 pi, R0^2 = A/(4 pi)
}

/// Frames during a step: their motion at its end, and their mean motion over it.
struct Frames {
  std::vector<Frame> last, mean;
};

/// Positions that frames carry along for a time.
std::vector<Coefficients> carried(std::span<const Frame> frames, double time, std::vector<Coefficients> x) {
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = carried(frames[k], time, x[k]);
  return x;
}

Coefficients frame_velocity(const RigidBody& body, const Frame& frame) {
  return rigid_velocity(body, frame.at(body.centre));
}

/// The frame of a shape that moves with a velocity in a flow.
Frame frame_of(const Membrane& m, const Coefficients& velocity, std::span<const FlowParameters> flows, double time) {
  const Coefficients flow = m.bases.field.analyze(background_velocity(flows, time, m.geometry.x.value));
  return {shape_motion(m.body, m.geometry, m.bases.field.synthesize(velocity).values), mean_gradient(m.body, flow)};
}

/// The motions of the present, turned with the frames and put on top of their motion at a later time, at carried
/// positions.
std::vector<Motion> carried_motions(const Dynamics& d, const Frames& frames, double time) {
  std::vector<Motion> m = motions(d);
  for (std::size_t k = 0; k < m.size(); ++k) {
    const VesicleDynamics& v = d.vesicles[k];
    const Matrix rest = m[k].velocity.values - frame_velocity(rigid_body(v.position), v.frame).values;
    const RigidBody there = rigid_body(carried(frames.mean[k], time, v.position));
    m[k].velocity.values =
        frame_velocity(there, frames.last[k]).values + turned(frames.mean[k], time, {v.position.order, rest}).values;
  }
  return m;
}

/// What is frozen for an implicit step x+ = h + c u+.
struct Frozen {
  std::vector<Coefficients> at;
  std::vector<Coefficients> behind;  ///< h - at; empty: zero
  double c, time;                    ///< the flow is taken at this time
};

/// u+ and x+, where u+ counts as it is or, for positions carried to their frozen place by frames, relative to these.
/// Errors and histories are the caller's.
Attempt<Advance> implicit_step(const StepProblem& problem, const Frozen& frozen, std::span<const Motion> guess,
                               const Frames* moving) {
  const Model& s = problem.model;
  const std::vector<Frame> reference = moving ? moving->last : frames(problem.before);
  const Suspension suspension = freeze(s, problem.before, frozen.at);
  const auto r = suspension_forcing(suspension, problem.flows, frozen.time, s.scene.buoyancy.gravity, frozen.behind);
  Attempt<SuspensionSolve> result = solve(s, suspension, frozen.c, r, guess, reference);
  if (!result) return result.rejection();
  Advance a{{}, result->iterations, result->residual};
  for (std::size_t k = 0; k < frozen.at.size(); ++k) {
    const Membrane& m = suspension.membranes[k];
    Motion& motion = result->motions[k];
    Matrix u = motion.velocity.values;
    if (moving) u -= frame_velocity(m.body, reference[k]).values;
    Coefficients x{m.order(), frozen.at[k].values + frozen.c * u};
    if (!frozen.behind.empty()) x.values += frozen.behind[k].values;
    const Frame frame = frame_of(m, motion.velocity, problem.flows, frozen.time);
    a.vesicles.push_back({std::move(x), std::move(motion), frame, {}, 0});
  }
  return a;
}

/// Half of dt times the change of velocity over the step: dt^2/2 x'' to leading order, the local error of Euler's
/// rules.
double euler_error(const VesicleDynamics& v, const Motion& after, double dt) {
  return size_of(v, dt / 2 * (after.velocity.values - v.motion.velocity.values));
}

Attempt<Advance> globally_implicit(const StepProblem& problem) {
  const Dynamics& d = problem.before;
  Attempt<Advance> a = implicit_step(problem, {positions(d), {}, problem.dt, d.time + problem.dt}, motions(d), nullptr);
  if (!a) return a;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k)
    a->vesicles[k].error = euler_error(d.vesicles[k], a->vesicles[k].motion, problem.dt);
  return a;
}

/// One step of backward Euler extrapolated from two half ones: how BDF2 starts. The frames move steadily. As its error
/// counts that of the two halves, which is of lower order.
Attempt<Advance> extrapolated_euler(const StepProblem& problem) {
  const Dynamics& d = problem.before;
  const double dt = problem.dt;
  const auto x = positions(d);
  const Frames steady{frames(d), frames(d)};
  const auto euler = [&](const std::vector<Coefficients>& from, double start, double c, std::span<const Motion> guess) {
    return implicit_step(problem, {carried(steady.mean, c, from), {}, c, start + c}, guess, &steady);
  };
  const Attempt<Advance> whole = euler(x, d.time, dt, carried_motions(d, steady, dt));
  if (!whole) return whole;
  const Attempt<Advance> half = euler(x, d.time, dt / 2, carried_motions(d, steady, dt / 2));
  if (!half) return half;
  std::vector<Coefficients> middle;
  std::vector<Motion> guess;
  for (const Moved& m : half->vesicles) {
    middle.push_back(m.position);
    guess.push_back(m.motion);
  }
  Attempt<Advance> last = euler(middle, d.time + dt / 2, dt / 2, guess);
  if (!last) return last;
  const int levels = scheme_of(problem.model.scene).past_levels;  // of the scheme that this one starts
  for (std::size_t k = 0; k < x.size(); ++k) {
    const VesicleDynamics& v = d.vesicles[k];
    Moved& m = last->vesicles[k];
    m.error = size_of(v, m.position.values - whole->vesicles[k].position.values);
    m.position.values = 2 * m.position.values - whole->vesicles[k].position.values;
    // The flow's frame, with which a run starts, is of another kind: that of the new time stands for both.
    m.history = pushed({}, {v.position, m.frame, steady.mean[k], dt}, levels);
  }
  last->iterations += whole->iterations + half->iterations;
  last->residual = std::max({whole->residual, half->residual, last->residual});
  return last;
}

Attempt<Advance> bdf2(const StepProblem& problem) {
  const Dynamics& d = problem.before;
  if (d.vesicles.front().history.levels.empty()) return extrapolated_euler(problem);
  const double dt = problem.dt, r = dt / d.vesicles.front().history.levels.front().dt;
  Frames moving;
  Frozen frozen{{}, {}, dt * (1 + r) / (1 + 2 * r), d.time + dt};
  std::vector<Coefficients> now;
  for (const VesicleDynamics& v : d.vesicles) {
    const PastLevel& past = v.history.levels.front();
    moving.last.push_back(extrapolated(v.frame, past.frame, r));
    moving.mean.push_back(extrapolated(v.frame, past.frame, r / 2));
    const Frame mean_before = extrapolated(v.frame, past.frame, -0.5);
    // x_n and x_{n-1} where the frame carries them at the new time.
    now.push_back(carried(moving.mean.back(), dt, v.position));
    const Coefficients before = carried(moving.mean.back(), dt, carried(mean_before, past.dt, past.position));
    const Matrix w = now.back().values - before.values;
    frozen.at.push_back({now.back().order, now.back().values + r * w});
    frozen.behind.push_back({now.back().order, (r * r / (1 + 2 * r) - r) * w});
  }
  const std::vector<Motion> guess = carried_motions(d, moving, dt);
  Attempt<Advance> a = implicit_step(problem, frozen, guess, &moving);
  if (!a) return a;
  const int levels = scheme_of(problem.model.scene).past_levels;  // another scheme may start with this one
  // What BDF2 leaves of dt^3 times the third derivative of x. The trapezoidal rule leaves 1/12, so that the two differ
  // by the rest.
  const double share = (1 + r) * (1 + r) / (6 * r * (1 + 2 * r)), rest = share - 1.0 / 12;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    const VesicleDynamics& v = d.vesicles[k];
    Moved& m = a->vesicles[k];
    // Velocities relative to the frame, that of x_n turned with it: `guess` stands on top of the frame's motion at the
    // new time.
    const Matrix start = guess[k].velocity.values - frame_velocity(rigid_body(now[k]), moving.last[k]).values;
    const Matrix end = (m.position.values - frozen.at[k].values - frozen.behind[k].values) / frozen.c;
    m.error = share / rest * size_of(v, now[k].values + dt / 2 * (start + end) - m.position.values);
    m.history = pushed(v.history, {v.position, v.frame, moving.mean[k], dt}, levels);
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
  const Suspension suspension = freeze(s, d, x);
  std::vector<Coefficients> r = suspension_forcing(suspension, problem.flows, d.time + dt, s.scene.buoyancy.gravity);
  if (x.size() > 1) {
    std::vector<Coefficients> tension;
    for (std::size_t k = 0; k < x.size(); ++k)
      tension.push_back(implicit_force(suspension.membranes[k], 0, d.vesicles[k].motion));
    const std::vector<Coefficients> others = interaction_of(suspension, tension, motions(d));
    for (std::size_t k = 0; k < x.size(); ++k) r[k].values += others[k].values;
  }
  Advance a;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const Membrane& m = suspension.membranes[k];
    // As in solve_suspension(): the rigid motion solves the homogeneous equations for itself.
    const Matrix rigid = frame_velocity(m.body, d.vesicles[k].frame).values;
    Motion guess = d.vesicles[k].motion;
    guess.velocity.values -= rigid;
    Solve self = solve_self(m, dt, {r[k].order, r[k].values - rigid}, guess, s.scene.numerics.gmres_tolerance);
    if (!self.converged) return not_converged(self.residual, self.iterations);
    self.motion.velocity.values += rigid;
    a.iterations += self.iterations;
    a.residual = std::max(a.residual, self.residual);
    Coefficients moved{x[k].order, x[k].values + dt * self.motion.velocity.values};
    const Frame frame = frame_of(m, self.motion.velocity, problem.flows, d.time + dt);
    const double error = euler_error(d.vesicles[k], self.motion, dt);
    a.vesicles.push_back({std::move(moved), std::move(self.motion), frame, {}, error});
  }
  return a;
}

Attempt<Advance> block_implicit(const StepProblem& problem) { return block_scheme(problem, solve_system); }

Attempt<Advance> block_jacobi(const StepProblem& problem) {
  return block_scheme(problem,
                      [](const Membrane& m, double c, const Coefficients& r, const Motion& guess, double tolerance) {
                        const Solve tension = solve_tension(m, r, guess, tolerance);
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

}  // namespace

const std::vector<CatalogueRow<Scheme>>& scheme_catalogue() {
  static const std::vector<CatalogueRow<Scheme>> table{
      {"bdf2", "second order, geometry extrapolated to the new time", {}, {.advance = bdf2, .past_levels = 1}},
      {"globally-implicit", "first order, the paper's backward Euler", {}, {.advance = globally_implicit}},
      {"block-implicit", "first order, the others' forces lag", {}, {.advance = block_implicit}},
      {"block-jacobi", "first order, tension then implicit position", {}, {.advance = block_jacobi}},
      {"explicit", "first order, tension then explicit position", {}, {.advance = explicit_position}},
  };
  return table;
}

const Scheme& scheme_of(const Scene& scene) {
  const auto* row = find_row(scheme_catalogue(), scene.time.scheme);
  if (!row) throw std::invalid_argument(fmt::format("'{}' is not a scheme", scene.time.scheme));
  return row->function;
}

Model make_model(const Scene& scene, Plans& plans) {
  Model s{scene, plans, {}};
  for (const VesicleParameters& v : scene.vesicles)
    s.materials.push_back({v.viscosity_contrast, v.bending_modulus, v.density_difference});
  return s;
}

double gap_floor(const Model& s, const Dynamics& d) {
  return s.scene.numerics.gap_floor.value_or(default_gap_floor * smallest_radius(sizes(d)));
}

Suspension freeze(const Model& s, const Dynamics& d, std::span<const Coefficients> frozen) {
  const NumericsParameters& n = s.scene.numerics;
  SuspensionOptions options{n.source_order,
                            {n.interaction_order, n.near_rule, {n.near_latitudes, n.near_longitudes}},
                            n.repulsion_strength,
                            n.repulsion_range.value_or(default_repulsion_range * smallest_radius(sizes(d)))};
  std::vector<Coefficients> expected;
  if (n.implicit_tension)
    for (const VesicleDynamics& v : d.vesicles) expected.push_back(v.motion.tension);
  return freeze_suspension(
      s.plans, s.materials, frozen, upsamplings(d), options, expected,
      pinned_tensions(s.plans, s.scene.flows, s.scene.buoyancy.gravity, s.materials, frozen, sizes(d)));
}

Attempt<SuspensionSolve> solve(const Model& s, const Suspension& suspension, double c, std::span<const Coefficients> r,
                               std::span<const Motion> guess, std::span<const Frame> frames) {
  const Preconditioner kind =
      s.scene.numerics.preconditioner == "block" ? Preconditioner::block : Preconditioner::spectral;
  std::vector<RigidMotion> rigid;
  for (std::size_t k = 0; k < frames.size(); ++k) rigid.push_back(frames[k].at(suspension.membranes[k].body.centre));
  SuspensionSolve result = solve_suspension(suspension, c, r, guess, s.scene.numerics.gmres_tolerance, kind, rigid);
  if (!result.converged) return not_converged(result.residual, result.iterations);
  return result;
}

std::vector<AreaVolume> sizes(const Dynamics& d) {
  std::vector<AreaVolume> all;
  for (const VesicleDynamics& v : d.vesicles) all.push_back({v.area, v.volume});
  return all;
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

std::vector<Frame> frames(const Dynamics& d) {
  std::vector<Frame> f;
  for (const VesicleDynamics& v : d.vesicles) f.push_back(v.frame);
  return f;
}

}  // namespace sim
