// Figures of curves: quantities against time, and plots of any kind.
#include "render/figures/figure_kinds.h"
#include "render/figures/panel_grid.h"

#include <fmt/format.h>

#include <algorithm>
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
                                        : !curve.name.empty()   ? curve.name
                                        : !curve.part.empty()   ? curve.part
                                                                : std::to_string(c));
      for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i)
        text += fmt::format("{},{},{:.10g},{:.10g},{}\n", csv_cell(plots[k].y.label), name, curve.x[i], curve.y[i],
                            i < curve.error.size() ? fmt::format("{:.6g}", curve.error[i]) : "");
    }
  return text;
}

constexpr std::size_t unmarked = 1;  // groups: a single one needs no marks

}  // namespace

std::vector<Plot> plots_against_time(const std::vector<Series>& all, const std::string& time_symbol) {
  std::vector<Plot> plots;
  std::vector<std::string> groups;
  for (const Series& s : all)
    if (std::find(groups.begin(), groups.end(), s.group) == groups.end()) groups.push_back(s.group);
  for (const Series& s : all) {
    auto plot = std::find_if(plots.begin(), plots.end(), [&](const Plot& p) { return p.y.label == s.axis; });
    if (plot == plots.end()) {
      plots.emplace_back();
      plot = plots.end() - 1;
      plot->x = {.label = time_symbol, .grid = true};
      plot->y = {.label = s.axis, .scale = s.scale, .grid = true};
    }
    std::vector<std::string> parts;
    for (const Curve& curve : plot->curves)
      if (std::find(parts.begin(), parts.end(), curve.part) == parts.end()) parts.push_back(curve.part);
    const auto group = static_cast<std::size_t>(std::find(groups.begin(), groups.end(), s.group) - groups.begin());
    Curve curve;
    curve.name = groups.size() > unmarked ? s.group : "";
    curve.part = s.part;
    curve.x = s.times;
    curve.y = s.values;
    curve.colour = group;
    curve.dash = static_cast<int>(std::find(parts.begin(), parts.end(), s.part) - parts.begin());
    curve.faint = s.faint;
    if (groups.size() > unmarked && !s.faint) {
      curve.marker = group_marker(group);
      curve.phase = (static_cast<double>(group) + 0.5) / static_cast<double>(groups.size());
    }
    plot->curves.push_back(std::move(curve));
  }
  return plots;
}

Figure draw_time_series(const FigureInput& input) {
  if (input.series.empty()) throw std::invalid_argument("a figure of time series needs at least one series");
  std::vector<Series> all = input.series;
  for (Series& s : all)
    for (double& t : s.times) t *= input.time_factor;
  return arranged(input, plots_against_time(all, input.time_symbol), true, csv_of(all));
}

Figure draw_plots(const FigureInput& input) {
  if (input.plots.empty()) throw std::invalid_argument("a figure of curves needs at least one panel");
  return arranged(input, input.plots, false, csv_of(input.plots));
}

}  // namespace render
