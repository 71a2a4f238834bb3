#include "app/figures/series.h"

#include "app/figures/samples.h"
#include "app/pictures/instants.h"

#include "sim/measures/diagnostics.h"
#include "sim/measures/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

/// What the quantities of one trajectory are computed from; left empty where no quantity needs it.
struct Measurements {
  double length = 1;                                ///< area radius
  std::vector<double> times;                        ///< of the saved states
  std::vector<std::vector<VesicleSample>> samples;  ///< state, vesicle
  std::vector<sim::SuspensionMeasures> whole;       ///< state
  std::vector<sim::StepRecord> steps;
};

/// States between two saved ones, for measures of shapes alone: flow and forces are not interpolated, and errors would
/// be those of the interpolation.
int between_saved(const FigureSource& source, const std::vector<const QuantityRow*>& rows, Instants instants) {
  const auto of_shapes = [](const QuantityRow* row) {
    return row->needs == Needs::shape && row->scale != render::Scale::logarithmic &&
           !std::holds_alternative<StepCurves>(row->curves);
  };
  constexpr std::int64_t enough = 400;  // points of a curve, that its corners are not seen
  const std::int64_t intervals = source.trajectory.count() - 1;
  if (instants == Instants::saved || intervals < 1 || !std::all_of(rows.begin(), rows.end(), of_shapes)) return 0;
  return static_cast<int>(std::min<std::int64_t>((enough - 1) / intervals, 19));
}

/// All saved states, and so many between two of them, with angles continued from state to state.
void measure_states(const FigureSource& source, Needs needs, int between, Measurements& m) {
  const sim::TrajectoryReader& trajectory = source.trajectory;
  sim::Plans plans;
  std::vector<sim::VesicleMeasures> initial;
  const std::int64_t pieces = between + 1, count = (trajectory.count() - 1) * pieces + 1;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t saved = k / pieces;
    const double share = static_cast<double>(k % pieces) / static_cast<double>(pieces);
    const sim::State state =
        share > 0 ? state_at(trajectory, (1 - share) * trajectory.time(saved) + share * trajectory.time(saved + 1))
                  : trajectory.state(saved);
    m.times.push_back(state.time);
    if (k == 0)
      for (const sim::VesicleState& v : state.vesicles) initial.push_back(sim::measure(plans, v, 1, 1));
    std::vector<VesicleSample> now = samples_of(plans, state, initial);
    if (needs != Needs::shape) add_flow(plans, source.settings.scene, state, needs, now);
    m.whole.push_back(whole_of(source.settings.scene, now, initial, needs));
    for (std::size_t v = 0; k > 0 && v < now.size(); ++v)
      now[v].inclination_deg = sim::unwrapped(now[v].inclination_deg, m.samples.back()[v].inclination_deg);
    m.samples.push_back(std::move(now));
  }
}

Measurements measurements_of(const FigureSource& source, const std::vector<const QuantityRow*>& rows,
                             Instants instants) {
  const auto of_states = [](const QuantityRow* row) { return !std::holds_alternative<StepCurves>(row->curves); };
  Measurements m;
  m.length = length_of(source.trajectory);
  Needs needs = Needs::shape;
  for (const QuantityRow* row : rows) needs = std::max(needs, row->needs);
  if (std::any_of(rows.begin(), rows.end(), of_states))
    measure_states(source, needs, between_saved(source, rows, instants), m);
  if (!std::all_of(rows.begin(), rows.end(), of_states)) m.steps = source.trajectory.steps();
  return m;
}

/// Central differences, one-sided at the ends.
void differentiate(render::Series& s) {
  const std::vector<double> values = s.values;
  const std::size_t n = values.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i > 0 ? i - 1 : 0, b = std::min(i + 1, n - 1);
    s.values[i] = b > a ? (values[b] - values[a]) / (s.times[b] - s.times[a]) : std::nan("");
  }
}

double time_factor(const FigureSource& source, const SharedScales& scales) {
  return scales.rate ? time_unit(source.settings.scene).factor : 1;
}

QuantityUnits units_of(const FigureSource& source, const SharedScales& scales, double length, std::size_t vesicle) {
  const sim::Scene& scene = source.settings.scene;
  return {.length = length,
          .rate = scales.rate ? time_factor(source, scales) : 0,
          .bending_modulus = scales.bending ? scene.vesicles[vesicle].bending_modulus : 0};
}

/// Values of one curve of one vesicle.
void put_values(const StateCurve& curve, const Measurements& m, std::size_t vesicle, const QuantityUnits& units,
                double factor, render::Series& series) {
  for (std::size_t k = 0; k < m.samples.size(); ++k) {
    series.times.push_back(factor * m.times[k]);
    series.values.push_back(curve.value(m.samples[k][vesicle], units));
  }
}
void put_values(const StepCurve& curve, const Measurements& m, std::size_t vesicle, const QuantityUnits& units,
                double factor, render::Series& series) {
  for (const sim::StepRecord& record : m.steps) {
    series.times.push_back(factor * record.time);
    series.values.push_back(curve.value(record, vesicle, units));
  }
}

void put_values(const SuspensionCurve& curve, const Measurements& m, std::size_t, const QuantityUnits& units,
                double factor, render::Series& series) {
  for (std::size_t k = 0; k < m.whole.size(); ++k) {
    series.times.push_back(factor * m.times[k]);
    series.values.push_back(curve.value(m.whole[k], units));
  }
}

constexpr int most_told_apart = 8;  // vesicles of one trajectory: more are a bundle of thin lines

/// How curve `c` of vesicle `v` looks, of `curves` and `vesicles` in all.
render::Series empty_series(const FigureSource& source, const char* curve, std::size_t curves, int v, int vesicles) {
  const auto joined = [](const std::string& text, const std::string& word) {
    return fmt::format("{}{}{}", text, text.empty() || word.empty() ? "" : ", ", word);
  };
  const std::string vesicle = vesicles > 1 ? fmt::format("vesicle {}", v) : "";
  render::Series series;
  series.faint = vesicles > most_told_apart;
  series.part = curves > 1 ? curve : "";
  series.group = joined(series.faint ? "" : vesicle, source.name);
  series.name = joined(joined(series.part, vesicle), source.name);
  return series;
}

}  // namespace

double length_of(const sim::TrajectoryReader& trajectory) {
  sim::Plans plans;
  return std::sqrt(sim::measure(plans, trajectory.state(0).vesicles.front(), 1, 1).area / sim::default_area);
}

SharedScales shared_scales(const std::vector<FigureSource>& sources) {
  SharedScales s{.time = time_unit(sources.front().settings.scene), .rate = true, .bending = true};
  for (const FigureSource& source : sources) {
    const sim::Scene& scene = source.settings.scene;
    s.rate = s.rate && time_unit(scene).symbol != TimeUnit{}.symbol;
    for (const sim::VesicleParameters& v : scene.vesicles) s.bending = s.bending && v.bending_modulus > 0;
  }
  if (!s.rate) s.time = {};
  return s;
}

std::vector<render::Series> series_of(const FigureSource& source, const SharedScales& scales,
                                      const std::vector<const QuantityRow*>& rows, bool single, Instants instants) {
  const Measurements measurements = measurements_of(source, rows, instants);
  const double factor = time_factor(source, scales);
  std::vector<render::Series> all;
  for (const QuantityRow* row : rows) {
    const int vesicles = row->per_vesicle && !single ? source.trajectory.layout().vesicles : 1;
    const auto add_vesicle = [&](const auto& curves, int v) {
      const auto vesicle = static_cast<std::size_t>(v);
      const QuantityUnits units = units_of(source, scales, measurements.length, vesicle);
      const std::size_t count = single ? 1 : curves.size();
      for (std::size_t c = 0; c < count; ++c) {
        render::Series series = empty_series(source, curves[c].name, count, v, vesicles);
        series.axis = axis_label(*row, units);
        series.scale = row->scale;
        put_values(curves[c], measurements, vesicle, units, factor, series);
        if (row->differentiate) differentiate(series);
        all.push_back(std::move(series));
      }
    };
    for (int v = 0; v < vesicles; ++v) std::visit([&](const auto& curves) { add_vesicle(curves, v); }, row->curves);
  }
  return all;
}

}  // namespace app
