#include "plot.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace render {
namespace {

constexpr double line = 0.9, tick = 4.5;  // pt
constexpr Colour black{0.10, 0.10, 0.12}, faint{0.90, 0.91, 0.92};

void set_colour(cairo_t* cairo, const Colour& c, double opacity = 1) {
  cairo_set_source_rgba(cairo, c.r, c.g, c.b, opacity);
}

void clip_to(cairo_t* cairo, const Panel& p) {
  cairo_rectangle(cairo, p.left, p.top, p.width, p.height);
  cairo_clip(cairo);
}

}  // namespace

std::vector<double> tick_values(const Range& range, int wanted, bool degrees) {
  if (!(range.size() > 0) || wanted < 1) return {};
  const double raw = range.size() / wanted, power = std::pow(10.0, std::floor(std::log10(raw)));
  std::vector<double> steps;
  if (degrees && raw > 4)
    steps = {5, 15, 30, 45, 90, 180};
  else
    for (const double factor : {1.0, 2.0, 2.5, 5.0, 10.0}) steps.push_back(factor * power);
  double step = steps.back();
  for (const double s : steps)
    if (s >= raw * 0.75) {
      step = s;
      break;
    }
  std::vector<double> ticks;
  for (double k = std::ceil(range.low / step - 1e-9); k * step <= range.high + 1e-9 * step; ++k)
    ticks.push_back(k == 0 ? 0 : k * step);
  return ticks;
}

Range range_of(const std::vector<double>& values, double margin, double least) {
  Range r{1e300, -1e300};
  for (const double v : values)
    if (std::isfinite(v)) r = {std::min(r.low, v), std::max(r.high, v)};
  if (r.low > r.high) return {0, 1};
  const double half = std::max(r.size() / 2 * (1 + 2 * margin), least / 2), middle = (r.low + r.high) / 2;
  return {middle - half, middle + half};
}

void draw_grid(cairo_t* cairo, const Panel& p, const AxisLabels& labels) {
  cairo_set_line_width(cairo, 0.6);
  set_colour(cairo, faint);
  for (const double v : tick_values(p.x, labels.x_ticks)) {
    cairo_move_to(cairo, p.page_x(v), p.top);
    cairo_line_to(cairo, p.page_x(v), p.top + p.height);
  }
  for (const double v : tick_values(p.y, labels.y_ticks, labels.y_degrees)) {
    cairo_move_to(cairo, p.left, p.page_y(v));
    cairo_line_to(cairo, p.left + p.width, p.page_y(v));
  }
  cairo_stroke(cairo);
}

void draw_axes(cairo_t* cairo, const Font& font, const Panel& p, const AxisLabels& labels) {
  set_colour(cairo, black);
  cairo_set_line_width(cairo, line);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_MITER);
  const std::vector<double> xs = tick_values(p.x, labels.x_ticks), ys = tick_values(p.y, labels.y_ticks, labels.y_degrees);
  for (const double v : xs) {
    cairo_move_to(cairo, p.page_x(v), p.top + p.height);
    cairo_rel_line_to(cairo, 0, -tick);
  }
  for (const double v : ys) {
    cairo_move_to(cairo, p.left, p.page_y(v));
    cairo_rel_line_to(cairo, tick, 0);
  }
  cairo_stroke(cairo);
  cairo_rectangle(cairo, p.left, p.top, p.width, p.height);
  cairo_stroke(cairo);
  double widest = 0;
  if (labels.x_numbers)
    for (const double v : xs)
      draw_text(cairo, font, tick_text, p.page_x(v), p.top + p.height + 4 + tick_text, number_text(v), Align::centre);
  if (labels.y_numbers)
    for (const double v : ys)
      widest = std::max(widest, draw_text(cairo, font, tick_text, p.left - 5, p.page_y(v) + 0.36 * tick_text, number_text(v),
                                          Align::right));
  if (!labels.x.empty())
    draw_text(cairo, font, label_text, p.left + p.width / 2, p.top + p.height + 9 + tick_text + label_text, labels.x,
              Align::centre);
  if (!labels.y.empty()) {
    cairo_save(cairo);
    cairo_translate(cairo, p.left - 12 - widest, p.top + p.height / 2);
    cairo_rotate(cairo, -1.5707963267948966);
    draw_text(cairo, font, label_text, 0, 0, labels.y, Align::centre);
    cairo_restore(cairo);
  }
}

void draw_polyline(cairo_t* cairo, const Panel& p, const std::vector<double>& x, const std::vector<double>& y,
                   const Stroke& stroke) {
  cairo_save(cairo);
  clip_to(cairo, p);
  cairo_new_path(cairo);
  bool down = false;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      down = false;
      continue;
    }
    (down ? cairo_line_to : cairo_move_to)(cairo, p.page_x(x[i]), p.page_y(y[i]));
    down = true;
  }
  set_colour(cairo, stroke.colour, stroke.opacity);
  cairo_set_line_width(cairo, stroke.width);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
  cairo_stroke(cairo);
  cairo_restore(cairo);
}

void draw_closed_curve(cairo_t* cairo, const Panel& p, const ClosedCurve& curve, const Eigen::Vector2d& shift,
                       const Stroke& stroke, double fill_opacity) {
  cairo_save(cairo);
  clip_to(cairo, p);
  cairo_new_path(cairo);
  const auto x = [&](const Eigen::Vector2d& v) { return p.page_x(v.x() + shift.x()); };
  const auto y = [&](const Eigen::Vector2d& v) { return p.page_y(v.y() + shift.y()); };
  bool first = true;
  for (const CubicPiece& c : cubic_pieces(curve)) {
    if (first) cairo_move_to(cairo, x(c.p0), y(c.p0));
    first = false;
    cairo_curve_to(cairo, x(c.p1), y(c.p1), x(c.p2), y(c.p2), x(c.p3), y(c.p3));
  }
  cairo_close_path(cairo);
  if (fill_opacity > 0) {
    set_colour(cairo, stroke.colour, fill_opacity);
    cairo_fill_preserve(cairo);
  }
  set_colour(cairo, stroke.colour, stroke.opacity);
  cairo_set_line_width(cairo, stroke.width);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(cairo);
  cairo_restore(cairo);
}

double legend_height(std::size_t names) { return 1.45 * tick_text * static_cast<double>(names) + 10; }

void draw_legend(cairo_t* cairo, const Font& font, const Panel& p, const std::vector<std::string>& names,
                 const std::vector<Colour>& colours, Corner corner) {
  double widest = 0;
  for (const std::string& name : names) widest = std::max(widest, text_width(cairo, font, tick_text, name));
  const double spacing = 1.45 * tick_text, height = spacing * static_cast<double>(names.size());
  const bool right = corner == Corner::upper_right || corner == Corner::lower_right;
  const bool upper = corner == Corner::upper_right || corner == Corner::upper_left;
  const double x = right ? p.left + p.width - 10 - widest : p.left + 38;
  double y = upper ? p.top + 7 + tick_text : p.top + p.height - height - 9 + tick_text;
  for (std::size_t i = 0; i < names.size(); ++i, y += spacing) {
    set_colour(cairo, colours[i]);
    cairo_set_line_width(cairo, 1.6);
    cairo_move_to(cairo, x - 28, y - 0.33 * tick_text);
    cairo_rel_line_to(cairo, 22, 0);
    cairo_stroke(cairo);
    set_colour(cairo, black);
    draw_text(cairo, font, tick_text, x, y, names[i]);
  }
}

void draw_legend_line(cairo_t* cairo, const Font& font, double right, double baseline, const std::vector<std::string>& names,
                      const std::vector<Colour>& colours) {
  double x = right;
  for (std::size_t i = names.size(); i-- > 0;) {
    set_colour(cairo, black);
    x -= draw_text(cairo, font, tick_text, x, baseline, names[i], Align::right);
    set_colour(cairo, colours[i]);
    cairo_set_line_width(cairo, 1.6);
    cairo_move_to(cairo, x - 26, baseline - 0.33 * tick_text);
    cairo_rel_line_to(cairo, 20, 0);
    cairo_stroke(cairo);
    x -= 42;
  }
}

std::optional<Corner> empty_corner(const Panel& p, const std::vector<double>& x, const std::vector<double>& y) {
  constexpr std::array<Corner, 4> corners{Corner::upper_right, Corner::lower_right, Corner::upper_left, Corner::lower_left};
  std::array<int, 4> points{};
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const double a = (x[i] - p.x.low) / p.x.size(), b = (y[i] - p.y.low) / p.y.size();
    if (b > 0.66 && a > 0.66) ++points[0];
    if (b > 0.66 && a < 0.34) ++points[2];
    if (b < 0.34 && a > 0.66) ++points[1];
    if (b < 0.34 && a < 0.34) ++points[3];
  }
  const auto empty = std::find(points.begin(), points.end(), 0);
  if (empty == points.end()) return {};
  return corners[static_cast<std::size_t>(empty - points.begin())];
}

}  // namespace render
