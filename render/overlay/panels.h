// A picture of several panels: their arrangement, and the lines between them.
#pragma once

#include "render/core/palette.h"
#include "render/image/image.h"

namespace render {

/// Columns of the most even division of a picture into `count` panels.
int panel_columns(int count, int width, int height);

/// Copies `part` into a picture with the same channels that is large enough; left, top: place of its upper left corner,
/// px.
void paste(Image& into, const Image& part, int left, int top);

/// Thin lines, empty where the picture has alpha, between its panels, each `width` x `height` px.
void draw_separators(Image& image, int columns, int rows, int width, int height, const Colour& colour);

}  // namespace render
