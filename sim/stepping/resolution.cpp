#include "sim/stepping/resolution.h"

#include "sim/core/divided.h"
#include "sim/measures/diagnostics.h"
#include "sim/membrane/cell.h"
#include "sim/membrane/flows.h"
#include "sim/suspension/gap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace sim {

namespace {

constexpr int apart = 2;  ///< shapes that are symmetric about their centre have every other degree only
constexpr int least_degree = 2;

VesicleDynamics in_order(const VesicleDynamics& v, int order) {
  VesicleDynamics changed = v;
  visit(changed, [order]<class Member>(Part part, Member& member) {
    if constexpr (std::is_same_v<Member, Coefficients>) {
      if (part != Part::label) member = resized(member, order);
    } else if constexpr (std::is_same_v<Member, History>) {
      for (PastLevel& level : member.levels)
        visit_level(level, [order]<class Field>(const char*, Field& field) {
          if constexpr (std::is_same_v<Field, Coefficients>) field = resized(field, order);
        });
    }
  });
  return changed;
}

double normal_size(Plans& plans, const VesicleDynamics& v, const Matrix& difference) {
  const Basis& basis = plans.basis(v.position.order, measure_order(v.position.order));
  const Geometry g = geometry(basis, v.position);
  const Matrix on_grid = basis.synthesize({v.position.order, difference}).values;
  const Vector along = on_grid.cwiseProduct(g.n).rowwise().sum();
  return std::sqrt(integrate(g, along.cwiseAbs2()) / v.area);
}

/// Velocities of all vesicles in the step with so many degrees less; nothing where there is no such step.
std::vector<Coefficients> velocities_of_less(const Model& s, const Dynamics& before, double dt, int less) {
  Dynamics d = before;
  for (VesicleDynamics& v : d.vesicles) v = in_order(v, std::max(least_degree, v.position.order - less));
  const auto flows = acting_flows(s.scene.flows, before.time, before.time + dt);
  const Attempt<Advance> advance = within_domain([&] { return scheme_of(s.scene).advance({s, d, dt, flows}); });
  std::vector<Coefficients> velocities;
  if (!advance) return velocities;
  velocities.resize(before.vesicles.size());
  divided_for(
      advance->division, int(velocities.size()),
      [&](int k) { velocities[k] = resized(advance->vesicles[k].motion.velocity, before.vesicles[k].position.order); },
      [&](Parcel& parcel, int k) { parcel(velocities[k]); });
  return velocities;
}

/// Over the parameter sphere.
Vec3 mean_place(const Coefficients& position) {
  return position.values.row(0).transpose() / std::sqrt(4 * std::numbers::pi);
}

/// Between the last switch of a flow, or the start, and the next one, or the end.
double phase_length(const Scene& scene, double time) {
  double since = 0;
  for (double next = next_switch(scene.flows, 0); next < time; next = next_switch(scene.flows, next)) since = next;
  return std::min(scene.time.end, next_switch(scene.flows, time)) - since;
}

/// The share of a wrong deformation that stays after flows have acted for so long. Where the flow at a place turns
/// material, most of it relaxes as the membrane runs round or the body turns, unless it is over before; a flow that
/// only stretches draws out what is wrong, too.
double lasting_share(std::span<const FlowParameters> flows, double time, double phase, const Vec3& place,
                     double radius) {
  constexpr double rest = 0.15;   // measured: 0.02 to 0.2
  constexpr double angle = 0.25;  // by which material turns while it relaxes: twice this leaves 0.2 to 0.3
  // Root mean squares over six places about the centre: on the axis of a tube flow there is no gradient.
  Matrix points(36, 3);
  for (int k = 0; k < 36; ++k)
    points.row(k) =
        (place + (k % 2 - 0.5) * radius * Vec3::Unit(k / 2 % 3) + (k / 6 % 2 - 0.5) * radius * Vec3::Unit(k / 12))
            .transpose();
  const Matrix u = background_velocity(flows, time, points);
  double strains = 0, spins = 0;
  for (int at = 0; at < 36; at += 6) {
    Eigen::Matrix3d gradient;
    for (int d = 0; d < 3; ++d) gradient.col(d) = (u.row(at + 2 * d + 1) - u.row(at + 2 * d)).transpose() / radius;
    strains += (gradient + gradient.transpose()).squaredNorm() / 6;
    spins += (gradient - gradient.transpose()).squaredNorm() / 6;
  }
  const double strain = std::sqrt(strains), spin = std::sqrt(spins);
  if (!(strain > 0)) return rest;
  const double turns = spin / (2 * std::numbers::sqrt2) * phase;
  return rest + (1 - rest) * std::max(1 - spin / strain, std::exp(-turns / angle));
}

bool any_follows(const Scene& scene) {
  return std::any_of(scene.vesicles.begin(), scene.vesicles.end(),
                     [&](const VesicleParameters& v) { return order_follows(scene.time, v); });
}

/// How many degrees more the errors of a vesicle ask for, where so much is allowed. A change disturbs the next steps a
/// little, so that there should be few.
int more_degrees(const SpaceError& e, double allowed) {
  constexpr double aim = 0.5, far_below = 0.1, slowest_decay = 0.6;
  constexpr int most = 8;
  if (e.lower < far_below * allowed) return -apart;
  if (e.here <= allowed) return 0;
  const double decay = std::min(e.here / e.lower, slowest_decay);
  return std::min(most, apart * int(std::ceil(std::log(aim * allowed / e.here) / std::log(decay))));
}

}  // namespace

double film_error(int degree, double gap) {
  constexpr double decay = 2.1;  // measured between gaps of 0.03 and 0.2
  return std::exp(-decay * degree * std::sqrt(gap));
}

std::vector<SpaceError> space_errors(const Model& s, const Dynamics& before, const Dynamics& after) {
  const double dt = after.time - before.time;
  const auto less = velocities_of_less(s, before, dt, apart), least = velocities_of_less(s, before, dt, 2 * apart);
  if (less.empty() || least.empty()) return {};
  double largest = 0;
  for (const VesicleDynamics& v : after.vesicles) largest = std::max(largest, area_radius({v.area, v.volume}));
  constexpr double far = 1;  // from there on no film asks for more than the least of degrees
  const std::vector<double> gaps =
      gaps_to_neighbours(s.plans, positions(after), far * largest, cell_at(s.scene, after.time), s.ranks);
  // As a rate it is large where it is large beside the tolerance, however slow the motion.
  const double motion = 2 * allowed_error(s, before, dt) / (dt * tolerance_of(s.scene.time));
  const auto flows = acting_flows(s.scene.flows, before.time, after.time);
  const double middle = before.time + dt / 2, phase = phase_length(s.scene, middle);
  std::vector<SpaceError> errors;
  for (std::size_t k = 0; k < less.size(); ++k) {
    const VesicleDynamics& v = after.vesicles[k];
    const double radius = area_radius({v.area, v.volume});
    const double stays = lasting_share(flows, middle, phase, mean_place(v.position), radius);
    const auto error = [&](const Coefficients& u) {
      return stays * normal_size(s.plans, v, v.motion.velocity.values - u.values) / radius;
    };
    const double lower = error(less[k]), lowest = error(least[k]);
    constexpr double usual = 0.5;  // where there are too few degrees to tell
    const double decay = v.position.order - 2 * apart < least_degree || !(lowest > 0) ? usual : lower / lowest;
    const auto of_film = [&](int degree) { return motion * film_error(degree, gaps[k] / radius); };
    errors.push_back({std::max(lower * std::min(decay, 1.0), of_film(v.position.order)),
                      std::max(lower, of_film(v.position.order - apart))});
  }
  return errors;
}

bool resolution_due(const Dynamics& d) { return d.step >= d.control.resolution_due; }

std::vector<SpaceError> estimate_resolution(const Model& s, const Dynamics& before, Step& step) {
  step.dynamics.control.resolution_due = before.step + (any_follows(s.scene) ? 10 : 20);
  std::vector<SpaceError> errors = space_errors(s, before, step.dynamics);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    step.dynamics.vesicles[k].space_error = errors[k].here;
    step.record.vesicles[k].space_error = errors[k].here * step.record.dt;
  }
  return errors;
}

double allowed_space_error(const Model& s, const Dynamics& before, double dt) {
  // Where nothing moves, what adds up to a share of the tolerance by the end may be left.
  return std::max(allowed_error(s, before, dt) / dt, 0.3 * tolerance_of(s.scene.time) / s.scene.time.end);
}

std::vector<int> orders_for(const Model& s, const Dynamics& before, double dt, std::span<const SpaceError> errors) {
  const NumericsParameters& n = s.scene.numerics;
  const double allowed = allowed_space_error(s, before, dt);
  std::vector<int> orders;
  for (std::size_t k = 0; k < before.vesicles.size(); ++k) {
    const int order = before.vesicles[k].position.order;
    const bool follows = order_follows(s.scene.time, s.scene.vesicles[k]) && k < errors.size();
    orders.push_back(follows ? std::clamp(order + more_degrees(errors[k], allowed), n.least_order, n.most_order)
                             : order);
  }
  return orders;
}

Attempt<Dynamics> in_orders(const Model& s, const Dynamics& d, std::span<const int> orders) {
  Dynamics changed = d;
  for (std::size_t k = 0; k < orders.size(); ++k) {
    VesicleDynamics& v = changed.vesicles[k];
    if (v.position.order == orders[k]) continue;
    const bool loses = orders[k] < v.position.order;
    v = in_order(v, orders[k]);
    if (!changed.learned.empty()) changed.learned[k] = nullptr;
    if (loses && s.scene.numerics.correction) {
      const Attempt<Correction> c = correction_of(s, v, v.position, measured_geometry(s.plans, v.position));
      if (!c) return c.rejection();
      v.position.values += c->shift.values;
    }
    if (s.scene.numerics.label_order == 0)
      v.labels = resized(v.labels, std::max(v.labels.order, automatic_label_order(orders[k])));
    v.upsampling_due = d.step;
  }
  return changed;
}

Dynamics resolved_start(const Model& s, const State* from) {
  Dynamics d = initial_dynamics(s, {}, from);
  if (!any_follows(s.scene)) return d;
  for (;;) {
    Dynamics moving = d;
    const Attempt<State> first = evaluate(s, d);
    if (!first) return d;
    expect(s, moving, *first);
    start_steps(s, moving);
    const double dt = std::min(moving.dt_limit, next_switch(s.scene.flows, d.time) - d.time);
    if (!(dt > 0) || !std::isfinite(dt)) return d;
    const Attempt<Step> step = take_step(s, moving, dt);
    if (!step) return d;
    const std::vector<int> orders = orders_for(s, moving, dt, space_errors(s, moving, step->dynamics));
    bool higher = false;
    for (std::size_t k = 0; k < orders.size(); ++k) higher = higher || orders[k] > d.vesicles[k].position.order;
    if (!higher) return d;
    d = initial_dynamics(s, orders, from);
  }
}

}  // namespace sim
