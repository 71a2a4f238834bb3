// Styles: how a membrane is painted. One row per style; each becomes a variant of the shader body.frag.
#pragma once

#include "render/core/palette.h"
#include "render/core/parameters.h"

#include "sim/core/catalogue.h"

namespace render {

struct StyleRow {
  std::string_view name;
  std::string_view meaning;
  std::string_view defines;  ///< macros of body.frag, separated by spaces
  bool grid;                 ///< lines on the membrane
  bool tracers;              ///< dots, when the view enables them
  bool own_colour;           ///< the vesicle's colour; otherwise the ground's
  bool see_through = false;  ///< drawn in order of depth, back faces too
  bool field = false;        ///< painted by Mesh::scalar on Frame::legend
  bool cut = false;          ///< opened by Body::cut
  bool occluded = false;     ///< hollows and neighbours darken it
};
const std::vector<StyleRow>& styles();
/// Throws std::invalid_argument that names the nearest known style.
const StyleRow& find_style(std::string_view name);

/// Dots on the lower half of a colour map that is symmetric in lightness, to keep the sign visible in grey.
struct SignDots {
  static constexpr double spacing = 11;   ///< px at a height of 1080
  static constexpr double least = 6.5;    ///< px
  static constexpr double radius = 0.25;  ///< of the spacing, when full
  static constexpr double full = 0.05;    ///< as far below the middle, share of the map; smaller toward the middle
};
/// Pixels, for a picture of this height in pixels.
double sign_dot_spacing(int height);
/// On this colour of the map, sRGB; body.frag does the same.
Colour sign_dot_colour(const Colour& under);

/// The #define lines of body.frag for this view; `sparse`: lines that fade to a few, `sign_dots` on a field.
std::string body_defines(const StyleRow& style, const ViewParameters& view, bool grid, bool sparse, bool tracers,
                         bool sign_dots = false, bool occluded = false);

}  // namespace render
