// Figures of cross-sections: strips of panels, and overlays.
#include "figure_kinds.h"
#include "plot.h"
#include "section.h"
#include "surface.h"

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
  bool follows = false;                  ///< windows are centred on each state
  double half_x = 0, half_y = 0;         ///< of the window, the same for all states
};

std::string time_text(const FigureInput& input, double time) {
  return fmt::format("{} = {}", input.time_symbol, number_text(std::round(time * 1e4) / 1e4));
}

Sections sections_of(const FigureInput& input) {
  if (input.states.empty()) throw std::invalid_argument("a figure of cross-sections needs at least one state");
  Sections all;
  Eigen::Vector2d lower = Eigen::Vector2d::Constant(1e300), upper = -lower;  // of everything
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();                         // extent of one state
  for (const sim::State& state : input.states) {
    all.times.push_back(input.time_factor * state.time);
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    std::vector<Cut> cuts;
    for (const sim::VesicleState& vesicle : state.vesicles) {
      CutPlane plane;
      plane.origin = volume_moments(vesicle.position).centroid;
      Cut c{cut(vesicle.position, plane), Eigen::Vector2d(plane.origin.x(), plane.origin.z()) / input.length};
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
    if (low.x() > high.x()) low = high = Eigen::Vector2d::Zero();
    all.cuts.push_back(std::move(cuts));
    all.centres.push_back((low + high) / 2);
    lower = lower.cwiseMin(low);
    upper = upper.cwiseMax(high);
    largest = largest.cwiseMax(high - low);
  }
  // One window for all; where the vesicles drift by more than their own size, each panel is centred on its state.
  all.follows = (upper - lower - largest).maxCoeff() > largest.maxCoeff();
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
  std::string text = "time,vesicle,curve,x,z\n";
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

std::string axis_label(const char* name, const FigureInput& input, bool relative) {
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

// a..z, then aa, ab, ...
std::string letter(std::size_t k) {
  std::string name = k < 26 ? std::string() : letter(k / 26 - 1);
  name.push_back(static_cast<char>('a' + k % 26));
  return name;
}

// Dark blue, green, orange: early to late, distinct in grey as well.
Colour colour_of_time(double t) {
  constexpr std::array<Colour, 4> stops{{{0.10, 0.17, 0.42}, {0.00, 0.45, 0.62}, {0.20, 0.66, 0.45}, {0.93, 0.62, 0.13}}};
  const double place = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double f = place - static_cast<double>(i);
  const auto mix = [&](double a, double b) { return a + f * (b - a); };
  return {mix(stops[i].r, stops[i + 1].r), mix(stops[i].g, stops[i + 1].g), mix(stops[i].b, stops[i + 1].b)};
}

}  // namespace

Figure draw_cross_sections(const FigureInput& input) {
  const auto s = std::make_shared<const Sections>(sections_of(input));
  const std::size_t count = s->cuts.size(), columns = count <= 4 ? count : (count <= 6 ? 3 : 4);
  const std::size_t rows = (count + columns - 1) / columns;
  constexpr double page = 510, left = 48, right = 8, bottom = 38, gap = 12, title = 20;
  const double top = input.labels.empty() ? 22 : 38;  // a line for the legend above the titles
  const double width = (page - left - right - gap * static_cast<double>(columns - 1)) /
                       static_cast<double>(std::max<std::size_t>(columns, 2));
  const double height = width * s->half_y / s->half_x;
  const double used = left + right + width * static_cast<double>(columns) + gap * static_cast<double>(columns - 1);

  Figure figure;
  figure.csv = csv_of(*s);
  figure.drawing.width = std::ceil(used);
  figure.drawing.height =
      std::ceil(top + bottom + static_cast<double>(rows) * height + static_cast<double>(rows - 1) * title);
  figure.drawing.paint = [s, input, count, columns, width, height, top, used](cairo_t* cairo, const Font& font) {
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t row = k / columns, column = k % columns;
      Panel panel = window(*s, k);
      panel.left = left + static_cast<double>(column) * (width + gap);
      panel.top = top + static_cast<double>(row) * (height + title);
      panel.width = width;
      panel.height = height;
      const bool lowest = k + columns >= count;
      const AxisLabels labels{lowest ? axis_label("x", input, s->follows) : "",
                              column == 0 ? axis_label("z", input, s->follows) : "",
                              lowest,
                              column == 0,
                              false,
                              3,
                              3};
      for (std::size_t v = 0; v < s->cuts[k].size(); ++v)
        for (const ClosedCurve& curve : s->cuts[k][v].curves)
          draw_closed_curve(cairo, panel, curve, shift_of(*s, k, s->cuts[k][v]), {curve_colour(v), 1.5, 1}, 0.13);
      draw_axes(cairo, font, panel, labels);
      cairo_set_source_rgb(cairo, 0.1, 0.1, 0.12);
      draw_text(cairo, font, label_text, panel.left, panel.top - 6,
                fmt::format("({})  {}", letter(k), time_text(input, s->times[k])));
    }
    std::vector<Colour> colours;
    for (std::size_t v = 0; v < input.labels.size(); ++v) colours.push_back(curve_colour(v));
    draw_legend_line(cairo, font, used - right, 16, input.labels, colours);
  };
  return figure;
}

Figure draw_overlay(const FigureInput& input) {
  const auto s = std::make_shared<const Sections>(sections_of(input));
  constexpr double left = 52, right = 96, top = 14, bottom = 42, width = 300;
  const double height = width * s->half_y / s->half_x;
  Figure figure;
  figure.csv = csv_of(*s);
  figure.drawing.width = left + width + right;
  figure.drawing.height = std::ceil(top + height + bottom);
  figure.drawing.paint = [s, input, height](cairo_t* cairo, const Font& font) {
    Panel panel = window(*s, 0);
    panel.left = left;
    panel.top = top;
    panel.width = width;
    panel.height = height;
    const AxisLabels labels{axis_label("x", input, s->follows), axis_label("z", input, s->follows), true, true, true, 5, 5};
    draw_grid(cairo, panel, labels);
    const double first = s->times.front(), span = std::max(s->times.back() - first, 1e-300);
    std::vector<std::string> names;
    std::vector<Colour> colours;
    for (std::size_t k = 0; k < s->cuts.size(); ++k) {
      colours.push_back(colour_of_time((s->times[k] - first) / span));
      names.push_back(time_text(input, s->times[k]));
      for (const Cut& c : s->cuts[k])
        for (const ClosedCurve& curve : c.curves)
          draw_closed_curve(cairo, panel, curve, shift_of(*s, k, c), {colours.back(), 1.4, 1});
    }
    draw_axes(cairo, font, panel, labels);
    if (names.size() > 14) {  // the legend holds a dozen; the ends tell the rest
      names = {names.front(), names[names.size() / 2], names.back()};
      colours = {colours.front(), colours[colours.size() / 2], colours.back()};
    }
    Panel beside = panel;
    beside.left += panel.width;
    beside.width = right;
    beside.top -= 6;
    draw_legend(cairo, font, beside, names, colours);
  };
  return figure;
}

}  // namespace render
