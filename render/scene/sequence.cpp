#include "render/scene/sequence.h"

#include <stdexcept>

namespace render {

constexpr double same_instant = 1e-9;  // share of the interval: times of frames are products, with rounding errors

sim::State interpolated(const sim::State& a, const sim::State& b, double time) {
  if (a.vesicles.size() != b.vesicles.size())
    throw std::invalid_argument("states with different numbers of vesicles have nothing between them");
  const double h = b.time - a.time, u = (time - a.time) / h, rest = 1 - u;
  if (rest < same_instant) return b;
  if (u < same_instant) return a;
  sim::State state = b;
  state.step = a.step;
  state.time = time;
  for (std::size_t k = 0; k < state.vesicles.size(); ++k) {
    const sim::VesicleState &before = a.vesicles[k], &after = b.vesicles[k];
    const sim::Matrix &x0 = after.position_before.values, &x1 = after.position.values;
    const sim::Matrix v0 = after.velocity_before.values, v1 = after.velocity.values + after.sliding.values;
    sim::VesicleState& v = state.vesicles[k];
    v.position.values = rest * rest * (1 + 2 * u) * x0 + u * u * (3 - 2 * u) * x1 + h * u * rest * (rest * v0 - u * v1);
    v.velocity.values = 6 * u * rest / h * (x1 - x0) + rest * (1 - 3 * u) * v0 + u * (3 * u - 2) * v1;
    // What is not carried to b's parametrisation is known in a's only.
    if (before.relabelled != after.relabelled || before.tension.order != after.tension.order) continue;
    v.tension.values = rest * before.tension.values + u * after.tension.values;
    v.sliding.values = rest * before.sliding.values + u * after.sliding.values;
    v.velocity.values -= v.sliding.values;
    v.tracers = (rest * before.tracers + u * after.tracers).rowwise().normalized();
    v.labels = before.labels;  // until they are laid anew
    if (before.labels_laid == after.labels_laid)
      v.labels.values = rest * before.labels.values + u * after.labels.values;
  }
  return state;
}

}  // namespace render
