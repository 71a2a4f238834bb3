// Every parameter of a picture, declared once, in the manner of sim/parameters.h: the default is the in-class
// initialiser of its member, and one visit() per struct adds name, unit, range, choices and meaning.
#pragma once

#include "sim/parameters.h"

namespace render {

using sim::Parameter;

inline constexpr std::array<std::string_view, 3> follow_names{"auto", "always", "never"};
inline constexpr std::array<std::string_view, 2> projection_names{"perspective", "orthographic"};
inline constexpr std::array<std::string_view, 2> line_names{"material", "grid"};
inline constexpr std::array<std::string_view, 2> background_names{"gradient", "white"};

/// [view]: how a frame looks.
struct ViewParameters {
  std::string camera = "flow-gradient";
  std::string follow = "auto";  ///< auto: follow the centroid once the drift exceeds a few radii
  std::string projection = "perspective";
  double zoom = 1;  ///< 1: everything that happens in the movie fits, with room for captions
  std::string style = "opaque";
  std::vector<int> size{1920, 1080};  ///< width, height
  int supersampling = 2;
  std::string lines = "material";
  int grid_parallels = 11;
  int grid_meridians = 24;
  double line_width = 2.2;     ///< px of the finished picture, at a height of 1080 px
  double outline_width = 2.2;  ///< px at 1080
  bool tracers = true;
  bool flow_arrows = true;
  bool time_stamp = true;
  bool caption = true;
  bool scale_bar = true;
  std::string background = "gradient";
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, ViewParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "camera", .unit = "", .meaning = "direction of view", .catalogue = "cameras"}, p.camera);
  v(Parameter{.name = "follow",
              .unit = "",
              .meaning = "move with the centroid; auto: when it drifts by more than a few radii",
              .choices = follow_names},
    p.follow);
  v(Parameter{.name = "projection",
              .unit = "",
              .meaning = "perspective, or orthographic to measure in the picture",
              .choices = projection_names},
    p.projection);
  v(Parameter{.name = "zoom",
              .unit = "",
              .meaning = "1: the whole movie fits; larger is nearer",
              .minimum = 0.05,
              .maximum = 50},
    p.zoom);
  v(Parameter{.name = "style", .unit = "", .meaning = "how vesicles are painted", .catalogue = "styles"}, p.style);
  v(Parameter{.name = "size", .unit = "px", .meaning = "width and height of the picture", .minimum = 16, .maximum = 8192},
    p.size);
  v(Parameter{.name = "supersampling",
              .unit = "",
              .meaning = "samples along each side of a pixel: 1 draft, 2 movies, 3 stills",
              .minimum = 1,
              .maximum = 4},
    p.supersampling);
  v(Parameter{.name = "lines",
              .unit = "",
              .meaning = "what the lines on the membrane move with: its material, or the grid",
              .choices = line_names},
    p.lines);
  v(Parameter{.name = "grid_parallels",
              .unit = "",
              .meaning = "number of parallels between the poles; 0: none",
              .minimum = 0,
              .maximum = 90},
    p.grid_parallels);
  v(Parameter{.name = "grid_meridians",
              .unit = "",
              .meaning = "number of meridians round the axis; 0: none",
              .minimum = 0,
              .maximum = 180},
    p.grid_meridians);
  v(Parameter{.name = "line_width",
              .unit = "px",
              .meaning = "width of the lines on the membrane at 1080 px of height",
              .minimum = 0,
              .maximum = 20},
    p.line_width);
  v(Parameter{.name = "outline_width",
              .unit = "px",
              .meaning = "width of the contour round a vesicle at 1080 px of height",
              .minimum = 0,
              .maximum = 20},
    p.outline_width);
  v(Parameter{.name = "tracers", .unit = "", .meaning = "draw the tracer dots"}, p.tracers);
  v(Parameter{.name = "flow_arrows", .unit = "", .meaning = "draw arrows of the background flow"}, p.flow_arrows);
  v(Parameter{.name = "time_stamp", .unit = "", .meaning = "write the time"}, p.time_stamp);
  v(Parameter{.name = "caption", .unit = "", .meaning = "write the physical parameters"}, p.caption);
  v(Parameter{.name = "scale_bar", .unit = "", .meaning = "draw a bar one area radius long"}, p.scale_bar);
  v(Parameter{.name = "background", .unit = "", .meaning = "the ground behind everything", .choices = background_names},
    p.background);
}

/// [movie]: which frames there are.
struct MovieParameters {
  double frame_rate = 30;
  double time_per_frame = 0;  ///< 0: save_every, one frame a saved state
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, MovieParameters>
void visit(P& p, V&& v) {
  v(
      Parameter{
          .name = "frame_rate", .unit = "1/s", .meaning = "frames per second of the video", .minimum = 0.1, .maximum = 240},
      p.frame_rate);
  v(Parameter{.name = "time_per_frame",
              .unit = "time",
              .meaning = "simulated time from frame to frame; 0: save_every, one frame a saved state",
              .minimum = 0},
    p.time_per_frame);
}

/// [[figure]]: one figure a table.
struct FigureParameters {
  std::string kind = "cross-sections";
  std::string out;            ///< file name without extension; empty: the kind's name
  std::vector<double> times;  ///< empty: evenly spread over the trajectory
  int panels = 6;
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, FigureParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "kind", .unit = "", .meaning = "which figure", .catalogue = "figures"}, p.kind);
  v(
      Parameter{
          .name = "out", .unit = "", .meaning = "file name without extension; empty: the name of the kind", .is_path = true},
      p.out);
  v(Parameter{.name = "times",
              .unit = "time",
              .meaning = "instants to show; empty: evenly spread over the trajectory",
              .minimum = 0},
    p.times);
  v(Parameter{.name = "panels",
              .unit = "",
              .meaning = "how many instants, when times are not given",
              .minimum = 1,
              .maximum = 64},
    p.panels);
}

}  // namespace render
