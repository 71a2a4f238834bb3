// `tanktread export --csv`: one row per saved state and vesicle; `--motion`: one row per vesicle; `--suspension`: one
// row per saved state; `--pairs`: the pair distribution.
#pragma once

#include "sim/core/parameters.h"
#include "sim/trajectory/trajectory.h"

namespace app {

/// Names and meanings of the columns, in order.
struct CsvColumn {
  std::string name, meaning;
};
std::vector<CsvColumn> csv_columns();
std::vector<CsvColumn> motion_columns();
std::vector<CsvColumn> suspension_columns();
std::vector<CsvColumn> pair_columns();

/// Header row and one row per vesicle and saved state from number `first` to `end` - 1; numbers with enough digits to
/// be read back exactly.
std::string csv_text(const sim::TrajectoryReader&, const sim::Scene&, std::int64_t first, std::int64_t end);
/// Header row and one row per saved state: all vesicles together.
std::string suspension_csv(const sim::TrajectoryReader&, const sim::Scene&, std::int64_t first, std::int64_t end);
/// Header row and one row per bin of distances of centres, over these states. Throws std::invalid_argument for a scene
/// without a periodic cell.
std::string pairs_csv(const sim::TrajectoryReader&, const sim::Scene&, std::int64_t first, std::int64_t end);
/// Header row and one row per vesicle: what it does over the whole trajectory.
std::string motion_csv(const sim::TrajectoryReader&, const sim::Scene&);

}  // namespace app
