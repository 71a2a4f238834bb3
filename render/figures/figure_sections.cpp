// Figures of cross-sections: strips of panels, and overlays.
#include "render/figures/figure_kinds.h"
#include "render/scene/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace render {
namespace {

struct Cut {
  std::vector<ClosedCurve> curves;
  Eigen::Vector2d origin;  ///< of the curves, in units of input.length
};

struct Sections {
  std::vector<double> times;             ///< as shown
  std::vector<std::vector<Cut>> cuts;    ///< state, vesicle; lengths in units of input.length
  std::vector<Eigen::Vector2d> centres;  ///< of each state's window
  std::string right, up;                 ///< names of the axes
  bool follows = false;                  ///< windows are centred on each state
  double half_x = 0, half_y = 0;         ///< of the window, the same for all states
};

Sections sections_of(const FigureInput& input) {
  if (input.states.empty()) throw std::invalid_argument("a figure of cross-sections needs at least one state");
  Sections all;
  const CutPlane axes = plane_of(input.parameters, sim::Vec3::Zero());
  std::tie(all.right, all.up) = axis_names(axes);
  Eigen::Vector2d lower = Eigen::Vector2d::Constant(1e300), upper = -lower;  // of everything
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();                         // extent of one state
  bool any = false;
  for (const sim::State& state : input.states) {
    all.times.push_back(input.time_factor * state.time);
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    std::vector<Cut> cuts;
    for (const sim::VesicleState& vesicle : state.vesicles) {
      const CutPlane plane = plane_of(input.parameters, volume_moments(vesicle.position).centroid);
      Cut c{cut(vesicle.position, plane),
            Eigen::Vector2d(plane.origin.dot(plane.right), plane.origin.dot(plane.up)) / input.length};
      for (ClosedCurve& curve : c.curves) {
        curve.points /= input.length;
        for (Eigen::Index i = 0; i < curve.points.rows(); ++i) {
          const Eigen::Vector2d p = c.origin + curve.points.row(i).transpose();
          low = low.cwiseMin(p);
          high = high.cwiseMax(p);
        }
      }
      cuts.push_back(std::move(c));
    }
    any = any || low.x() <= high.x();
    if (low.x() > high.x()) low = high = Eigen::Vector2d::Zero();
    all.cuts.push_back(std::move(cuts));
    all.centres.push_back((low + high) / 2);
    lower = lower.cwiseMin(low);
    upper = upper.cwiseMax(high);
    largest = largest.cwiseMax(high - low);
  }
  if (!any) throw std::invalid_argument("the plane of the figure cuts no vesicle at any of its instants");
  // One window for all; where the vesicles drift by more than their own size, each panel is centred on its state.
  all.follows = (upper - lower - largest).maxCoeff() > largest.maxCoeff();
  if (input.parameters.window != "auto") all.follows = input.parameters.window == "own";
  if (!all.follows) {
    all.centres.assign(all.centres.size(), (lower + upper) / 2);
    largest = upper - lower;
  }
  const double margin = 0.10 * largest.maxCoeff() + 1e-6;
  all.half_x = largest.x() / 2 + margin;
  all.half_y = largest.y() / 2 + margin;
  all.half_y = std::max(all.half_y, 0.5 * all.half_x);
  all.half_x = std::max(all.half_x, 0.6 * all.half_y);
  return all;
}

std::string csv_of(const Sections& s) {
  std::string text = fmt::format("time,vesicle,curve,{},{}\n", s.right, s.up);
  for (std::size_t k = 0; k < s.cuts.size(); ++k)
    for (std::size_t v = 0; v < s.cuts[k].size(); ++v)
      for (std::size_t c = 0; c < s.cuts[k][v].curves.size(); ++c) {
        const Cut& one = s.cuts[k][v];
        for (Eigen::Index i = 0; i < one.curves[c].points.rows(); ++i)
          text += fmt::format("{:.10g},{},{},{:.10g},{:.10g}\n", s.times[k], v, c,
                              one.curves[c].points(i, 0) + one.origin.x(), one.curves[c].points(i, 1) + one.origin.y());
      }
  return text;
}

std::string axis_label(const std::string& name, const FigureInput& input, bool relative) {
  const std::string quantity = relative ? fmt::format("({0} − {0}_{{c}})", name) : name;
  return input.length_symbol.empty() ? quantity : quantity + " / " + input.length_symbol;
}

// The window of state k: page-independent part of its panel.
Panel window(const Sections& s, std::size_t k) {
  const Eigen::Vector2d c = s.follows ? Eigen::Vector2d(Eigen::Vector2d::Zero()) : s.centres[k];
  Panel p;
  p.x = {c.x() - s.half_x, c.x() + s.half_x};
  p.y = {c.y() - s.half_y, c.y() + s.half_y};
  return p;
}

Eigen::Vector2d shift_of(const Sections& s, std::size_t k, const Cut& c) {
  return s.follows ? Eigen::Vector2d(c.origin - s.centres[k]) : c.origin;
}

struct Strip {
  std::vector<Panel> panels;
  std::vector<Axes> axes;
  std::vector<std::string> titles;
  double width = 0, height = 0;
};

// Panels of one scale in rows: as large as the page allows.
Strip strip_of(const Sections& s, const FigureInput& input, const Page& page, std::size_t columns) {
  const Theme& theme = page.theme;
  const Ruler ruler;
  const std::size_t count = s.cuts.size(), rows = (count + columns - 1) / columns;
  const double gap = 1.2 * theme.text, title = title_height(theme),
               legend = input.labels.empty() ? 0 : 1.8 * theme.text;
  const double page_width = page.width > 0 ? page.width : theme.width;
  Strip strip;
  for (std::size_t k = 0; k < count; ++k) {
    const bool lowest = k + columns >= count, leftmost = k % columns == 0;
    strip.panels.push_back(window(s, k));
    strip.axes.push_back({{lowest ? axis_label(s.right, input, s.follows) : "", Scale::linear, lowest, false},
                          {leftmost ? axis_label(s.up, input, s.follows) : "", Scale::linear, leftmost, false},
                          0});
  }
  double scale = page_width / (2 * s.half_x * static_cast<double>(std::max<std::size_t>(columns, 2)));
  for (int round = 0; round < 3; ++round) {
    Margins m;
    for (std::size_t k = 0; k < count; ++k) {
      strip.panels[k].width = 2 * s.half_x * scale;
      strip.panels[k].height = 2 * s.half_y * scale;
      const Margins one = margins_of(ruler, theme, strip.axes[k], strip.panels[k]);
      m.left = std::max(m.left, one.left);
      m.right = std::max(m.right, one.right);
      m.bottom = std::max(m.bottom, one.bottom);
    }
    const double free_width = page_width - m.left - m.right - gap * static_cast<double>(columns - 1);
    // A few panels do not grow beyond half of the page, unless its size was asked for.
    const double across = static_cast<double>(page.width > 0 ? columns : std::max<std::size_t>(columns, 2));
    scale = free_width / across / (2 * s.half_x);
    const double down =
        m.bottom + legend + title * static_cast<double>(rows) + 0.3 * theme.text * static_cast<double>(rows - 1);
    if (page.height > 0) scale = std::min(scale, (page.height - down) / static_cast<double>(rows) / (2 * s.half_y));
    scale = std::max(scale, 1.0);
    const double width = 2 * s.half_x * scale, height = 2 * s.half_y * scale;
    const double used =
        m.left + m.right + width * static_cast<double>(columns) + gap * static_cast<double>(columns - 1);
    strip.width = page.width > 0 || page.height > 0 ? page_width : std::ceil(used);
    const double used_height = down + height * static_cast<double>(rows);
    strip.height = page.height > 0 ? page.height : std::ceil(used_height);
    const double left = m.left + (strip.width - used) / 2, top = legend + (strip.height - used_height) / 2;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t row = k / columns, column = k % columns;
      Panel& p = strip.panels[k];
      p.width = width;
      p.height = height;
      p.left = left + static_cast<double>(column) * (width + gap);
      p.top = top + title + static_cast<double>(row) * (height + title + 0.3 * theme.text);
    }
  }
  // Labels wider than their panel stand once, in the middle; titles too long for it lose their time.
  const Panel& panel = strip.panels.front();
  const auto fits = [&](const std::string& text, double room) {
    return ruler.width(theme.label, text) < room + 0.5 * gap;
  };
  bool long_titles = false;
  for (std::size_t k = 0; k < count; ++k) {
    strip.titles.push_back(fmt::format("({})  {}", letter(k), time_text(input, s.times[k])));
    long_titles = long_titles || !fits(strip.titles.back(), panel.width);
    Axes& axes = strip.axes[k];
    if (!axes.x.label.empty() && !fits(axes.x.label, 0.8 * panel.width) && k % columns != (columns - 1) / 2)
      axes.x.label.clear();
    if (!axes.y.label.empty() && !fits(axes.y.label, panel.height + title) && k / columns != (rows - 1) / 2)
      axes.y.label.clear();
  }
  if (long_titles)
    for (std::size_t k = 0; k < count; ++k) strip.titles[k] = fmt::format("({})", letter(k));
  return strip;
}

std::vector<LegendEntry> vesicle_legend(const FigureInput& input, const Theme& theme) {
  std::vector<LegendEntry> entries;
  for (std::size_t v = 0; v < input.labels.size(); ++v)
    entries.push_back({input.labels[v], vesicle_colour(theme, v), {}, false});
  return entries;
}

}  // namespace

Figure draw_cross_sections(const FigureInput& input) {
  const auto s = std::make_shared<const Sections>(sections_of(input));
  const Page page = page_of(input.parameters);
  const std::size_t count = s->cuts.size();
  auto columns = std::min(static_cast<std::size_t>(input.parameters.columns), count);
  Strip strip;
  if (columns > 0 || page.height == 0) {
    if (columns == 0) columns = count <= 4 ? count : (count <= 6 ? 3 : 4);
    strip = strip_of(*s, input, page, columns);
  } else {  // the number of columns that makes the panels largest
    for (std::size_t c = 1; c <= count; ++c) {
      Strip trial = strip_of(*s, input, page, c);
      if (strip.panels.empty() || trial.panels[0].width > strip.panels[0].width) strip = std::move(trial);
    }
  }
  Figure figure;
  figure.csv = csv_of(*s);
  figure.drawing = {strip.width, strip.height, nullptr, page.theme.ground, dots_per_inch(input.parameters)};
  figure.drawing.paint = [s, input, strip, theme = page.theme](cairo_t* cairo, const Font& font) {
    const Pen pen{cairo, font, theme};
    for (std::size_t k = 0; k < strip.panels.size(); ++k) {
      const Panel& panel = strip.panels[k];
      for (std::size_t v = 0; v < s->cuts[k].size(); ++v)
        for (const ClosedCurve& curve : s->cuts[k][v].curves)
          draw_closed_curve(pen, panel, curve, shift_of(*s, k, s->cuts[k][v]), {vesicle_colour(theme, v)}, 0.13);
      draw_axes(pen, panel, strip.axes[k]);
      draw_title(pen, panel, strip.titles[k]);
    }
    draw_legend_line(pen, strip.width - 0.8 * theme.text, 1.4 * theme.text, vesicle_legend(input, theme));
  };
  return figure;
}

Figure draw_overlay(const FigureInput& input) {
  const auto s = std::make_shared<const Sections>(sections_of(input));
  const Page page = page_of(input.parameters);
  const Theme& theme = page.theme;
  const Ruler ruler;
  std::vector<LegendEntry> entries;
  const double first = s->times.front(), span = std::max(s->times.back() - first, 1e-300);
  for (std::size_t k = 0; k < s->cuts.size(); ++k)
    entries.push_back(
        {time_text(input, s->times[k]), on_ground(theme, colour_of_time((s->times[k] - first) / span)), {}, false});
  const std::vector<LegendEntry> colours = entries;
  if (entries.size() > 14)
    entries = {entries.front(), entries[entries.size() / 2], entries.back()};  // the ends tell the rest
  const Axes axes{{axis_label(s->right, input, s->follows), Scale::linear, true, true},
                  {axis_label(s->up, input, s->follows), Scale::linear, true, true},
                  0};
  Panel panel = window(*s, 0);
  const Eigen::Vector2d legend = legend_size(ruler, theme, entries);
  const double page_width = page.width > 0 ? page.width : page.height > 0 ? theme.width : 0.85 * theme.width;
  double page_height = page.height;
  panel.width = panel.height = 200;
  for (int round = 0; round < 3; ++round) {
    const Margins m = margins_of(ruler, theme, axes, panel);
    double scale = (page_width - m.left - legend.x()) / panel.x.size();
    if (page.height > 0) scale = std::min(scale, (page.height - m.top - m.bottom) / panel.y.size());
    panel.width = scale * panel.x.size();
    panel.height = scale * panel.y.size();
    panel.left = m.left + (page_width - m.left - legend.x() - panel.width) / 2;
    const double used = std::max(panel.height + m.bottom, legend.y()) + m.top;
    if (page.height == 0) page_height = std::ceil(used);
    panel.top = m.top + std::max(0.0, page_height - panel.height - m.top - m.bottom) / 2;
  }
  Figure figure;
  figure.csv = csv_of(*s);
  figure.drawing = {page_width, page_height, nullptr, theme.ground, dots_per_inch(input.parameters)};
  figure.drawing.paint = [s, entries, colours, panel, axes, legend, theme = page.theme](cairo_t* cairo,
                                                                                        const Font& font) {
    const Pen pen{cairo, font, theme};
    draw_grid(pen, panel, axes);
    for (std::size_t k = 0; k < s->cuts.size(); ++k)
      for (const Cut& c : s->cuts[k])
        for (const ClosedCurve& curve : c.curves)
          draw_closed_curve(pen, panel, curve, shift_of(*s, k, c), {colours[k].colour, 0.9});
    draw_axes(pen, panel, axes);
    Panel beside = panel;
    beside.left += panel.width;
    beside.width = legend.x();
    beside.top -= 0.5 * theme.text;
    draw_legend(pen, beside, entries, Corner::upper_left);
  };
  return figure;
}

}  // namespace render
