#include "figures.h"

#include "captions.h"

#include "render/figure.h"
#include "sim/diagnostics.h"

#include <fmt/format.h>

#include <cmath>

namespace app {

namespace {

/// What "time-series" shows of the measures; rows of one axis share a panel.
struct SeriesRow {
  const char *measure, *name, *axis;
};
constexpr SeriesRow series_rows[] = {{"inclination_deg", "inclination", "inclination (°)"},
                                     {"axis_1", "a_{1}", "axes / R_{0}"},
                                     {"axis_2", "a_{2}", "axes / R_{0}"},
                                     {"axis_3", "a_{3}", "axes / R_{0}"},
                                     {"energy", "energy", "E / 8πκ"},
                                     {"area_error", "area", "relative error"},
                                     {"volume_error", "volume", "relative error"}};

/// An angle of a direction without sense, continued from the one before: no jump by 180 degrees.
double unwrapped(double angle, const std::vector<double>& before) {
  return before.empty() ? angle : angle + 180 * std::round((before.back() - angle) / 180);
}

std::vector<render::Series> all_series(const FigureSource& source, double radius) {
  const sim::TrajectoryReader& trajectory = source.trajectory;
  const TimeUnit unit = time_unit(source.settings.scene);
  const int vesicles = trajectory.layout().vesicles;
  std::vector<render::Series> all;
  for (int v = 0; v < vesicles; ++v)
    for (const SeriesRow& row : series_rows) {
      std::string name = row.name;
      if (vesicles > 1) name += fmt::format(", vesicle {}", v);
      if (!source.name.empty()) name += ", " + source.name;
      all.push_back({name, row.axis, {}, {}});
    }
  sim::Plans plans;
  std::vector<sim::VesicleMeasures> initial;
  for (std::int64_t k = 0; k < trajectory.count(); ++k) {
    const sim::State state = trajectory.state(k);
    std::size_t column = 0;
    for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
      if (k == 0) initial.push_back(sim::measure(plans, state.vesicles[v], 1, 1));
      const sim::VesicleMeasures m = sim::measure(plans, state.vesicles[v], initial[v].area, initial[v].volume);
      for (const SeriesRow& row : series_rows) {
        render::Series& series = all[column++];
        series.times.push_back(unit.factor * state.time);
        visit(m, [&](std::string_view name, const char*, double value) {
          if (name != row.measure) return;
          if (name == "inclination_deg") value = unwrapped(value, series.values);
          series.values.push_back(name.starts_with("axis") ? value / radius : value);
        });
      }
    }
  }
  return all;
}

}  // namespace

std::vector<std::filesystem::path> draw_figure(const std::vector<FigureSource>& sources,
                                               const render::FigureParameters& parameters,
                                               const std::filesystem::path& stem) {
  const render::FigureRow& kind = render::find_figure(parameters.kind);
  const FigureSource& first = sources.front();
  const sim::TrajectoryReader& trajectory = first.trajectory;
  render::FigureInput input;
  const TimeUnit unit = time_unit(first.settings.scene);
  input.time_symbol = unit.symbol;
  input.time_factor = unit.factor;
  sim::Plans plans;
  input.length = std::sqrt(sim::measure(plans, trajectory.state(0).vesicles.front(), 1, 1).area / sim::default_area);
  if (kind.name == "time-series") {
    input.time_factor = 1;  // the series bring their own
    for (const FigureSource& source : sources)
      for (render::Series& series : all_series(source, input.length)) input.series.push_back(std::move(series));
  } else if (kind.all_states) {
    for (std::int64_t k = 0; k < trajectory.count(); ++k) input.states.push_back(trajectory.state(k));
  } else {
    std::vector<double> times;
    for (std::int64_t k = 0; k < trajectory.count(); ++k) times.push_back(trajectory.time(k));
    for (const std::size_t k : render::chosen_states(times, parameters))
      input.states.push_back(trajectory.state(static_cast<std::int64_t>(k)));
  }
  return render::write_figure(kind.draw(input), stem);
}

}  // namespace app
