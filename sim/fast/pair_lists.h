// Which pairs of points are summed beside the mesh: targets come in groups, sources in bodies, and cells find who is
// near whom.
#pragma once

#include "sim/core/cells.h"
#include "sim/core/types.h"
#include "sim/fast/patches.h"

#include <cstdint>
#include <optional>

namespace sim {

/// Sources of one body. The fine ones, if any, serve patches of targets that are nearer than `fine_within`. Where
/// several ranks make a sum, each has the points of those bodies that it needs (needs_of() in fast_sum.h).
struct FastBody {
  Points coarse, fine;
  double fine_within = 0;
  int owner = 0;  ///< a rank that has its strengths
};

/// Strengths of one body at its points: S f + D Q without factors; `dual` may be empty.
struct FastStrengths {
  Points force;
  Tensors dual;
};

struct FastGroup {
  Points points;
  int body = -1;       ///< whose points they are, which they do not see; -1: of none
  bool wanted = true;  ///< else no velocities are, and no points are needed: another rank has them
};

/// Of one geometry.
struct PairLists {
  static constexpr int multiple = 4;  ///< of which lists are long
  struct Level {
    Patches patches;  ///< of a body's points
    Points points;    ///< in their order, from the body's centre
  };
  struct Body {
    Eigen::Vector3d centre;
    std::array<Level, 2> levels;  ///< coarse, fine; empty where no group sees them
  };
  /// Sources of a body that a patch of targets sees within the cut-off.
  struct Segment {
    int body, patch, level, count;
    std::uint32_t lanes;    ///< those of the patch that see it
    std::size_t first;      ///< in the group's list
    Eigen::Vector3d shift;  ///< of the body's image
  };
  /// Targets from which the smooth part of a body is taken.
  struct Taken {
    int body;
    Eigen::Vector3d shift;
    std::vector<int> targets;
  };
  struct Group {
    Points points;
    Patches patches;
    std::vector<Segment> segments;
    std::vector<std::uint16_t>
        sources;  ///< places in the order of a level's patches; its end is a point of no strength
    std::vector<Taken> taken;
  };
  bool single_precision = false;
  std::vector<Body> bodies;
  std::vector<Group> groups;
  double pairs() const;  ///< evaluated in the residual part
};

/// That holds these points; of none an empty one.
Box box_of(const Points& points);
/// Which bodies have images that are no farther than the cut-off, the unit of length, from some group.
std::vector<char> near_bodies(std::span<const Box> bodies, std::span<const Box> groups,
                              const std::optional<Eigen::Matrix3d>& cell);

/// Lengths in units of the cut-off; the columns of `cell` are the sides of a periodic cell, if there is one. Bodies
/// have at most 65535 points.
PairLists plan_pairs(const std::vector<FastBody>&, const std::vector<FastGroup>&, const std::vector<Exclusion>&,
                     bool single_precision, const std::optional<Eigen::Matrix3d>& cell);

}  // namespace sim
