// Panels of curves that are made from trajectories or states.
#pragma once

#include "app/figures/series.h"

namespace app {

/// One quantity against another, a curve a trajectory, with a dot where each begins.
std::vector<render::Plot> phase_plots(const std::vector<FigureSource>&, const render::FigureParameters&);

/// Spectra of position and curvature, a curve for each of input.states.
std::vector<render::Plot> spectra_plots(const render::FigureInput& input);

/// Angles and frequencies of tank-treading at the end of each trajectory. Throws std::runtime_error where the flow is
/// no steady shear, or a vesicle swings or tumbles; tells of runs that are too short.
std::vector<render::Plot> steady_plots(const std::vector<FigureSource>&);

/// Pair distributions over distances in area radii, a curve a trajectory with its error as a band, and a line at 1:
/// means over the states from p.from on, else those of the last third of the run. Throws std::runtime_error for scenes
/// without a cell or with a single vesicle, and std::invalid_argument where a run ends before p.from.
std::vector<render::Plot> pair_plots(const std::vector<FigureSource>&, const render::FigureParameters& p);

}  // namespace app
