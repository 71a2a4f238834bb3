// Where everything that lies over a picture stands: boxes measured from the texts, none of which meets another.
#pragma once

#include "render/core/places.h"
#include "render/image/text.h"
#include "render/scene/frame.h"

#include <optional>
#include <string>
#include <vector>

namespace render {

/// A line of text with its baseline at box.bottom - 0.24 size.
struct TextPlace {
  enum class Role { time, parameters, errors, note, title, panel };
  Role role;
  std::string text;  ///< shortened where there is no room for all of it
  double size;
  Box box;
};

/// What is shown of a frame, and where. What has no room at all is left out.
struct OverlayLayout {
  std::vector<TextPlace> texts;
  std::optional<Box> scale_bar;   ///< with its text
  double scale_length = 0;        ///< px
  std::optional<Box> colour_bar;  ///< with its label, ends and numbers
  Box bar;                        ///< its colours alone
  std::optional<Box> inset;
  std::optional<Box> profile;  ///< with its name
  double profile_reach = 0;    ///< of it, shown above and below the middle; share of half the picture's height
  std::optional<Box> triad;
  double triad_length = 0;  ///< of an axis, px

  /// All of them.
  std::vector<Box> boxes() const;
};
OverlayLayout lay_out(const Frame& frame, const Font& font);

/// Whether `place` (-1..1 from left to right and from bottom to top, as Camera::picture_place() gives it) is clear of
/// the boxes: 0 in one, 1 away from all, smooth in between. size: of the picture, px.
double clear_of(const std::vector<Box>& boxes, const glm::dvec2& place, const std::vector<int>& size);

}  // namespace render
