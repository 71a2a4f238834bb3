// One panel of a figure: a window of data coordinates in a rectangle of the page, with frame, ticks and labels.
#pragma once

#include "render/figures/theme.h"
#include "render/image/text.h"

#include <string>
#include <vector>

namespace render {

struct Range {
  double low = 0, high = 1;
  double size() const { return high - low; }
};

/// Data window and place on the page (points; y points downward there, upward in data).
struct Panel {
  Range x, y;
  double left = 0, top = 0, width = 100, height = 100;

  double page_x(double v) const { return left + (v - x.low) / x.size() * width; }
  double page_y(double v) const { return top + height - (v - y.low) / y.size() * height; }
};

/// Drawing context: Cairo, font and theme.
struct Pen {
  cairo_t* cairo;
  const Font& font;
  const Theme& theme;
};
void set_colour(const Pen& pen, const Colour& colour, double opacity = 1);

/// Measures text widths before a page exists.
class Ruler {
 public:
  explicit Ruler(FontFamily family = FontFamily::sans);
  double width(double size, std::string_view text) const;

 private:
  Font font_;
  std::shared_ptr<cairo_t> cairo_;
};

/// The text in lines of at most that width, broken at blanks, and within words that are wider.
std::vector<std::string> wrapped(const Ruler& ruler, double size, std::string_view text, double width);
/// As much of the beginning of a text as fits, with "…" where it is not all.
std::string shortened(const Ruler& ruler, double size, const std::string& text, double width);
/// The lines of a text, which '\n' separates.
std::vector<std::string> lines_of(std::string_view text);

/// linear: multiples of 1, 2, 2.5 or 5 times a power of ten. degrees: of 5, 15, 30, 45... logarithmic: the coordinate
/// is the decimal logarithm, ticks at decades.
enum class Scale { linear, degrees, logarithmic };

/// About `wanted` round numbers inside the range.
std::vector<double> tick_values(const Range& range, int wanted, Scale scale = Scale::linear);
/// Their labels: number_texts(), or powers of ten.
std::vector<std::string> tick_texts(const std::vector<double>& values, Scale scale = Scale::linear);

/// `values` widened by `margin` of their span, to at least `least` and the resolution of double precision.
Range range_of(const std::vector<double>& values, double margin = 0.06, double least = 0);
/// A range of decades that contains the logarithms of the positive values.
Range decades(const std::vector<double>& values);
/// Decimal logarithms; NaN where undefined.
std::vector<double> logarithms(const std::vector<double>& values);

struct Axis {
  std::string label;  ///< empty: none; '\n' separates lines
  Scale scale = Scale::linear;
  bool numbers = true;
  bool grid = false;       ///< faint lines at the ticks
  double label_scale = 1;  ///< of its text
};
/// The axis with its label in lines that fit beside it: up to three, then smaller.
Axis fitted(const Ruler& ruler, const Theme& theme, Axis axis, double length);
struct Axes {
  Axis x, y;
  double label_room =
      0;  ///< from the panel's left edge to the y label, pt; 0: beside the widest number. Aligns stacked panels.
};

/// Ticks of an axis `length` long on which no two numbers touch.
struct Ticks {
  std::vector<double> values;
  std::vector<std::string> texts;
  double widest = 0;  ///< pt
};
Ticks ticks_of(const Ruler& ruler, const Theme& theme, const Axis& axis, const Range& range, double length,
               bool horizontal);

/// Space taken by numbers and labels outside the panel, pt.
struct Margins {
  double left = 0, right = 0, top = 0, bottom = 0;
};
Margins margins_of(const Ruler& ruler, const Theme& theme, const Axes& axes, const Panel& panel);
/// The larger of both on each side. Numbers depend on the size of a panel and its size on the margins, so that rounds
/// may swing between two: those after the first ones only widen.
Margins widest(const Margins& a, const Margins& b);
inline constexpr int free_rounds = 2, layout_rounds = 5;

/// Faint grid; call before the curves.
void draw_grid(const Pen& pen, const Panel& panel, const Axes& axes);
/// Frame, inward ticks, numbers, labels; call after the curves. Numbers are left of and below the panel.
void draw_axes(const Pen& pen, const Panel& panel, const Axes& axes);
/// "(a)  t = 5" above the panel's upper left corner.
void draw_title(const Pen& pen, const Panel& panel, std::string_view text);
double title_height(const Theme& theme);

}  // namespace render
