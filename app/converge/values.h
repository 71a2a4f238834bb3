// The results that a study of convergence compares: how they are asked for, and their values in each run.
#pragma once

#include "app/figures/series.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace app {

/// One result: a quantity, a column of `export --csv` or a row of `results()`.
struct AskedResult {
  std::string name;
  std::string reduction = "final";  ///< of a quantity or a column
  std::optional<int> vesicle;       ///< nothing: each
  bool usual = false;               ///< nobody asked for it: left out where it says nothing
};

/// "inclination,energy:largest,vesicle.1.half-turn". Throws std::runtime_error that names the nearest known word.
std::vector<AskedResult> read_results(std::string_view list, const sim::Scene&);
/// What says something of most scenes.
std::vector<AskedResult> usual_results(const sim::Scene&);

/// What may be asked for, for completion.
std::vector<std::string_view> result_names();

/// A result in all runs.
struct ResultValues {
  std::string name;            ///< "vesicle.1.position:largest x_{c}", as it is asked for
  std::string label;           ///< of an axis: "position / R_{0}"
  std::string unit;            ///< "R_{0}"; empty: a pure number, or that of the scene
  std::vector<double> values;  ///< one a run
  bool scaled = true;          ///< free of the units of the scene: of size one, by and large
  bool from_last_run = false;  ///< a distance from the most accurate run
  bool usual = false;
};
/// The most accurate run comes last.
std::vector<ResultValues> values_of(const std::vector<FigureSource>& runs, const std::vector<AskedResult>&);

/// Distance of the final shapes of a run from those of the last one, in R0, of the vesicle that is farthest.
double shape_distance_of(const FigureSource& run, const FigureSource& last);

/// Without the braces of superscripts and subscripts, for terminals and tables.
std::string without_braces(std::string_view);

}  // namespace app
