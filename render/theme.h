// How figures look: sizes of text and lines, colours of ground and ink, the usual size of a page. A catalogue.
#pragma once

#include "palette.h"

#include "sim/catalogue.h"

namespace render {

struct Theme {
  std::string_view name;
  std::string_view meaning;
  double text = 9;            ///< numbers at ticks, legends; pt
  double label = 10.5;        ///< names of axes, titles of panels; pt
  double line = 0.9;          ///< frame and ticks; pt
  double stroke = 1.6;        ///< curves; pt
  double tick = 4.5;          ///< length; pt
  double width = 510;         ///< of a page that is filled from side to side, pt
  double height = 0;          ///< of a page; 0: as high as it comes
  Colour ground = white;
  Colour ink{0.10, 0.10, 0.12};
  Colour soft{0.42, 0.44, 0.48};   ///< what stands back: references, frames of pictures
  Colour faint{0.90, 0.91, 0.92};  ///< grids
};
const std::vector<Theme>& themes();
/// Throws std::invalid_argument that names the nearest known theme. font_size: of `text`, in points; everything but the page
/// follows it; 0: the theme's own.
Theme find_theme(std::string_view name, double font_size = 0);

/// Colours of curves: those of the palette, lightened on a dark ground.
Colour on_ground(const Theme& theme, const Colour& colour);
Colour curve_colour(const Theme& theme, std::size_t curve);
/// Of the outline of a vesicle: the hue that its body has in pictures.
Colour vesicle_colour(const Theme& theme, std::size_t vesicle);

}  // namespace render
