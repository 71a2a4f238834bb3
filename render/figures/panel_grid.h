// Panels of curves on one page: side by side, or below each other with a common axis of time.
#pragma once

#include "render/figures/figure.h"

namespace render {

/// Panels row by row on the page of the input. stacked: they share their axis of x, which is numbered under the lowest
/// of each column. csv: the data of the figure, as it is. At least one plot.
Figure arranged(const FigureInput& input, std::vector<Plot> plots, bool stacked, std::string csv);

}  // namespace render
