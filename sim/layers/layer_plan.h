// What the assembly of a layer matrix knows beforehand, and its two halves: rows of the collocation operator, tile by
// tile, and their projection on the harmonics of the target. Internal to layer_potentials.
#pragma once

#include "sim/layers/folded_analysis.h"
#include "sim/layers/layer_potentials.h"

#include <vector>

namespace sim {

struct LayerPotentials::Plan {
  int p, q, s;
  FoldedGrid target, source;
  SpectrumRows target_rows, source_rows;
  std::vector<double> singular_weight;  ///< of each source latitude, for the integrand kernel * |x_t x x_f|
  struct Rotation {                     ///< the two mirror classes of one degree n, row-major, forward and transposed
    std::vector<double> cosine, sine, cosine_t, sine_t;
  };
  std::vector<std::vector<Rotation>> rotations;  ///< [target latitude][n]
  struct Turn {  ///< the z-rotation by phi of four targets, one a lane: cos(m phi), sin(m phi)
    std::vector<Lane> cosine, sine;
  };
  std::vector<Turn> turns, opposite_turns;  ///< of each tile of four longitudes, and of that half a turn further

  /// Four targets and their antipodes, which see the same source points.
  struct Tile {
    int latitude, tile;
    int targets;  ///< up to four; the other lanes are idle
  };
  std::vector<Tile> tiles;  ///< with their antipodes all targets, each once

  Plan(int order, int source_order);
  struct Scratch;
  Turn turn_of(int first) const;
  void to_pole(int latitude, const Turn&, const Coefficients& x, Scratch&) const;
  void along_latitudes(Scratch&) const;
  void spectra_of(int i, Scratch&) const;
  void points_of(int lat, Scratch&) const;
  void fold_kernels(int i, const Lane* target_x, bool antipode, bool with_double, Scratch&) const;
  void from_pole(int latitude, const Turn&, int used, Scratch&) const;
  void write_rows(const Lane* back, const Tile&, bool antipode, int used, double* rows) const;
  void rows_of_tile(const Tile&, const Coefficients& x, bool with_double, double* rows, Scratch&) const;
  RawVector<double> rows_of(const Coefficients& x, bool with_double) const;
  LayerMatrices project(const RawVector<double>& rows, bool with_double) const;
  int column_stride() const { return (coefficient_count(p) + lanes - 1) / lanes * lanes; }
};

}  // namespace sim
