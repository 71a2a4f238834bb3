// Places of a picture: how large captions and the other overlays are, and what is left for bodies. A place is a pair
// -1..1, from left to right and from bottom to top, as Camera::picture_place() gives it.
#pragma once

#include "render/core/vectors.h"

namespace render {

/// Share of the picture that bodies may take; captions get the rest.
inline constexpr double bodies_width = 0.86, bodies_height = 0.74;
inline constexpr double bodies_width_beside_profile = 0.74;

/// Lengths of captions and annotations, px.
struct OverlaySizes {
  double unit;    ///< a 1080th of the picture's height
  double margin;  ///< from the edges of the picture to the captions
  double large;   ///< text of the time and the title
  double small;   ///< other text
};
OverlaySizes overlay_sizes(int picture_height);
/// What a colour bar with its numbers takes at the right edge, px.
double colour_bar_room(int picture_height);

/// The box of the inset: height as a share of the picture's, width relative to its height.
inline constexpr double inset_height = 0.21, inset_aspect = 1.35;
/// The colours of the colour bar: upper end and height, shares of the picture's height.
inline constexpr double colour_bar_top = 0.295, colour_bar_height = 0.44;
/// The profile of the background flow: width as a share of the picture's; the vertical line that it shows reaches so
/// far above and below the middle, as a share of half the picture's height.
inline constexpr double profile_width = 0.085, profile_reach = 0.62;

/// Of a picture, pixels, y downward.
struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};
/// They have no point in common.
bool apart(const Box& a, const Box& b);

/// 0 where time, parameters and scale bar usually are, 1 elsewhere, smooth in between: for what is laid before the
/// texts are known.
double clear_of_captions(const glm::dvec2& place);

}  // namespace render
