// The bar at the right edge of a picture that tells the values of its colours.
#pragma once

#include "picture_canvas.h"
#include "scene.h"

namespace render {

/// Round numbers in [low, high], three to seven of them.
std::vector<double> bar_ticks(double low, double high);

/// Where the bar of a picture stands: its colours from bottom to top, without the pointed ends. Pixels.
struct BarPlace {
  double left, top, width, height;
};
BarPlace colour_bar_place(const Image& image, const Font& font, const Legend& legend);

void draw_colour_bar(Image& image, const Font& font, const Legend& legend, bool sign_dots = false);

}  // namespace render
