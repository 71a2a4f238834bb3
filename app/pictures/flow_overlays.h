// The flow in a frame: arrows or streamlines, and the profile beside the vesicles.
#pragma once

#include "app/pictures/panel.h"

#include "render/core/places.h"
#include "sim/layers/plans.h"

namespace app {

/// Background velocity at the net of arrows; empty where the view shows none.
render::FlowArrows arrows_of(const ViewPanel&, const render::StateSummary&);

/// The coarsest net of which enough arrows stand clear of vesicles and copies, or the one with most of them: one for
/// the whole movie, from the mean over its states.
int arrow_net_of(const ViewPanel&, const std::vector<render::StateSummary>&);

/// Streamlines of the whole flow in the plane of the arrows, as far as the picture reaches; none under what lies
/// over it, in these boxes, and none at all where the view shows none. Throws Interrupted at the first signal.
render::FlowLines flow_lines_of(sim::Plans&, const ViewPanel&, const sim::State&, const render::Camera&,
                                const std::vector<render::Box>& overlays);

/// The background velocity to the right of the picture along the vertical line through its middle.
render::FlowProfile profile_of(const ViewPanel&, const render::Camera&, double time);

}  // namespace app
