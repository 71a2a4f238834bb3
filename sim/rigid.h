// Rigid motions of a membrane. The double layer treats them exactly: with the sign of layer_potentials.h, D of (5) without
// (1 - lambda) makes of a rigid motion r
//   -r inside, -r/2 on the membrane, 0 outside.
// Quadrature misses this by an error that would grow with lambda and with the speed of the stream, so D acts only on
// what is left of a velocity without its rigid part. Steps are taken in a frame that moves rigidly along, for the same reason.
#pragma once

#include "geometry.h"

namespace sim {

/// The velocity field x -> translation + rotation x (x - centre).
struct RigidMotion {
  Vec3 translation = Vec3::Zero(), rotation = Vec3::Zero(), centre = Vec3::Zero();
  Vec3 at(const Vec3& x) const { return translation + rotation.cross(x - centre); }
};

/// A surface as rigid motions see it: the six of them are exact in its degree.
struct RigidBody {
  Vec3 centre = Vec3::Zero();      ///< mean position over the parameter sphere
  Coefficients arm;                ///< x - centre
  Eigen::Matrix3d inverse_inertia; ///< of the coefficients of the arm
};
RigidBody rigid_body(const Coefficients& position);

/// Projection of a velocity (3 fields) on the rigid motions, in the inner product of the coefficients.
RigidMotion rigid_part(const RigidBody&, const Coefficients& velocity);
/// A rigid motion, about any centre, as coefficients on the surface.
Coefficients rigid_velocity(const RigidBody&, const RigidMotion&);
/// A velocity less its rigid part.
Coefficients without_rigid_part(const RigidBody&, const Coefficients& velocity);

/// The rigid motion that a shape makes as it is seen, whatever its membrane does: it takes the most of the normal velocity,
///   min over r of oint [(1 - eta) ((u - r).n)^2 + eta |u - r|^2] dA,   eta = 0.03.
/// The second term decides what the first leaves open (a body of revolution, a sphere). With eta = 1e-3 frames that are
/// extrapolated by it made steps of nearly round vesicles unstable (nu = 0.999, lambda = 0.1). Velocity: points x 3.
RigidMotion shape_motion(const RigidBody&, const Geometry&, const Matrix& velocity);

/// A frame that moves along with a vesicle: it turns steadily, and its place drifts as a point of a linear flow does, which
/// follows a straight line in shear and a circle in rotating fluid.
struct Frame {
  RigidMotion motion;                               ///< at its centre
  Eigen::Matrix3d drift = Eigen::Matrix3d::Zero();  ///< gradient of the flow: how its velocity changes with its place
  /// The motion of the frame when it has come to another place.
  RigidMotion at(const Vec3& place) const {
    return {motion.translation + drift * (place - motion.centre), motion.rotation, place};
  }
};

/// Gradient of the linear flow nearest to a velocity (3 fields) on the surface.
Eigen::Matrix3d mean_gradient(const RigidBody&, const Coefficients& velocity);

/// a + share (a - b), at the place of a.
Frame extrapolated(const Frame& a, const Frame& b, double share);

/// Where a frame carries positions (3 fields) in a time, which may be negative; and how it turns vectors.
Coefficients carried(const Frame&, double time, const Coefficients& position);
Coefficients turned(const Frame&, double time, const Coefficients& vectors);

}  // namespace sim
