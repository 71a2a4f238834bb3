// The plan of a movie or a still: what all frames share, measured in one pass over each trajectory.
#pragma once

#include "app/pictures/panel.h"
#include "app/pictures/plot_strip.h"

#include <optional>
#include <string>
#include <vector>

namespace app {

struct Production {
  std::vector<ViewPanel> panels;  ///< row by row
  int columns = 1, rows = 1;
  int width = 0, height = 0;              ///< of the whole picture
  int views_width = 0, views_height = 0;  ///< of what the panels fill: all of it, but for the plots
  std::optional<PlotStrip> plots = {};
  std::string hash;  ///< of everything that a picture depends on except its time
};

/// Passes over each trajectory once. Several sources are drawn side by side, with one row per source if there are
/// several views; size and style of the whole are those of the first. `still`: the time of the only picture. Throws
/// std::invalid_argument with one sentence when nothing would be visible.
Production prepare_pictures(const std::vector<PictureSource>& sources, std::optional<double> still = {},
                            std::optional<PlotStrip> plots = {});

}  // namespace app
