// What the figures of the paper need beyond panels with linear axes: logarithmic axes, and pictures as panels of a sheet.
#pragma once

#include "render/image.h"
#include "render/plot.h"

namespace app {

/// Frame, ticks and labels of a panel whose coordinates are decimal logarithms where log_x or log_y say so.
void draw_log_axes(cairo_t*, const render::Font&, const render::Panel&, const render::AxisLabels&, bool log_x, bool log_y);
/// Dots at points of data coordinates.
void draw_dots(cairo_t*, const render::Panel&, const std::vector<double>& x, const std::vector<double>& y,
               const render::Colour&, double radius);
/// A range of decades that holds the logarithms of the positive values.
render::Range decades(const std::vector<double>& values);
std::vector<double> logarithms(const std::vector<double>& values);

/// An RGB picture in a rectangle of the page.
void draw_picture(cairo_t*, const render::Image&, double left, double top, double width, double height);

}  // namespace app
