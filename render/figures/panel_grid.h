// Panels of curves on one page: side by side, or below each other with a common axis of time. All texts are measured
// before anything is placed: one legend for all panels stands above them, or in a single panel where no curve runs.
#pragma once

#include "render/figures/figure.h"

namespace render {

/// A panel with everything that is drawn in it and round it.
struct PlacedPlot {
  Plot plot;
  Panel panel;
  Axes axes;
  std::string letter;  ///< above the upper left corner
  LaidLegend key;      ///< of the parts, beside the letter
};
struct PlacedPlots {
  Theme theme;
  std::vector<PlacedPlot> plots;
  LaidLegend legend;
  Eigen::Vector2d legend_at{0, 0};
  double width = 0, height = 0;  ///< of the page, pt
};
/// Panels row by row on the page. stacked: they share their axis of x, which is numbered under the lowest of each
/// column. letters: "(a)", "(b)" above panels, where there are several. Text is made smaller where the page is too
/// small for it. At least one plot.
PlacedPlots placed_plots(const FigureParameters& parameters, const Page& page, const std::vector<Plot>& plots,
                         bool stacked, bool letters = true);
void draw_plots(const Pen& pen, const PlacedPlots& placed);

/// A line at an abscissa in each panel, and dots where it meets curves.
void draw_instant(const Pen& pen, const PlacedPlots& placed, double x);

/// Panels of quantities against time: an axis each, groups of curves told apart by colours and marks.
std::vector<Plot> plots_against_time(const std::vector<Series>& series, const std::string& time_symbol);

/// The same as a figure on the page of the input. csv: the data of the figure, as it is.
Figure arranged(const FigureInput& input, const std::vector<Plot>& plots, bool stacked, std::string csv);

}  // namespace render
