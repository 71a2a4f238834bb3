#include "render/overlay/panels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace render {

int panel_columns(int count, int width, int height) {
  int best = 1;
  double least = 1e300;
  for (int columns = 1; columns <= count; ++columns) {
    const int rows = (count + columns - 1) / columns;
    const double aspect = static_cast<double>(width) * rows / (static_cast<double>(height) * columns);
    const double cost =
        std::abs(std::log(aspect / 1.33)) + 0.3 * (rows * columns - count);  // empty places look unfinished
    if (cost < least - 1e-12) {
      least = cost;
      best = columns;
    }
  }
  return best;
}

void paste(Image& into, const Image& part, int left, int top) {
  for (int y = 0; y < part.height; ++y)
    std::copy_n(part.at(0, y), static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.channels),
                into.at(left, top + y));
}

void draw_separators(Image& image, int columns, int rows, int width, int height, const Colour& colour) {
  const std::array<double, 3> parts{colour.r, colour.g, colour.b};
  const int thickness = std::max(1, static_cast<int>(std::lround(image.height / 540.0)));
  const auto byte = [&](int c) -> std::uint8_t {
    return c < 3 ? static_cast<std::uint8_t>(std::lround(255 * parts[static_cast<std::size_t>(c)])) : 0;
  };
  const auto fill = [&](int x0, int y0, int x1, int y1) {
    for (int y = std::max(y0, 0); y < std::min(y1, image.height); ++y)
      for (int x = std::max(x0, 0); x < std::min(x1, image.width); ++x)
        for (int c = 0; c < image.channels; ++c) image.at(x, y)[c] = byte(c);
  };
  for (int c = 1; c < columns; ++c) fill(c * width - thickness, 0, c * width + thickness, image.height);
  for (int r = 1; r < rows; ++r) fill(0, r * height - thickness, image.width, r * height + thickness);
}

}  // namespace render
