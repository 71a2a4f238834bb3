// The colour bar at the right edge of a picture.
#pragma once

#include "render/core/ground.h"
#include "render/core/places.h"
#include "render/image/picture_canvas.h"
#include "render/scene/frame.h"

namespace render {

/// Three to seven round numbers in [low, high].
std::vector<double> bar_ticks(double low, double high);

/// Lengths of a colour bar, px: of the colours, from them to the numbers.
struct BarSizes {
  double width, text, tick, gap;
};
BarSizes bar_sizes(int picture_height);

/// bar: its colours from bottom to top, without the pointed ends; whole pixels.
void draw_colour_bar(Image& image, const Font& font, const Inks& inks, const Legend& legend, const Box& bar,
                     bool sign_dots = false);

}  // namespace render
