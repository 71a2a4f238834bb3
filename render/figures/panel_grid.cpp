#include "render/figures/panel_grid.h"

#include "render/figures/figure_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  return range_of(values, 0.07,
                  std::max(1e-4 * size, 1e-14));  // rounding errors are not blown up to the height of a panel
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

/// Panels row by row. stacked: they share their axis of x, which is numbered under the lowest of each column.
struct Grid {
  std::size_t columns = 1, rows = 1;
  bool stacked = false;
  double width = 0;   ///< of the page, pt
  double height = 0;  ///< likewise; 0: follows the panels

  double aspect() const { return stacked ? 0.4 : 0.72; }  ///< height / width of a panel where the page is free
};

Grid grid_of(const FigureParameters& parameters, const Page& page, std::size_t count, bool stacked) {
  std::size_t columns = static_cast<std::size_t>(parameters.columns);
  if (columns == 0) columns = stacked ? (page.height > 0 && count > 2 ? 2 : 1) : std::min<std::size_t>(count, 2);
  columns = std::min(columns, count);
  const double share = columns > 1 ? 1 : stacked ? 0.78 : 0.56;  // of the width of a full page
  const double full = page.theme.width;
  return {.columns = columns,
          .rows = (count + columns - 1) / columns,
          .stacked = stacked,
          .width = page.width > 0    ? page.width
                   : page.height > 0 ? full
                                     : share * full,
          .height = page.height};
}

std::vector<Placed> placed_plots(std::vector<Plot> plots, const Grid& grid) {
  const std::size_t count = plots.size();
  std::vector<Placed> placed;
  for (std::size_t k = 0; k < count; ++k) {
    Placed& p = placed.emplace_back();
    p.plot = std::move(plots[k]);
    p.axes = {.x = p.plot.x, .y = p.plot.y};
    const bool lowest = k + grid.columns >= count;
    if (grid.stacked && !lowest) {
      p.axes.x.numbers = false;
      p.axes.x.label.clear();
    }
    if (!grid.stacked && count > 1) p.title = fmt::format("({})", letter(k));
    set_ranges(p, grid.stacked);
  }
  return placed;
}

/// One span of time, and a legend once where all say the same.
void share_time(std::vector<Placed>& placed) {
  const auto names = [](const Placed& p) {
    std::vector<std::string> all;
    for (const Curve& curve : p.plot.curves) all.push_back(curve.name);
    return all;
  };
  const bool same =
      std::all_of(placed.begin(), placed.end(), [&](const Placed& p) { return names(p) == names(placed.front()); });
  for (std::size_t k = 1; same && k < placed.size(); ++k)
    for (Curve& curve : placed[k].plot.curves) curve.name.clear();
  Range span = placed.front().panel.x;
  for (const Placed& p : placed) span = {std::min(span.low, p.panel.x.low), std::max(span.high, p.panel.x.high)};
  for (Placed& p : placed) p.panel.x = span;
}

/// The largest margins of each column and row of panels whose sizes are known; `title`: height above each. Labels of y
/// are aligned within a column.
struct GridMargins {
  std::vector<Margins> column, row;
};
GridMargins grid_margins(std::vector<Placed>& placed, const Grid& grid, const Ruler& ruler, const Theme& theme,
                         double title) {
  std::vector<double> label_room(grid.columns, 0);
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const Panel& panel = placed[k].panel;
    placed[k].axes.label_room = 0;
    const Ticks y = ticks_of(ruler, theme, placed[k].axes.y, panel.y, panel.height, false);
    label_room[k % grid.columns] = std::max(label_room[k % grid.columns], y.widest + 0.5 * theme.text);
  }
  GridMargins margins{.column = std::vector<Margins>(grid.columns), .row = std::vector<Margins>(grid.rows)};
  for (std::size_t k = 0; k < placed.size(); ++k) {
    placed[k].axes.label_room = label_room[k % grid.columns];
    const Margins m = margins_of(ruler, theme, placed[k].axes, placed[k].panel);
    Margins &c = margins.column[k % grid.columns], &r = margins.row[k / grid.columns];
    c.left = std::max(c.left, m.left);
    c.right = std::max(c.right, m.right);
    r.top = std::max(r.top, m.top + title);
    r.bottom = std::max(r.bottom, m.bottom);
  }
  return margins;
}

/// Gives the panels sizes and places; returns the height of the page, pt.
double place_panels(std::vector<Placed>& placed, const Grid& grid, const GridMargins& margins, const Theme& theme) {
  const double between = (grid.stacked ? 1.5 : 1.0) * theme.text;  // columns
  const double between_rows = grid.stacked ? 0.3 * theme.text : 0;
  double across = between * static_cast<double>(grid.columns - 1), down = 0;
  for (const Margins& c : margins.column) across += c.left + c.right;
  for (const Margins& r : margins.row) down += r.top + r.bottom;
  if (grid.stacked) down += between_rows * static_cast<double>(grid.rows - 1);
  const double width = std::max((grid.width - across) / static_cast<double>(grid.columns), 4 * theme.text);
  const double height = grid.height > 0
                            ? std::max((grid.height - down) / static_cast<double>(grid.rows), 3 * theme.text)
                            : grid.aspect() * width;
  std::vector<double> lefts, tops;
  double x = 0, y = 0;
  for (const Margins& c : margins.column) {
    lefts.push_back(x + c.left);
    x += c.left + width + c.right + between;
  }
  for (const Margins& r : margins.row) {
    tops.push_back(y + r.top);
    y += r.top + height + r.bottom + between_rows;
  }
  for (std::size_t k = 0; k < placed.size(); ++k) {
    Panel& panel = placed[k].panel;
    panel.left = lefts[k % grid.columns];
    panel.top = tops[k / grid.columns];
    panel.width = width;
    panel.height = height;
  }
  return grid.height > 0 ? grid.height : std::ceil(y);
}

}  // namespace

Figure arranged(const FigureInput& input, std::vector<Plot> plots, bool stacked, std::string csv) {
  const Page page = page_of(input.parameters);
  const Theme& theme = page.theme;
  const Grid grid = grid_of(input.parameters, page, plots.size(), stacked);
  const Ruler ruler;
  std::vector<Placed> placed = placed_plots(std::move(plots), grid);
  if (stacked) share_time(placed);
  const double title = placed.front().title.empty() ? 0 : title_height(theme);
  for (Placed& p : placed) {  // to begin with
    p.panel.width = grid.width / static_cast<double>(grid.columns) * 0.8;
    p.panel.height = grid.aspect() * p.panel.width;
  }
  // Numbers decide margins, margins the panels, and panels the numbers: two rounds settle it.
  double total = 0;
  for (int round = 0; round < 3; ++round)
    total = place_panels(placed, grid, grid_margins(placed, grid, ruler, theme, title), theme);
  for (Placed& p : placed) place_legend(p, ruler, theme);
  Figure figure;
  figure.csv = std::move(csv);
  figure.drawing = {.width = grid.width,
                    .height = total,
                    .paint =
                        [placed, theme](cairo_t* cairo, const Font& font) {
                          const Pen pen{cairo, font, theme};
                          for (const Placed& p : placed) draw(pen, p);
                        },
                    .ground = theme.ground,
                    .dots_per_inch = dots_per_inch(input.parameters)};
  return figure;
}

}  // namespace render
