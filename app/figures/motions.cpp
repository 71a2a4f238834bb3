#include "app/figures/motions.h"

#include "app/figures/samples.h"
#include "app/figures/tank_treading.h"

#include "render/scene/surface.h"
#include "sim/membrane/flows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace app {

namespace {

/// Angles of one vesicle in the states in which it has a long axis.
struct Angles {
  std::vector<double> times, degrees;
};

/// Spheres are held round to less; the angle of what is rounder is noise.
constexpr double round_deformation = 1e-4;

void add_angle(const sim::VesicleState& v, double time, Angles& a) {
  const Eigen::Matrix3d moments = render::volume_moments(v.position).second;
  if (!(deformation_of(moments) > round_deformation)) return;
  const double angle = sim::inclination(moments) * 180 / std::numbers::pi;
  a.times.push_back(time);
  a.degrees.push_back(a.degrees.empty() ? angle : sim::unwrapped(angle, a.degrees.back()));
}

std::optional<sim::State> state_of(const sim::TrajectoryReader& trajectory, std::int64_t k, Damage damage) try {
  return trajectory.state(k);
} catch (const std::exception&) {
  if (damage == Damage::is_error) throw;
  return std::nullopt;
}

std::string_view reason(const Angles& a, bool some_state) {
  if (!some_state) return "no state can be read";
  if (a.times.empty()) return "it is round in the shear plane and has no axis to follow";
  if (!sim::can_be_followed(a.times, a.degrees)) return "its states are too far apart to follow the long axis";
  return "too short a run to tell whether it tank-treads, swings or tumbles";
}

void set_last_third(const sim::TrajectoryReader& trajectory, VesicleMotion& m) {
  if (trajectory.count() == 0) return;
  m.to = trajectory.time(trajectory.count() - 1);
  m.from = m.to - (m.to - trajectory.time(0)) / 3;
}

VesicleMotion motion_in(const Angles& a, double rate, bool some_state) {
  std::vector<double> strains = a.times;
  for (double& t : strains) t *= rate;
  VesicleMotion m{sim::motion_period(strains, a.degrees)};
  for (double* t : {&m.period, &m.from, &m.to}) *t /= rate;
  if (m.motion == sim::AxisMotion::untold) m.why = reason(a, some_state);
  return m;
}

}  // namespace

std::vector<VesicleMotion> motions_of(const sim::TrajectoryReader& trajectory, const sim::Scene& scene, Damage damage) {
  const auto vesicles = static_cast<std::size_t>(trajectory.layout().vesicles);
  const std::optional<double> rate = sim::steady_shear_rate(scene.flows);
  std::vector<VesicleMotion> all;
  if (!rate) {
    VesicleMotion none{sim::motion_period({}, {})};
    none.why = "there is no steady shear flow";
    set_last_third(trajectory, none);
    all.assign(vesicles, none);
    return all;
  }
  std::vector<Angles> angles(vesicles);
  bool some_state = false;
  for (std::int64_t k = 0; k < trajectory.count(); ++k)
    if (const std::optional<sim::State> state = state_of(trajectory, k, damage)) {
      some_state = true;
      for (std::size_t v = 0; v < vesicles; ++v) add_angle(state->vesicles[v], state->time, angles[v]);
    }
  for (const Angles& a : angles) {
    all.push_back(motion_in(a, std::abs(*rate), some_state));
    if (all.back().motion == sim::AxisMotion::untold) set_last_third(trajectory, all.back());
  }
  return all;
}

std::vector<VesicleMotion> motions_with_means(const sim::TrajectoryReader& trajectory, const sim::Scene& scene) {
  std::vector<VesicleMotion> all = motions_of(trajectory, scene);
  struct Curves {
    std::vector<double> frequency, viscosity, normal_1, normal_2, migration;
  };
  std::vector<Curves> curves(all.size());
  std::vector<double> times;
  sim::Plans plans;
  std::vector<sim::VesicleMeasures> initial;
  double first = std::numeric_limits<double>::infinity();  // what is before it plays no part, but for three states
  for (const VesicleMotion& m : all) first = std::min(first, m.from);
  std::int64_t begin = 0;
  while (begin < trajectory.count() && trajectory.time(begin) < first) ++begin;
  begin = std::max<std::int64_t>(begin - 3, 0);
  for (std::int64_t k = begin; k < trajectory.count(); ++k) {
    const sim::State state = trajectory.state(k);
    if (k == begin)
      for (const sim::VesicleState& v : state.vesicles) initial.push_back(sim::measure(plans, v, 1, 1));
    times.push_back(state.time);
    std::vector<VesicleSample> samples = samples_of(plans, state, initial);
    add_flow(plans, scene, state, Needs::forces, samples);
    for (std::size_t v = 0; v < samples.size(); ++v) {
      const sim::FlowMeasures& flow = samples[v].flow;
      curves[v].frequency.push_back(samples[v].frequency);
      curves[v].viscosity.push_back(flow.intrinsic_viscosity);
      curves[v].normal_1.push_back(flow.normal_stress_1);
      curves[v].normal_2.push_back(flow.normal_stress_2);
      curves[v].migration.push_back(flow.migration);
    }
  }
  for (std::size_t v = 0; v < all.size(); ++v) {
    VesicleMotion& m = all[v];
    const auto mean = [&](const std::vector<double>& values) { return sim::mean_over(times, values, m.from, m.to); };
    m.frequency = mean(curves[v].frequency);
    m.intrinsic_viscosity = mean(curves[v].viscosity);
    m.normal_stress_1 = mean(curves[v].normal_1);
    m.normal_stress_2 = mean(curves[v].normal_2);
    m.migration = mean(curves[v].migration);
  }
  return all;
}

std::string motion_text(const VesicleMotion& m, double rate) {
  switch (m.motion) {
    case sim::AxisMotion::tank_treading: {
      std::string text = fmt::format("tank-treading at {:.1f}°", m.mean);
      if (std::isfinite(m.frequency)) text += fmt::format(", frequency {:.3f} γ̇", std::abs(m.frequency) / rate);
      return text;
    }
    case sim::AxisMotion::swinging:
      return fmt::format("swinging between {:.1f}° and {:.1f}°, period {:.5g}", m.least, m.most, m.period);
    case sim::AxisMotion::tumbling:
      return std::isfinite(m.period) ? fmt::format("tumbling, period {:.5g} (half turn {:.5g})", m.period, m.period / 2)
                                     : "tumbling";
    case sim::AxisMotion::untold:
      break;
  }
  return fmt::format("untold: {}", m.why);
}

std::vector<std::string> motion_lines(const sim::TrajectoryReader& trajectory, const sim::Scene& scene) {
  if (trajectory.count() == 0) return {};
  std::vector<VesicleMotion> motions = motions_of(trajectory, scene, Damage::is_left_out);
  std::optional<sim::State> last;
  for (std::int64_t k = trajectory.count() - 1; k >= 0 && !last; --k)
    last = state_of(trajectory, k, Damage::is_left_out);
  const double rate = std::abs(sim::steady_shear_rate(scene.flows).value_or(1));
  std::vector<std::string> texts;
  sim::Plans plans;
  for (std::size_t v = 0; v < motions.size(); ++v) {
    if (last && motions[v].motion == sim::AxisMotion::tank_treading)
      motions[v].frequency = rate * steady_point(plans, last->vesicles[v], 1, rate).frequency;
    texts.push_back(motion_text(motions[v], rate));
  }
  if (std::all_of(texts.begin(), texts.end(), [&](const std::string& text) { return text == texts.front(); }))
    return {texts.front()};
  constexpr std::size_t most = 8;
  std::vector<std::string> lines;
  if (texts.size() <= most) {
    for (std::size_t v = 0; v < texts.size(); ++v) lines.push_back(fmt::format("vesicle {}: {}", v, texts[v]));
    return lines;
  }
  for (const sim::AxisMotion kind :
       {sim::AxisMotion::tank_treading, sim::AxisMotion::swinging, sim::AxisMotion::tumbling, sim::AxisMotion::untold})
    if (const auto count =
            std::count_if(motions.begin(), motions.end(), [&](const auto& m) { return m.motion == kind; }))
      lines.push_back(fmt::format("{} of {} vesicles {}", count, motions.size(), name_of(kind)));
  return lines;
}

}  // namespace app
