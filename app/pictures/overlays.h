// What stands on a frame besides the flow: the inset, the captions and a note.
#pragma once

#include "app/pictures/panel.h"

namespace app {

/// What the insets of all frames must hold: sets inset_centre and inset_half of a panel that has its framing.
void frame_inset(ViewPanel&, const std::vector<render::StateSummary>&);

/// Its middle in a frame, (x, z); centre: what a following camera follows. Half of its height, in every frame.
glm::dvec2 inset_centre(const ViewPanel&, const glm::dvec3& centre);
double inset_half_height(const ViewPanel&);

/// All vesicles cut by the plane y = that of what the camera follows or aims at. centre: what a following camera
/// follows.
render::Inset inset_of(const ViewPanel&, const sim::State&, const render::Camera&, const glm::dvec3& centre);

/// The captions of the panel, with the time and a note where it is stamped.
render::Captions captions_of(const ViewPanel&, double time);

}  // namespace app
