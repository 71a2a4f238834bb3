// Sums over pairs of points beside the mesh: the residual part within the cut-off, and the smooth part that the mesh
// has put in where it does not belong.
#pragma once

#include "sim/fast/pair_lists.h"

namespace sim {

/// Adds the residual part and subtracts the smooth one of what is not seen. Strengths of coarse and of fine points;
/// those of a body that has or needs none may be empty. `dual`: some have double layers, be it on another rank.
void add_pairs(const PairLists&, const KernelSplit&, bool dual, std::span<const FastStrengths> coarse,
               std::span<const FastStrengths> fine, std::vector<Points>& velocity);

}  // namespace sim
