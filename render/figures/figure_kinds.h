// The drawing functions of the figure catalogue, and their common helpers.
#pragma once

#include "render/figures/figure.h"

namespace render {

Figure draw_cross_sections(const FigureInput& input);
Figure draw_overlay(const FigureInput& input);
Figure draw_snapshots(const FigureInput& input);
Figure draw_streamlines(const FigureInput& input);
Figure draw_time_series(const FigureInput& input);
Figure draw_plots(const FigureInput& input);
Figure draw_phase_diagram(const FigureInput& input);

/// a..z, then aa, ab, ...
std::string letter(std::size_t k);
/// Dark blue, green, orange: early (0) to late (1), distinct in grey too.
Colour colour_of_time(double t);

}  // namespace render
