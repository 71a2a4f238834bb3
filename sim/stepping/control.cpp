#include "sim/stepping/control.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr double safety = 0.8;

/// The first step of a sphere is not tested: its instantaneous velocity strains it.
bool tested(const Dynamics& before) { return !(before.vesicles.front().history.levels.empty() && any_sphere(before)); }

/// Factor to the length that an estimate asks for. Order 1 leaves errors of the second order only where a vesicle turns
/// as a whole, since frames follow a change of its rotation: as errors of the first they would make it win for ever.
double growth(double error, double allowed, int order) {
  const double least = 1e-8;  // of the allowed error: what comes below does not matter
  return safety * std::pow(std::max(error / allowed, least), -1.0 / std::max(order, 2));
}

/// Variable steps of high order are stable while they do not grow faster.
double fastest_growth(bool first, int order) {
  if (first) return 10;
  return order <= 2 ? 2 : order == 3 ? 1.5 : 1.3;
}

}  // namespace

double allowed_error(const Model& s, const Dynamics& before, double dt) {
  // What a step leaves may grow before it dies out: by 1.5 while a vesicle turns over.
  constexpr double caution = 0.5;
  return caution * tolerance_of(s.scene.time) * motion_over(before, dt);
}

double length_towards(double time, double target, double wanted) {
  const double left = target - time;
  constexpr double rounding = 1e-9;
  if (left <= wanted * (1 + rounding)) return left;
  return std::min(wanted, left / 2);
}

std::optional<double> shortening(const Model& s, const Dynamics& before, const Step& step) {
  if (!tested(before)) return std::nullopt;
  const int order = step.dynamics.control.order;
  const double allowed = allowed_error(s, before, step.record.dt);
  if (step.record.error <= allowed) return std::nullopt;
  return std::clamp(growth(step.record.error, allowed, order), 0.2, 0.9);
}

bool stalls(const Model& s, Step& step) {
  constexpr double hopeless = 1e6;   // steps to the end
  constexpr std::int64_t most = 50;  // a start or an encounter is over sooner
  Dynamics& d = step.dynamics;
  d.calm = (s.scene.time.end - d.time) / step.record.dt > hopeless ? d.calm + 1 : 0;
  return d.calm >= most;
}

void plan_next(const Model& s, const Dynamics& before, Step& step) {
  Dynamics& d = step.dynamics;
  Control& control = d.control;
  const double dt = step.record.dt, allowed = allowed_error(s, before, dt);
  const bool first = before.vesicles.front().history.levels.empty();
  const int used = control.order;
  control.at_order = used == before.control.order ? before.control.at_order + 1 : 1;
  const auto wish = [&](int order) { return growth(step.errors[std::size_t(order) - 1], allowed, order); };
  double factor = tested(before) ? wish(std::min<int>(used, int(step.errors.size()))) : 1;
  if (control.at_order > used)
    for (const int order : {used - 1, used + 1})
      if (order >= 1 && order <= highest_order && order <= int(step.errors.size()) && wish(order) > factor) {
        factor = wish(order);
        control.order = order;
        control.at_order = 0;
      }
  factor = std::clamp(factor, 0.2, fastest_growth(first, used));
  if (control.held) factor = std::min(factor, 1.0);
  control.held = false;
  d.dt_limit = std::min(dt * factor, longest_adaptive_step(s, d));
  // A step that was cut to meet a time says little of what the next may be.
  if (dt < before.dt_limit && factor >= 1) d.dt_limit = std::max(d.dt_limit, std::min(before.dt_limit, 2 * dt));
  if (const double closed = before.control.gap - control.gap; closed > 0) {
    constexpr double most = 0.5;  // of the gap, in one step
    d.dt_limit = std::min(d.dt_limit, most * control.gap / closed * dt);
  }
}

}  // namespace sim
