// Figures of trajectories: collects the states, measures, pictures or flows that a kind of figure needs, and writes
// its four files.
#pragma once

#include "app/base/options.h"
#include "app/figures/series.h"

#include <filesystem>

namespace app {

/// Whether curves of several trajectories share a figure of this kind; otherwise each gets its own figure.
bool takes_several(std::string_view kind);

/// Kinds that show states use only the first source.
render::Figure make_figure(const std::vector<FigureSource>&, const render::FigureParameters&, const Options&);

/// stem.png, .svg, .pdf and .csv, written by `write`; returns their paths.
std::vector<std::filesystem::path> draw_figure(const std::vector<FigureSource>&, const render::FigureParameters&,
                                               const std::filesystem::path& stem, const sim::FileWriter& write,
                                               const Options&);

}  // namespace app
