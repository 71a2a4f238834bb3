// Whether the far field of a suspension is summed directly or fast, and how: from what each costs.
#pragma once

#include "sim/fast/fast_sum.h"
#include "sim/layers/far_field.h"

#include <optional>
#include <string>

namespace sim {

struct FarOptions {
  std::string method = "auto";  ///< as numerics.far_field
  double tolerance = 1e-6;      ///< relative error of the velocities
  CellSides cell = {};          ///< periodic: always fast
};

/// How the fast sum is made: its setting, and the grids from which vesicles are spread on the mesh.
struct FastChoice {
  FastSetting setting;
  int finer = 0;       ///< 0: order p + 1, 1: 3p/2, 2: 2p
  double seconds = 0;  ///< of one core for a product
};
/// Order of the grid that is spread for a vesicle of order p.
int spread_order(int p, int finer);
/// Targets nearer than so many spacings of the spread grid see the fine one.
double coarse_limit(double tolerance);

/// The cheapest fast sum for surfaces of these orders, if it is cheaper than the direct one or `always`. `coarse`: the
/// grids of the targets.
std::optional<FastChoice> choose_fast(std::span<const int> orders, std::span<const Sources> coarse,
                                      std::span<const Sources> fine, bool dual, const FarOptions&);

}  // namespace sim
