// Hydrodynamic interaction: single and double layer of each vesicle, evaluated at the grid points of the others.
//
// Far targets: smooth quadrature on a source grid of order q ~ p^(3/2) (section 3.1.10), summed directly. Targets
// nearer than four local source spacings: the near-singular rule of near.h, one row per target, assembled once per
// step. Targets far enough from the coarser (p+1)-grid use that grid instead: in a suspension nearly all pairs do.
// The interface is only "velocity at targets from densities on sources".
#pragma once

#include "membrane.h"
#include "near.h"

namespace sim {

struct InteractionOptions {
  int source_order = 0;      ///< q of the smooth rule; 0: p^(3/2), rounded up
  bool near_rule = true;
  NearOrder near_order;
  double near_spacings = 4;  ///< targets nearer than this many local spacings use the near rule
  double coarse_spacings = 6;  ///< targets farther than this many spacings of the coarse grid use that grid; 0: none
};

/// Densities on one vesicle, degree p: force for the single layer, (1 - lambda) u minus its rigid part for the double
/// layer.
struct Densities {
  Coefficients force, dual;
};

/// A surface as the interaction sees it.
struct Sources {
  Matrix points, normals;   ///< points x 3; normals weighted by dA
  Vector area;              ///< dA
  Vector spacing;           ///< local distance of neighbouring source points
  Vec3 low, high;           ///< bounding box
};

Sources make_sources(const Basis&, const Coefficients& position);

/// Index of the source point nearest to x, and its distance.
std::pair<Eigen::Index, double> nearest_source(const Sources&, const Vec3& x);

/// Targets of vesicle i that use the smooth rule for vesicle j, on its coarse or fine source grid, and those that
/// need rows, with the nearest point of j for each of these.
struct PairPlan {
  std::vector<int> coarse, fine;
  std::vector<int> near;
  std::vector<PointRow> rows;
  std::vector<NearestPoint> nearest;
};

struct Interaction {
  std::vector<const Basis*> source_basis, target_basis;  ///< the target grid is the coarse source grid
  std::vector<Sources> sources, coarse_sources;
  std::vector<Matrix> targets;                ///< points x 3
  std::vector<std::vector<PairPlan>> pairs;   ///< [target vesicle][source vesicle]
  std::vector<char> dual;                     ///< per source vesicle: its viscosity contrast differs from 1
};

/// Throws std::domain_error when a target lies inside another vesicle.
Interaction plan_interaction(Plans&, std::span<const Coefficients> positions, std::span<const Material>,
                             const InteractionOptions&);

/// Velocity that all other vesicles induce on each, projected on its degree.
std::vector<Coefficients> induced_velocity(const Interaction&, std::span<const Densities>);

/// Optional short-range repulsion: traction strength exp(-gap/range) on the points of each vesicle that are near
/// another, away from its nearest point. Force densities as coefficients of degree p; zero beyond the range of the
/// near rule (four spacings of its source grid), and when that rule is off.
std::vector<Coefficients> repulsion(const Interaction&, double strength, double range);

/// Sum of the two kernels over one surface at points (count x 3), added to `velocity`: S with 1/(8 pi), D with
/// +3/(4 pi). Densities are samples at the source points. Smooth rule only.
void add_direct_sum(const Sources&, const Matrix& force, const Matrix* dual, const Matrix& points, Matrix& velocity);

/// Closest approach of two surfaces.
struct Gap {
  double distance = 0;
  int first = -1, second = -1;  ///< the two vesicles
  bool crossing = false;        ///< they overlap
};
/// Over all pairs; infinite for a single vesicle. Overlap is detected by the solid angle of each surface at the
/// points of the other, so it includes a vesicle entirely inside another.
Gap smallest_gap(Plans&, std::span<const Coefficients> positions);

}  // namespace sim
