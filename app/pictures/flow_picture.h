// The flow of a saved state in a plane, prepared for drawing: streamlines and speeds. Away from the membranes the
// velocity is interpolated from nets of samples; near a membrane, across which its gradient jumps, every value is
// computed.
#pragma once

#include "render/figures/figure.h"
#include "sim/core/parameters.h"
#include "sim/layers/plans.h"

namespace app {

struct FlowRequest {
  render::CutPlane plane;
  render::Range x, y;                            ///< window in the plane, lengths of the scene
  sim::Vec3 frame_velocity = sim::Vec3::Zero();  ///< subtracted everywhere
  double spacing = 0.2;                          ///< of the lines, length
  double length = 1;       ///< area radius: with the scene it determines which speeds are rounding errors
  bool with_speed = true;  ///< also speeds on a net, for the background
};

/// Throws Interrupted at the first signal: fine spacings take minutes.
render::FlowPicture flow_picture(sim::Plans&, const sim::Scene&, const sim::State&, const FlowRequest&);

/// What membranes a window shows: those of the state; of a boxed state in a periodic cell, all images that may reach
/// into the window, and the vesicles that they are images of.
struct WindowMembranes {
  sim::State state;
  std::vector<std::size_t> owners;
};
WindowMembranes membranes_in(const sim::Scene&, const sim::State&, const FlowRequest&);

/// Mean of the velocities of the vesicles' centroids.
sim::Vec3 frame_velocity(sim::Plans&, const sim::State&);

/// The request for a figure: plane, window around the sections, frame. `length`: the area radius.
FlowRequest flow_request(sim::Plans&, const sim::State&, const render::FigureParameters&, double length);

}  // namespace app
