// Contents of a panel: curves, markers, arrow heads, pictures.
#pragma once

#include "render/figures/plot.h"
#include "render/image/image.h"
#include "render/scene/section.h"

namespace render {

struct Stroke {
  Colour colour;
  double width = 1;  ///< in units of the theme's stroke
  double opacity = 1;
  int dash = 0;  ///< number of dashes; 0: none
};
/// Patterns beside the whole line, told apart in grey.
inline constexpr int dash_count = 5;
/// Pattern `dash`, in units of the width of the line; 0: whole.
void set_dash(cairo_t* cairo, int dash, double width);
/// Clipped to the panel. Points that are not finite interrupt the line.
void draw_polyline(const Pen& pen, const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                   const Stroke& stroke);
/// What lies within `error` of a line, tinted; clipped to the panel.
void draw_band(const Pen& pen, const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
               const std::vector<double>& error, const Colour& colour);
/// `shift` is added to the points; fill_opacity > 0 tints the inside.
void draw_closed_curve(const Pen& pen, const Panel& panel, const ClosedCurve& curve, const Eigen::Vector2d& shift,
                       const Stroke& stroke, double fill_opacity = 0);
enum class Marker { dot, square, diamond, triangle, ring };
void draw_marker(const Pen& pen, Marker marker, double x, double y, const Colour& colour, double radius);
/// radius: in units of the theme's stroke. error: half length of a bar in y; empty: none.
void draw_markers(const Pen& pen, const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                  Marker marker, const Colour& colour, double radius = 1.8, const std::vector<double>& error = {});
/// Marks on a line, about `spacing` apart on the page, the first after the share `phase` of it.
void draw_markers_along(const Pen& pen, const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                        Marker marker, const Colour& colour, double spacing, double phase);
/// Where such marks stand, on the page.
std::vector<Eigen::Vector2d> marks_along(const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                                         double spacing, double phase);

/// The head of an arrow on a curve, on the page.
struct ArrowHead {
  Eigen::Vector2d tip, along;  ///< along: unit vector
};
/// Of a curve that is `size` or more long: one, of a long one two, on the first round of it, away from the points
/// `taken` by marks. Heads are `size` long, pt.
std::vector<ArrowHead> arrow_heads(const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                                   double size, const std::vector<Eigen::Vector2d>& taken);
/// Nearly as wide as long; clipped to the panel.
void draw_arrow_heads(const Pen& pen, const Panel& panel, const std::vector<ArrowHead>& heads, double size,
                      const Colour& colour);

/// A picture, RGB or RGBA, in a rectangle of the page; smooth: interpolated when enlarged.
void draw_picture(cairo_t* cairo, const Image& image, double left, double top, double width, double height,
                  bool smooth = true);

}  // namespace render
