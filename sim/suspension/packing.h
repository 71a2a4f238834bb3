// Rigid bodies moved and turned apart until none is nearer to another than a gap: dense arrangements at random.
//
// Of two convex bodies with support functions h, n . (b - a) - h_A(n) - h_B(-n) is for every unit vector n a lower
// bound of their distance, and its largest value is the distance, or less the depth of an overlap. So bodies that pass
// are apart whether or not the search for n has converged. Bodies that are not convex count as their convex hulls.
#pragma once

#include "sim/core/cells.h"

#include <functional>
#include <vector>

namespace sim {

/// Where a body ends in each direction, about the origin.
class SupportShape {
 public:
  /// Of a surface of revolution about z: it can be turned.
  static SupportShape round(const Coefficients& surface);
  /// Of any surface, as it stands.
  static SupportShape fixed(const Coefficients& surface);

  bool can_turn() const { return !profile_.empty(); }
  double reach() const { return reach_; }
  /// Farthest point along the unit vector n; `axis`: unit vector that z has been turned to.
  Vec3 farthest(const Vec3& n, const Vec3& axis) const;
  /// By how much h may be too small: that of the chords between its points.
  double error() const { return error_; }

 private:
  std::vector<Eigen::Vector2d> profile_;  ///< distance from the axis and place on it, by the angle of n to the axis
  std::vector<Vec3> points_;
  double reach_ = 0, error_ = 0;
};
/// Whether a surface is one of revolution about z, to 1e-6 of its size.
bool is_round(const Coefficients& surface);

struct PackedBody {
  int shape = 0;    ///< number of its SupportShape
  double size = 1;  ///< its lengths over those of that shape
  Vec3 centre = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
};

struct PackingRoom {
  double gap = 0;
  double radius = 1;         ///< of a body of size 1, length
  std::optional<Vec3> cell;  ///< sides of a periodic cell; else centres stay within `half` of the origin
  Vec3 half = Vec3::Zero();
  bool turning = true;         ///< else bodies keep their axes
  std::function<bool()> stop;  ///< asked once a round; true ends the search with std::system_error (interrupted)
};

/// Moves bodies apart in at most so many rounds; returns by how much the nearest two are nearer than the gap, 0 when
/// none is. The work is done in one order, so that the result depends on nothing but the arguments.
double move_apart(std::vector<PackedBody>&, const std::vector<SupportShape>&, const PackingRoom&, int rounds);

}  // namespace sim
