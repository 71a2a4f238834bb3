// The plots that a movie shows beside its views: view.plots.
#pragma once

#include "app/figures/series.h"
#include "app/pictures/plot_strip.h"

namespace app {

/// Nothing unless the first source's view asks for plots. Every source has its curves in them. Throws
/// std::invalid_argument with one sentence when the picture is too small.
std::optional<PlotStrip> movie_plots(const std::vector<FigureSource>&);

}  // namespace app
