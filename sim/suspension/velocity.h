// The velocity of the fluid anywhere, outside and inside the membranes, from a saved state.
//
// With the force densities f_j of all membranes on the fluid and their velocities u_j, from the representation formula:
//   c u(x) = u_inf(x) + sum_j { S_j[f_j](x) + (1 - lambda_j) D_j[u_j](x) },   c = 1 outside, lambda_k inside vesicle k
// (D with the sign of layer_potentials.h: its factor for a rigid motion is -1 inside, 0 outside, and this part of u_j
// is exact). Both sides converge to the membrane's own velocity. Far from a membrane the smooth rule on a coarse grid
// is used (far_field.h); nearer, in its place, the coarser of two finer grids that is fine enough, and within some
// spacings of the finest the near-singular rule of near.h.
//
// In a periodic cell the sums are over all images, as in the steps: a smooth part from a mesh, and round each image
// what is missing to these rules (flow_images.h). The mean of u - u_inf over the cell is zero. An image moves as its
// vesicle does and as u_inf differs between them.
#pragma once

#include "sim/layers/source_tiles.h"
#include "sim/suspension/flow_images.h"
#include "sim/suspension/suspension.h"

#include <array>

namespace sim {

struct FlowFieldOptions {
  double spacings = 3;           ///< least distance n of the smooth rule in source spacings; error ~ e^(-2 pi n)
  NearOrder near_order{48, 64};  ///< 32 x 40 is enough for pictures, at a third of the cost
  double tolerance = 1e-6;       ///< of the sums over images, relative
  bool hold_spheres = true;      ///< by the tension that keeps them round in a run; otherwise they stretch as by (3a)
};

/// One membrane as a source of flow, frozen at a state.
struct FlowSource {
  struct Level {
    Sources sources;
    SourceDensities densities;
  };
  Coefficients position, velocity;
  Densities densities;
  double viscosity_contrast = 1;
  RigidMotion rigid;           ///< of the velocity
  Matrix directions;           ///< parameters of the coarsest level's points, unit vectors
  SourceTiles tiles;           ///< of these points
  std::array<Level, 2> finer;  ///< each spacing half of the one before, the first half of the coarse grid's
  const RotationPlan* rotation = nullptr;
};

/// Everything that the velocity at a point depends on, at one instant.
struct FlowField {
  std::vector<FlowParameters> flows;
  double time = 0;
  std::vector<FlowSource> sources;
  std::shared_ptr<const std::vector<Sources>> coarse;  ///< of all membranes, for the far field
  std::vector<SourceDensities> coarse_densities;
  std::shared_ptr<const FlowImages> images;  ///< in a periodic cell
  FlowFieldOptions options;
};
/// Forces are computed as the stepper does: bending, tension, buoyancy and repulsion of the scene.
FlowField flow_field(Plans&, const Scene&, const State&, const FlowFieldOptions& = {});

struct FlowSamples {
  Matrix velocity;          ///< count x 3
  std::vector<int> within;  ///< index of the vesicle that, or an image of which, contains the point, -1 outside all
  Vector distance;          ///< to the nearest membrane; a lower bound beyond the range of the near rule
};
/// At points, count x 3. The result does not depend on the number of threads.
FlowSamples velocity_at(const FlowField&, const Matrix& points);

/// Velocity of the volume centroid: 1/V oint x (u.n) dA.
Vec3 centroid_velocity(Plans&, const VesicleState&);

}  // namespace sim
