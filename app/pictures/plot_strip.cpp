#include "app/pictures/plot_strip.h"

#include "render/overlay/panels.h"

namespace app {

void add_plots(render::Image& picture, const PlotStrip& strip, double time) {
  render::Image plots = strip.ground;
  const render::Font font(render::Font::Use::paths, strip.placed.theme.family, true);
  render::draw_on(plots, {0, 0, plots.width, plots.height}, [&](cairo_t* cairo) {
    cairo_scale(cairo, strip.pixels, strip.pixels);
    render::draw_instant({cairo, font, strip.placed.theme}, strip.placed, strip.time_factor * time);
  });
  render::paste(picture, plots, strip.place.x, strip.place.y);
}

}  // namespace app
