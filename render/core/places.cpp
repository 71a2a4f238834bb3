#include "render/core/places.h"

#include <algorithm>
#include <cmath>

namespace render {
OverlaySizes overlay_sizes(int picture_height) {
  const double unit = std::max(picture_height, 0) / 1080.0;
  return {.unit = unit,
          .margin = 44 * unit,
          .large = std::max(29 * unit, 9.0),  // px: smaller text cannot be read
          .small = std::max(21 * unit, 7.5)};
}

double colour_bar_room(int picture_height) {
  constexpr double numbers = 4.2;  // "−12000", in heights of its text
  const OverlaySizes sizes = overlay_sizes(picture_height);
  // margin, tick, gaps on both sides, and the colours, of which small pictures have 6 px
  return sizes.margin + 25 * sizes.unit + std::max(22 * sizes.unit, 6.0) + numbers * sizes.small;
}

bool apart(const Box& a, const Box& b) {
  return a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
}

double clear_of_captions(const glm::dvec2& place) {
  constexpr double right_end = -0.60;   // of captions and scale bar, which begin at the left edge
  constexpr double caption_low = 0.72;  // of time and parameters
  constexpr double bar_high = -0.78;    // of the scale bar and its text
  constexpr double ramp = 0.12, bar_ramp = 0.06;
  const double right = (place.x - right_end) / ramp, below = (caption_low - place.y) / ramp;
  const double above = (place.y - bar_high) / bar_ramp;
  return glm::smoothstep(0.0, 1.0, std::max(right, std::min(below, above)));
}

}  // namespace render
