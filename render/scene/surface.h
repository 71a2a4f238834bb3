// Points anywhere on the spectral surface.
#pragma once

#include "sim/core/types.h"

namespace render {

/// count x 3 each.
struct SurfacePoints {
  sim::Matrix position;
  sim::Matrix normal;  ///< outward unit vectors
};

/// directions: count x 3 unit vectors s; the poles of the parametrisation are allowed.
SurfacePoints surface_points(const sim::Coefficients& position, const sim::Matrix& directions);

/// Mean position, and mean of x x^T relative to it, over the enclosed volume: centre of mass and second moments
/// divided by the volume.
struct VolumeMoments {
  double volume = 0;
  sim::Vec3 centroid;
  Eigen::Matrix3d second;
};
VolumeMoments volume_moments(const sim::Coefficients& position);

}  // namespace render
