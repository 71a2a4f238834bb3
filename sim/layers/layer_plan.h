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
  /// The z-rotations by the targets' longitudes: cos(m phi), sin(m phi), [m][longitude], going round more than once and
  /// a half, so that the lanes of any tile and of its antipodes follow one another.
  std::vector<double> cosine, sine;
  int longitudes;  ///< of a row of these

  /// Targets of one latitude and their antipodes, which see the same source points, one a lane.
  struct Tile {
    int latitude, first;  ///< first: longitude
    int targets;          ///< up to the number of lanes; the others are idle
    bool wide;            ///< of WideLane instead of Lane
  };
  std::vector<Tile> tiles;  ///< with their antipodes all targets, each once
  bool wide;

  Plan(int order, int source_order, bool wide);
  template <class Vector>
  struct Rows;
  template <class Vector>
  struct Columns;
  RawVector<double> rows_of(const Coefficients& x, bool with_double) const;
  LayerMatrices project(const RawVector<double>& rows, bool with_double) const;
  int column_stride() const { return (coefficient_count(p) + lanes - 1) / lanes * lanes; }
};

}  // namespace sim
