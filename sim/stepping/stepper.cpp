#include "sim/stepping/stepper.h"

#include "sim/core/divided.h"
#include "sim/measures/diagnostics.h"
#include "sim/membrane/cell.h"
#include "sim/sphere/norms.h"
#include "sim/surface/dealias.h"
#include "sim/suspension/gap.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace sim {

namespace {

double energy_of(const Geometry& g) { return integrate(g, g.H.cwiseAbs2()) / unit_sphere_area; }

/// Moves the grid points along the membrane and carries everything that belongs to the material. False: it would not
/// pay.
bool relabel_vesicle(const Model& s, VesicleDynamics& v) {
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

/// Shifts x to the area and volume of the start; the longest shift.
Attempt<double> correct(const Model& s, VesicleDynamics& v, const Geometry& g) {
  const Attempt<Correction> c = correction_of(s, v, v.position, g);
  if (!c) return c.rejection();
  v.position.values += c->shift.values;
  return c->largest;
}

/// Why a step must not have led to this geometry, if so.
std::optional<Rejection> objection(const NumericsParameters& n, const Geometry& after, double area_before,
                                   double energy_before) {
  const double change = after.dA.sum() / area_before - 1;
  if (!(std::abs(change) <= n.step_area_bound))
    return Rejection{fmt::format("the area changed by {:.2g} % in one step", 100 * change)};
  const double energy = energy_of(after);
  if (!(std::abs(energy - energy_before) <= n.step_energy_bound * energy_before))
    return Rejection{fmt::format("the bending energy jumped from {:.4g} to {:.4g}", energy_before, energy)};
  return std::nullopt;
}

}  // namespace

namespace {

void lay_labels_anew(VesicleDynamics& v, double time) {
  v.labels = fresh_labels(v.labels.order);
  ++v.labels_laid;
  v.labels_laid_time = time;
}

/// Labels and dots follow the material while the grid slides over it.
void slide(const Model& s, const VesicleDynamics& before, double dt, double time, VesicleDynamics& v) {
  const SlidingPath path = sliding_path(before, dt, v.position, v.sliding);
  v.labels = slid_labels(s.plans, path, v.labels, -dt, 0);
  v.tracers = slid_points(path, v.tracers, -dt, 0);
  if (labels_wound_up(v.labels)) lay_labels_anew(v, time);
}

struct Finished {
  VesicleStep record;
  std::vector<double> errors;  ///< of each order from 1
};

/// Checks, correction, relabelling and renewal of one vesicle after its scheme has moved it.
Attempt<Finished> finish_vesicle(const Model& s, VesicleDynamics& v, Moved moved, const Dynamics& all, double dt) {
  const NumericsParameters& n = s.scene.numerics;
  const Scheme& scheme = scheme_of(s.scene);
  if (!moved.position.values.allFinite()) return Rejection{"a position is not finite"};
  const int p = moved.position.order;
  const Basis& measured = s.plans.basis(p, measure_order(p));
  const Geometry there = geometry(measured, moved.position);
  if (auto rejection = objection(n, there, n.correction ? v.area : area_volume(measured, v.position).area, v.energy))
    return *rejection;
  const VesicleDynamics before = v;
  v.position = std::move(moved.position);
  v.motion = std::move(moved.motion);
  v.sliding = std::move(moved.sliding);
  v.frame = moved.frame;
  v.history = std::move(moved.history);
  Finished finished;
  VesicleStep& record = finished.record;
  const auto correct_to = [&](const Geometry& g) -> std::optional<Rejection> {
    const Attempt<double> shift = correct(s, v, g);
    if (!shift) return shift.rejection();
    record.correction = std::max(record.correction, *shift);
    return std::nullopt;
  };
  if (n.correction) {
    const Matrix uncorrected = v.position.values;
    if (auto rejection = correct_to(there)) return *rejection;
    // The shift is part of the motion: the next step expects the like, or its forces would be those of another place.
    if (moved.c > 0) v.sliding.values += (v.position.values - uncorrected) / moved.c;
  }
  // The shift of the correction is part of the motion, except that the prediction of a first step knows nothing of it.
  if (scheme.slides && !before.history.levels.empty())
    finished.errors = estimated_errors(before, dt, v.position, all.control.order + 1);
  else
    finished.errors = {moved.error};
  const double time = all.time;
  if (grid_slides(s.scene)) {
    slide(s, before, dt, time, v);
  } else if (relabelling_due(n.reparametrization, v) && relabel_vesicle(s, v)) {
    record.relabelled = 1;
    if (n.correction)
      if (auto rejection = correct_to(measured_geometry(s.plans, v.position))) return *rejection;
    if (labels_wound_up(v.labels)) lay_labels_anew(v, time);
  }
  const Geometry now = measured_geometry(s.plans, v.position);
  const Measures after = measures(now);
  v.energy = after.h_squared / unit_sphere_area;
  if (n.upsampling == 0 && all.step >= v.upsampling_due) {
    v.upsampling = upsampling_rate(s.plans, v.position, n.aliasing_tolerance);
    v.upsampling_due = all.step + upsampling_steps;
  }
  record.area_error = after.area / v.area - 1;
  record.volume_error = after.volume / v.volume - 1;
  record.energy = v.energy;
  record.upsampling = v.upsampling;
  record.tail = v.tail = curvature_tail(measured, now);
  record.degree = p;
  record.space_error = v.space_error * dt;
  return finished;
}

/// Finishes all vesicles; of several rejections that of the first vesicle counts.
std::optional<Rejection> finish_vesicles(const Model& s, Step& step, Advance& advance, double dt) {
  Dynamics& d = step.dynamics;
  const int n = int(d.vesicles.size());
  step.record.vesicles.resize(n);
  std::vector<std::optional<Rejection>> rejections(n);
  std::vector<std::vector<double>> errors(n);
  const auto finish = [&](int k) {
    const Attempt<Finished> finished =
        within_domain([&] { return finish_vesicle(s, d.vesicles[k], std::move(advance.vesicles[k]), d, dt); });
    if (finished) {
      step.record.vesicles[k] = finished->record;
      errors[k] = finished->errors;
    } else {
      rejections[k] = finished.rejection();
    }
  };
  divided_for(advance.division, n, finish, [&](Parcel& parcel, int k) {
    bool rejected = rejections[k].has_value();
    parcel(rejected);
    if (rejected) {
      if (!rejections[k]) rejections[k].emplace();
      return parcel(rejections[k]->reason), parcel(rejections[k]->final);
    }
    transfer(parcel, d.vesicles[k]);
    parcel(errors[k]);
    visit(step.record.vesicles[k], [&](auto&&, auto&&, double& column) { parcel(column); });
  });
  for (const auto& rejection : rejections)
    if (rejection) return rejection;
  step.errors = errors[0];
  for (const auto& of_vesicle : errors)
    for (std::size_t q = 0; q < step.errors.size(); ++q) step.errors[q] = std::max(step.errors[q], of_vesicle[q]);
  return std::nullopt;
}

/// What may keep membranes apart that have come together.
std::string remedy(const Model& s, const Dynamics& d) {
  const NumericsParameters& n = s.scene.numerics;
  const double radius = smallest_radius(sizes(d)), range = repulsion_range(n, radius);
  const double enough = std::max(sufficient_repulsion(strain(s, d), radius, range), 2 * n.repulsion_strength);
  const double digit = std::pow(10, std::floor(std::log10(enough)) - 1);
  return fmt::format("try more degrees, or numerics.repulsion_strength = {:g}{}", std::ceil(enough / digit) * digit,
                     n.repulsion_range ? "" : fmt::format(" (its range is {:.2g})", range));
}

/// Of a step that leads two vesicles into each other. Where they were all but there before, shorter steps only take
/// longer: the film between them is thinner than their degrees resolve.
Rejection too_close(const Model& s, const Dynamics& before, const Gap& gap) {
  const std::string pair = pair_name(gap);
  const double floor = gap_floor(s, before), last = before.control.gap;
  constexpr double all_but_there = 1.5;
  if (last > 0 && last < all_but_there * floor)
    return {fmt::format("{} come within numerics.gap_floor = {:.3g}, nearer than order {} keeps membranes apart; {}",
                        pair, floor, before.vesicles[gap.first].position.order, remedy(s, before)),
            true};
  if (gap.crossing) return {pair + " would cross"};
  return {fmt::format("{} would come within {:.2g}", pair, gap.distance)};
}

}  // namespace

Attempt<Step> take_step(const Model& s, const Dynamics& before, double dt) {
  const auto flows = acting_flows(s.scene.flows, before.time, before.time + dt);
  const Scheme& scheme = scheme_of(s.scene);
  Attempt<Advance> advance = within_domain([&] { return scheme.advance({s, before, dt, flows}); });
  if (!advance) return advance.rejection();
  Step step{before, {}, {}};
  Dynamics& d = step.dynamics;
  StepRecord& record = step.record;
  const int levels = int(before.vesicles.front().history.levels.size()) + 1;
  d.control.order = std::min(steps_adapt(s.scene.time) ? before.control.order : scheme.order, levels);
  d.time = before.time + dt;
  d.step = before.step + 1;
  if (auto rejection = finish_vesicles(s, step, *advance, dt)) return *rejection;
  d.learned = std::move(advance->learned);
  d.keepers = std::move(advance->division.owner);
  for (std::size_t k = 0; k < d.learned.size(); ++k)  // of coefficients in other parameters
    if (record.vesicles[k].relabelled > 0) d.learned[k] = nullptr;
  const Gap gap = smallest_gap(s.plans, positions(d), cell_at(s.scene, d.time), s.ranks);
  if (gap.crossing || gap.distance < gap_floor(s, d)) return too_close(s, before, gap);
  if (std::isfinite(gap.distance)) d.control.gap = gap.distance;
  record.step = double(d.step);
  record.dt = dt;
  record.time = d.time;
  record.gap = gap.distance;
  record.iterations = advance->iterations;
  record.residual = advance->residual;
  record.order = d.control.order;
  record.error = step.errors[std::min(step.errors.size(), std::size_t(d.control.order)) - 1];
  return step;
}

}  // namespace sim
