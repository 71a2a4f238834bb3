// A run that starts in a saved state of another one: shapes, places and material labels are taken over, the past is
// not, so the first steps are those of a start. Its time begins at 0; what a cell leans by is taken along as a strain
// (cell.h). The run is then one by itself: its first state is in its own file, and the other file is not needed again.
#pragma once

#include "sim/core/ranks.h"
#include "sim/layers/plans.h"
#include "sim/membrane/cell.h"

#include <optional>
#include <span>
#include <string>

namespace sim {

struct SavedStart {
  State state;
  std::string checksum;
};
/// The state that is meant, read with all checks of a trajectory. Throws std::runtime_error that names the file where
/// there is no such state, or its checksum is another than the parameters give.
SavedStart read_start(const StartParameters&);
/// The state of a scene with start.from; none without. The first rank reads, all get it.
std::optional<State> start_state(const Scene&, const Ranks&);

/// Of shapes, places and labels, 16 hexadecimal digits: tells that a state is another one.
std::string state_checksum(const State&);

/// Why the vesicles of a scene are not those of a state: another number, or other sizes than the shapes of the scene
/// have. Shapes from tables are compared where the scene says their size; tables are not read.
std::optional<SceneObjection> start_objection(Plans&, const Scene&, const State&);

/// What degrees above an order hold of a surface, root of the mean square over the parameter sphere, in area radii of
/// a vesicle as large as its mean extent.
double cut_off(const Coefficients& position, int order);
/// More is not cut off.
inline constexpr double most_cut_off = 0.02;
/// That positions have lost something to lower orders than those of the state; empty where they have not.
std::string cut_warning(const Scene&, const State&, std::span<const Coefficients> positions);

}  // namespace sim
