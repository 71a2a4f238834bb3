// Figures of trajectories: gathers the states and measures that a kind of figure asks for and writes its four files.
#pragma once

#include "settings.h"

#include "sim/trajectory.h"

#include <filesystem>

namespace app {

/// One trajectory as the source of a figure.
struct FigureSource {
  const sim::TrajectoryReader& trajectory;
  const Settings& settings;
  std::string name;  ///< in the legend when there are several; else empty
};

/// Writes stem.png, .svg, .pdf and .csv and returns their paths. Kinds that show states take the first source only.
std::vector<std::filesystem::path> draw_figure(const std::vector<FigureSource>&, const render::FigureParameters&,
                                               const std::filesystem::path& stem);

}  // namespace app
