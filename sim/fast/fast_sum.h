// Single and double layer of many bodies at many targets in a time that grows as the number of points: the smooth part
// of the kernels by Fourier transforms, from coarse points, the rest within a cut-off.
//
//   u = mesh(all bodies) + residual(bodies that are seen) - smooth(bodies that are not),    u = sum of S f + D Q,
//   S = I/r + r r/r^3,  D Q = r (r.Q r)/r^5.
//
// In a periodic cell the sums are over all images. The mean velocity over the whole cell, insides of bodies included,
// is zero; for that the double layer needs a constant, -(4 pi/3V) sum (y - y0) tr Q with y from the middle y0 of its
// body, which makes it 0 outside a body that moves as a whole, as in free space.
//
// What is not seen, the own surface and near pairs, is taken out again by the very points that put it in, so that the
// error of their coarse rule cancels.
#pragma once

#include "sim/fast/pair_sums.h"

namespace sim {

/// How a sum is split and with which error.
struct FastSetting {
  double cutoff = 1;                                   ///< length
  double wave_number = 14;                             ///< c = K times the cut-off
  double accuracy = 1e-5;                              ///< of the polynomials
  int window = 6;                                      ///< nodes
  double oversampling = 1.2;                           ///< of the mesh
  bool single_precision = false;                       ///< of the sums over pairs
  std::optional<Eigen::Matrix3d> cell = std::nullopt;  ///< sides of a periodic cell, in columns; none: free space
};
/// For a relative error of the velocities, with or without double layers. The cut-off is a matter of cost.
FastSetting fast_setting(double tolerance, bool dual);

/// One geometry; strengths may change.
struct FastSum {
  FastSetting setting;
  bool dual = false;  ///< double layers are planned
  std::shared_ptr<const KernelSplit> split;
  std::shared_ptr<const Mesh> mesh;
  MeshPoints sources, targets;
  PairLists pairs;
  std::vector<Eigen::Index> first_source, first_target;  ///< of bodies and of groups, and the ends
  std::vector<char> wanted;                              ///< by group
  std::vector<int> owner;                                ///< by body
  std::vector<Points> arms;                              ///< of own bodies in a cell: coarse points from the middle
  const Ranks* ranks = &alone;                           ///< who divide the mesh
  std::vector<int> home;                                 ///< by target, the rank that reads its velocity off the mesh
  std::vector<Eigen::Index> read_for;                    ///< by rank, how many of its targets are read here
};

/// Split, window and mesh depend on few numbers: whoever makes many sums keeps them.
struct FastParts {
  std::shared_ptr<const KernelSplit> split;
  std::shared_ptr<const Window> window;
  std::shared_ptr<const Mesh> mesh;
  FastSetting setting;
  std::array<int, 3> nodes{};  ///< in free space
};

/// The boxes of all bodies' coarse points, of their coarse and fine points, and of the targets of groups: what ranks
/// know of those that they may not need.
struct FastOutlines {
  std::vector<Box> coarse, both, groups;
};
/// By body, whether this rank needs its coarse points for its part of the mesh, and all its points for its groups.
struct FastNeeds {
  std::vector<char> mesh, pairs;
};
/// `wanted`: the groups of this rank. Beside what is told, a group needs all points of the bodies that are taken out of
/// its velocities.
FastNeeds needs_of(const FastSetting&, const FastOutlines&, std::span<const char> wanted, FastParts& parts,
                   const Ranks&);

/// `dual`: some strengths have double layers. `parts`: of an earlier sum; renewed where they do not fit. Ranks, which
/// live longer than the sum, have the same bodies and groups, with the points that they need; each group is wanted by
/// one.
FastSum plan_fast_sum(const FastSetting&, std::vector<FastBody>, std::vector<FastGroup>, const std::vector<Exclusion>&,
                      bool dual, FastParts& parts, const Ranks& = alone);

/// Velocity at the targets of each group that is wanted; ranks call it together, with the strengths of the points that
/// they have. Does not depend on the number of threads and ranks. Throws std::invalid_argument when there are double
/// layers that were not planned.
std::vector<Points> fast_velocity(const FastSum&, std::vector<FastStrengths> coarse, std::vector<FastStrengths> fine);

}  // namespace sim
