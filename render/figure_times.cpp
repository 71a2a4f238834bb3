// Figures against time.
#include "figure_kinds.h"
#include "plot.h"
#include "surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

struct Curves {
  std::string axis;
  std::vector<const Series*> series;
};

std::string csv_of(const std::vector<Series>& all) {
  std::string text = "series,quantity,time,value\n";
  const auto quoted = [](const std::string& s) {
    return s.find_first_of(",\"\n") == std::string::npos ? s : "\"" + s + "\"";
  };
  for (const Series& s : all)
    for (std::size_t i = 0; i < std::min(s.times.size(), s.values.size()); ++i)
      text += fmt::format("{},{},{:.10g},{:.10g}\n", quoted(s.name), quoted(s.axis), s.times[i], s.values[i]);
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

// Panels one below the other, one a quantity, with a common time axis.
Figure stacked(std::vector<Series> series, const std::string& time_label, std::string csv) {
  const auto owned = std::make_shared<const std::vector<Series>>(std::move(series));
  std::vector<Curves> panels;
  std::vector<double> times;
  for (const Series& s : *owned) {
    times.insert(times.end(), s.times.begin(), s.times.end());
    const auto same = std::find_if(panels.begin(), panels.end(), [&](const Curves& c) { return c.axis == s.axis; });
    if (same == panels.end())
      panels.push_back({s.axis, {&s}});
    else
      same->series.push_back(&s);
  }
  constexpr double left = 66, right = 14, top = 14, bottom = 42, width = 380, height = 150, gap = 14;
  Figure figure;
  figure.csv = std::move(csv);
  const auto count = static_cast<double>(panels.size());
  figure.drawing.width = left + width + right;
  figure.drawing.height = top + bottom + count * height + (count - 1) * gap;
  Range span = range_of(times, 0, 1e-12);
  figure.drawing.paint = [owned, panels, span, time_label](cairo_t* cairo, const Font& font) {
    for (std::size_t k = 0; k < panels.size(); ++k) {
      std::vector<double> values;
      for (const Series* s : panels[k].series) values.insert(values.end(), s->values.begin(), s->values.end());
      double size = 0;
      for (const double v : values)
        if (std::isfinite(v)) size = std::max(size, std::abs(v));
      // a constant is drawn as one: rounding errors are not blown up to the height of the panel
      Panel panel{span,  range_of(values, 0.07, std::max(1e-4 * size, 1e-14)),
                  left,  top + static_cast<double>(k) * (height + gap),
                  width, height};
      const bool last = k + 1 == panels.size();
      const AxisLabels labels{
          last ? time_label : "", panels[k].axis, last, true, true, 6, 4, panels[k].axis.find("°") != std::string::npos};
      std::vector<std::string> names;
      std::vector<Colour> colours;
      std::vector<double> at;
      for (std::size_t i = 0; i < panels[k].series.size(); ++i) {
        const Series& s = *panels[k].series[i];
        at.insert(at.end(), s.times.begin(), s.times.end());
        if (s.name.empty()) continue;
        names.push_back(s.name);
        colours.push_back(curve_colour(i));
      }
      const std::optional<Corner> corner = empty_corner(panel, at, values);
      if (!corner && !names.empty()) {  // room for the legend above the curves
        const double share = legend_height(names.size()) / height;
        panel.y.high += panel.y.size() * share / (1 - share);
      }
      draw_grid(cairo, panel, labels);
      for (std::size_t i = 0; i < panels[k].series.size(); ++i)
        draw_polyline(cairo, panel, panels[k].series[i]->times, panels[k].series[i]->values, {curve_colour(i), 1.6, 1});
      draw_axes(cairo, font, panel, labels);
      draw_legend(cairo, font, panel, names, colours, corner.value_or(Corner::upper_right));
    }
  };
  return figure;
}

}  // namespace

Figure draw_inclination(const FigureInput& input) {
  if (input.states.empty()) throw std::invalid_argument("a figure of the inclination needs at least one state");
  std::vector<Series> all(input.states.front().vesicles.size());
  for (std::size_t v = 0; v < all.size(); ++v) {
    all[v].axis = "inclination θ / °";
    all[v].name = v < input.labels.size() ? input.labels[v] : all.size() > 1 ? fmt::format("vesicle {}", v + 1) : "";
    for (const sim::State& state : input.states) {
      if (v >= state.vesicles.size()) continue;
      const Eigen::Matrix3d m = volume_moments(state.vesicles[v].position).second;
      // longest axis of the moments in the x-z plane; z up, positive toward +z
      const double angle = 0.5 * std::atan2(2 * m(0, 2), m(0, 0) - m(2, 2));
      all[v].times.push_back(input.time_factor * state.time);
      all[v].values.push_back(angle * 180 / std::numbers::pi);
    }
  }
  std::string csv = csv_of(all);
  for (Series& s : all) s = interrupted(std::move(s));
  return stacked(std::move(all), input.time_symbol, std::move(csv));
}

Figure draw_time_series(const FigureInput& input) {
  if (input.series.empty()) throw std::invalid_argument("a figure of time series needs at least one series");
  std::vector<Series> all = input.series;
  for (Series& s : all)
    for (double& t : s.times) t *= input.time_factor;
  std::string csv = csv_of(all);
  return stacked(std::move(all), input.time_symbol, std::move(csv));
}

}  // namespace render
