// What a mesh knows beforehand: its size, its FFTW plans and the multiplier b(k). Internal to mesh.
#pragma once

#include "sim/fast/mesh.h"

#include <fftw3.h>

namespace sim {

/// What one rank has of a mesh: planes in z, and rows in y of its spectrum.
struct MeshSlab {
  int first_plane, planes, first_row, rows;
};

struct Mesh::Plan {
  static constexpr int batch = 16;  ///< columns transformed together, in the first caches
  enum Transform { to_x, to_y, from_y, from_x, to_z, from_z, transforms };  ///< spectra in x, y, z and back

  Window window;
  bool periodic;
  double step = 0, cut = 0;         ///< in free space: distance of nodes, R
  std::array<int, 3> nodes, full;   ///< of the mesh, and of its transforms: doubled in free space
  Eigen::Matrix3d per_node, waves;  ///< from places to nodes; from numbers of waves to wave vectors
  int padded_width;                 ///< of windows, in whole vectors
  int block, blocks;                ///< planes in z that one thread fills, and the number of such blocks
  std::size_t row, plane;           ///< doubles from one row in x, plane in z to the next
  RawVector<double> multiplier;     ///< [y][x][z]; in free space an octant, nodes + 1 each
  std::array<fftw_plan, transforms> fftw{};

  Plan(const KernelSplit&, const Window&, double oversampling, const std::array<int, 3>& node_counts);
  Plan(const KernelSplit&, const Window&, double oversampling, const Eigen::Matrix3d& cell);
  ~Plan();
  Plan(const Plan&) = delete;

  void make_layout();
  void make_transforms();
  void make_free_multiplier(const KernelSplit&);
  void make_periodic_multiplier(const KernelSplit&, double volume);
  MeshSlab slab(int rank, int count) const {
    const auto begin = [&](int n, int r) { return static_cast<int>(static_cast<long long>(n) * r / count); };
    const int z = begin(nodes[2], rank), y = begin(full[1], rank);
    return {z, begin(nodes[2], rank + 1) - z, y, begin(full[1], rank + 1) - y};
  }
  int home(int plane_number, int count) const {  ///< the rank that has it
    int rank = static_cast<int>(static_cast<long long>(plane_number) * count / nodes[2]);
    while (slab(rank, count).first_plane > plane_number) --rank;
    while (rank + 1 < count && slab(rank + 1, count).first_plane <= plane_number) ++rank;
    return rank;
  }
  /// Planes behind a slab that windows which begin in it reach.
  int halo(int count) const { return count > 1 ? window.width() - 1 : 0; }

  std::vector<int> starts(const Points&, const Eigen::Vector3d& middle) const;  ///< 3 a point
  MeshPoints placed(const Points&, const Eigen::Vector3d& middle, const std::vector<int>& starts,
                    std::vector<int> points, bool slopes) const;
  using Field = RawVector<double>;  ///< the planes of a slab, then its halo
  void spread(const MeshPoints&, const Points& force, const Tensors& dual, const MeshSlab&, std::span<Field>) const;
  void forward_planes(const MeshSlab&, std::span<Field>) const;
  /// In place, all being here.
  void multiply_columns(std::span<Field>) const;
  /// The same with rows that go from rank to rank and back.
  void multiply_columns(const MeshSlab&, const Ranks&, std::span<Field>) const;
  void backward_planes(const MeshSlab&, std::span<Field>) const;
  void fill_halo(const MeshSlab&, const Ranks&, std::span<Field>) const;
  void read(std::span<const Field>, const MeshPoints&, const MeshSlab&, bool divided, Points& velocity) const;
  /// of channel c the spectrum in x at z, y
  template <class Row>
  void multiply_row_columns(int y, std::size_t channels, const Row& row_at) const;
  /// Of the wave number in place n of a transform.
  int signed_wave(int n, int d) const { return n <= full[d] / 2 ? n : n - full[d]; }
  /// ... its place in the multiplier, whose size this is in x, y, z.
  std::size_t wave_place(int n, int d) const { return std::size_t(periodic || n <= nodes[d] ? n : full[d] - n); }
  std::array<std::size_t, 3> multiplier_size() const {
    if (!periodic) return {std::size_t(nodes[0]) + 1, std::size_t(nodes[1]) + 1, std::size_t(nodes[2]) + 1};
    return {std::size_t(full[0]) / 2 + 1, std::size_t(full[1]), std::size_t(full[2])};
  }
  int wrapped(int node, int d) const { return node < nodes[d] ? node : node - nodes[d]; }
  std::size_t at(int z, int y, int x) const {
    return static_cast<std::size_t>(z) * plane + static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
  }
};

}  // namespace sim
