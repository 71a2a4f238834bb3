// Themes of figures: sizes of text and lines, colours of background and ink, default page size. A catalogue.
#pragma once

#include "render/core/palette.h"
#include "render/image/text.h"

#include "sim/core/catalogue.h"

namespace render {

struct Theme {
  std::string_view name;
  std::string_view meaning;
  double text = 9;      ///< numbers at ticks, legends; pt
  double label = 10.5;  ///< names of axes, titles of panels; pt
  double line = 0.9;    ///< frame and ticks; pt
  double stroke = 1.6;  ///< curves; pt
  double tick = 4.5;    ///< length; pt
  double width = 510;   ///< of a full-width page, pt
  double height = 0;    ///< of a page; 0: follows the content
  Colour ground = white;
  Colour ink{0.10, 0.10, 0.12};
  Colour soft{0.42, 0.44, 0.48};   ///< secondary elements: references, frames of pictures
  Colour faint{0.90, 0.91, 0.92};  ///< grids
  bool transparent = false;        ///< the ground is not painted
  FontFamily family = FontFamily::sans;

  bool is_dark() const { return ground.g < 0.5; }
};
const std::vector<Theme>& themes();
/// Throws std::invalid_argument that names the nearest known theme. font_size: of `text`, in points; everything but
/// the page scales with it; 0: the theme's own.
Theme find_theme(std::string_view name, double font_size = 0);
/// Text and lines times the factor.
Theme scaled(Theme theme, double factor);
/// The same on another ground: "theme" (its own) or one of ground_of(), a gradient as its mean; ink and colours follow.
/// Throws std::invalid_argument for another word.
Theme on_ground_named(Theme theme, std::string_view ground);

/// Colours of curves: those of the palette, lightened on a dark ground.
Colour on_ground(const Theme& theme, const Colour& colour);
Colour curve_colour(const Theme& theme, std::size_t curve);
/// Of the outline of a vesicle: the hue of its body in pictures.
Colour vesicle_colour(const Theme& theme, std::size_t vesicle);

}  // namespace render
