#include "sim/stepping/evaluate.h"

#include "sim/measures/diagnostics.h"

#include <cmath>
#include <numbers>

namespace sim {

Geometry measured_geometry(Plans& plans, const Coefficients& x) {
  return geometry(plans.basis(x.order, measure_order(x.order)), x);
}

Attempt<State> evaluate(const Model& s, const Dynamics& d) {
  return within_domain([&]() -> Attempt<State> {
    const auto x = positions(d);
    const Suspension suspension = freeze(s, d, x);
    const auto r = suspension_forcing(suspension, s.scene.flows, d.time, s.scene.buoyancy.gravity);
    Attempt<SuspensionSolve> result = solve(s, suspension, 0, r, motions(d), frames(d));
    if (!result) return result.rejection();
    State state{d.step, d.time, {}};
    for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
      const VesicleDynamics& v = d.vesicles[k];
      const Membrane& m = suspension.membranes[k];
      Motion& motion = result->motions[k];
      if (is_sphere({v.area, v.volume})) {  // only tensions of zero mean are determined
        const Matrix sigma = m.bases.field.synthesize(motion.tension).values;
        motion.tension.values(0, 0) -=
            integrate(m.geometry, sigma.col(0)) / m.geometry.dA.sum() * std::sqrt(4 * std::numbers::pi);
      }
      VesicleState out{v.position,       motion.velocity,  motion.tension, v.labels,      v.tracers,
                       v.saved_position, v.saved_velocity, v.relabelled,   v.labels_laid, v.labels_laid_time};
      if (d.saves == 0) out.velocity_before = out.velocity;
      state.vesicles.push_back(std::move(out));
    }
    return state;
  });
}

void expect(const Model& s, Dynamics& d, const State& state) {
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    VesicleDynamics& v = d.vesicles[k];
    v.motion = {state.vesicles[k].velocity, state.vesicles[k].tension};
    const Basis& basis = s.plans.basis(v.position.order, measure_order(v.position.order));
    v.frame.motion =
        shape_motion(rigid_body(v.position), geometry(basis, v.position), basis.synthesize(v.motion.velocity).values);
  }
}

void mark_saved(Dynamics& d, const State& state) {
  ++d.saves;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k) {
    d.vesicles[k].saved_position = state.vesicles[k].position;
    d.vesicles[k].saved_velocity = state.vesicles[k].velocity;
  }
}

}  // namespace sim
