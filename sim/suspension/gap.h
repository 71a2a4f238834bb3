// Closest approach of the membranes of a suspension; in a periodic cell, also of their images, one's own included.
#pragma once

#include "sim/core/cells.h"
#include "sim/core/ranks.h"
#include "sim/layers/far_field.h"
#include "sim/layers/near.h"
#include "sim/layers/plans.h"

#include <span>
#include <string>
#include <vector>

namespace sim {

struct Gap {
  double distance = 0;
  int first = -1, second = -1;  ///< the two vesicles; twice the same: a vesicle and an image of its own
  bool crossing = false;        ///< they overlap
};
/// "vesicles 0 and 3", "vesicle 2 and its own image".
std::string pair_name(const Gap&);
/// Over all pairs; infinite for a single vesicle in unbounded fluid. Overlap is found by the solid angle of each
/// surface at the points of the other, so a vesicle wholly inside another is found too.
/// Ranks divide the pairs.
Gap smallest_gap(Plans&, std::span<const Coefficients> positions, const CellSides& = {}, const Ranks& = alone);

/// Of two alone, in one thread: for many small searches, where threads would wait for one another.
Gap gap_of_two(Plans&, const Coefficients& first, const Coefficients& second);

/// From every vesicle to the nearest other; where that is farther than `reach`, any value above it, also infinity.
std::vector<double> gaps_to_neighbours(Plans&, std::span<const Coefficients> positions, double reach,
                                       const CellSides& = {}, const Ranks& = alone);

/// Solid angle of a surface at x over 4 pi: 1 inside, 0 outside; by the smooth rule, so right to about one half near
/// it.
double winding(const Sources&, const Vec3& x);

}  // namespace sim
