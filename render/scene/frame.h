// One frame as a value: everything that draw_frame() needs.
#pragma once

#include "render/core/colormap.h"
#include "render/core/palette.h"
#include "render/core/parameters.h"
#include "render/scene/camera.h"
#include "render/scene/faces.h"
#include "render/scene/mesh.h"

#include <optional>

namespace render {

/// The part of a body removed by a plane, for the style "cutaway".
struct Cut {
  glm::dvec3 normal{0, -1, 0};                 ///< unit vector toward the removed side
  glm::dvec3 point{0};                         ///< of the plane
  std::vector<std::vector<glm::dvec3>> edges;  ///< closed curves, the first point is not repeated
};

struct Body {
  Mesh mesh;
  Colour colour = body_colour(0);
  std::optional<Cut> cut;
};

/// The colour bar of a field, or of a quantity that colours whole bodies.
struct Legend {
  std::string label;         ///< as in Captions
  double low = 0, high = 1;  ///< values at the ends of the map
  ColourTable colours{};
  bool below = false, above = false;  ///< values beyond that end occur; they have its colour
  /// A field whose map is symmetric in lightness about its middle: view.sign_dots marks the lower half.
  bool mirrored = false;
};

/// Background velocity at arrow_points(), sampled by the caller. In a fluid at rest a following camera shows beads
/// instead, to make its own motion visible.
struct FlowArrows {
  sim::Matrix points;      ///< count x 3
  sim::Matrix velocities;  ///< count x 3
  double reference_speed =
      0;             ///< drawn at full length; 0: the fastest of `velocities`. One value per movie keeps arrows steady.
  double shown = 1;  ///< 0: faded into the ground
};

/// Streamlines in space, with the positions of arrow heads.
struct FlowLines {
  struct Line {
    std::vector<glm::dvec3> points;
    bool closed = false;
    std::vector<std::size_t> heads;  ///< indices of points
  };
  std::vector<Line> lines;
};

/// UTF-8; `_{...}` and `^{...}` are subscripts and superscripts. Empty: not drawn.
struct Captions {
  std::string time;          ///< "γ̇t = 12.50"
  std::string parameters;    ///< "Ca = 2.0   λ = 1   ν = 0.85"
  std::string errors;        ///< below the parameters: "error of position 1.1·10^{−3} R_{0}"
  std::string note;          ///< below these, highlighted: a temporary remark for the viewer
  std::string title;         ///< in the middle of the upper edge
  std::string widest_title;  ///< of all panels of a picture, and their parameters: titles stand alike in all of them
  std::string widest_parameters;
  std::string panel;            ///< in the middle of the lower edge: which view this is
  std::string scale = "R_{0}";  ///< above the scale bar
  double scale_length = 1;      ///< of the bar, in lengths of the scene
};

/// Background velocity along a vertical line through the middle of the picture.
struct FlowProfile {
  std::vector<glm::dvec2> points;  ///< place: -1..1 from bottom to top of the picture; velocity to its right
  double reference_speed = 0;      ///< drawn at full length; 0: the fastest of these
};

/// The section of all vesicles with a plane y = constant.
struct Inset {
  struct Curve {
    std::vector<glm::dvec2> points;  ///< (x, z), closed
    Colour colour;
  };
  std::vector<Curve> curves;
  glm::dvec2 centre{0};
  double half_height = 1;
};

struct Frame {
  std::vector<Body> bodies;      ///< those that may be seen
  std::size_t vesicles = 0;      ///< of the state; 0: as many as bodies
  std::optional<FaceBox> faces;  ///< bodies end there, and its edges are drawn
  Camera camera;
  ViewParameters view;
  Captions captions;
  FlowArrows arrows;
  FlowLines flow_lines;  ///< behind everything, or at their depth where the style opens the membranes
  std::optional<FlowProfile> profile;
  std::optional<Inset> inset;
  std::optional<Legend> legend;  ///< needed by the style "field"
};

}  // namespace render
