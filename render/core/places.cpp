#include "render/core/places.h"

#include <algorithm>
#include <cmath>

namespace render {
namespace {

enum class Edge { left, middle, right };  // of the picture

// A rectangle at an edge of the picture, or about the vertical line through its middle.
struct CoveredArea {
  Edge edge;
  double reach;           // from there, half heights of the picture
  double share_of_width;  // reaches farther by this share of half the width
  double low, high;       // heights of its lower and upper side, -1..1
};

CoveredArea area_of(Overlay overlay) {
  switch (overlay) {
    case Overlay::colour_bar:
      return {.edge = Edge::right, .reach = 0.42, .share_of_width = 0, .low = -0.52, .high = 0.68};
    case Overlay::triad:
      return {.edge = Edge::right, .reach = 0.45, .share_of_width = 0, .low = -1, .high = -0.62};
    case Overlay::inset:
      return {.edge = Edge::right, .reach = 0.72, .share_of_width = 0, .low = 0.48, .high = 1};
    case Overlay::profile:
      return {.edge = Edge::left, .reach = 0, .share_of_width = 0.25, .low = -0.72, .high = 0.78};
    case Overlay::title:
      return {.edge = Edge::middle, .reach = 0.8, .share_of_width = 0, .low = 0.80, .high = 1};
    case Overlay::panel:
      break;
  }
  return {.edge = Edge::middle, .reach = 0.35, .share_of_width = 0, .low = -1, .high = -0.80};
}

// Half heights of the picture.
double distance_from(Edge edge, const glm::dvec2& place, double aspect) {
  switch (edge) {
    case Edge::left:
      return (1 + place.x) * aspect;
    case Edge::middle:
      return std::abs(place.x) * aspect;
    case Edge::right:
      break;
  }
  return (1 - place.x) * aspect;
}

}  // namespace

OverlaySizes overlay_sizes(int picture_height) {
  const double unit = std::max(picture_height, 0) / 1080.0;
  return {.unit = unit,
          .margin = 44 * unit,
          .large = std::max(29 * unit, 9.0),  // px: smaller text cannot be read
          .small = std::max(21 * unit, 7.5)};
}

double clear_of(Overlay overlay, const glm::dvec2& place, double aspect) {
  constexpr double ramp = 0.10;  // half heights
  const CoveredArea area = area_of(overlay);
  const double aside = distance_from(area.edge, place, aspect) - (area.reach + area.share_of_width * aspect);
  return glm::smoothstep(0.0, 1.0, std::max({aside, area.low - place.y, place.y - area.high}) / ramp);
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
