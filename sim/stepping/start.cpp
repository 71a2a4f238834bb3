#include "sim/stepping/start.h"

#include "sim/measures/diagnostics.h"
#include "sim/membrane/cell.h"
#include "sim/sphere/norms.h"
#include "sim/stepping/contrasts.h"
#include "sim/stepping/saved_start.h"
#include "sim/surface/correction.h"
#include "sim/surface/dealias.h"
#include "sim/surface/shapes.h"
#include "sim/suspension/gap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

namespace sim {

double fixed_step(const Scene& scene) {
  if (!scene.time.step)
    throw std::invalid_argument(fmt::format("the scheme '{}' takes fixed steps: give time.step", scheme_name(scene)));
  return *scene.time.step;
}

double longest_step(const Scene& scene) {
  // Measured on a tank-treading prolate: 20 steps a period leave 1 % of the amplitude.
  constexpr double steps_a_period = 20;
  double longest = fixed_step(scene);
  for (const FlowParameters& flow : scene.flows)
    if (const double frequency = oscillation(flow); frequency > 0)
      longest = std::min(longest, 1 / (steps_a_period * frequency));
  return longest;
}

double strain(const Model& s, const Dynamics& d) {
  return straining_rate(s.plans, s.scene.flows, s.scene.buoyancy.gravity, s.materials, positions(d), sizes(d));
}

namespace {

/// x := c + R (x - c)/|x - c|, the sphere of the given volume.
void make_round(Coefficients& x, double volume) {
  const double radius = std::cbrt(3 * volume / unit_sphere_area);
  const Basis basis(x.order, 2 * x.order + 8);
  const Vec3 centre = rigid_body(x).centre;
  Matrix arms = basis.synthesize(x).values.rowwise() - centre.transpose();
  arms.rowwise().normalize();
  const Coefficients round = basis.analyze(Matrix(radius * arms));
  x = round;
  x.values.row(0) += std::sqrt(unit_sphere_area) * centre.transpose();
}

/// Throws std::invalid_argument where the range is too short to be sampled.
void check_repulsion(const Model& s, const Dynamics& d) {
  const NumericsParameters& n = s.scene.numerics;
  if (n.repulsion_strength == 0) return;
  double largest = 0;
  for (const AreaVolume& size : sizes(d)) largest = std::max(largest, area_radius(size));
  const double smallest = smallest_radius(sizes(d)), least = least_repulsion_range(smallest, largest);
  if (const double range = repulsion_range(n, smallest); range < least * (1 - 1e-9))
    throw std::invalid_argument(
        fmt::format("numerics.repulsion_range = {:.3g} is too short to be sampled on vesicles of radius {}: it must be "
                    "at least {:.3g}",
                    range,
                    largest > smallest * (1 + 1e-9) ? fmt::format("{:.3g} to {:.3g}", smallest, largest)
                                                    : fmt::format("{:.3g}", largest),
                    least));
}

/// By how many of its radii, or strains, each cause of motion moves a vesicle until the end: by flows, weights and
/// contacts no further than a double has digits left for the shape; bending only brings a shape to rest, and must be a
/// number with which can be computed. Throws std::invalid_argument, which names the key.
void check_magnitudes(const Model& s, const Dynamics& d) {
  constexpr double furthest = 1e15, stiffest = 1e100;
  const Scene& scene = s.scene;
  const double time = std::max(scene.time.end, scene.time.step.value_or(0));
  const auto check = [&](double rate, const std::string& what, std::size_t vesicle) {
    if (!(rate * time <= furthest))
      throw std::invalid_argument(
          fmt::format("{} is too large to compute with: until time.end = {:g} it would move vesicle {} by {:.2g} times "
                      "its radius; beyond {:.0e} no digits are left for its shape",
                      what, scene.time.end, vesicle, rate * time, furthest));
  };
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    const VesicleDynamics& v = d.vesicles[k];
    const double radius = area_radius({v.area, v.volume});
    const Matrix centre = v.position.values.row(0) / std::sqrt(unit_sphere_area);
    for (const FlowParameters& flow : scene.flows) {
      FlowParameters steady = flow;
      steady.time_factor = "constant";
      Matrix points = centre.replicate(4, 1);
      for (int a = 0; a < 3; ++a) points(a + 1, a) += radius;
      const double speed = background_velocity(std::span(&steady, 1), 0, points).cwiseAbs().maxCoeff();
      check(speed / radius, fmt::format("the [[flow]] '{}'", flow.kind), k);
    }
    const Material& m = s.materials[k];
    if (!(m.bending_modulus / std::pow(radius, 3) <= stiffest))
      throw std::invalid_argument(fmt::format(
          "vesicle.bending_modulus = {:g} of vesicle {} is too large to compute with", m.bending_modulus, k));
    check(std::abs(m.density_difference) * scene.buoyancy.gravity.norm() * radius,
          fmt::format("vesicle.density_difference = {:g} in buoyancy.gravity", m.density_difference), k);
    if (d.vesicles.size() > 1 || scene.cell.size)
      check(scene.numerics.repulsion_strength,
            fmt::format("numerics.repulsion_strength = {:g}", scene.numerics.repulsion_strength), k);
  }
}

/// What a vesicle starts with that no step has moved yet, or that other flows take from now on: the frame of the flow.
void start_anew(const Model& s, double time, std::int64_t step, VesicleDynamics& v) {
  const Basis& basis = s.plans.basis(v.position.order, v.position.order + 1);
  const Matrix points = basis.synthesize(v.position).values;
  const RigidBody body = rigid_body(v.position);
  const Coefficients flow = basis.analyze(background_velocity(s.scene.flows, time, points));
  v.frame = {rigid_part(body, flow), mean_gradient(body, flow)};
  v.motion.velocity = rigid_velocity(body, v.frame.motion);
  const NumericsParameters& n = s.scene.numerics;
  v.upsampling = n.upsampling > 0 ? double(n.upsampling) : upsampling_rate(s.plans, v.position, n.aliasing_tolerance);
  v.upsampling_due = step + upsampling_steps;
}

/// A nearly round vesicle uses up its excess area in a time of sqrt(1 - nu) over the rate of straining; a quarter of it
/// suits all contrasts from 0.1 on.
double nearly_round_step(const Model& s, const Dynamics& d) {
  constexpr double nearly_round = 0.02;
  double longest = std::numeric_limits<double>::infinity();
  for (const VesicleDynamics& v : d.vesicles)
    if (const double excess = 1 - reduced_volume(v.area, v.volume);
        excess < nearly_round && !is_sphere({v.area, v.volume}))
      longest = std::min(longest, 0.25 * std::sqrt(excess) / strain(s, d));
  return longest;
}

/// From the rate at which the membranes move at present.
double first_adaptive_step(const Model& s, const Dynamics& d) {
  double rate = fastest_motion(d);
  if (!(rate > 0)) rate = strain(s, d);  // at rest: by what could move it
  const double left = s.scene.time.end - d.time;
  const double length = rate > 0 ? 0.1 * std::sqrt(tolerance_of(s.scene.time)) / rate : left;
  return std::min({length, left > 0 ? left : length, longest_adaptive_step(s, d)});
}

}  // namespace

bool any_sphere(const Dynamics& d) {
  const std::vector<AreaVolume> all = sizes(d);
  return std::any_of(all.begin(), all.end(), is_sphere);
}

double longest_adaptive_step(const Model& s, const Dynamics& d) {
  double longest = std::numeric_limits<double>::infinity();
  constexpr double steps_a_period = 10;  // fewer could take a flow that oscillates for a steady one
  for (const FlowParameters& flow : s.scene.flows)
    if (const double frequency = oscillation(flow); frequency > 0)
      longest = std::min(longest, 1 / (steps_a_period * frequency));
  if (any_sphere(d)) longest = std::min(longest, 0.5 / strain(s, d));
  return longest;
}

void start_steps(const Model& s, Dynamics& d) {
  d.control = {};
  if (steps_adapt(s.scene.time)) {
    d.calm = 0;
    d.dt_limit = std::min(first_adaptive_step(s, d), nearly_round_step(s, d));
    return;
  }
  // Shorter ones while the order builds up; where a shape or a pulse of a flow asks for short steps, they stay short.
  const double build_up = std::ldexp(longest_step(s.scene), -2 * (scheme_of(s.scene).order - 1)),
               short_ones = std::min((next_switch(s.scene.flows, d.time) - d.time) / 4, nearly_round_step(s, d));
  d.calm = short_ones < build_up ? 0 : calm_enough;
  d.dt_limit = std::min(build_up, short_ones);
}

namespace {

/// A vesicle of another run in an order of this one. What a lower order cuts off changes area and volume, which are
/// restored.
Coefficients taken_position(const Model& s, std::size_t vesicle, const Coefficients& from, int order) {
  const VesicleParameters& v = s.scene.vesicles[vesicle];
  const NumericsParameters& n = s.scene.numerics;
  if (order == 0) order = v.order;
  if (order == 0)
    order = order_follows(s.scene.time, v) ? std::clamp(from.order, n.least_order, n.most_order) : fixed_order;
  Coefficients x = resized(from, order);
  if (order >= from.order) return x;
  if (const double lost = cut_off(from, order); !(lost <= most_cut_off)) {
    int enough = order;
    while (!(cut_off(from, enough) <= most_cut_off)) ++enough;
    throw std::invalid_argument(fmt::format(
        "order {} would cut off {:.2g} of its radius from the shape of vesicle {} in '{}', of order {}; give "
        "an order of at least {}",
        order, lost, vesicle, s.scene.start.from.value_or(""), from.order, enough));
  }
  const Measures before = measures(measured_geometry(s.plans, from));
  if (!n.correction || is_sphere({before.area, before.volume})) return x;
  const Correction c = area_volume_correction(s.plans, x, before.area, before.volume);
  if (!c.converged)
    throw std::invalid_argument(
        fmt::format("in order {} vesicle {} of '{}' cannot keep its area and volume; give a higher order", order,
                    vesicle, s.scene.start.from.value_or("")));
  x.values += c.shift.values;
  return x;
}

Coefficients starting_position(const Scene& scene, VesicleParameters v, int order) {
  if (order > 0) v.order = order;
  if (v.order == 0 && !order_follows(scene.time, v)) v.order = fixed_order;
  if (v.order > 0) return initial_position(v);
  const Coefficients x = initial_position(v);
  v.order = std::clamp(x.order, scene.numerics.least_order, scene.numerics.most_order);
  return v.order == x.order ? x : initial_position(v);
}

/// A scene that has a cell may have it, and no vesicle is thicker than the cell: looking for where it meets its images
/// would take for ever.
void check_cell(const Model& s, const Dynamics& d) {
  if (const auto objection = scene_objection(s.scene)) throw std::invalid_argument(objection->reason);
  if (!s.scene.cell.size) return;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    const VesicleDynamics& v = d.vesicles[k];
    const Basis& basis = s.plans.basis(v.position.order, measure_order(v.position.order));
    const Matrix points = basis.synthesize(v.position).values;
    const Vec3 extent = (points.colwise().maxCoeff() - points.colwise().minCoeff()).transpose();
    for (int a = 0; a < 3; ++a) {
      // The mean chord along an axis: some chord is as long, and its ends overlap if the cell is shorter.
      const double thickness = v.volume / (extent[(a + 1) % 3] * extent[(a + 2) % 3]);
      if (thickness > (*s.scene.cell.size)[a])
        throw std::invalid_argument(
            fmt::format("vesicle {} and its own image overlap: it is at least {:.3g} thick along {}, the cell {:.3g}",
                        k, thickness, "xyz"[a], (*s.scene.cell.size)[a]));
    }
  }
}

}  // namespace

Dynamics initial_dynamics(const Model& s, std::span<const int> orders, const State* from) {
  if (s.scene.vesicles.empty()) throw std::invalid_argument("the scene has no vesicle");
  if (from)
    if (const auto objection = start_objection(s.plans, s.scene, *from)) throw std::invalid_argument(objection->reason);
  Dynamics d;
  for (const VesicleParameters& parameters : s.scene.vesicles) {
    VesicleDynamics v;
    const std::size_t k = d.vesicles.size();
    const int order = orders.empty() ? 0 : orders[k];
    v.position =
        from ? taken_position(s, k, from->vesicles[k].position, order) : starting_position(s.scene, parameters, order);
    const int p = v.position.order;
    if (const Measures given = measures(measured_geometry(s.plans, v.position)); is_sphere({given.area, given.volume}))
      make_round(v.position, given.volume);
    const int label_order = s.scene.numerics.label_order;
    v.labels = fresh_labels(label_order > 0 ? label_order : automatic_label_order(p));
    v.tracers = tracer_directions();
    if (from) {  // the same material as there
      const Coefficients& labels = from->vesicles[k].labels;
      v.labels = resized(labels, label_order > 0 ? label_order : std::max(labels.order, automatic_label_order(p)));
      v.tracers = from->vesicles[k].tracers;
    }
    v.saved_position = v.position;
    visit(v, [&]<class Member>(Part part, Member& member) {  // fields that nothing is known of yet
      if constexpr (std::is_same_v<Member, Coefficients>)
        if (member.values.size() == 0) member = {p, Matrix::Zero(coefficient_count(p), part == Part::scalar ? 1 : 3)};
    });
    const Geometry g = measured_geometry(s.plans, v.position);
    const Measures measured = measures(g);
    v.area = measured.area;
    v.volume = measured.volume;
    v.energy = measured.h_squared / unit_sphere_area;
    v.tail = curvature_tail(s.plans.basis(p, measure_order(p)), g);
    v.high_share = high_degree_share(v.position);
    start_anew(s, 0, 0, v);
    d.vesicles.push_back(std::move(v));
  }
  check_cell(s, d);
  check_magnitudes(s, d);
  check_contrasts(s, d);
  const Gap gap = smallest_gap(s.plans, positions(d), cell_at(s.scene, 0), s.ranks);
  if (gap.crossing) throw std::invalid_argument(pair_name(gap) + " overlap");
  if (gap.distance < gap_floor(s, d))
    throw std::invalid_argument(fmt::format("{} are {:.3g} apart, less than numerics.gap_floor = {:.3g}",
                                            pair_name(gap), gap.distance, gap_floor(s, d)));
  check_repulsion(s, d);
  start_steps(s, d);
  if (std::isfinite(gap.distance)) d.control.gap = gap.distance;
  if (scheme_name(s.scene) == "explicit")
    for (std::size_t k = 0; k < d.vesicles.size(); ++k)
      if (is_sphere({d.vesicles[k].area, d.vesicles[k].volume}))
        throw std::invalid_argument(
            fmt::format("vesicle {} is a sphere, which the scheme 'explicit' cannot hold in shape; take "
                        "another time.scheme",
                        k));
  return d;
}

Attempt<Dynamics> begun_anew(const Model& s, Dynamics d) {
  for (VesicleDynamics& v : d.vesicles) {
    v.history = {};
    start_anew(s, d.time, d.step, v);
  }
  const Attempt<State> now = evaluate(s, d);
  if (!now) return now.rejection();
  expect(s, d, *now);
  start_steps(s, d);
  return d;
}

}  // namespace sim
