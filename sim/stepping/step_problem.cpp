#include "sim/stepping/step_problem.h"

#include "sim/membrane/cell.h"
#include "sim/membrane/sliding.h"

#include <fmt/format.h>

#include <cmath>

namespace sim {

namespace {

std::vector<double> upsamplings(const Dynamics& d) {
  std::vector<double> rates;
  for (const VesicleDynamics& v : d.vesicles) rates.push_back(v.upsampling);
  return rates;
}

/// The vesicles among the ranks, by place; assembling the operators of degree p is most of the work, of p^5.
Division division_of(const Ranks& ranks, std::span<const Coefficients> positions) {
  std::vector<Vec3> places;
  std::vector<double> weights;
  for (const Coefficients& x : positions) {
    places.emplace_back(x.values.row(0).transpose());
    weights.push_back(std::pow(x.order + 1, 5));
  }
  return divided(ranks, places, weights);
}

}  // namespace

Rejection not_converged(double residual, int iterations) {
  if (!std::isfinite(residual)) return {"velocities or forces are too large to compute with"};
  return {fmt::format("the linear solver stopped at a relative residual of {:.1e} after {} iterations", residual,
                      iterations)};
}

Coefficients frame_velocity(const RigidBody& body, const Frame& frame) {
  return rigid_velocity(body, frame.at(body.centre));
}

Frame frame_of(const Membrane& m, const Coefficients& velocity, std::span<const FlowParameters> flows, double time) {
  const Coefficients flow = m.bases.field.analyze(background_velocity(flows, time, m.geometry.x.value));
  return {shape_motion(m.body, m.geometry, m.bases.field.synthesize(velocity).values), mean_gradient(m.body, flow)};
}

double size_of(const VesicleDynamics& v, const Matrix& difference) {
  return difference.norm() / std::sqrt(v.area);  // of an orthonormal basis: the mean is over 4 pi, R0^2 = A/(4 pi)
}

Model make_model(const Scene& scene, Plans& plans, const Ranks& ranks) {
  Model s{scene, plans, {}, ranks};
  for (const VesicleParameters& v : scene.vesicles)
    s.materials.push_back({v.viscosity_contrast, v.bending_modulus, v.density_difference});
  return s;
}

double gap_floor(const Model& s, const Dynamics& d) {
  return s.scene.numerics.gap_floor.value_or(default_gap_floor * smallest_radius(sizes(d)));
}

Suspension freeze(const Model& s, const Dynamics& d, double time, std::span<const Coefficients> frozen,
                  std::span<const Motion> likely) {
  const NumericsParameters& n = s.scene.numerics;
  SuspensionOptions options =
      suspension_options(n, smallest_radius(sizes(d)), solve_tolerance(s.scene), cell_at(s.scene, time));
  options.interaction.division = division_of(s.ranks, frozen);
  std::vector<Coefficients> expected;
  if (n.implicit_tension)
    for (const Motion& m : likely) expected.push_back(m.tension);
  return freeze_suspension(
      s.plans, s.materials, frozen, upsamplings(d), options, expected,
      pinned_tensions(s.plans, s.scene.flows, s.scene.buoyancy.gravity, s.materials, frozen, sizes(d)));
}

Attempt<SuspensionSolve> solve(const Model& s, const Suspension& suspension, double c, std::span<const Coefficients> r,
                               std::span<const Motion> guess, std::span<const Frame> frames, double tolerance,
                               const Dynamics& before) {
  const Preconditioner kind =
      s.scene.numerics.preconditioner == "block" ? Preconditioner::block : Preconditioner::spectral;
  std::vector<RigidMotion> rigid;
  for (std::size_t k = 0; k < frames.size(); ++k)
    rigid.push_back(suspension.membranes[k] ? frames[k].at(suspension.membranes[k]->body.centre) : RigidMotion{});
  constexpr double stiff_sphere = 1e-9;  // the tension that keeps a sphere round hides smaller residuals
  bool pinned = false;
  for (const auto& m : suspension.membranes) pinned = pinned || (m && m->pinned);
  if (any(s.ranks, pinned) && !s.scene.numerics.gmres_tolerance && steps_adapt(s.scene.time))
    tolerance = std::max(tolerance, stiff_sphere);
  // An instantaneous problem knows no stiffness: what steps have learned costs it iterations.
  const Lessons known = c > 0 ? delivered(before.learned, before.keepers, suspension.division) : Lessons{};
  SuspensionSolve result = solve_suspension(suspension, c, r, guess, tolerance, kind, rigid, known);
  if (!result.converged && !known.empty()) result = solve_suspension(suspension, c, r, guess, tolerance, kind, rigid);
  if (!result.converged) return not_converged(result.residual, result.iterations);
  return result;
}

double fastest_motion(const Dynamics& d) {
  double rate = 0;
  for (const VesicleDynamics& v : d.vesicles)
    rate = std::max(rate, motion_rate(v.motion.velocity, area_radius({v.area, v.volume})));
  return rate;
}

double motion_over(const Dynamics& d, double dt) {
  constexpr double share_a_step = 0.01;
  return dt * fastest_motion(d) + share_a_step;
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
