// Material labels and tracer dots, by which pictures show the motion of the membrane itself. A label is the point of
// the unit sphere where the material point started. As long as grid points move with the fluid, the label of a
// parameter does not change; a relabelling transports the field. In steady tank-treading the labels wind up; when
// their degree no longer resolves them they are reset, L(s) = s, and the state records when.
#pragma once

#include "sim/surface/reparametrize.h"

namespace sim {

/// L(s) = s in the given degree.
Coefficients fresh_labels(int order);

/// True when the last quarter of the label spectrum contains more than 2 % of it.
bool labels_wound_up(const Coefficients& labels);

/// The 14 dots of every vesicle, in fixed order: +-x, +-y, +-z, then the corners (x slowest, + before -): 14 x 3.
Matrix tracer_directions();

}  // namespace sim
