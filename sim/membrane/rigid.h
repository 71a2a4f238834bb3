// Rigid motions of a membrane. The double layer treats them exactly: with the sign of layer_potentials.h, D of (5)
// without (1 - lambda) maps a rigid motion r to
//   -r inside, -r/2 on the membrane, 0 outside.
// Quadrature would leave an error that grows with lambda and with the speed of the stream, so D acts only on a
// velocity minus its rigid part. Steps are taken in a co-moving rigid frame for the same reason.
#pragma once

#include "sim/surface/geometry.h"

namespace sim {

/// The velocity field x -> translation + rotation x (x - centre).
struct RigidMotion {
  Vec3 translation = Vec3::Zero(), rotation = Vec3::Zero(), centre = Vec3::Zero();
  Vec3 at(const Vec3& x) const { return translation + rotation.cross(x - centre); }
};

/// Data of a surface for rigid motions, all six of which its degree represents exactly.
struct RigidBody {
  Vec3 centre = Vec3::Zero();       ///< mean position over the parameter sphere
  Coefficients arm;                 ///< x - centre
  Eigen::Matrix3d inverse_inertia;  ///< of the coefficients of the arm
};
RigidBody rigid_body(const Coefficients& position);

/// Projection of a velocity (3 fields) on the rigid motions, in the inner product of the coefficients.
RigidMotion rigid_part(const RigidBody&, const Coefficients& velocity);
/// A rigid motion, about any centre, as coefficients on the surface.
Coefficients rigid_velocity(const RigidBody&, const RigidMotion&);
/// A velocity minus its rigid part.
Coefficients without_rigid_part(const RigidBody&, const Coefficients& velocity);

/// The rigid motion of a shape, whatever the membrane does within it: the best fit to the normal velocity,
///   min over r of oint [(1 - eta) ((u - r).n)^2 + eta |u - r|^2] dA,   eta = 0.03.
/// The second term determines what the first leaves open (a body of revolution, a sphere). With eta = 1e-3,
/// extrapolated frames make steps of nearly round vesicles unstable (nu = 0.999, lambda = 0.1). Velocity: points x 3.
RigidMotion shape_motion(const RigidBody&, const Geometry&, const Matrix& velocity);

/// A frame that moves with a vesicle: its rotation changes linearly with time, and its centre drifts like a point of a
/// linear flow, along a straight line in shear and a circle in rotating fluid.
struct Frame {
  RigidMotion motion;                               ///< at its centre, at time 0
  Eigen::Matrix3d drift = Eigen::Matrix3d::Zero();  ///< gradient of the flow: change of its velocity with position
  Vec3 spin_up = Vec3::Zero();                      ///< change of its rotation with time
  /// The motion of the frame when its centre is elsewhere.
  RigidMotion at(const Vec3& place) const {
    return {motion.translation + drift * (place - motion.centre), motion.rotation, place};
  }
  /// With another time as its time 0.
  Frame from(double time) const {
    return {{motion.translation, motion.rotation + time * spin_up, motion.centre}, drift, spin_up};
  }
};

/// Gradient of the linear flow nearest to a velocity (3 fields) on the surface.
Eigen::Matrix3d mean_gradient(const RigidBody&, const Coefficients& velocity);

/// A span of time of a frame; it may go backwards.
struct Span {
  double from = 0, to = 0;
  double length() const { return to - from; }
};
/// Positions (3 fields) moved by a frame; and vectors rotated by it, about the mean of its rotations at both ends:
/// smooth in both, and as the frame moves where they meet.
Coefficients carried(const Frame&, Span, const Coefficients& position);
Coefficients turned(const Frame&, Span, const Coefficients& vectors);

}  // namespace sim
