#include "app/pictures/plot_strip.h"

#include <algorithm>

namespace app {

void add_plots(render::Image& picture, const PlotStrip& strip, const render::Font& font, double time) {
  render::Image plots = strip.ground;
  render::draw_on(plots, {0, 0, plots.width, plots.height}, [&](cairo_t* cairo) {
    cairo_scale(cairo, strip.pixels, strip.pixels);
    render::draw_instant({cairo, font, strip.placed.theme}, strip.placed, strip.time_factor * time);
  });
  for (int y = 0; y < plots.height; ++y)
    for (int x = 0; x < plots.width; ++x) {
      std::uint8_t* p = picture.at(strip.place.x + x, strip.place.y + y);
      std::copy_n(plots.at(x, y), 3, p);
      if (picture.channels == 4) p[3] = 255;  // views may have no ground
    }
}

}  // namespace app
