// Plots against time beside the views of a picture, with a mark at the time of each frame.
#pragma once

#include "render/figures/panel_grid.h"
#include "render/image/picture_canvas.h"

namespace app {

/// What all frames share; made by app/figures/movie_plots.h.
struct PlotStrip {
  render::Rectangle place{};  ///< in the whole picture, px
  int views_width = 0;        ///< what is left for the views, px
  int views_height = 0;
  render::PlacedPlots placed = {};
  double pixels = 1;          ///< of a point
  double time_factor = 1;     ///< shown time = this x time
  render::Image ground = {};  ///< the plots without a mark
};

/// Pastes the plots of this time beside the views.
void add_plots(render::Image& picture, const PlotStrip&, const render::Font&, double time);

}  // namespace app
