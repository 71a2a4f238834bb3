// The drawing functions behind the rows of the figure catalogue.
#pragma once

#include "figure.h"

namespace render {

Figure draw_cross_sections(const FigureInput& input);
Figure draw_overlay(const FigureInput& input);
Figure draw_inclination(const FigureInput& input);
Figure draw_time_series(const FigureInput& input);

}  // namespace render
