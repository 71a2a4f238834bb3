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
  std::vector<std::vector<Rotation>> rotations;       ///< [target latitude][n]
  std::vector<int> identity3, identity9, identity12;  ///< 0, 3, 6, ...; 0, 9, 18, ...; 0, 12, 24, ...
  std::vector<int> down3, down12;                     ///< 0, -3, -6, ... and 0, -12, -24, ...

  Plan(int order, int source_order);
  struct Turn;
  struct Scratch;
  Turn turn_of(int tile) const;
  LaneBuffer to_pole(int latitude, const Turn&, const Coefficients& x) const;
  LaneBuffer along_latitudes(const LaneBuffer& pole) const;
  void quarter_of(const LaneBuffer& x_lat, int i, int lat, Scratch&) const;
  void unfold_points(int lat, Scratch&) const;
  void fold_kernels(int i, const Lane* target_x, bool with_double, Scratch&) const;
  LaneBuffer from_pole(int latitude, const Turn&, const LaneBuffer& pole, int used) const;
  void write_rows(const LaneBuffer& back, int tile, int used, double* rows) const;
  void rows_of_tile(int latitude, int tile, const Coefficients& x, bool with_double, double* rows) const;
  LayerMatrices project(const RawVector<double>& rows, bool with_double) const;
  int column_stride() const { return (coefficient_count(p) + lanes - 1) / lanes * lanes; }
};

}  // namespace sim
