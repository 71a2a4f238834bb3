// Figures for papers: a catalogue of kinds, each drawn from states of a trajectory, written as PNG, SVG, PDF and CSV.
#pragma once

#include "canvas.h"
#include "parameters.h"

#include "sim/catalogue.h"
#include "sim/types.h"

#include <vector>

namespace render {

/// Quantities against time that others have computed: one curve each, curves of one `axis` share a panel.
struct Series {
  std::string name;  ///< in the legend: "λ = 4"; column header of the CSV
  std::string axis;  ///< label of the panel's y axis: "σR_{0}^{2}/κ_{b}"
  std::vector<double> times, values;
};

struct FigureInput {
  std::vector<sim::State> states;   ///< those to show; see FigureRow::all_states
  std::vector<std::string> labels;  ///< one a vesicle, for the legend; may be empty
  std::vector<Series> series;       ///< read by "time-series" alone
  std::string time_symbol = "t";    ///< "γ̇t", "χt"
  double time_factor = 1;           ///< shown time = this x State::time
  double length = 1;                ///< area radius: lengths are shown in units of it
  std::string length_symbol = "R_{0}";
};

struct Figure {
  Drawing drawing;
  std::string csv;  ///< the same data; first line names columns
};

struct FigureRow {
  std::string_view name;
  std::string_view meaning;
  bool all_states;  ///< true: wants every saved state; false: a few chosen instants
  Figure (*draw)(const FigureInput&);
};
const std::vector<FigureRow>& figures();
/// Throws std::invalid_argument that names the nearest known kind.
const FigureRow& find_figure(std::string_view name);

/// `panels` indices spread evenly over `count` states, first and last among them; or, with times, the nearest states.
std::vector<std::size_t> chosen_states(const std::vector<double>& state_times, const FigureParameters& parameters);

/// stem.png, stem.svg, stem.pdf, stem.csv; returns the four paths. Throws std::runtime_error with path and reason.
std::vector<std::filesystem::path> write_figure(const Figure& figure, const std::filesystem::path& stem);

}  // namespace render
