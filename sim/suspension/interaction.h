// Hydrodynamic interaction: single and double layer of each vesicle, evaluated at the grid points of the others.
//
// All pairs are summed by the smooth rule on coarse source grids, directly (far_field.h) or fast (fast_sum.h),
// whichever costs less. Where that is not good enough, the smooth rule on a finer grid of order q ~ p^(3/2) takes its
// place (section 3.1.10), and nearer than four of its local spacings the near-singular rule of near.h, one row per
// target, assembled once per step. Pairs of this kind are few, and found by cells. The interface is only "velocity at
// targets from densities on sources".
#pragma once

#include "sim/core/ranks.h"
#include "sim/layers/far_field.h"
#include "sim/layers/near.h"
#include "sim/membrane/block.h"
#include "sim/suspension/far_choice.h"

namespace sim {

struct InteractionOptions {
  int source_order = 0;  ///< q of the smooth rule; 0: p^(3/2), rounded up
  bool near_rule = true;
  NearOrder near_order{0, 0};  ///< 0: near_order_for() the tolerance of the far field
  double near_spacings = 4;    ///< targets nearer than this many local spacings use the near rule
  double coarse_spacings = 6;  ///< targets farther than this many spacings of the coarse grid use that grid; 0: none
  FarOptions far = {};
  Division division = {};  ///< of the vesicles, among ranks: each plans and evaluates what its own ones feel
};

/// What one vesicle makes at those targets of another that are excluded from the far field: by the smooth rule on its
/// fine grid (where the far field is summed directly), or by rows.
struct PairPlan {
  int target = 0, source = 0;
  Eigen::Vector3i image = Eigen::Vector3i::Zero();  ///< of the source, in sides of the cell
  Vec3 shift = Vec3::Zero();                        ///< of that image
  std::vector<int> fine, near;
  std::vector<PointRow> rows;
};

/// The far field as a fast sum: vesicles are spread from grids of their own, and fine grids serve within the cut-off.
struct FastInteraction {
  FastSum sum;
  std::vector<const Basis*> spread_basis;
  std::vector<Sources> spread;  ///< of those that this rank needs; their weights
  std::vector<char> finely;     ///< whose fine grid is seen
};

struct Interaction {
  std::vector<const Basis*> source_basis,
      target_basis;                             ///< fine source grids; target grids, which are the coarse source grids
  FarField far;                                 ///< on the coarse grids, which a fast sum does without
  std::shared_ptr<const FastInteraction> fast;  ///< in place of `far`, where it is cheaper
  std::vector<Sources> sources;                 ///< on the fine grids, of those that this rank's vesicles see so; of a
                                                ///< fast sum their weights
  std::vector<PairPlan> pairs;                  ///< of this rank's targets; by target, then source
  std::vector<char> dual;                       ///< per source vesicle: its viscosity contrast differs from 1
  Division division;                            ///< as the options have it
  std::vector<char> felt;                       ///< whose densities this rank needs
  std::vector<std::vector<int>> asked_by;       ///< by rank: this one's vesicles whose densities it needs
  bool none() const { return sources.empty(); }
};

/// None for a single vesicle in unbounded fluid. Throws std::domain_error when a target lies inside another vesicle.
Interaction plan_interaction(Plans&, std::span<const Coefficients> positions, std::span<const Material>,
                             const InteractionOptions&);

/// Velocity that all other vesicles, and in a periodic cell all images, induce on each, projected on its degree;
/// of this rank's vesicles, each rank giving the densities of its own.
std::vector<Coefficients> induced_velocity(const Interaction&, std::vector<Densities>);

}  // namespace sim
