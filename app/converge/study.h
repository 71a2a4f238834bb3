// A study of convergence: runs of one scene at several tolerances, steps or orders, and what their results say; as
// tables, as CSV and as a figure.
#pragma once

#include "app/converge/sequence.h"
#include "app/converge/values.h"
#include "app/converge/variation.h"
#include "app/tables/text_table.h"

#include "render/figures/figure.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// Seconds of the runs that were made now.
struct RunTime {
  double wall = 0, cpu = 0;  ///< cpu: of all threads
};

struct StudyRun {
  double value = 0;  ///< of what is varied
  Settings settings;
  std::filesystem::path file;        ///< its trajectory
  std::optional<RunTime> seconds{};  ///< nothing: the trajectory was there
  std::int64_t steps = 0;
  double rejected = 0, iterations = 0;  ///< iterations: mean of a step
  double stated = 0;                    ///< error of position by what is varied, R0: sim::stated_errors
  double residual = 0;                  ///< largest of the linear solves, relative
};

struct StudyRow {
  ResultValues result;
  Convergence convergence;
};

struct Study {
  const VariationRow& what;
  Settings scene;                  ///< as it is given
  std::optional<std::size_t> own;  ///< the run with the scene's own value
  std::vector<StudyRun> runs;      ///< the most accurate comes last
  std::vector<StudyRow> rows;
  Convergence shapes;                 ///< of the distance of the final shapes, largest of all vesicles, R0
  std::vector<std::string> findings;  ///< sentences
};

/// Reads the trajectories of the runs, two at least, and evaluates.
Study study_of(const VariationRow&, const Settings& scene, std::optional<double> own, std::vector<StudyRun> runs,
               const std::vector<AskedResult>&);

/// Runs and their cost (seconds differ from call to call: not for files), values with their limits, errors.
std::vector<TextTable> tables_of(const Study&, bool with_seconds);
/// A row for each result and run; before them lines that begin with "# ": program and resolved scene.
std::string csv_of(const Study&);
/// Errors against what is varied, logarithmic: a panel a quantity, with the order that theory gives as a dashed line.
render::Figure figure_of(const Study&, const render::FigureParameters&);
/// A page: command, tables, figure, findings, resolved scene.
std::string page_of(const Study&, const std::string& command, const std::string& picture);

}  // namespace app
