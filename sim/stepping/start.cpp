#include "sim/stepping/start.h"

#include "sim/measures/diagnostics.h"
#include "sim/sphere/norms.h"
#include "sim/surface/dealias.h"
#include "sim/surface/shapes.h"
#include "sim/suspension/gap.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <type_traits>

namespace sim {

namespace {

constexpr double four_pi = 4 * std::numbers::pi;

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
void start_anew(const Model& s, double time, VesicleDynamics& v) {
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

/// Longest step from a start: four until flows are switched again. A nearly round vesicle uses up its excess area in a
/// time of sqrt(1 - nu) over the rate of straining; a quarter of it suits all contrasts from 0.1 on.
double start_step(const Model& s, const Dynamics& d) {
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

Dynamics initial_dynamics(const Model& s) {
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
    throw std::invalid_argument(
        fmt::format("vesicles {} and {} are {:.3g} apart, less than numerics.gap_floor = {:.3g}", gap.first, gap.second,
                    gap.distance, gap_floor(s, d)));
  d.dt_limit = start_step(s, d);
  if (s.scene.time.scheme == "explicit")
    for (std::size_t k = 0; k < d.vesicles.size(); ++k)
      if (is_sphere({d.vesicles[k].area, d.vesicles[k].volume}))
        throw std::invalid_argument(
            fmt::format("vesicle {} is a sphere, which the scheme 'explicit' cannot hold in shape; take "
                        "another time.scheme",
                        k));
  return d;
}

Attempt<Dynamics> begun_anew(const Model& s, Dynamics d) {
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

}  // namespace sim
