// Text and symbols on a finished frame: time, parameters, title, scale bar, annotations.
#pragma once

#include "render/image/image.h"
#include "render/image/text.h"
#include "render/scene/frame.h"

namespace render {

/// Draws the captions requested by the view onto an RGB picture.
void draw_captions(Image& image, const Font& font, const Frame& frame);

}  // namespace render
