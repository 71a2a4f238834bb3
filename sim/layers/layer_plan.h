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
  std::vector<Turn> turns;  ///< of each tile of four longitudes

  Plan(int order, int source_order);
  struct Scratch;
  Turn turn_of(int tile) const;
  LaneBuffer to_pole(int latitude, const Turn&, const Coefficients& x) const;
  LaneBuffer along_latitudes(const LaneBuffer& pole) const;
  void spectra_of(const LaneBuffer& x_lat, int i, Scratch&) const;
  void points_of(int lat, Scratch&) const;
  void fold_kernels(int i, const Lane* target_x, bool with_double, Scratch&) const;
  LaneBuffer from_pole(int latitude, const Turn&, const LaneBuffer& pole, int used) const;
  void write_rows(const LaneBuffer& back, int tile, int used, double* rows) const;
  void rows_of_tile(int latitude, int tile, const Coefficients& x, bool with_double, double* rows) const;
  LayerMatrices project(const RawVector<double>& rows, bool with_double) const;
  int column_stride() const { return (coefficient_count(p) + lanes - 1) / lanes * lanes; }
};

}  // namespace sim
