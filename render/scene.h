// One frame as a value: everything that draw_frame() needs, and nothing it could look up elsewhere.
#pragma once

#include "camera.h"
#include "mesh.h"
#include "palette.h"
#include "parameters.h"

namespace render {

struct Body {
  Mesh mesh;
  Colour colour = body_colours[0];
};

/// Background velocity at arrow_points(), sampled by whoever knows the flow. Where everything rests, a camera that follows
/// shows beads at rest instead, or nothing would tell that it moves.
struct FlowArrows {
  sim::Matrix points;      ///< count x 3
  sim::Matrix velocities;  ///< count x 3
  double reference_speed =
      0;  ///< drawn at full length; 0: the fastest of `velocities`. One value a movie keeps arrows steady.
};

/// UTF-8; `_{...}` and `^{...}` lower and raise. Empty: not drawn.
struct Captions {
  std::string time;             ///< "γ̇t = 12.50"
  std::string parameters;       ///< "Ca = 2.0   λ = 1   ν = 0.85"
  std::string scale = "R_{0}";  ///< above the scale bar
  double scale_length = 1;      ///< of the bar, in lengths of the scene
};

struct Frame {
  std::vector<Body> bodies;
  Camera camera;
  ViewParameters view;
  Captions captions;
  FlowArrows arrows;
};

}  // namespace render
