// Closest approach of the membranes of a suspension.
#pragma once

#include "sim/layers/near.h"
#include "sim/layers/plans.h"

#include <span>
#include <vector>

namespace sim {

struct Gap {
  double distance = 0;
  int first = -1, second = -1;  ///< the two vesicles
  bool crossing = false;        ///< they overlap
};
/// Over all pairs; infinite for a single vesicle. Overlap is found by the solid angle of each surface at the points of
/// the other, so a vesicle wholly inside another is found too.
Gap smallest_gap(Plans&, std::span<const Coefficients> positions);

/// From every vesicle to the nearest other; where that is farther than `reach`, any value above it, also infinity.
std::vector<double> gaps_to_neighbours(Plans&, std::span<const Coefficients> positions, double reach);

}  // namespace sim
