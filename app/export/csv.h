// `tanktread export --csv`: one row per saved state and vesicle.
#pragma once

#include "sim/trajectory/trajectory.h"

namespace app {

/// Names and meanings of the columns, in order.
struct CsvColumn {
  std::string name, meaning;
};
std::vector<CsvColumn> csv_columns();

/// Header row and one row per vesicle and saved state from number `first` to `end` - 1; numbers with enough digits to
/// be read back exactly.
std::string csv_text(const sim::TrajectoryReader&, std::int64_t first, std::int64_t end);

}  // namespace app
