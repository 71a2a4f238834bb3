// The ground behind everything, and the colours of what is written on it. sRGB, 0..1.
#pragma once

#include "render/core/palette.h"

#include <string_view>
#include <vector>

namespace render {

/// A vertical gradient from top to bottom, or nothing.
struct Ground {
  Colour top = white, bottom = white;
  bool transparent = false;
  /// Darker than middle grey: text, contours and arrows on it are light.
  bool dark() const;
  /// In one colour, for pages.
  Colour mean() const { return {(top.r + bottom.r) / 2, (top.g + bottom.g) / 2, (top.b + bottom.b) / 2}; }
};
/// "gradient", "white", "dark", "transparent" or "#rrggbb". Throws std::invalid_argument with one sentence that names
/// the nearest of them and of `other` words, which only the caller knows.
Ground ground_of(std::string_view background, std::vector<std::string_view> other = {});

/// What is written and drawn over a picture.
struct Inks {
  Colour text = ink;       ///< and frames of overlays
  Colour soft = soft_ink;  ///< captions
  Colour note = note_ink;  ///< remarks
  Colour rim = white;      ///< soft, round text that lies on a vesicle
  Colour arrow = arrow_colour;
  Colour flow_line = flow_line_colour;
  Colour paper = white;  ///< of boxes
  bool rimmed = false;   ///< lines have the rim, too: nobody knows what will lie behind them
};
Inks inks_on(const Ground& ground);

}  // namespace render
