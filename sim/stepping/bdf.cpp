#include "sim/stepping/bdf.h"

#include "sim/core/divided.h"
#include "sim/membrane/sliding.h"
#include "sim/stepping/multistep.h"

#include <algorithm>
#include <optional>

namespace sim {

namespace {

std::vector<double> times_of(std::span<const Level> levels) {
  std::vector<double> times;
  for (const Level& level : levels) times.push_back(level.time);
  return times;
}

/// Times of the present and of the past, relative to one so much after the present.
std::vector<double> times_of(const History& history, double later) {
  double time = 0;
  std::vector<double> times{-later};
  for (const PastLevel& past : history.levels) {
    time -= past.dt;
    times.push_back(time - later);
  }
  return times;
}

/// What is extrapolated for one vesicle.
struct Outlook {
  Coefficients behind;  ///< h
  Coefficients at;      ///< x*
  Coefficients sliding;
  Motion motion;  ///< velocity of the frame included
  /// Estimated local error of the position from the past alone, by size_of(): c/(k + 1) times the k-th difference of
  /// the velocities. None: there are too few levels.
  std::optional<double> error;
};

Outlook outlook(const VesicleDynamics& v, std::span<const Level> levels, const Frame& frame, int order,
                Extrapolation extrapolation, bool euler_predicts) {
  const std::vector<double> times = times_of(levels);
  const auto weights = [&](int points) {
    return lagrange(std::span(times).first(std::min<std::size_t>(points, times.size())), 0);
  };
  const int points = order + (extrapolation == Extrapolation::one_more ? 1 : 0);
  constexpr int most_guessed = 4;  // a cubic: of higher ones the noise of the solves grows
  Outlook o;
  const Bdf formula = bdf(times, order);
  o.behind = combined(levels, formula.behind, &Level::position);
  o.at = combined(levels, weights(points), &Level::position);
  if (levels.size() == 1 && euler_predicts)
    o.at.values -= times[0] * (levels[0].velocity.values + levels[0].sliding.values);
  o.sliding = combined(levels, weights(order), &Level::sliding);
  o.motion.velocity = combined(levels, weights(std::min(order + 1, most_guessed)), &Level::velocity);
  o.motion.velocity.values += frame_velocity(rigid_body(o.at), frame).values;
  o.motion.tension = combined(levels, weights(std::min(order + 1, most_guessed)), &Level::tension);
  if (int(levels.size()) > order) {
    std::vector<double> difference = weights(order + 1);
    const std::vector<double> of_order = weights(order);
    for (std::size_t j = 0; j < of_order.size(); ++j) difference[j] -= of_order[j];
    o.error = formula.c / (order + 1) * size_of(v, combined(levels, difference, &Level::velocity).values);
  }
  return o;
}

/// Residual of the least squares for w, relative: w must be smooth in time.
double sliding_tolerance(const Scene& scene) {
  return steps_adapt(scene.time) ? std::min(0.1 * tolerance_of(scene.time), 1e-4) : 1e-8;
}

}  // namespace

std::vector<Level> carried_levels(const VesicleDynamics& v, const Frame& frame, double present, double to) {
  std::vector<Level> levels;
  double time = present;
  const auto add = [&](const Coefficients& x, const Motion& motion, const Coefficients& sliding) {
    const Span span{time, to};
    const Coefficients rest{x.order, motion.velocity.values - frame_velocity(rigid_body(x), frame.from(time)).values};
    levels.push_back(
        {time - to, carried(frame, span, x), turned(frame, span, rest), turned(frame, span, sliding), motion.tension});
  };
  add(v.position, v.motion, v.sliding);
  for (const PastLevel& past : v.history.levels) {
    time -= past.dt;
    add(past.position, past.motion, past.sliding);
  }
  return levels;
}

Coefficients combined(std::span<const Level> levels, std::span<const double> weights, Coefficients Level::*member) {
  Coefficients sum = levels[0].*member;
  sum.values *= weights[0];
  for (std::size_t j = 1; j < weights.size(); ++j) sum.values += weights[j] * (levels[j].*member).values;
  return sum;
}

std::vector<double> estimated_errors(const VesicleDynamics& before, double dt, const Coefficients& position,
                                     int most_order) {
  const std::vector<Level> levels = carried_levels(before, before.frame, 0, dt);
  if (levels.size() == 1) {
    const Matrix euler = levels[0].position.values + dt * (levels[0].velocity.values + levels[0].sliding.values);
    return {size_of(before, position.values - euler) / 2};
  }
  const std::vector<double> times = times_of(levels);
  std::vector<double> errors;
  for (int k = 1; k <= most_order && k < static_cast<int>(levels.size()); ++k) {
    const Coefficients expected = combined(levels, lagrange(std::span(times).first(k + 1), 0), &Level::position);
    errors.push_back(error_share(times, k) * size_of(before, position.values - expected.values));
  }
  return errors;
}

Attempt<Advance> bdf_step(const StepProblem& problem, int wanted_order, Extrapolation extrapolation, int past_levels) {
  const Model& s = problem.model;
  const Dynamics& d = problem.before;
  std::vector<Frame> moving;  // as they are at the new time
  for (const VesicleDynamics& v : d.vesicles) moving.push_back(v.frame.from(problem.dt));
  const bool slides = s.scene.numerics.reparametrization == "moving";
  const double time = d.time + problem.dt;
  const int order = std::min<int>(wanted_order, int(d.vesicles.front().history.levels.size()) + 1);

  const int n = int(d.vesicles.size());
  const double c = bdf(times_of(d.vesicles.front().history, problem.dt), order).c;

  std::vector<Outlook> expected(n);
  std::vector<Coefficients> at(n), behind(n);
  std::vector<Motion> guess(n);
  parallel_for(n, [&](int k) {
    const VesicleDynamics& v = d.vesicles[k];
    const std::vector<Level> levels = carried_levels(v, v.frame, 0, problem.dt);
    // The instantaneous velocity of a sphere strains it: no prediction.
    const bool euler_predicts = extrapolation == Extrapolation::one_more && !is_sphere({v.area, v.volume});
    const Outlook& o = expected[k] = outlook(v, levels, moving[k], order, extrapolation, euler_predicts);
    at[k] = o.at;
    behind[k] = {o.at.order, o.behind.values - o.at.values + c * o.sliding.values};
    guess[k] = o.motion;
  });

  double error = 0;  // of the step, as that of its record: the largest
  for (const Outlook& o : expected) error = std::max(error, o.error.value_or(0));
  const double tolerance = solve_tolerance(s.scene, error / motion_over(d, problem.dt));

  const Suspension suspension = freeze(s, d, time, at, guess);
  const auto r = suspension_forcing(suspension, problem.flows, time, s.scene.buoyancy.gravity, behind);
  Attempt<SuspensionSolve> result = solve(s, suspension, c, r, guess, moving, tolerance, d);
  if (!result) return result.rejection();

  Advance a{std::vector<Moved>(n), result->iterations, result->residual, suspension.division,
            std::move(result->learned)};
  divided_for(a.division, n, [&](int k) {
    const VesicleDynamics& v = d.vesicles[k];
    const Membrane& m = *suspension.membranes[k];
    Motion& motion = result->motions[k];
    const Coefficients u{m.order(), motion.velocity.values - frame_velocity(m.body, moving[k]).values};
    Moved moved{{m.order(), expected[k].behind.values + c * u.values}, {}, {}, {}, {}, c, 0};
    moved.sliding = {m.order(), Matrix::Zero(u.values.rows(), 3)};
    if (slides) {
      moved.sliding = sliding_velocity(
          {m.bases.field, m.geometry, m.body, moved.position, u, area_radius({v.area, v.volume}), v.frame.drift, c},
          expected[k].sliding, sliding_tolerance(s.scene));
      moved.position.values += c * moved.sliding.values;
    }
    moved.frame = frame_of(m, motion.velocity, problem.flows, time);
    if (!v.history.levels.empty())  // how a start turns is not known well
      moved.frame.spin_up = (moved.frame.motion.rotation - v.frame.motion.rotation) / problem.dt;
    moved.motion = std::move(motion);
    moved.error = estimated_errors(v, problem.dt, moved.position, order).back();
    moved.history = pushed(v.history, {v.position, v.motion, v.sliding, problem.dt}, past_levels);
    a.vesicles[k] = std::move(moved);
  });
  return a;
}

SlidingPath sliding_path(const VesicleDynamics& before, double dt, const Coefficients& position,
                         const Coefficients& sliding) {
  SlidingPath path{{0}, {position}, {sliding}};
  constexpr std::size_t enough = 2;
  for (const Level& level : carried_levels(before, before.frame, 0, dt)) {
    if (path.times.size() > enough) break;
    path.times.push_back(level.time);
    path.positions.push_back(level.position);
    path.sliding.push_back(level.sliding);
  }
  return path;
}

}  // namespace sim
