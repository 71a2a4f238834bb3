// What a mesh knows beforehand: its size, its FFTW plans and the multiplier b(k). Internal to mesh.
#pragma once

#include "sim/fast/mesh.h"

#include <fftw3.h>

namespace sim {

struct Mesh::Plan {
  static constexpr int batch = 16;  ///< columns transformed together, in the first caches
  enum Transform { to_x, to_y, from_y, from_x, to_z, from_z, transforms };  ///< spectra in x, y, z and back

  Window window;
  double step;                     ///< distance of nodes
  double cut;                      ///< R
  std::array<int, 3> nodes, full;  ///< of the mesh, and doubled
  int padded_width;                ///< of windows, in whole vectors
  int block, blocks;               ///< planes in z that one thread fills, and the number of such blocks
  std::size_t row, plane;          ///< doubles from one row in x, plane in z to the next
  RawVector<double> multiplier;    ///< octant: [y][x][z], nodes + 1 each
  std::array<fftw_plan, transforms> fftw{};

  Plan(const KernelSplit&, const Window&, double oversampling, const std::array<int, 3>& node_counts);
  ~Plan();
  Plan(const Plan&) = delete;

  void make_transforms();
  void make_multiplier(const KernelSplit&);
  using Field = RawVector<double>;
  void spread(const MeshPoints&, const Points& force, const Tensors& dual, std::span<Field>) const;
  void forward_planes(std::span<Field>) const;
  void multiply_columns(std::span<Field>) const;
  void backward_planes(std::span<Field>) const;
  void read(std::span<const Field>, const MeshPoints&, Points& velocity) const;
  std::size_t at(int z, int y, int x) const {
    return static_cast<std::size_t>(z) * plane + static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
  }
};

}  // namespace sim
