// Which vesicles are wholly behind others, so that they need not be drawn.
#pragma once

#include "render/scene/detail.h"
#include "render/scene/faces.h"

#include <span>

namespace render {

/// One flag a vesicle. Errs on the side of drawing: a vesicle counts as hidden only where others cover it and its
/// contour with a margin of some two pixels. What the faces cut hides nothing.
std::vector<bool> hidden(std::span<const Sketch> sketches, const Camera& camera, const ViewParameters& view,
                         const std::optional<FaceBox>& faces = {});

}  // namespace render
