// Stokes single and double layer (4), (5) of one vesicle on itself, as dense Galerkin matrices (31), (32).
//
// Each target on the q-grid, q = p + 1, becomes the pole of a rotated source grid, where the Graham-Sloan weights
//   w_k pi/(s+1) [sum_{n<=s} P_n(cos t_k)] 2 sin(t_k/2)/sin(t_k)
// integrate the weakly singular kernels spectrally. Positions and normals at the sources are synthesised from the
// rotated coefficients. The kernel is analysed in the rotated basis and rotated back, so that one row of the operator
// acts on coefficients; the rows are then projected on the target harmonics. Every step is a separable product:
// O(p^5) in total. The double layer has the corrected sign, +3/(4 pi) (r.n)(r r^T)/|r|^5 with r = x - y, and no
// factor (1 - lambda).
#pragma once

#include "sim/core/lanes.h"
#include "sim/core/raw_memory.h"
#include "sim/sphere/basis.h"

#include <memory>

namespace sim {

/// The six distinct blocks xx, xy, xz, yy, yz, zz of a symmetric tensor kernel: each row-major (p+1)^2 x stride.
struct LayerMatrix {
  int order = -1;                                         ///< p; -1: not assembled
  int stride = 0;                                         ///< doubles from one row of a block to the next
  RawVector<double> values;                               ///< [row][block][column], blocks padded to `stride` columns
  Coefficients apply(const Coefficients& density) const;  ///< 3 fields in, 3 fields out
};

struct LayerMatrices {
  LayerMatrix single;  ///< S of (4) with mu = 1
  LayerMatrix dual;    ///< D of (5) without (1 - lambda); assembled only on request
};

/// Plan: degree p, source grid order s (p + 1 by default, more for accuracy).
class LayerPotentials {
 public:
  explicit LayerPotentials(int order, int source_order = 0, LaneCount = LaneCount::widest);
  ~LayerPotentials();
  LayerPotentials(LayerPotentials&&) noexcept;
  LayerPotentials(const LayerPotentials&) = delete;

  int order() const;
  int source_order() const;
  /// Position: 3 fields of degree <= p. The result does not depend on the number of threads.
  LayerMatrices assemble(const Coefficients& position, bool with_double) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace sim
