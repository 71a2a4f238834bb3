// The data of a phase diagram: motions of trajectories over two parameters in which their scenes differ.
#pragma once

#include "app/figures/series.h"

namespace app {

/// The first vesicle of each trajectory. Throws std::invalid_argument when the two parameters are not given and cannot
/// be found.
render::Diagram phase_diagram(const std::vector<FigureSource>&, const render::FigureParameters&);

}  // namespace app
