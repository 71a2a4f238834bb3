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

/// A grid of sources as a whole.
struct Outline {
  Box box;
  double spacing = 0;  ///< largest
};
Outline outline_of(const Sources&);
/// Points of a grid of sources of an order.
constexpr double grid_points(int order) { return 2.0 * (order + 1) * (order + 1); }

/// The surfaces of a suspension as the choice sees them.
struct SurfaceCrowd {
  std::span<const int> orders;
  std::span<const Outline> coarse;        ///< of the grids of the targets, of order p + 1
  double fine_points = 0;                 ///< of the fine grids of all
  bool dual = false;                      ///< some viscosity contrasts differ from 1
  std::span<const Sources> sources = {};  ///< the grids of the targets; not asked for in a cell
};
/// The cheapest fast sum, if it is cheaper than the direct one or `always`.
std::optional<FastChoice> choose_fast(const SurfaceCrowd&, const FarOptions&);

}  // namespace sim
