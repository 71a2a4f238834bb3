// What the runs of a sweep come to, as a table: a row a run and vesicle.
#pragma once

#include "app/converge/values.h"
#include "app/sweep/runs.h"
#include "app/tables/text_table.h"

#include <optional>

namespace app {

/// Final measures of a run; the trajectory is read once.
struct SweepRow {
  std::vector<std::string> values;  ///< of the axes
  int vesicle = 0, vesicles = 1;
  std::string motion;
  std::vector<double> measures;  ///< of visit(VesicleMotion), then of the run's statement
  std::vector<double> asked;     ///< one a result
  RunOutcome outcome;
};
struct SweepTable {
  std::vector<std::string> axes, short_axes;  ///< names of columns
  std::vector<std::string> measures;          ///< names of SweepRow::measures
  std::vector<std::string> asked;             ///< names of SweepRow::asked
  std::vector<SweepRow> rows;
  std::string why_untold;  ///< of the first motion that is not told
};
/// One outcome a run. Motions are measured in all states, which takes a while: a line of progress unless quiet.
SweepTable table_of(const std::vector<SweepAxis>&, const std::vector<SweepRun>&, const std::vector<RunOutcome>&,
                    const std::vector<AskedResult>&, bool quiet);

/// Everything, all digits.
TextTable full_table(const SweepTable&);
/// The columns that say something, few digits.
TextTable short_table(const SweepTable&);

}  // namespace app
