// One panel of a figure: a window of data coordinates in a rectangle of the page, with frame, ticks, labels, curves.
#pragma once

#include "palette.h"
#include "section.h"
#include "text.h"

#include <optional>
#include <string>
#include <vector>

namespace render {

struct Range {
  double low = 0, high = 1;
  double size() const { return high - low; }
};

/// Data window and place on the page (points; y grows downward there, upward in data).
struct Panel {
  Range x, y;
  double left = 0, top = 0, width = 100, height = 100;

  double page_x(double v) const { return left + (v - x.low) / x.size() * width; }
  double page_y(double v) const { return top + height - (v - y.low) / y.size() * height; }
};

inline constexpr double tick_text = 9, label_text = 10.5;  // pt

/// Multiples of 1, 2, 2.5 or 5 times a power of ten inside the range, about `wanted` of them; degrees: of 5, 15,
/// 30, 45...
std::vector<double> tick_values(const Range& range, int wanted, bool degrees = false);
/// `values` widened by `margin` of their span and to at least `least`.
Range range_of(const std::vector<double>& values, double margin = 0.06, double least = 1e-9);

struct AxisLabels {
  std::string x, y;  ///< empty: no label
  bool x_numbers = true, y_numbers = true;
  bool grid = false;  ///< faint lines at the ticks
  int x_ticks = 5, y_ticks = 5;
  bool y_degrees = false;  ///< ticks at divisions of the circle
};
/// Faint grid; call before the curves.
void draw_grid(cairo_t* cairo, const Panel& panel, const AxisLabels& labels);
/// Frame, inward ticks, numbers, labels; call after the curves. Numbers stand left of and below the panel.
void draw_axes(cairo_t* cairo, const Font& font, const Panel& panel, const AxisLabels& labels);

struct Stroke {
  Colour colour;
  double width = 1.5;  ///< pt
  double opacity = 1;
};
/// Clipped to the panel. Points that are not finite interrupt the line.
void draw_polyline(cairo_t* cairo, const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                   const Stroke& stroke);
/// `shift` is added to the points; fill_opacity > 0 tints the inside.
void draw_closed_curve(cairo_t* cairo, const Panel& panel, const ClosedCurve& curve, const Eigen::Vector2d& shift,
                       const Stroke& stroke, double fill_opacity = 0);
enum class Corner { upper_right, lower_right, upper_left, lower_left };
/// Short lines of the curves' colours with their names, in a corner of the panel.
void draw_legend(cairo_t* cairo, const Font& font, const Panel& panel, const std::vector<std::string>& names,
                 const std::vector<Colour>& colours, Corner corner = Corner::upper_right);
/// The same in one line whose right end is at (right, baseline).
void draw_legend_line(cairo_t* cairo, const Font& font, double right, double baseline, const std::vector<std::string>& names,
                      const std::vector<Colour>& colours);
/// Height of a legend with so many names, with the space round it, pt.
double legend_height(std::size_t names);
/// A corner that holds none of the points, if there is one.
std::optional<Corner> empty_corner(const Panel& panel, const std::vector<double>& x, const std::vector<double>& y);

}  // namespace render
