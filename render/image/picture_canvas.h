// Cairo on a finished picture.
#pragma once

#include "render/core/palette.h"
#include "render/image/image.h"
#include "render/image/text.h"

#include <functional>

namespace render {

/// Pixels; may extend beyond the picture.
struct Rectangle {
  int x, y, width, height;
};

/// Paints within `where`, in the picture's own coordinates: pixels, y downward. Throws std::runtime_error when Cairo
/// fails.
void draw_on(Image& image, Rectangle where, const std::function<void(cairo_t*)>& paint);

inline void set_colour(cairo_t* cairo, const Colour& c) { cairo_set_source_rgb(cairo, c.r, c.g, c.b); }

}  // namespace render
