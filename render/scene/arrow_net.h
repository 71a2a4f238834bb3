// Where the arrows of the background flow stand.
#pragma once

#include "render/scene/camera.h"

namespace render {

/// Centres of the flow arrows: a regular net in the coordinate plane through the target that faces the viewer most,
/// clear of the captions. count x 3. The net is fixed in space under a following camera, so that arrows move past.
/// finer: so many rows in place of one, and two columns if it is more than 1, for narrow gaps between vesicles.
sim::Matrix arrow_points(const Framing& framing, const Moment& moment, int finer = 1);
inline constexpr int finest_arrow_net = 3;

/// 1, or less when a turning camera sees the plane of the arrows too obliquely; 0: edge on.
double arrows_shown(const Framing& framing, const Moment& moment);

}  // namespace render
