// Figures of curves: panels side by side, or below each other with a common axis of time.
#include "render/figures/figure_kinds.h"
#include "render/scene/surface.h"

#include "sim/surface/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

// A curve in the coordinates of its panel.
using Points = std::pair<std::vector<double>, std::vector<double>>;
Points in_panel(const Plot& plot, const Curve& curve) {
  return {plot.x.scale == Scale::logarithmic ? logarithms(curve.x) : curve.x,
          plot.y.scale == Scale::logarithmic ? logarithms(curve.y) : curve.y};
}

Range range_of_axis(const std::vector<double>& values, Scale scale, bool abscissa) {
  if (scale == Scale::logarithmic) {
    std::vector<double> positive;
    for (const double v : values)
      if (std::isfinite(v)) positive.push_back(std::pow(10, v));
    return decades(positive);
  }
  double size = 0;
  for (const double v : values)
    if (std::isfinite(v)) size = std::max(size, std::abs(v));
  if (abscissa) return range_of(values, 0);
  return range_of(values, 0.07, std::max(1e-4 * size, 1e-14));  // rounding errors are not blown up to the height of a panel
}

Colour colour_of(const Theme& theme, const Curve& curve) {
  return curve.instant ? on_ground(theme, colour_of_time(*curve.instant)) : curve_colour(theme, curve.colour);
}

struct Placed {
  Plot plot;
  Panel panel;
  Axes axes;
  std::string title;
  std::vector<LegendEntry> legend;
  Corner corner = Corner::upper_right;
};

// Windows of data, and room for the legend above the curves where no corner is free.
void set_ranges(Placed& p, bool tight_x) {
  std::vector<double> xs, ys;
  for (const Curve& curve : p.plot.curves) {
    const Points c = in_panel(p.plot, curve);
    xs.insert(xs.end(), c.first.begin(), c.first.end());
    ys.insert(ys.end(), c.second.begin(), c.second.end());
    for (std::size_t k = 0; k < std::min(curve.error.size(), c.second.size()); ++k) {
      ys.push_back(c.second[k] - curve.error[k]);
      ys.push_back(c.second[k] + curve.error[k]);
    }
  }
  p.panel.x = p.plot.x_range ? *p.plot.x_range : range_of_axis(xs, p.plot.x.scale, tight_x);
  p.panel.y = p.plot.y_range ? *p.plot.y_range : range_of_axis(ys, p.plot.y.scale, false);
}

std::vector<LegendEntry> legend_of(const Plot& plot, const Theme& theme) {
  std::vector<LegendEntry> legend;
  for (const Curve& curve : plot.curves) {
    const std::optional<Marker> marker = curve.line ? std::nullopt : curve.marker;
    if (!curve.name.empty()) legend.push_back({curve.name, colour_of(theme, curve), marker, curve.dashed});
  }
  return legend;
}

void place_legend(Placed& p, const Ruler& ruler, const Theme& theme) {
  p.legend = legend_of(p.plot, theme);
  if (p.legend.empty()) return;
  // A long row of instants is told by its ends and its middle.
  if (p.legend.size() > 5 && p.plot.curves.front().instant)
    p.legend = {p.legend.front(), p.legend[p.legend.size() / 2], p.legend.back()};
  std::vector<Points> curves;
  for (const Curve& curve : p.plot.curves) curves.push_back(in_panel(p.plot, curve));
  const Eigen::Vector2d size = legend_size(ruler, theme, p.legend);
  const std::optional<Corner> corner = p.plot.legend ? p.plot.legend : empty_corner(p.panel, size, curves);
  p.corner = corner.value_or(Corner::upper_right);
  if (corner || p.plot.y_range) return;
  const double share = std::min(0.7, size.y() / p.panel.height);
  p.panel.y.high += p.panel.y.size() * share / (1 - share);
}

void draw(const Pen& pen, const Placed& p) {
  draw_grid(pen, p.panel, p.axes);
  for (const Curve& curve : p.plot.curves) {
    const Points c = in_panel(p.plot, curve);
    const Colour colour = colour_of(pen.theme, curve);
    if (curve.line) draw_polyline(pen, p.panel, c.first, c.second, {colour, 1, 1, curve.dashed});
    if (curve.marker) draw_markers(pen, p.panel, c.first, c.second, *curve.marker, colour, 1.8, curve.error);
  }
  draw_axes(pen, p.panel, p.axes);
  draw_legend(pen, p.panel, p.legend, p.corner);
  if (!p.title.empty()) draw_title(pen, p.panel, p.title);
}

/// stacked: panels share their axis of x, which is numbered under the lowest of each column.
Figure arranged(const FigureInput& input, std::vector<Plot> plots, bool stacked, std::string csv) {
  const Page page = page_of(input.parameters);
  const Theme& theme = page.theme;
  const std::size_t count = plots.size();
  std::size_t columns = static_cast<std::size_t>(input.parameters.columns);
  if (columns == 0) columns = stacked ? (page.height > 0 && count > 2 ? 2 : 1) : std::min<std::size_t>(count, 2);
  columns = std::min(columns, count);
  const std::size_t rows = (count + columns - 1) / columns;
  const double share = columns > 1 ? 1 : stacked ? 0.78 : 0.56;  // of the width of a full page
  const double width = page.width > 0 ? page.width : page.height > 0 ? theme.width : share * theme.width;

  const Ruler ruler;
  std::vector<Placed> placed;
  for (std::size_t k = 0; k < count; ++k) {
    Placed p{std::move(plots[k]), {}, {}, {}, {}, Corner::upper_right};
    p.axes = {p.plot.x, p.plot.y, 0};
    const bool lowest = k + columns >= count;
    if (stacked && !lowest) {
      p.axes.x.numbers = false;
      p.axes.x.label.clear();
    }
    if (!stacked && count > 1) p.title = fmt::format("({})", letter(k));
    set_ranges(p, stacked);
    placed.push_back(std::move(p));
  }
  if (stacked) {  // one span of time, and a legend once where all say the same
    const auto names = [&](const Placed& p) {
      std::vector<std::string> all;
      for (const Curve& curve : p.plot.curves) all.push_back(curve.name);
      return all;
    };
    const bool same = std::all_of(placed.begin(), placed.end(), [&](const Placed& p) { return names(p) == names(placed.front()); });
    for (std::size_t k = 1; same && k < count; ++k)
      for (Curve& curve : placed[k].plot.curves) curve.name.clear();
    Range span = placed.front().panel.x;
    for (const Placed& p : placed) span = {std::min(span.low, p.panel.x.low), std::max(span.high, p.panel.x.high)};
    for (Placed& p : placed) p.panel.x = span;
  }
  // Numbers decide margins, margins the panels, and panels the numbers: two rounds settle it.
  const double between = (stacked ? 1.5 : 1.0) * theme.text, title = placed.front().title.empty() ? 0 : title_height(theme);
  double inner = width / static_cast<double>(columns) * 0.8, height = 0, total = 0;
  for (int round = 0; round < 3; ++round) {
    std::vector<Margins> column(columns), row(rows);
    std::vector<double> label_room(columns, 0);
    for (std::size_t k = 0; k < count; ++k) {
      Panel& panel = placed[k].panel;
      panel.width = inner;
      panel.height = height > 0 ? height : (stacked ? 0.4 : 0.72) * inner;
      placed[k].axes.label_room = 0;
      const Ticks y = ticks_of(ruler, theme, placed[k].axes.y, panel.y, panel.height, false);
      label_room[k % columns] = std::max(label_room[k % columns], y.widest + 0.5 * theme.text);
    }
    for (std::size_t k = 0; k < count; ++k) {
      placed[k].axes.label_room = label_room[k % columns];
      const Margins m = margins_of(ruler, theme, placed[k].axes, placed[k].panel);
      Margins &c = column[k % columns], &r = row[k / columns];
      c.left = std::max(c.left, m.left);
      c.right = std::max(c.right, m.right);
      r.top = std::max(r.top, m.top + title);
      r.bottom = std::max(r.bottom, m.bottom);
    }
    double across = between * static_cast<double>(columns - 1), down = 0;
    for (const Margins& c : column) across += c.left + c.right;
    for (const Margins& r : row) down += r.top + r.bottom;
    if (stacked) down += 0.3 * theme.text * static_cast<double>(rows - 1);
    inner = std::max((width - across) / static_cast<double>(columns), 4 * theme.text);
    height = page.height > 0 ? std::max((page.height - down) / static_cast<double>(rows), 3 * theme.text)
                             : (stacked ? 0.4 : 0.72) * inner;
    std::vector<double> lefts, tops;
    double x = 0, y = 0;
    for (const Margins& c : column) {
      lefts.push_back(x + c.left);
      x += c.left + inner + c.right + between;
    }
    for (const Margins& r : row) {
      tops.push_back(y + r.top);
      y += r.top + height + r.bottom + (stacked ? 0.3 * theme.text : 0);
    }
    total = page.height > 0 ? page.height : std::ceil(y);
    for (std::size_t k = 0; k < count; ++k) {
      Panel& panel = placed[k].panel;
      panel.left = lefts[k % columns];
      panel.top = tops[k / columns];
      panel.width = inner;
      panel.height = height;
    }
  }
  for (Placed& p : placed) place_legend(p, ruler, theme);
  Figure figure;
  figure.csv = std::move(csv);
  figure.drawing = {width, total, nullptr, theme.ground, dots_per_inch(input.parameters)};
  figure.drawing.paint = [placed, theme](cairo_t* cairo, const Font& font) {
    const Pen pen{cairo, font, theme};
    for (const Placed& p : placed) draw(pen, p);
  };
  return figure;
}

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
      const std::string name = csv_cell(!curve.csv_name.empty() ? curve.csv_name : curve.name.empty() ? std::to_string(c) : curve.name);
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
      plots.push_back({{input.time_symbol, Scale::linear, true, true}, {s.axis, s.scale, true, true}, {}, {}, {}, {}});
      plot = plots.end() - 1;
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
      all[v].values.push_back(sim::inclination(volume_moments(state.vesicles[v].position).second) * 180 / std::numbers::pi);
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
