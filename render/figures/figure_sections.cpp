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

struct SectionCut {
  std::vector<ClosedCurve> curves;
  Eigen::Vector2d origin;  ///< of the curves, in units of input.length
};

struct Sections {
  std::vector<double> times;                  ///< as shown
  std::vector<std::vector<SectionCut>> cuts;  ///< state, vesicle; lengths in units of input.length
  std::vector<Eigen::Vector2d> centres;       ///< of each state's window
  std::string right, up;                      ///< names of the axes
  bool follows = false;                       ///< windows are centred on each state
  double half_x = 0, half_y = 0;              ///< of the window, the same for all states
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
    std::vector<SectionCut> cuts;
    for (const sim::VesicleState& vesicle : state.vesicles) {
      const CutPlane plane = plane_of(input.parameters, volume_moments(vesicle.position).centroid);
      SectionCut c{cut(vesicle.position, plane),
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
        const SectionCut& one = s.cuts[k][v];
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

Eigen::Vector2d shift_of(const Sections& s, std::size_t k, const SectionCut& c) {
  return s.follows ? Eigen::Vector2d(c.origin - s.centres[k]) : c.origin;
}

std::vector<LegendEntry> vesicle_legend(const FigureInput& input, const Theme& theme) {
  std::vector<LegendEntry> entries;
  for (std::size_t v = 0; v < input.labels.size(); ++v)
    entries.push_back({.name = input.labels[v], .colour = vesicle_colour(theme, v), .marker = {}});
  return entries;
}

struct Strip {
  std::vector<Panel> panels;
  std::vector<Axes> axes;
  std::vector<std::string> titles;
  LaidLegend legend;
  bool whole_titles = true;  ///< with their times
  double width = 0, height = 0;
};

/// How far numbers of x reach beyond the ends of a panel, together.
double overhang(const Ruler& ruler, const Theme& theme, const Axis& axis, const Panel& panel) {
  const Ticks x = ticks_of(ruler, theme, axis, panel.x, panel.width, true);
  if (x.values.empty()) return 0;
  const double left = ruler.width(theme.text, x.texts.front()) / 2 - (panel.page_x(x.values.front()) - panel.left);
  const double right =
      ruler.width(theme.text, x.texts.back()) / 2 - (panel.left + panel.width - panel.page_x(x.values.back()));
  return std::max(left, 0.0) + std::max(right, 0.0);
}

// Panels of one scale in rows: as large as the page allows.
Strip strip_of(const Sections& s, const FigureInput& input, const Page& page, std::size_t columns) {
  const Theme& theme = page.theme;
  const Ruler ruler(theme.family);
  const std::size_t count = s.cuts.size(), rows = (count + columns - 1) / columns;
  const double title = title_height(theme), page_width = page.width > 0 ? page.width : theme.width;
  double gap = 1.2 * theme.text;
  Strip strip;
  strip.legend = laid_legend(ruler, theme, vesicle_legend(input, theme), page_width - 1.6 * theme.text);
  const double legend = strip.legend.entries.empty() ? 0 : strip.legend.height + 0.4 * theme.text;
  for (std::size_t k = 0; k < count; ++k) {
    const bool lowest = k + columns >= count, leftmost = k % columns == 0;
    strip.panels.push_back(window(s, k));
    strip.axes.push_back({{lowest ? axis_label(s.right, input, s.follows) : "", Scale::linear, lowest, false},
                          {leftmost ? axis_label(s.up, input, s.follows) : "", Scale::linear, leftmost, false},
                          0});
  }
  double scale = page_width / (2 * s.half_x * static_cast<double>(std::max<std::size_t>(columns, 2)));
  Margins before;
  for (int round = 0; round < layout_rounds; ++round) {
    Margins m = round > free_rounds ? before : Margins();
    for (std::size_t k = 0; k < count; ++k) {
      strip.panels[k].width = 2 * s.half_x * scale;
      strip.panels[k].height = 2 * s.half_y * scale;
      const Margins one = margins_of(ruler, theme, strip.axes[k], strip.panels[k]);
      m.left = std::max(m.left, one.left);
      m.right = std::max(m.right, one.right);
      m.bottom = std::max(m.bottom, one.bottom);
    }
    before = m;
    if (columns > 1)  // numbers of neighbours do not touch
      gap = std::max(1.2 * theme.text, 0.7 * theme.text + overhang(ruler, theme, {}, strip.panels.front()));
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
    return ruler.width(theme.label, text) < room + 0.25 * theme.text;
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
  strip.whole_titles = !long_titles;
  if (long_titles)
    for (std::size_t k = 0; k < count; ++k) strip.titles[k] = fmt::format("({})", letter(k));
  return strip;
}

}  // namespace

Figure draw_cross_sections(const FigureInput& input) {
  const auto s = std::make_shared<const Sections>(sections_of(input));
  const Page page = page_of(input.parameters);
  const std::size_t count = s->cuts.size();
  auto columns = std::min(static_cast<std::size_t>(input.parameters.columns), count);
  Strip strip;
  if (columns > 0 || page.height == 0) {
    const bool free = columns == 0;
    if (free) columns = count <= 4 ? count : (count <= 6 ? 3 : 4);
    strip = strip_of(*s, input, page, columns);
    while (free && columns > 1 && !strip.whole_titles) strip = strip_of(*s, input, page, --columns);
  } else {  // the number of columns that makes the panels largest
    for (std::size_t c = 1; c <= count; ++c) {
      Strip trial = strip_of(*s, input, page, c);
      const bool better = strip.panels.empty() || (trial.whole_titles && !strip.whole_titles) ||
                          (trial.whole_titles == strip.whole_titles && trial.panels[0].width > strip.panels[0].width);
      if (better) strip = std::move(trial);
    }
  }
  Figure figure;
  figure.csv = csv_of(*s);
  const auto paint = [s, strip, theme = page.theme](cairo_t* cairo, const Font& font) {
    const Pen pen{cairo, font, theme};
    for (std::size_t k = 0; k < strip.panels.size(); ++k) {
      const Panel& panel = strip.panels[k];
      for (std::size_t v = 0; v < s->cuts[k].size(); ++v)
        for (const ClosedCurve& curve : s->cuts[k][v].curves)
          draw_closed_curve(pen, panel, curve, shift_of(*s, k, s->cuts[k][v]), {vesicle_colour(theme, v)}, 0.13);
      draw_axes(pen, panel, strip.axes[k]);
      draw_title(pen, panel, strip.titles[k]);
    }
    draw_legend(pen, strip.legend, strip.panels.front().left, 0.4 * theme.text);
  };
  figure.drawing = drawing_on(page.theme, input.parameters, strip.width, strip.height, paint);
  return figure;
}

Figure draw_overlay(const FigureInput& input) {
  const auto s = std::make_shared<const Sections>(sections_of(input));
  const Page page = page_of(input.parameters);
  const Theme& theme = page.theme;
  const Ruler ruler(theme.family);
  std::vector<LegendEntry> entries;
  std::vector<Colour> colours;
  const double first = s->times.front(), span = std::max(s->times.back() - first, 1e-300);
  for (std::size_t k = 0; k < s->cuts.size(); ++k) {
    colours.push_back(on_ground(theme, colour_of_time((s->times[k] - first) / span)));
    entries.push_back({.name = time_text(input, s->times[k]), .colour = colours.back(), .marker = {}});
  }
  if (entries.size() > 14)
    entries = {entries.front(), entries[entries.size() / 2], entries.back()};  // the ends tell the rest
  Axes axes{{axis_label(s->right, input, s->follows), Scale::linear, true, true},
            {axis_label(s->up, input, s->follows), Scale::linear, true, true},
            0};
  Panel panel = window(*s, 0);
  const double page_width = page.width > 0 ? page.width : page.height > 0 ? theme.width : 0.85 * theme.width;
  // The legend in a column beside the panel, or above it where the page is narrow.
  const double edge = 0.8 * theme.text;
  double column = 0;
  for (const LegendEntry& entry : entries)
    column = std::max(column, 1.001 * laid_legend(ruler, theme, {entry}, page_width).width);
  LaidLegend legend = laid_legend(ruler, theme, entries, column);
  const bool above = legend.width + 2 * edge > 0.3 * page_width || (page.height > 0 && legend.height > page.height);
  if (above) legend = laid_legend(ruler, theme, entries, page_width - 2 * edge);
  const double beside = above ? 0 : legend.width + 2 * edge, top = above ? legend.height + 0.5 * edge : 0;
  double page_height = page.height;
  panel.width = panel.height = 200;
  Margins before;
  for (int round = 0; round < layout_rounds; ++round) {
    axes.x.label_scale = axes.y.label_scale = 1;
    axes.x = fitted(ruler, theme, axes.x, panel.width);
    axes.y = fitted(ruler, theme, axes.y, panel.height);
    Margins m = margins_of(ruler, theme, axes, panel);
    if (round > free_rounds) m = widest(m, before);
    before = m;
    const double right = above ? m.right : std::max(beside, m.right);
    double scale = (page_width - m.left - right) / panel.x.size();
    if (page.height > 0) scale = std::min(scale, (page.height - top - m.top - m.bottom) / panel.y.size());
    scale = std::max(scale, 1.0);
    panel.width = scale * panel.x.size();
    panel.height = scale * panel.y.size();
    panel.left = m.left + (page_width - m.left - right - panel.width) / 2;
    const double used = std::max(panel.height + m.bottom, above ? 0.0 : legend.height) + m.top;
    if (page.height == 0) page_height = std::ceil(top + used);
    panel.top = top + m.top + std::max(0.0, page_height - top - panel.height - m.top - m.bottom) / 2;
  }
  Figure figure;
  figure.csv = csv_of(*s);
  const Eigen::Vector2d at =
      above ? Eigen::Vector2d(std::max(edge, std::min(panel.left, page_width - edge - legend.width)), 0.5 * edge)
            : Eigen::Vector2d(panel.left + panel.width + edge, panel.top);
  const auto paint = [s, colours, panel, axes, legend, at, theme = page.theme](cairo_t* cairo, const Font& font) {
    const Pen pen{cairo, font, theme};
    draw_grid(pen, panel, axes);
    for (std::size_t k = 0; k < s->cuts.size(); ++k)
      for (const SectionCut& c : s->cuts[k])
        for (const ClosedCurve& curve : c.curves)
          draw_closed_curve(pen, panel, curve, shift_of(*s, k, c), {colours[k], 0.9});
    draw_axes(pen, panel, axes);
    draw_legend(pen, legend, at.x(), at.y());
  };
  figure.drawing = drawing_on(theme, input.parameters, page_width, page_height, paint);
  return figure;
}

}  // namespace render
