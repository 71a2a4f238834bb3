// One panel of a figure: a window of data coordinates in a rectangle of the page, with frame, ticks, labels, curves.
#pragma once

#include "image.h"
#include "section.h"
#include "text.h"
#include "theme.h"

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

/// What everything is drawn with.
struct Pen {
  cairo_t* cairo;
  const Font& font;
  const Theme& theme;
};
void set_colour(const Pen& pen, const Colour& colour, double opacity = 1);

/// Widths of texts before there is a page.
class Ruler {
 public:
  Ruler();
  double width(double size, std::string_view text) const;

 private:
  Font font_;
  std::shared_ptr<cairo_t> cairo_;
};

/// linear: multiples of 1, 2, 2.5 or 5 times a power of ten. degrees: of 5, 15, 30, 45... logarithmic: the coordinate is the
/// decimal logarithm, ticks at decades.
enum class Scale { linear, degrees, logarithmic };

/// About `wanted` round numbers inside the range.
std::vector<double> tick_values(const Range& range, int wanted, Scale scale = Scale::linear);
/// How they are written: all with as many digits after the point as the one that needs most.
std::vector<std::string> tick_texts(const std::vector<double>& values, Scale scale = Scale::linear);

/// `values` widened by `margin` of their span and to at least `least`.
Range range_of(const std::vector<double>& values, double margin = 0.06, double least = 1e-9);
/// A range of decades that holds the logarithms of the positive values.
Range decades(const std::vector<double>& values);
/// Decimal logarithms; not a number where there is none.
std::vector<double> logarithms(const std::vector<double>& values);

struct Axis {
  std::string label;  ///< empty: none
  Scale scale = Scale::linear;
  bool numbers = true;
  bool grid = false;  ///< faint lines at the ticks
};
struct Axes {
  Axis x, y;
  double label_room = 0;  ///< from the panel's left edge to the y label, pt; 0: beside the widest number. Aligns stacked panels.
};

/// Ticks of an axis `length` long on which no two numbers touch.
struct Ticks {
  std::vector<double> values;
  std::vector<std::string> texts;
  double widest = 0;  ///< pt
};
Ticks ticks_of(const Ruler& ruler, const Theme& theme, const Axis& axis, const Range& range, double length, bool horizontal);

/// Room that numbers and labels take outside the panel, pt.
struct Margins {
  double left = 0, right = 0, top = 0, bottom = 0;
};
Margins margins_of(const Ruler& ruler, const Theme& theme, const Axes& axes, const Panel& panel);

/// Faint grid; call before the curves.
void draw_grid(const Pen& pen, const Panel& panel, const Axes& axes);
/// Frame, inward ticks, numbers, labels; call after the curves. Numbers stand left of and below the panel.
void draw_axes(const Pen& pen, const Panel& panel, const Axes& axes);
/// "(a)  t = 5" above the panel's upper left corner.
void draw_title(const Pen& pen, const Panel& panel, std::string_view text);
double title_height(const Theme& theme);

struct Stroke {
  Colour colour;
  double width = 1;  ///< in units of the theme's stroke
  double opacity = 1;
  bool dashed = false;
};
/// Clipped to the panel. Points that are not finite interrupt the line.
void draw_polyline(const Pen& pen, const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                   const Stroke& stroke);
/// `shift` is added to the points; fill_opacity > 0 tints the inside.
void draw_closed_curve(const Pen& pen, const Panel& panel, const ClosedCurve& curve, const Eigen::Vector2d& shift,
                       const Stroke& stroke, double fill_opacity = 0);
enum class Marker { dot, square, diamond, triangle, ring };
/// radius: in units of the theme's stroke. error: half length of a bar in y; empty: none.
void draw_markers(const Pen& pen, const Panel& panel, const std::vector<double>& x, const std::vector<double>& y, Marker marker,
                  const Colour& colour, double radius = 1.8, const std::vector<double>& error = {});
/// An RGB picture in a rectangle of the page; smooth: enlarged without edges.
void draw_picture(cairo_t* cairo, const Image& image, double left, double top, double width, double height, bool smooth = true);

/// One line of a legend.
struct LegendEntry {
  std::string name;
  Colour colour;
  std::optional<Marker> marker;  ///< instead of a line
  bool dashed = false;
};
enum class Corner { upper_right, lower_right, upper_left, lower_left };
void draw_legend(const Pen& pen, const Panel& panel, const std::vector<LegendEntry>& entries, Corner corner);
/// The same in one line whose right end is at (right, baseline).
void draw_legend_line(const Pen& pen, double right, double baseline, const std::vector<LegendEntry>& entries);
/// Size with the space round it, pt.
Eigen::Vector2d legend_size(const Ruler& ruler, const Theme& theme, const std::vector<LegendEntry>& entries);
/// A corner where a rectangle of that size meets none of the curves, if there is one.
std::optional<Corner> empty_corner(const Panel& panel, const Eigen::Vector2d& size,
                                   const std::vector<std::pair<std::vector<double>, std::vector<double>>>& curves);

/// Colours of curves: those of the palette, lightened on a dark ground.
Colour on_ground(const Theme& theme, const Colour& colour);
Colour curve_colour(const Theme& theme, std::size_t curve);
/// Of the outline of a vesicle: the hue that its body has in pictures.
Colour vesicle_colour(const Theme& theme, std::size_t vesicle);

}  // namespace render
