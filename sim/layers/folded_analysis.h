// Analysis of the 12 kernel components on a folded grid: samples -> sums over mirrors -> Fourier -> Legendre ->
// coefficients.
#pragma once

#include "sim/layers/folded_grid.h"
#include "sim/layers/small_product.h"

#include <array>
#include <vector>

namespace sim {

constexpr int components = 12;  ///< six of S, six of D

/// Row of (parity, block, m) among the intermediate spectra: latitude parity is the outermost index.
struct SpectrumRows {
  std::array<int, 4> first{};
  int count = 0;
  std::vector<std::vector<int>> coefficients;  ///< [row, parity of n - m]: where its degrees n stand among [nm][12]
  explicit SpectrumRows(const FoldedGrid&);
};

/// Contribution of a sample of the four members of an orbit to the blocks cos even, cos odd, sin even, sin odd:
/// [block][member], members f, -f, pi - f, pi + f.
constexpr double fold_sign[4][4] = {{1, 1, 1, 1}, {1, 1, -1, -1}, {1, -1, -1, 1}, {1, -1, 1, -1}};

/// Adds 12 components of one sample to the eight folded sums it belongs to. Latitude parity: even sum and odd
/// difference. samples: [2 latitudes][4 members][12], zero where there is none; folded: [parity][block] strided by
/// `stride`.
void fold(const Lane* samples, Lane* folded, std::ptrdiff_t stride, int width);

/// Folded samples [latitude parity][block][orbit][12] -> spectrum rows at one latitude,
/// [latitude parity][block, m][half][12]. `width`: how many of the 12 are needed.
void fourier_analysis(const FoldedGrid&, const SpectrumRows&, const Lane* folded, Lane* spectrum, int latitude,
                      int width);

/// Spectrum as above -> coefficients [nm][12].
void legendre_analysis(const FoldedGrid&, const SpectrumRows&, const Lane* spectrum, Lane* out, int width);

}  // namespace sim
