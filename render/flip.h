// FLIP: how different two pictures look to somebody who flips between them on a screen.
//
// After P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D. Fairchild, "FLIP: A Difference
// Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. Symbols are the paper's.
#pragma once

#include "image.h"

#include <functional>

namespace render {

/// Pixels that do not count: width x height, not zero where ignored; empty: all count.
using Ignored = std::vector<std::uint8_t>;

/// Pixels per degree of sight for which the filters are neither finer than a pixel nor wider than a screen.
inline constexpr double flip_least_ppd = 10, flip_most_ppd = 1000;

/// One value a pixel, rows from the top: 0 (nothing to be seen) to 1 (the largest difference there is). Transparent
/// pictures are laid on white. ppd: pixels per degree of sight, 67 for a 0.7 m wide 3840-pixel screen 0.7 m away.
/// Throws std::invalid_argument when sizes differ, or beyond flip_least_ppd and flip_most_ppd.
std::vector<float> flip(const Image& reference, const Image& test, double ppd = 67);

struct FlipTile {
  int left, top, right, bottom;  ///< right and bottom excluded
};
/// Hears the values of a tile, its rows from the top; may throw to end all.
using FlipVisitor = std::function<void(const FlipTile&, const std::vector<float>&)>;
/// The same values tile by tile, which takes some megabytes however large the pictures are, and no time where they are equal.
/// Ignored pixels count as equal.
void flip_by_tiles(const Image& reference, const Image& test, double ppd, const Ignored&, const FlipVisitor&);

}  // namespace render
