#include "app/figures/samples.h"

#include "app/figures/tank_treading.h"

#include "render/scene/surface.h"
#include "sim/core/parallel.h"
#include "sim/suspension/velocity.h"

#include <cmath>

namespace app {

namespace {

/// A vesicle with its velocity relative to its centre.
sim::VesicleState relative(sim::VesicleState vesicle, const sim::Vec3& centre) {
  vesicle.velocity.values.row(0) -= std::sqrt(sim::default_area) * centre.transpose();
  return vesicle;
}

}  // namespace

double deformation_of(const Eigen::Matrix3d& m) {
  const double mean = (m(0, 0) + m(2, 2)) / 2, half = std::hypot((m(0, 0) - m(2, 2)) / 2, m(0, 2));
  const double l = std::sqrt(mean + half), b = std::sqrt(mean - half);
  return (l - b) / (l + b);
}

std::vector<VesicleSample> samples_of(sim::Plans& plans, const sim::State& state,
                                      std::span<const sim::VesicleMeasures> initial) {
  std::vector<VesicleSample> all;
  for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
    const sim::VesicleState one = relative(state.vesicles[v], sim::centroid_velocity(plans, state.vesicles[v]));
    VesicleSample sample{sim::measure(plans, one, initial[v].area, initial[v].volume)};
    sample.deformation = deformation_of(render::volume_moments(one.position).second);
    all.push_back(sample);
  }
  return all;
}

sim::SuspensionMeasures whole_of(const sim::Scene& scene, std::span<const VesicleSample> samples,
                                 std::span<const sim::VesicleMeasures> initial, Needs needs) {
  std::vector<sim::VesicleMeasures> vesicles(samples.begin(), samples.end());
  std::vector<sim::FlowMeasures> flow;
  std::vector<sim::Vec3> first;
  for (const sim::VesicleMeasures& m : initial) first.push_back(m.center);
  if (needs == Needs::forces)
    for (const VesicleSample& s : samples) flow.push_back(s.flow);
  return sim::suspension_measures(scene, vesicles, flow, first);
}

void add_flow(sim::Plans& plans, const sim::Scene& scene, const sim::State& state, Needs needs,
              std::span<VesicleSample> samples) {
  const std::vector<sim::FlowMeasures> flows = sim::flow_measures(plans, scene, state, needs == Needs::forces);
  sim::parallel_for(static_cast<int>(samples.size()), [&](int k) {
    const auto v = static_cast<std::size_t>(k);
    const sim::FlowMeasures& flow = flows[v];
    const sim::VesicleState one = relative(state.vesicles[v], flow.center_velocity);
    samples[v].flow = flow;
    samples[v].frequency = membrane_frequency(one.position, one.velocity, samples[v].center,
                                              std::isnan(flow.inclination_rate) ? 0 : flow.inclination_rate);
  });
}

}  // namespace app
