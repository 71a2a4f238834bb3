#include "render/figures/panel_grid.h"

#include "render/figures/figure_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace render {
namespace {

constexpr double mark_spacing = 8;  // along a curve, in heights of the text

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
  if (curve.guide) return theme.ink;
  return curve.instant ? on_ground(theme, colour_of_time(*curve.instant)) : curve_colour(theme, curve.colour);
}

// Windows of the data.
void set_ranges(PlacedPlot& p, bool tight_x) {
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

/// The names of all panels, each once.
std::vector<LegendEntry> legend_of(const std::vector<Plot>& plots, const Theme& theme) {
  std::vector<LegendEntry> legend;
  bool instants = true;
  for (const Plot& plot : plots)
    for (const Curve& curve : plot.curves) {
      const auto is_it = [&](const LegendEntry& e) { return e.name == curve.name; };
      if (curve.name.empty() || std::any_of(legend.begin(), legend.end(), is_it)) continue;
      instants = instants && curve.instant.has_value();
      LegendEntry entry;
      entry.name = curve.name;
      if (!curve.ink_in_legend) entry.colour = colour_of(theme, curve);
      entry.marker = curve.marker;
      entry.line = curve.line;
      entry.dash = curve.part.empty() ? curve.dash : 0;
      legend.push_back(std::move(entry));
    }
  std::stable_partition(legend.begin(), legend.end(), [](const LegendEntry& e) { return e.colour.has_value(); });
  // A long row of instants is told by its ends and its middle.
  if (legend.size() > 8 && instants) legend = {legend.front(), legend[legend.size() / 2], legend.back()};
  return legend;
}

/// The parts of a panel, each once; in ink where several colours have them.
std::vector<LegendEntry> key_of(const Plot& plot, const Theme& theme) {
  std::vector<LegendEntry> key;
  for (const Curve& curve : plot.curves) {
    if (curve.part.empty()) continue;
    const auto known = std::find_if(key.begin(), key.end(), [&](const LegendEntry& e) { return e.name == curve.part; });
    if (known != key.end()) {
      if (known->colour && !(*known->colour == colour_of(theme, curve))) known->colour.reset();
      continue;
    }
    LegendEntry entry;
    entry.name = curve.part;
    entry.colour = colour_of(theme, curve);
    entry.line = curve.line;
    entry.dash = curve.dash;
    if (curve.name.empty()) entry.marker = curve.marker;
    key.push_back(std::move(entry));
  }
  return key;
}

/// Panels row by row. stacked: they share their axis of x, which is numbered under the lowest of each column.
struct Grid {
  std::size_t columns = 1, rows = 1;
  bool stacked = false;
  double width = 0;   ///< of the page, pt
  double height = 0;  ///< likewise; 0: follows the panels

  /// Of a panel where the page is free. A narrow one is up to as high as it is wide.
  double height_of(double panel_width, const Theme& theme) const {
    if (stacked) return (rows > 1 ? 0.4 : 0.55) * panel_width;
    return std::max(0.72 * panel_width, std::min(panel_width, 15 * theme.text));
  }
};

Grid grid_of(const FigureParameters& parameters, const Page& page, std::size_t count, bool stacked) {
  std::size_t columns = static_cast<std::size_t>(parameters.columns);
  const bool free = columns == 0;
  if (free) columns = stacked ? (page.height > 0 && count > 2 ? 2 : 1) : std::min<std::size_t>(count, 2);
  columns = std::min(columns, count);
  const double share = columns > 1 ? 1 : stacked ? 0.78 : 0.56;  // of the width of a full page
  const double full = page.theme.width;
  const double width = page.width > 0 ? page.width : page.height > 0 ? full : share * full;
  constexpr double least = 16;  // of a column, in heights of the text
  if (free && page.height == 0)
    while (columns > 1 && width / static_cast<double>(columns) < least * page.theme.text) --columns;
  return {.columns = columns,
          .rows = (count + columns - 1) / columns,
          .stacked = stacked,
          .width = width,
          .height = page.height};
}

/// One span of time for all.
void share_time(std::vector<PlacedPlot>& placed) {
  Range span = placed.front().panel.x;
  for (const PlacedPlot& p : placed) span = {std::min(span.low, p.panel.x.low), std::max(span.high, p.panel.x.high)};
  for (PlacedPlot& p : placed) p.panel.x = span;
}

/// Of the arrows on curves, pt.
double head_size(const Theme& theme) { return 5.5 * theme.stroke; }

double key_room(const Panel& panel, const Theme& theme) {
  return std::max(panel.width - 2.2 * theme.label, 6 * theme.text);
}

/// Above a panel: its letter and its key.
double header_of(const PlacedPlot& p, const Theme& theme) {
  const double letter = p.letter.empty() ? 0 : title_height(theme);
  return p.key.entries.empty() ? letter : std::max(letter, p.key.height + 0.55 * theme.text);
}

/// The largest margins of each column and row of panels whose sizes are known. Labels of y are aligned within a column.
struct GridMargins {
  std::vector<Margins> column, row;
};
GridMargins grid_margins(std::vector<PlacedPlot>& placed, const Grid& grid, const Ruler& ruler, const Theme& theme) {
  std::vector<double> label_room(grid.columns, 0);
  for (std::size_t k = 0; k < placed.size(); ++k) {
    PlacedPlot& p = placed[k];
    p.axes.label_room = 0;
    p.axes.x.label_scale = p.axes.y.label_scale = 1;
    p.axes.x = fitted(ruler, theme, p.axes.x, p.panel.width);
    p.axes.y = fitted(ruler, theme, p.axes.y, p.panel.height + 0.6 * header_of(p, theme));
    p.key = laid_legend(ruler, theme, key_of(p.plot, theme), key_room(p.panel, theme));
    const Ticks y = ticks_of(ruler, theme, p.axes.y, p.panel.y, p.panel.height, false);
    label_room[k % grid.columns] = std::max(label_room[k % grid.columns], y.widest + 0.5 * theme.text);
  }
  GridMargins margins{.column = std::vector<Margins>(grid.columns), .row = std::vector<Margins>(grid.rows)};
  for (std::size_t k = 0; k < placed.size(); ++k) {
    PlacedPlot& p = placed[k];
    p.axes.label_room = label_room[k % grid.columns];
    const Margins m = margins_of(ruler, theme, p.axes, p.panel);
    Margins &c = margins.column[k % grid.columns], &r = margins.row[k / grid.columns];
    c.left = std::max(c.left, m.left);
    c.right = std::max(c.right, m.right);
    r.top = std::max(r.top, m.top + header_of(p, theme));
    r.bottom = std::max(r.bottom, m.bottom);
  }
  return margins;
}

/// Gives the panels sizes and places below `top`; returns the height of the page, pt, or nothing when it is too small.
std::optional<double> place_panels(std::vector<PlacedPlot>& placed, const Grid& grid, const GridMargins& margins,
                                   const Theme& theme, double top) {
  const double between = (grid.stacked ? 1.5 : 1.0) * theme.text;  // columns
  const double between_rows = grid.stacked ? 0.3 * theme.text : 0;
  double across = between * static_cast<double>(grid.columns - 1), down = top;
  for (const Margins& c : margins.column) across += c.left + c.right;
  for (const Margins& r : margins.row) down += r.top + r.bottom;
  if (grid.stacked) down += between_rows * static_cast<double>(grid.rows - 1);
  const double free_width = (grid.width - across) / static_cast<double>(grid.columns);
  const double width = std::max(free_width, 4 * theme.text);
  const double free_height = (grid.height - down) / static_cast<double>(grid.rows);
  const double height = grid.height > 0 ? std::max(free_height, 3 * theme.text) : grid.height_of(width, theme);
  std::vector<double> lefts, tops;
  double x = 0, y = top;
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
  const bool fits = free_width >= 7 * theme.text && (grid.height == 0 || free_height >= 4.5 * theme.text);
  if (!fits) return {};
  return grid.height > 0 ? grid.height : std::ceil(y);
}

/// Where a single panel has room for the legend, if it has.
std::optional<Eigen::Vector2d> place_within(const PlacedPlot& p, const LaidLegend& legend, const Theme& theme) {
  std::vector<Points> curves;
  bool directed = false;
  for (const Curve& curve : p.plot.curves) {
    directed = directed || curve.directed;
    Points c = in_panel(p.plot, curve);
    for (std::size_t k = 0; k < std::min(curve.error.size(), curve.x.size()); ++k) {  // bars, as lines of their own
      const double x = c.first[k], y = c.second[k], e = curve.error[k], none = std::nan("");
      curves.push_back({{x, x, none}, {y - e, y + e, none}});
    }
    curves.push_back(std::move(c));
  }
  const double edge = 0.7 * theme.text;
  const std::optional<Eigen::Vector2d> place =
      free_place(p.panel, {legend.width + 2 * edge, legend.height + edge}, curves,
                 directed ? 0.5 * head_size(theme) : 2.2 * theme.stroke);
  if (!place) return {};
  return Eigen::Vector2d(place->x() + edge, place->y() + 0.55 * edge);
}

/// Placed with a theme; nothing when the page is too small for it.
std::optional<PlacedPlots> placed_with(const Theme& theme, const Grid& grid, const std::vector<Plot>& plots,
                                       bool letters) {
  const Ruler ruler(theme.family);
  PlacedPlots result;
  result.theme = theme;
  result.width = grid.width;
  const std::size_t count = plots.size();
  for (std::size_t k = 0; k < count; ++k) {
    PlacedPlot& p = result.plots.emplace_back();
    p.plot = plots[k];
    p.axes = {.x = p.plot.x, .y = p.plot.y};
    const bool lowest = k + grid.columns >= count;
    if (grid.stacked && !lowest) {
      p.axes.x.numbers = false;
      p.axes.x.label.clear();
    }
    if (letters && count > 1) p.letter = fmt::format("({})", letter(k));
    set_ranges(p, grid.stacked);
    p.panel.width = grid.width / static_cast<double>(grid.columns) * 0.8;  // to begin with
    p.panel.height = grid.height_of(p.panel.width, theme);
  }
  if (grid.stacked) share_time(result.plots);
  // Numbers and labels decide margins, margins the panels, and panels the numbers: some rounds settle it.
  const auto settle = [&](double top) -> bool {
    std::optional<double> height;
    GridMargins before;
    for (int round = 0; round < layout_rounds; ++round) {
      GridMargins margins = grid_margins(result.plots, grid, ruler, theme);
      for (std::size_t k = 0; round > free_rounds && k < margins.column.size(); ++k)
        margins.column[k] = widest(margins.column[k], before.column[k]);
      for (std::size_t k = 0; round > free_rounds && k < margins.row.size(); ++k)
        margins.row[k] = widest(margins.row[k], before.row[k]);
      height = place_panels(result.plots, grid, margins, theme, top);
      before = std::move(margins);
    }
    result.height = height.value_or(0);
    return height.has_value();
  };
  const double edge = 0.5 * theme.text;
  const std::vector<LegendEntry> entries = legend_of(plots, theme);
  if (count == 1 && !entries.empty() && settle(0)) {
    const Panel& panel = result.plots.front().panel;
    result.legend = laid_legend(ruler, theme, entries, 0.6 * panel.width);
    if (result.legend.height < 0.62 * panel.height)
      if (const auto place = place_within(result.plots.front(), result.legend, theme)) {
        result.legend_at = *place;
        return result;
      }
  }
  // Above the panels; where it took too much of the page, names are cut.
  const double room = grid.width - 2 * edge;
  result.legend = laid_legend(ruler, theme, entries, room);
  const double most = grid.height > 0 ? 0.25 * grid.height : 0.8 * grid.width;
  if (result.legend.height > most) result.legend = laid_legend(ruler, theme, entries, room, 1);
  for (std::size_t shown = entries.size(); shown > 2 && result.legend.height > most;)
    result.legend = laid_legend(ruler, theme, entries, room, 1, --shown);
  const double top = entries.empty() ? 0 : result.legend.height + edge;
  if (!settle(top)) return {};
  const Panel& first = result.plots.front().panel;
  result.legend_at = {std::max(edge, std::min(first.left, grid.width - edge - result.legend.width)), 0.5 * edge};
  return result;
}

/// Heads on the directed curves, away from the marks of all curves.
void draw_directions(const Pen& pen, const PlacedPlot& p) {
  std::vector<Eigen::Vector2d> taken;
  for (const Curve& curve : p.plot.curves) {
    if (!curve.marker) continue;
    const Points c = in_panel(p.plot, curve);
    if (curve.phase >= 0) {
      const std::vector<Eigen::Vector2d> marks =
          marks_along(p.panel, c.first, c.second, mark_spacing * pen.theme.text, curve.phase);
      taken.insert(taken.end(), marks.begin(), marks.end());
      continue;
    }
    for (std::size_t k = 0; k < c.first.size(); ++k)
      taken.emplace_back(p.panel.page_x(c.first[k]), p.panel.page_y(c.second[k]));
  }
  const double size = head_size(pen.theme);
  for (const Curve& curve : p.plot.curves) {
    if (!curve.directed) continue;
    const Points c = in_panel(p.plot, curve);
    const std::vector<ArrowHead> heads = arrow_heads(p.panel, c.first, c.second, size, taken);
    draw_arrow_heads(pen, p.panel, heads, size, colour_of(pen.theme, curve));
    for (const ArrowHead& head : heads) taken.emplace_back(head.tip - 0.5 * size * head.along);
  }
}

void draw_one(const Pen& pen, const PlacedPlot& p) {
  draw_grid(pen, p.panel, p.axes);
  for (const Curve& curve : p.plot.curves) {
    if (!curve.band) continue;
    const Points c = in_panel(p.plot, curve);
    draw_band(pen, p.panel, c.first, c.second, curve.error, colour_of(pen.theme, curve));
  }
  for (const Curve& curve : p.plot.curves) {
    const Points c = in_panel(p.plot, curve);
    const Colour colour = colour_of(pen.theme, curve);
    if (curve.line)
      draw_polyline(pen, p.panel, c.first, c.second,
                    {colour,
                     curve.faint || curve.guide ? 0.5
                     : curve.fine               ? 0.65
                                                : 1,
                     curve.faint ? 0.7 : 1, curve.dash});
    if (!curve.marker) continue;
    if (curve.phase >= 0)
      draw_markers_along(pen, p.panel, c.first, c.second, *curve.marker, colour, mark_spacing * pen.theme.text,
                         curve.phase);
    else
      draw_markers(pen, p.panel, c.first, c.second, *curve.marker, colour, curve.fine ? 1.1 : 1.8, curve.error);
  }
  draw_directions(pen, p);
  draw_axes(pen, p.panel, p.axes);
  if (!p.letter.empty()) draw_title(pen, p.panel, p.letter);
  draw_legend(pen, p.key, p.panel.left + p.panel.width - p.key.width,
              p.panel.top - p.key.height - 0.35 * pen.theme.text);
}

}  // namespace

PlacedPlots placed_plots(const FigureParameters& parameters, const Page& page, const std::vector<Plot>& plots,
                         bool stacked, bool letters) {
  const Grid grid = grid_of(parameters, page, plots.size(), stacked);
  Theme theme = page.theme;
  constexpr double least = 2;  // pt: below it nobody reads
  for (; theme.text > least; theme = scaled(theme, 0.9))
    if (std::optional<PlacedPlots> placed = placed_with(theme, grid, plots, letters)) return std::move(*placed);
  throw std::invalid_argument("a figure of this size has no room for its panels and their text");
}

void draw_plots(const Pen& pen, const PlacedPlots& placed) {
  for (const PlacedPlot& p : placed.plots) draw_one(pen, p);
  draw_legend(pen, placed.legend, placed.legend_at.x(), placed.legend_at.y());
}

void draw_instant(const Pen& pen, const PlacedPlots& placed, double x) {
  cairo_t* cairo = pen.cairo;
  for (const PlacedPlot& p : placed.plots) {
    const double at = std::clamp(x, p.panel.x.low, p.panel.x.high), page_x = p.panel.page_x(at);
    set_colour(pen, pen.theme.ink, 0.55);
    cairo_set_line_width(cairo, 1.1 * pen.theme.line);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT);
    cairo_move_to(cairo, page_x, p.panel.top);
    cairo_line_to(cairo, page_x, p.panel.top + p.panel.height);
    cairo_stroke(cairo);
    for (const Curve& curve : p.plot.curves) {
      if (curve.faint) continue;
      const Points c = in_panel(p.plot, curve);
      const auto after = std::lower_bound(c.first.begin(), c.first.end(), at);
      const auto k = static_cast<std::size_t>(after - c.first.begin());
      if (k >= c.first.size() || (k == 0 && c.first[0] > at)) continue;  // it has ended, or not begun
      const double share = k == 0 ? 1 : (at - c.first[k - 1]) / (c.first[k] - c.first[k - 1]);
      const double y = k == 0 ? c.second[0] : c.second[k - 1] + share * (c.second[k] - c.second[k - 1]);
      if (!std::isfinite(y) || y < p.panel.y.low || y > p.panel.y.high) continue;
      const std::vector<double> xs{at}, ys{y};
      draw_markers(pen, p.panel, xs, ys, Marker::dot, pen.theme.ground, 2.7);
      draw_markers(pen, p.panel, xs, ys, Marker::dot, colour_of(pen.theme, curve), 1.9);
    }
  }
}

Figure arranged(const FigureInput& input, const std::vector<Plot>& plots, bool stacked, std::string csv) {
  PlacedPlots placed = placed_plots(input.parameters, page_of(input.parameters), plots, stacked);
  Figure figure;
  figure.csv = std::move(csv);
  figure.drawing = drawing_on(placed.theme, input.parameters, placed.width, placed.height,
                              [placed](cairo_t* cairo, const Font& font) {
                                draw_plots({cairo, font, placed.theme}, placed);
                              });
  return figure;
}

}  // namespace render
