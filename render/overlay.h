// What is written on a finished frame: time, parameters, title, scale bar, and what explains it.
#pragma once

#include "image.h"
#include "scene.h"
#include "text.h"

namespace render {

/// Draws the captions that the view asks for onto an RGB picture.
void draw_captions(Image& image, const Font& font, const Frame& frame);

}  // namespace render
