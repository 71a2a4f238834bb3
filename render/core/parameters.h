// Every parameter of a picture, declared once, in the manner of sim/core/parameters.h: the default is the in-class
// initialiser of its member, and one visit() per struct adds name, unit, range, choices and meaning.
#pragma once

#include "sim/core/parameters.h"

namespace render {

using sim::Parameter;

inline constexpr std::array<std::string_view, 4> follow_names{"auto", "always", "never", "vesicle"};
inline constexpr std::array<std::string_view, 2> projection_names{"perspective", "orthographic"};
inline constexpr std::array<std::string_view, 2> line_names{"material", "grid"};
inline constexpr std::array<std::string_view, 2> plot_places{"below", "beside"};
inline constexpr std::array<std::string_view, 2> detail_names{"auto", "full"};
inline constexpr std::array<std::string_view, 2> face_names{"cut", "whole"};
inline constexpr std::array<std::string_view, 2> cut_names{"each", "common"};
inline constexpr std::array<std::string_view, 3> streamline_names{"off", "laboratory", "vesicles"};
inline constexpr std::array<std::string_view, 1> range_words{"shared"};
inline constexpr std::array<std::string_view, 5> colour_by_names{"order", "viscosity_contrast", "bending_modulus",
                                                                 "density_difference", "reduced_volume"};

/// Of the colours of a field: two ends, or how they are found.
struct FieldRange {
  std::vector<double> ends;  ///< lowest and highest; empty: they follow what is shown
  bool shared = false;       ///< ... of all instants of all trajectories of the command

  bool given() const { return !ends.empty(); }
};

/// [view]: how a frame looks.
struct ViewParameters {
  std::string camera = "flow-gradient";
  std::vector<std::string> views;  ///< several cameras in one frame; empty: the one above
  std::string follow = "auto";     ///< auto: follow the centroid once it drifts by half the extent
  int follow_vesicle = 0;
  std::string projection = "perspective";
  double zoom = 1;   ///< 1: everything that happens in the movie fits, with room for captions
  double orbit = 0;  ///< degrees per unit of time, about the z axis
  std::optional<sim::Vec3> eye, target;
  sim::Vec3 up = sim::Vec3::UnitZ();
  std::string style = "opaque";
  std::string field = "tension";
  std::optional<std::string> colour_map;
  FieldRange field_range;
  double opacity = 0.30;  ///< of a ghost's membrane seen straight on
  sim::Vec3 cut_normal = -sim::Vec3::UnitY();
  double cut_offset = 0;
  std::string cut = "each";
  std::vector<std::string> colours;
  std::string colour_by = "order";
  std::vector<int> size{1920, 1080};  ///< width, height
  int supersampling = 2;
  std::string lines = "material";
  int grid_parallels = 11;
  int grid_meridians = 24;
  double line_width = 2.2;     ///< px of the finished picture, at a height of 1080 px
  double outline_width = 2.2;  ///< px at 1080
  bool tracers = true;
  bool flow_arrows = true;
  std::string streamlines = "off";
  bool time_stamp = true;
  bool caption = true;
  bool errors = false;
  bool scale_bar = true;
  bool title = false;
  bool triad = false;
  bool flow_profile = false;
  bool inset = false;
  bool colour_bar = true;
  bool sign_dots = true;
  std::string background = "gradient";
  std::vector<std::string> plots;  ///< quantities against time beside the picture
  std::string plots_at = "below";
  std::optional<double> depth_cue;
  double occlusion = 1;
  std::string detail = "auto";
  std::vector<int> copies{0, 0, 0};  ///< on each side of a periodic cell, along x, y, z
  std::string faces = "cut";         ///< of a periodic cell
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, ViewParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "camera", .unit = "", .meaning = "direction of view", .catalogue = "cameras"}, p.camera);
  v(Parameter{.name = "views",
              .unit = "",
              .meaning = "several directions of view side by side in one frame; empty: the camera alone",
              .catalogue = "cameras"},
    p.views);
  v(Parameter{.name = "follow",
              .unit = "",
              .meaning = "move with the centroid of all, or with one vesicle; auto: when it drifts by more than half "
                         "of what is seen at once",
              .choices = follow_names},
    p.follow);
  v(Parameter{.name = "follow_vesicle",
              .unit = "",
              .meaning = "which one, counted from 0, when follow is vesicle",
              .minimum = 0},
    p.follow_vesicle);
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
  v(Parameter{.name = "orbit",
              .unit = "degree/time",
              .meaning = "the camera turns about the z axis at this rate",
              .minimum = -1e5,
              .maximum = 1e5},
    p.orbit);
  v(Parameter{.name = "eye",
              .unit = "length",
              .meaning = "where the camera stands; zoom then only narrows the angle of view",
              .when_absent = "where camera and framing put it"},
    p.eye);
  v(Parameter{.name = "target",
              .unit = "length",
              .meaning = "the point in the middle of the picture",
              .when_absent = "the middle of what happens in the movie"},
    p.target);
  v(Parameter{.name = "up", .unit = "", .meaning = "direction that points up the picture, when eye is given"}, p.up);
  v(Parameter{.name = "style", .unit = "", .meaning = "how vesicles are painted", .catalogue = "styles"}, p.style);
  v(Parameter{.name = "field", .unit = "", .meaning = "what the style field paints", .catalogue = "fields"}, p.field);
  v(Parameter{.name = "colour_map",
              .unit = "",
              .meaning = "colours of the field",
              .catalogue = "colour_maps",
              .when_absent = "viridis, or blue-red for fields with a sign"},
    p.colour_map);
  v(
      Parameter{
          .name = "field_range",
          .unit = "",
          .meaning =
              "values at both ends of the colour bar; empty: all but the outermost 0.5 % of what is shown, the whole "
              "movie or movies side by side without what happens at their start alone, or the still; shared: those of "
              "all movies of the command, in stills and in figures, too",
          .choices = range_words},
      p.field_range);
  v(Parameter{.name = "opacity",
              .unit = "",
              .meaning = "of the membranes in the style ghost, seen straight on",
              .minimum = 0,
              .maximum = 1},
    p.opacity);
  v(Parameter{.name = "cut_normal",
              .unit = "",
              .meaning = "the style cutaway takes away what lies on this side of a plane"},
    p.cut_normal);
  v(Parameter{.name = "cut_offset",
              .unit = "length",
              .meaning = "of that plane along cut_normal, from the centre that cut says"},
    p.cut_offset);
  v(Parameter{.name = "cut",
              .unit = "",
              .meaning = "where the plane lies: through the centre of each vesicle, or one through that of all",
              .choices = cut_names},
    p.cut);
  v(Parameter{.name = "colours",
              .unit = "",
              .meaning = "of the vesicles in turn: names of list colours, or #rrggbb; empty: all of that list"},
    p.colours);
  v(Parameter{.name = "colour_by",
              .unit = "",
              .meaning = "colour vesicles in turn, or by a quantity of theirs, on colour_map",
              .choices = colour_by_names},
    p.colour_by);
  v(
      Parameter{
          .name = "size", .unit = "px", .meaning = "width and height of the picture", .minimum = 16, .maximum = 8192},
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
  v(Parameter{.name = "streamlines",
              .unit = "",
              .meaning =
                  "draw streamlines of the whole flow in place of the arrows, at rest or moving with the vesicles; for "
                  "stills: they take seconds a frame and are laid anew in each",
              .choices = streamline_names},
    p.streamlines);
  v(Parameter{.name = "time_stamp", .unit = "", .meaning = "write the time"}, p.time_stamp);
  v(Parameter{.name = "caption", .unit = "", .meaning = "write the physical parameters"}, p.caption);
  v(Parameter{.name = "errors",
              .unit = "",
              .meaning = "write the error of position that the time steps so far are estimated to leave"},
    p.errors);
  v(Parameter{.name = "scale_bar", .unit = "", .meaning = "draw a bar one area radius long"}, p.scale_bar);
  v(Parameter{.name = "title", .unit = "", .meaning = "write the title of the scene"}, p.title);
  v(Parameter{.name = "triad", .unit = "", .meaning = "draw the directions of the axes x, y, z"}, p.triad);
  v(
      Parameter{
          .name = "flow_profile", .unit = "", .meaning = "draw the profile of the background flow at the left edge"},
      p.flow_profile);
  v(Parameter{.name = "inset", .unit = "", .meaning = "draw the cross-section in the (x, z) plane in a corner"},
    p.inset);
  v(Parameter{.name = "colour_bar", .unit = "", .meaning = "draw the bar of the style field, or of colour_by"},
    p.colour_bar);
  v(Parameter{.name = "sign_dots",
              .unit = "",
              .meaning =
                  "fields on a diverging map: fine dots on the side below zero, which tell the sign in grey print"},
    p.sign_dots);
  v(Parameter{.name = "background",
              .unit = "",
              .meaning = "the ground behind everything: gradient, white, dark, #rrggbb or transparent"},
    p.background);
  v(Parameter{.name = "plots",
              .unit = "",
              .meaning = "quantities against time, drawn beside the picture with a mark at the time of the frame",
              .catalogue = "quantities"},
    p.plots);
  v(Parameter{.name = "plots_at", .unit = "", .meaning = "where these plots are", .choices = plot_places}, p.plots_at);
  v(Parameter{.name = "depth_cue",
              .unit = "",
              .meaning = "share by which the farthest of what the movie shows fades into the ground",
              .minimum = 0,
              .maximum = 1,
              .when_absent = "0.65 from 20 vesicles on, 0 for fewer"},
    p.depth_cue);
  v(Parameter{.name = "occlusion",
              .unit = "",
              .meaning = "how much hollows and neighbours darken solid membranes; 0: not at all, and faster",
              .minimum = 0,
              .maximum = 2},
    p.occlusion);
  v(Parameter{.name = "detail",
              .unit = "",
              .meaning = "auto: small vesicles have fewer lines, no dots and a finer contour; full: all have all",
              .choices = detail_names},
    p.detail);
  v(Parameter{.name = "copies",
              .unit = "",
              .meaning = "how many copies of a periodic cell are drawn on each side of it, along x, y and z",
              .minimum = 0,
              .maximum = 10},
    p.copies);
  v(Parameter{.name = "faces",
              .unit = "",
              .meaning =
                  "cut: vesicles end at the faces of a periodic cell and go on at the opposite ones; whole: those "
                  "whose centre is in it, which move to the opposite face from one frame to the next",
              .choices = face_names},
    p.faces);
}

/// [[key_frame]]: where the camera is at one time; between key frames it moves smoothly.
struct KeyFrameParameters {
  double time = 0;
  double azimuth = 0, elevation = 0;  ///< degrees
  double zoom = 1;
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, KeyFrameParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "time", .unit = "time", .meaning = "when the camera is there", .minimum = 0, .required = true},
    p.time);
  v(
      Parameter{
          .name = "azimuth", .unit = "degree", .meaning = "to the right of the flow-gradient view, about the z axis"},
      p.azimuth);
  v(
      Parameter{
          .name = "elevation", .unit = "degree", .meaning = "above the (x, y) plane", .minimum = -90, .maximum = 90},
      p.elevation);
  v(Parameter{.name = "zoom", .unit = "", .meaning = "times that of [view]", .minimum = 0.05, .maximum = 50}, p.zoom);
}

/// [movie]: which frames there are.
struct MovieParameters {
  std::string format = "mp4";
  std::optional<double> poster;
  double frame_rate = 30;
  double time_per_frame = 0;  ///< 0: save_every, one frame a saved state
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, MovieParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "format", .unit = "", .meaning = "kind of the movie file", .catalogue = "formats"}, p.format);
  v(Parameter{.name = "poster",
              .unit = "time",
              .meaning = "the frame at this time is also written as poster.png",
              .minimum = 0,
              .when_absent = "none"},
    p.poster);
  v(Parameter{.name = "frame_rate",
              .unit = "1/s",
              .meaning = "frames per second of the video",
              .minimum = 0.1,
              .maximum = 240},
    p.frame_rate);
  v(Parameter{.name = "time_per_frame",
              .unit = "time",
              .meaning = "simulated time from frame to frame; 0: save_every, one frame a saved state",
              .minimum = 0},
    p.time_per_frame);
}

inline constexpr std::array<std::string_view, 2> size_units{"mm", "px"};
inline constexpr std::array<std::string_view, 3> window_names{"auto", "common", "own"};
inline constexpr std::array<std::string_view, 2> frame_names{"laboratory", "vesicle"};
inline constexpr std::array<std::string_view, 2> flow_background_names{"speed", "none"};
inline constexpr std::array<std::string_view, 2> text_names{"text", "paths"};
inline constexpr std::array<std::string_view, 2> diagram_vesicles{"pictures", "sections"};
inline constexpr std::array<std::string_view, 2> font_names{"sans", "serif"};

/// [[figure]]: one figure a table.
struct FigureParameters {
  std::string kind = "cross-sections";
  std::string out;            ///< file name without extension; empty: the kind's name
  std::vector<double> times;  ///< empty: evenly spread over the trajectory
  int panels = 6;
  int columns = 0;
  std::vector<double> size;  ///< width, or width and height; empty: as the kind and the theme say
  std::string unit = "mm";
  std::string theme = "paper";
  std::string ground = "theme";
  std::string font = "sans";
  std::string text = "text";  ///< of PDF and SVG
  double font_size = 0;       ///< pt; 0: the theme's
  std::optional<double> dots_per_inch;
  std::vector<double> plane_point;  ///< empty: through the centroid of each vesicle
  sim::Vec3 plane_normal{0, 1, 0};
  std::string window = "auto";
  std::vector<std::string> quantities{"inclination", "axes", "energy", "errors"};
  std::string abscissa = "inclination";
  std::string ordinate = "deformation";
  std::string frame = "vesicle";
  double spacing = 0.16;  ///< of streamlines, R0
  double margin = 1;      ///< round the vesicles in a picture of the flow, R0
  std::string background = "speed";
  std::vector<std::string> axes;  ///< of a phase diagram; empty: found
  std::string vesicles = "pictures";
  std::optional<double> from;  ///< of a mean over time
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, FigureParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "kind", .unit = "", .meaning = "which figure", .catalogue = "figures"}, p.kind);
  v(Parameter{.name = "out",
              .unit = "",
              .meaning = "file name without extension; empty: the name of the kind",
              .is_path = true},
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
  v(Parameter{.name = "columns",
              .unit = "",
              .meaning = "panels in a row; 0: as many as look well",
              .minimum = 0,
              .maximum = 64},
    p.columns);
  v(Parameter{.name = "size",
              .unit = "unit",
              .meaning = "width of the page, or width and height; empty: as kind and theme say",
              .minimum = 10,
              .maximum = 20000},
    p.size);
  v(
      Parameter{
          .name = "unit", .unit = "", .meaning = "of size: millimetres, or pixels of the PNG", .choices = size_units},
      p.unit);
  v(Parameter{.name = "theme", .unit = "", .meaning = "sizes of text and lines, colours, page", .catalogue = "themes"},
    p.theme);
  v(
      Parameter{
          .name = "ground",
          .unit = "",
          .meaning =
              "of the page: theme, white, dark, transparent, gradient (its mean), or #rrggbb; ink and colours follow"},
      p.ground);
  v(Parameter{.name = "font", .unit = "", .meaning = "of all text", .choices = font_names}, p.font);
  v(Parameter{.name = "text",
              .unit = "",
              .meaning = "in PDF and SVG: text that can be searched and edited, or its outlines",
              .choices = text_names},
    p.text);
  v(Parameter{.name = "font_size",
              .unit = "pt",
              .meaning = "of numbers and legends; the rest follows; 0: the theme's",
              .minimum = 0,
              .maximum = 72},
    p.font_size);
  v(Parameter{.name = "dots_per_inch",
              .unit = "1/inch",
              .meaning = "of the PNG, which says so itself",
              .minimum = 30,
              .maximum = 2400,
              .when_absent = "300; 200 for a size in pixels, which is for a screen"},
    p.dots_per_inch);
  v(Parameter{.name = "plane_point",
              .unit = "length",
              .meaning = "a point of the plane that cuts all vesicles; empty: through the centroid of each"},
    p.plane_point);
  v(Parameter{.name = "plane_normal", .unit = "", .meaning = "normal of the plane of cross-sections and streamlines"},
    p.plane_normal);
  v(Parameter{.name = "window",
              .unit = "",
              .meaning = "of cross-sections: one for all, each round its own state, or common until vesicles drift far",
              .choices = window_names},
    p.window);
  v(Parameter{.name = "quantities", .unit = "", .meaning = "of time-series, a panel each", .catalogue = "quantities"},
    p.quantities);
  v(Parameter{.name = "abscissa", .unit = "", .meaning = "of a phase portrait", .catalogue = "quantities"}, p.abscissa);
  v(Parameter{.name = "ordinate", .unit = "", .meaning = "of a phase portrait", .catalogue = "quantities"}, p.ordinate);
  v(Parameter{.name = "frame",
              .unit = "",
              .meaning = "of streamlines: at rest, or moving with the centroid of the vesicles",
              .choices = frame_names},
    p.frame);
  v(Parameter{.name = "spacing",
              .unit = "R0",
              .meaning = "distance of neighbouring streamlines",
              .minimum = 0.02,
              .maximum = 10},
    p.spacing);
  v(Parameter{.name = "margin",
              .unit = "R0",
              .meaning = "round the vesicles in a picture of the flow",
              .minimum = 0.05,
              .maximum = 100},
    p.margin);
  v(Parameter{.name = "background",
              .unit = "",
              .meaning = "under streamlines: the speed by colours with a bar, or nothing",
              .choices = flow_background_names},
    p.background);
  v(Parameter{.name = "axes",
              .unit = "",
              .meaning = "of a phase diagram: two keys of the scene, such as vesicle.reduced_volume and flow.rate; "
                         "empty: those in which the scenes differ"},
    p.axes);
  v(Parameter{.name = "vesicles",
              .unit = "",
              .meaning = "in a phase diagram: pictures in the style of the view, coloured by the motion, or sections",
              .choices = diagram_vesicles},
    p.vesicles);
  v(Parameter{.name = "from",
              .unit = "time",
              .meaning = "of a pair distribution: states from then on are averaged",
              .minimum = 0,
              .when_absent = "the last third of the run"},
    p.from);
}

}  // namespace render
