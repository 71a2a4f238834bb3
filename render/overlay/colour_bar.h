// The colour bar at the right edge of a picture.
#pragma once

#include "render/core/ground.h"
#include "render/image/picture_canvas.h"
#include "render/scene/frame.h"

namespace render {

/// Three to seven round numbers in [low, high].
std::vector<double> bar_ticks(double low, double high);

/// Place of the bar in a picture: its colours from bottom to top, without the pointed ends. Pixels.
struct BarPlace {
  double left, top, width, height;
};
BarPlace colour_bar_place(const Image& image, const Font& font, const Legend& legend);

void draw_colour_bar(Image& image, const Font& font, const Inks& inks, const Legend& legend, bool sign_dots = false);

}  // namespace render
