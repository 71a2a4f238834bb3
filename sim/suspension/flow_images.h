// The flow of all images of the membranes in a periodic cell: a smooth part on a mesh, made once for an instant, and by
// image what is missing near it. The sum is that of fast_sum.h, here for few points at a time.
#pragma once

#include "sim/fast/smooth_sum.h"
#include "sim/layers/far_field.h"
#include "sim/layers/plans.h"

namespace sim {

/// The grid from which one membrane is spread on the mesh.
struct SpreadSurface {
  Sources sources;
  SourceDensities densities;
  Points points;            ///< in units of the cut-off
  FastStrengths strengths;  ///< likewise
};

struct FlowImages {
  Eigen::Matrix3d sides;
  double cutoff;        ///< farther from a membrane the mesh has all of it
  double spread_limit;  ///< distance, in spacings, from which a spread grid is fine enough for the whole kernel
  std::shared_ptr<const KernelSplit> split;
  std::shared_ptr<const Mesh> mesh;
  MeshVelocity smooth;
  std::vector<SpreadSurface> spread;
};

/// For surfaces with densities (force, and for some the double layer) given by coefficients; `tolerance`: relative
/// error of the velocities.
FlowImages flow_images(Plans&, std::span<const Coefficients> positions, std::span<const Coefficients* const> forces,
                       std::span<const Coefficients* const> duals, const Eigen::Matrix3d& sides, double tolerance);

/// Of all images at points, count x 3: the smooth part.
Matrix smooth_velocity(const FlowImages&, const Matrix& points);
/// Takes the smooth part of one image from the velocities at points, which are given from where its vesicle is.
void take_smooth(const FlowImages&, int surface, const Matrix& points, Matrix& velocity);

/// Lattice vectors that bring the box of a surface nearer than `reach` to some other box.
std::vector<Vec3> near_shifts(const Eigen::Matrix3d& sides, const Box& moved, const Box& fixed, double reach);

}  // namespace sim
