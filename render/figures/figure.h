// Figures for papers and slides: a catalogue of kinds, each drawn from values, written as PNG, SVG, PDF and CSV.
#pragma once

#include "render/core/parameters.h"
#include "render/figures/canvas.h"
#include "render/figures/plot_legend.h"
#include "render/figures/streamlines.h"
#include "render/scene/frame.h"

#include "sim/core/catalogue.h"
#include "sim/core/types.h"

#include <array>
#include <optional>
#include <vector>

namespace render {

/// Quantities against time, computed by the caller: one curve each; curves with the same `axis` share a panel.
struct Series {
  std::string name;   ///< column of the CSV
  std::string axis;   ///< label of the panel's y axis: "σR_{0}^{2}/κ_{b}"
  std::string group;  ///< whose curve it is, in the legend of the figure: colours and marks tell groups apart
  std::string part;   ///< which curve of its quantity, in the key of its panel: dashes tell parts apart
  std::vector<double> times, values;
  Scale scale = Scale::linear;
  bool faint = false;  ///< one of many
};

/// A panel of curves.
struct Curve {
  std::string name;  ///< in the legend of the figure; empty: not there
  std::string part;  ///< in the key of its panel; empty: not there
  std::vector<double> x, y;
  std::vector<double> error;      ///< half lengths of bars; empty: none
  bool band = false;              ///< errors are a tinted band along the curve instead
  std::size_t colour = 0;         ///< number of the palette
  std::optional<double> instant;  ///< 0..1: a colour between early and late instead of the palette
  std::optional<Marker> marker;
  double phase = -1;  ///< 0..1: marks along the curve, the first after this share of their distance; else at the points
  bool line = true;
  int dash = 0;
  bool directed = false;       ///< heads of arrows tell which way it runs
  bool fine = false;           ///< one of several that lie on each other: thinner, with small marks
  bool faint = false;          ///< one of many: thin
  bool guide = false;          ///< a value to compare with: thin, in ink
  bool ink_in_legend = false;  ///< the name tells a mark or dash, whatever the colour
  std::string csv_name = {};   ///< in the CSV; empty: the name and part, or the curve's number
};
struct Plot {
  Axis x, y;  ///< on a logarithmic axis the curves contain the values themselves
  std::vector<Curve> curves;
  std::optional<Range> x_range, y_range;
};
/// Marks of groups in turn.
Marker group_marker(std::size_t group);

/// The flow in a plane at one instant, computed by the caller.
struct FlowPicture {
  CutPlane plane;  ///< origin: zero of the coordinates of lines and speeds
  Range x, y;      ///< the window, in lengths of the scene
  std::vector<Streamline> lines;
  sim::Matrix speed;                  ///< on a net of cells, row 0 at the top; empty: no background
  std::array<Range, 2> speed_window;  ///< covered by the cells, along x and y
  std::string speed_label = "|u|";
  double speed_factor = 1;           ///< shown speed = this x speed
  double spacing = 0.2;              ///< of the lines, length
  std::vector<std::string> remarks;  ///< first lines of the CSV
  /// In a periodic cell the state has the images that the window shows: of which vesicles; else empty.
  std::vector<std::size_t> owners;
};

/// One vesicle in a phase diagram.
struct DiagramPoint {
  double x = 0, y = 0;
  std::size_t kind = 0;  ///< of its motion: number in Diagram::kinds
  /// Sections at some instants of its motion, the last of which is drawn full; relative to its centre, R0.
  std::vector<std::vector<ClosedCurve>> outlines;
  double time = 0;               ///< of the last instant
  double reach = 0;              ///< of what must be seen from its centre, R0
  std::optional<Image> picture;  ///< of the last instant, diagram_picture() wide and high; in place of the full section
};
/// Motions over two parameters.
struct Diagram {
  std::string x, y;                ///< labels of the axes
  std::vector<std::string> kinds;  ///< of motion, in the legend
  std::vector<DiagramPoint> points;
  std::string csv;
};

struct FigureInput {
  std::vector<sim::State> states;   ///< those to show
  std::optional<FaceBox> box = {};  ///< of a sheet: what each panel holds; none: the vesicles of its state
  std::vector<std::string> labels;  ///< one per vesicle, for the legend; may be empty
  std::vector<Series> series;       ///< of "time-series" and "inclination"
  std::vector<Plot> plots;          ///< for kinds drawn from plots
  std::vector<Image> stills;        ///< for "snapshots": the pictures requested by sheet_layout()
  bool shows_field = false;         ///< they show a field, whose bar needs room
  std::optional<Legend> field;      ///< its bar
  FlowPicture flow;                 ///< of "streamlines"
  Diagram diagram;                  ///< of "phase-diagram"
  std::string time_symbol = "t";    ///< "γ̇t"
  double time_factor = 1;           ///< shown time = this x State::time
  double length = 1;                ///< area radius: lengths are shown in units of it
  std::string length_symbol = "R_{0}";
  std::string camera = "flow-gradient";  ///< of the stills
  FigureParameters parameters;
};

struct Figure {
  Drawing drawing;
  std::string csv;  ///< the same data; the first line has the column names
};

/// The input of a kind of figure.
enum class FigureNeeds { instants, series, plots, stills, flow, diagram };

struct FigureRow {
  std::string_view name;
  std::string_view meaning;
  FigureNeeds needs;
  Figure (*draw)(const FigureInput&);
};
const std::vector<FigureRow>& figures();
/// Throws std::invalid_argument that names the nearest known kind.
const FigureRow& find_figure(std::string_view name);

/// Of the PNG.
double dots_per_inch(const FigureParameters& parameters);

/// A drawing on the ground and in the font of the theme, as the parameters ask.
Drawing drawing_on(const Theme& theme, const FigureParameters& parameters, double width, double height,
                   std::function<void(cairo_t*, const Font&)> paint);

/// The requested page: sizes in points, 0 where the kind of figure decides.
struct Page {
  Theme theme;
  double width = 0, height = 0;
};
Page page_of(const FigureParameters& parameters);

/// Instants of a figure: `times`, or those of `panels` states spread evenly, first and last among them. Throws
/// std::invalid_argument for a time beyond the last state.
std::vector<double> chosen_times(const std::vector<double>& state_times, const FigureParameters& parameters);

/// The plane of a figure; origin: the given point, or the vesicle's centroid. Its axes lie along x and z as far as
/// possible.
CutPlane plane_of(const FigureParameters& parameters, const sim::Vec3& centroid);
/// "x" for the first axis of the scene, and so on; "ξ" and "η" when the plane is oblique.
std::pair<std::string, std::string> axis_names(const CutPlane& plane);

/// One picture of a sheet: place on the page in points, content in lengths of the scene.
struct SheetPanel {
  double left = 0, top = 0, width = 0, height = 0;
  sim::Vec3 target = sim::Vec3::Zero();
  double half_height = 1;
  std::string title;
};
struct Sheet {
  double width = 0, height = 0;
  double scale = 1;  ///< points per length, the same for all panels
  std::vector<SheetPanel> panels;
};
/// Rows of panels at one scale that fill the page; the width of each follows its state.
Sheet sheet_layout(const FigureInput& input);

/// The square of a picture in a phase diagram.
struct DiagramPicture {
  double side = 0;   ///< pt
  double reach = 0;  ///< from its middle to its edge, R0
};
DiagramPicture diagram_picture(const FigureInput& input);
/// Of the vesicles whose motion has this number: that of their mark, but never black.
Colour diagram_colour(const Theme& theme, std::size_t kind);

/// "γ̇t = 2.5": with enough digits to distinguish the instants of the figure. `time`: as shown.
std::string time_text(const FigureInput& input, double time);

/// A text that may contain commas or quotes as one CSV cell.
std::string csv_cell(const std::string& text);

inline constexpr const char* figure_extensions[] = {".png", ".svg", ".pdf", ".csv"};
/// stem.png, stem.svg, stem.pdf, stem.csv; returns the four paths. `text` is stored in the PNG. Throws
/// std::runtime_error with path and reason.
std::vector<std::filesystem::path> write_figure(const Figure& figure, const std::filesystem::path& stem,
                                                const PngText& text = {},
                                                const sim::FileWriter& write = sim::write_file);

}  // namespace render
