// FLIP: how different two pictures look to somebody who flips between them on a screen.
//
// After P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D. Fairchild, "FLIP: A Difference
// Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. Symbols are the paper's.
#pragma once

#include "image.h"

namespace render {

/// One value a pixel, rows from the top: 0 (nothing to be seen) to 1 (the largest difference there is). Transparent
/// pictures are laid on white. ppd: pixels per degree of sight, 67 for a 0.7 m wide 3840-pixel screen 0.7 m away.
/// Throws std::invalid_argument when sizes differ.
std::vector<float> flip(const Image& reference, const Image& test, double ppd = 67);

}  // namespace render
