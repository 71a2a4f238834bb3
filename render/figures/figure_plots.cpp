// Figures of curves: inclination, quantities against time, and plots of any kind.
#include "render/figures/figure_kinds.h"
#include "render/figures/panel_grid.h"
#include "render/scene/surface.h"

#include "sim/surface/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

std::string csv_of(const std::vector<Series>& all) {
  std::string text = "series,quantity,time,value\n";
  for (const Series& s : all)
    for (std::size_t i = 0; i < std::min(s.times.size(), s.values.size()); ++i)
      text += fmt::format("{},{},{:.10g},{:.10g}\n", csv_cell(s.name), csv_cell(s.axis), s.times[i], s.values[i]);
  return text;
}

std::string csv_of(const std::vector<Plot>& plots) {
  std::string text = "panel,curve,x,y,error\n";
  for (std::size_t k = 0; k < plots.size(); ++k)
    for (std::size_t c = 0; c < plots[k].curves.size(); ++c) {
      const Curve& curve = plots[k].curves[c];
      const std::string name = csv_cell(!curve.csv_name.empty() ? curve.csv_name
                                        : curve.name.empty()    ? std::to_string(c)
                                                                : curve.name);
      for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i)
        text += fmt::format("{},{},{:.10g},{:.10g},{}\n", csv_cell(plots[k].y.label), name, curve.x[i], curve.y[i],
                            i < curve.error.size() ? fmt::format("{:.6g}", curve.error[i]) : "");
    }
  return text;
}

// An angle that passes 90 degrees comes back at -90: the line is interrupted there.
Series interrupted(Series s) {
  for (std::size_t i = 1; i < s.values.size(); ++i)
    if (std::abs(s.values[i] - s.values[i - 1]) > 90) {
      const auto at = static_cast<std::ptrdiff_t>(i);
      s.times.insert(s.times.begin() + at, s.times[i]);
      s.values.insert(s.values.begin() + at, std::nan(""));
      ++i;
    }
  return s;
}

Figure against_time(const FigureInput& input, const std::vector<Series>& all, std::string csv) {
  std::vector<Plot> plots;
  for (const Series& s : all) {
    auto plot = std::find_if(plots.begin(), plots.end(), [&](const Plot& p) { return p.y.label == s.axis; });
    if (plot == plots.end()) {
      plots.emplace_back();
      plot = plots.end() - 1;
      plot->x = {.label = input.time_symbol, .grid = true};
      plot->y = {.label = s.axis, .scale = s.scale, .grid = true};
    }
    Curve curve;
    curve.name = s.legend.value_or(s.name);
    curve.x = s.times;
    curve.y = s.values;
    curve.colour = s.colour.value_or(plot->curves.size());
    curve.dashed = s.dashed;
    plot->curves.push_back(std::move(curve));
  }
  return arranged(input, std::move(plots), true, std::move(csv));
}

}  // namespace

Figure draw_inclination(const FigureInput& input) {
  if (input.states.empty()) throw std::invalid_argument("a figure of the inclination needs at least one state");
  std::vector<Series> all(input.states.front().vesicles.size());
  for (std::size_t v = 0; v < all.size(); ++v) {
    all[v].axis = "inclination θ (°)";
    all[v].scale = Scale::degrees;
    all[v].name = v < input.labels.size() ? input.labels[v] : all.size() > 1 ? fmt::format("vesicle {}", v) : "";
    for (const sim::State& state : input.states) {
      if (v >= state.vesicles.size()) continue;
      all[v].times.push_back(input.time_factor * state.time);
      all[v].values.push_back(sim::inclination(volume_moments(state.vesicles[v].position).second) * 180 /
                              std::numbers::pi);
    }
  }
  std::string csv = csv_of(all);
  for (Series& s : all) s = interrupted(std::move(s));
  return against_time(input, all, std::move(csv));
}

Figure draw_time_series(const FigureInput& input) {
  if (input.series.empty()) throw std::invalid_argument("a figure of time series needs at least one series");
  std::vector<Series> all = input.series;
  for (Series& s : all)
    for (double& t : s.times) t *= input.time_factor;
  return against_time(input, all, csv_of(all));
}

Figure draw_plots(const FigureInput& input) {
  if (input.plots.empty()) throw std::invalid_argument("a figure of curves needs at least one panel");
  return arranged(input, input.plots, false, csv_of(input.plots));
}

}  // namespace render
