// Where the arrows of the background flow stand.
#pragma once

#include "render/scene/camera.h"

namespace render {

/// Centres of the flow arrows: a regular net in the coordinate plane through the target that faces the viewer most,
/// clear of the captions. count x 3. The net is fixed in space under a following camera, so that arrows move past.
sim::Matrix arrow_points(const Framing& framing, const Moment& moment);

/// 1, or less when a turning camera sees the plane of the arrows too obliquely; 0: edge on.
double arrows_shown(const Framing& framing, const Moment& moment);

}  // namespace render
