// The smooth part of the kernels summed over all points by Fourier transforms on a mesh. Lengths are in units of the
// cut-off of the split.
//
// With f^, Q^ the sums of strength * exp(-i k.y) the velocity is u^ = b(k) [k^2 g - k (k.g) - (i/6) k^2 k t], where
// g = f^ - (i/3) Q^ k, t = tr Q^: four meshes, three of the force less a third of the divergence of Q, which the slopes
// of the window give, and one of the trace; three come back.
//
// In free space the biharmonic function r is replaced by -(R - r)^2/(2R), 0 beyond R, which differs from it by a
// constant and by r^2 within the distances that occur, and 2/R times the net force makes up for it. Meshes are doubled
// in each direction, so that no image is seen.
//
// In a periodic cell, which may be sheared, wave vectors are those of its lattice, and the one of zero is left out: the
// mean velocity over the whole cell is zero, and a uniform pressure gradient balances the net force.
//
// Ranks divide the mesh into slabs along z, and for transforms along z into slabs along y; each number comes of the
// same sums in the same order, whoever makes it.
#pragma once

#include "sim/core/cells.h"
#include "sim/core/ranks.h"
#include "sim/core/raw_memory.h"
#include "sim/fast/window.h"

#include <Eigen/Dense>

#include <array>
#include <memory>
#include <span>

namespace sim {

using Points = Eigen::Matrix3Xd;                           ///< a point or vector a column
using Tensors = Eigen::Matrix<double, 6, Eigen::Dynamic>;  ///< symmetric: xx, xy, xz, yy, yz, zz

/// Points on a mesh with their windows; of several ranks, those that this one's slab has to do with.
struct MeshPoints {
  std::vector<int> point;             ///< which one of those that were given
  std::vector<int> start;             ///< 3 a point: the first node in x, y, z
  RawVector<double> windows, slopes;  ///< 3 a point, padded to whole vectors; slopes empty unless asked for
  std::vector<int> order;             ///< neighbours together
  std::vector<int> touching, first;   ///< sources whose windows reach into block b: touching[first[b]] ...
};

/// What sources bring to a mesh: S f + D Q without factors, a column a point that was placed.
struct MeshStrengths {
  Points force;
  Tensors dual;                        ///< no columns without double layers
  bool double_layers = false;          ///< of some source of some rank
  Eigen::Vector3d net_force{0, 0, 0};  ///< of all sources of all ranks; wanted in free space
};

/// The smooth part of some sources at all nodes of a mesh, of several ranks at those of the slab and its halo, to be
/// read at any points.
struct MeshVelocity {
  std::array<RawVector<double>, 3> nodes;
  Eigen::Vector3d everywhere{0, 0, 0};  ///< added to them
};

/// Plan; immutable.
class Mesh {
 public:
  /// In free space, of so many nodes.
  Mesh(const KernelSplit&, const Window&, double oversampling, const std::array<int, 3>& nodes);
  /// Of a periodic cell; the columns of the matrix are its sides.
  Mesh(const KernelSplit&, const Window&, double oversampling, const Eigen::Matrix3d& cell);
  ~Mesh();
  Mesh(const Mesh&) = delete;

  /// Distance of neighbouring nodes.
  static double spacing(double wave_number, double oversampling);
  /// The least good numbers of nodes for points that fill a box of these sides.
  static std::array<int, 3> nodes_for(const Eigen::Vector3d& sides, double spacing, int width);
  /// Transforms are of this many nodes.
  static double padded_nodes(const std::array<int, 3>& nodes);

  /// Points in a box around the middle of the mesh, which is at `middle`; anywhere, in a periodic cell. Throws
  /// std::domain_error when a window would leave the mesh. Of several ranks each gives in ascending order all sources
  /// whose windows reach into its slab, and perhaps others, and the targets whose home it is.
  MeshPoints place_sources(const Points&, const Eigen::Vector3d& middle, bool slopes, const Ranks& = alone) const;
  MeshPoints place_targets(const Points&, const Eigen::Vector3d& middle) const;
  /// By target, the rank in whose slab its window begins.
  std::vector<int> homes(const Points&, const Eigen::Vector3d& middle, const Ranks&) const;
  /// Whether the window of a point in the box may reach into the slab of this rank.
  bool reaches_slab(const Box&, const Eigen::Vector3d& middle, const Ranks&) const;
  /// Adds the smooth part of all sources at the targets placed here. Does not depend on the number of threads and
  /// ranks, which call it together.
  void add_velocity(const MeshPoints& sources, const MeshStrengths&, const MeshPoints& targets, Points& velocity,
                    const Ranks& = alone) const;
  /// The same in two steps.
  MeshVelocity velocity_of(const MeshPoints& sources, const MeshStrengths&, const Ranks& = alone) const;
  void add_velocity(const MeshVelocity&, const MeshPoints& targets, Points& velocity, const Ranks& = alone) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace sim
