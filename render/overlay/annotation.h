// Annotations of a picture besides its captions: axes, profile of the background flow, cross-section.
#pragma once

#include "render/core/ground.h"
#include "render/core/places.h"
#include "render/image/picture_canvas.h"
#include "render/scene/frame.h"

namespace render {

/// Directions of x, y, z, of this length, about the middle of the box; an axis along the line of sight is a dot or a
/// cross in a ring.
void draw_triad(Image& image, const Font& font, const Inks& inks, const Camera& camera, const Box& box, double length);

/// Arrows between a vertical line and the profile, at the left edge of the picture, as far as `reach` above and below
/// the middle.
void draw_flow_profile(Image& image, const Font& font, const Inks& inks, const FlowProfile& profile, double reach);

/// The (x, z) cross-section in a box.
void draw_inset(Image& image, const Font& font, const Inks& inks, const Inset& inset, const Box& box);

}  // namespace render
