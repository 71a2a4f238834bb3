// The smooth part of the kernels of one body at points of any distance: what the mesh has put in for it.
#pragma once

#include "sim/fast/kernel_split.h"
#include "sim/fast/pair_lists.h"

namespace sim {

/// Takes it from the velocities at the targets; lengths in units of the cut-off. A target's value does not depend on
/// the others.
void subtract_smooth(const KernelSplit&, const Points& sources, const FastStrengths&, const Points& targets,
                     Points& velocity);

}  // namespace sim
