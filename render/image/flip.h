// FLIP: perceived difference of two pictures for a viewer who flips between them on a screen.
//
// After P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D. Fairchild, "FLIP: A Difference
// Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. Symbols are the paper's.
#pragma once

#include "render/image/image.h"

#include <functional>

namespace render {

/// Ignored pixels: width x height, nonzero where ignored; empty: none.
using Ignored = std::vector<std::uint8_t>;

/// Range of pixels per degree for which the filters are neither finer than a pixel nor wider than a screen.
inline constexpr double flip_least_ppd = 10, flip_most_ppd = 1000;

/// One value per pixel, top row first: 0 (no visible difference) to 1 (the largest possible one). Transparent
/// pictures are composited on white. ppd: pixels per degree of visual angle, 67 for a 0.7 m wide 3840-pixel screen
/// 0.7 m away. Throws std::invalid_argument when sizes differ, or outside flip_least_ppd to flip_most_ppd.
std::vector<float> flip(const Image& reference, const Image& test, double ppd = 67);

struct FlipTile {
  int left, top, right, bottom;  ///< right and bottom excluded
};
/// Receives the values of a tile, top row first; may throw to stop.
using FlipVisitor = std::function<void(const FlipTile&, const std::vector<float>&)>;
/// The same values tile by tile, which needs only some megabytes whatever the size of the pictures, and no time where
/// they are equal. Ignored pixels count as equal.
void flip_by_tiles(const Image& reference, const Image& test, double ppd, const Ignored&, const FlipVisitor&);

}  // namespace render
