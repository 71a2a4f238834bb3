// Every parameter of a simulation, declared once: its default is the in-class initialiser of its member, and one
// visit() per struct adds name, unit, range, choices and meaning. The command line, the scene reader, the writer of the
// resolved scene, the trajectory header and the reference page all walk these visits; nothing else lists parameters.
//
// A visitor is called as v(const Parameter&, Member&) for each member, in the order of the scene file.
// Member types: bool, int, double, std::string, Vec3, vectors and std::optional of these; an empty optional is "not
// given".
#pragma once

#include "sim/core/types.h"

#include <array>
#include <concepts>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>

namespace sim {

/// What is known of one key of a scene beside its value.
struct Parameter {
  std::string_view name;
  std::string_view unit;     ///< in the scene's non-dimensional units (mu = 1); empty for a pure number or a word
  std::string_view meaning;  ///< one line, no full stop
  double minimum = -std::numeric_limits<double>::infinity();  ///< of numbers, and of each component of a list
  double maximum = std::numeric_limits<double>::infinity();
  bool exclusive_minimum = false;
  bool exclusive_maximum = false;
  std::span<const std::string_view> choices = {};  ///< allowed words; empty: any
  std::string_view catalogue = {};    ///< the allowed words are the names of this catalogue ("flows", "shapes", ...)
  bool required = false;              ///< a table without this key is refused
  bool zero_is_auto = false;          ///< integers: 0, whatever the minimum, is written and read as "auto"
  std::string_view when_absent = {};  ///< optionals: what holds when the key is not given
  bool computed =
      false;  ///< optionals that only some kinds have: what holds is computed, so these kinds do without the key
  std::string_view refused = {};  ///< not empty: the key is reserved; giving it is an error with this sentence
  bool is_path = false;           ///< a file name
  std::string_view instead = {};  ///< what to give where a value is refused
};

inline constexpr double unlimited = std::numeric_limits<double>::infinity();
inline constexpr std::array<std::string_view, 3> time_factor_names{"constant", "oscillating", "step"};
inline constexpr std::array<std::string_view, 4> reparametrization_names{"moving", "auto", "always", "off"};

inline constexpr std::array<std::string_view, 2> preconditioner_names{"spectral", "block"};
inline constexpr std::array<std::string_view, 3> far_field_names{"auto", "direct", "fast"};

/// One term of the background flow u_inf; several terms add up.
struct FlowParameters {
  std::string kind = "none";
  double rate = 1;                       ///< shear: u = rate z e_x; extension: rate (x, 0, -z) or rate (x, -y/2, -z/2)
  double curvature = 0;                  ///< poiseuille: a in u_x = U - a (y^2 + z^2)
  double centreline_velocity = 0;        ///< poiseuille, streams: U
  std::optional<double> wavelength;      ///< streams: l
  bool planar = true;                    ///< extension
  Vec3 angular_velocity = Vec3::Zero();  ///< rotation: u = omega x x
  Vec3 velocity = Vec3::Zero();          ///< uniform
  std::string time_factor =
      "constant";  ///< oscillating: cos(2 pi frequency t + phase); step: 1 in [from, until), else 0
  double frequency = 1;
  double phase = 0;
  double from = 0;
  double until = unlimited;
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, FlowParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "kind", .unit = "", .meaning = "which flow", .catalogue = "flows"}, p.kind);
  v(Parameter{.name = "rate", .unit = "1/time", .meaning = "shear or extension rate"}, p.rate);
  v(Parameter{.name = "curvature", .unit = "1/(length time)", .meaning = "a in u_x = U - a (y^2 + z^2)"}, p.curvature);
  v(Parameter{.name = "centreline_velocity",
              .unit = "length/time",
              .meaning = "U in u_x = U - a (y^2 + z^2), and of the streams"},
    p.centreline_velocity);
  v(Parameter{.name = "wavelength",
              .unit = "length",
              .meaning = "l of the streams, twice the distance of a stream from those beside it, which flow back",
              .minimum = 0,
              .exclusive_minimum = true,
              .when_absent = "streams need it"},
    p.wavelength);
  v(Parameter{.name = "planar", .unit = "", .meaning = "true: rate (x, 0, -z); false: rate (x, -y/2, -z/2)"}, p.planar);
  v(Parameter{.name = "angular_velocity", .unit = "1/time", .meaning = "omega in u = omega x r"}, p.angular_velocity);
  v(Parameter{.name = "velocity", .unit = "length/time", .meaning = "the uniform velocity"}, p.velocity);
  v(Parameter{.name = "time_factor",
              .unit = "",
              .meaning = "the flow times 1, times cos(2 pi frequency t + phase), or switched on from <= t < until",
              .choices = time_factor_names},
    p.time_factor);
  v(Parameter{.name = "frequency", .unit = "1/time", .meaning = "of an oscillating flow, in cycles", .minimum = 0},
    p.frequency);
  v(Parameter{.name = "phase", .unit = "rad", .meaning = "of an oscillating flow"}, p.phase);
  v(Parameter{.name = "from", .unit = "time", .meaning = "a stepped flow acts from this time"}, p.from);
  v(Parameter{.name = "until", .unit = "time", .meaning = "... and up to this time"}, p.until);
}

struct TimeParameters {
  double end = 0;
  std::optional<double> tolerance;    ///< of adaptive steps
  std::optional<double> step;         ///< of fixed ones
  std::optional<std::string> scheme;  ///< not given: bdf2 where a step is given, adaptive otherwise
  std::optional<double> save_every;   ///< not given: see derived.h
};
/// Errors of steps below it are rounding and residuals.
inline constexpr double least_tolerance = 1e-6;

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, TimeParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "end",
              .unit = "time",
              .meaning = "the simulation runs from 0 to this time",
              .minimum = 0,
              .required = true},
    p.end);
  v(Parameter{.name = "tolerance",
              .unit = "",
              .meaning =
                  "error of position that steps may leave, in area radii for each radius that the membrane moves",
              .minimum = least_tolerance,
              .maximum = 0.1,
              .when_absent = "0.001, or none where a step is given"},
    p.tolerance);
  v(Parameter{.name = "step",
              .unit = "time",
              .meaning = "fixed time step; shortened where save_every or end is not a multiple of it",
              .minimum = 0,
              .exclusive_minimum = true,
              .when_absent = "steps follow the tolerance"},
    p.step);
  v(Parameter{.name = "scheme",
              .unit = "",
              .meaning = "time stepping scheme",
              .catalogue = "schemes",
              .when_absent = "adaptive, or bdf2 where a step is given"},
    p.scheme);
  v(Parameter{.name = "save_every",
              .unit = "time",
              .meaning = "time between saved states",
              .minimum = 0,
              .exclusive_minimum = true,
              .when_absent = "end/200, or step"},
    p.save_every);
}

inline constexpr int largest_vesicle_order = 64;

struct VesicleParameters {
  std::string shape = "sphere";
  std::optional<double> reduced_volume;  ///< nu = 6 sqrt(pi) V / A^(3/2)
  std::optional<Vec3> axes;              ///< ellipsoid: semi-axes along axis, the y axis made perpendicular, the third
  std::optional<double> area;            ///< not given: 4 pi, except where axes set the size
  std::optional<double> radius;          ///< area radius, instead of area
  Vec3 center = Vec3::Zero();
  std::optional<Vec3> axis;       ///< symmetry axis of the shape; the grid's pole lies on it; any length but 0
  int order = 0;                  ///< p; 0: automatic
  double viscosity_contrast = 1;  ///< lambda = inside / outside
  double bending_modulus = 0.01;  ///< kappa_b of E = kappa_b oint H^2 dA (twice Helfrich's)
  double density_difference = 0;  ///< inside - outside
  std::vector<std::array<double, 3>>
      coefficients;                     ///< harmonics: terms [n, m, value] of the radius, unit sphere + terms
  std::string file;                     ///< shape "file"
  std::optional<std::string> checksum;  ///< of the file: resolved scenes say it
};

/// Area of a vesicle whose size is not given: that of the unit sphere.
inline constexpr double default_area = 4 * std::numbers::pi;

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, VesicleParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "shape", .unit = "", .meaning = "initial shape", .catalogue = "shapes"}, p.shape);
  v(Parameter{.name = "reduced_volume",
              .unit = "",
              .meaning = "nu = 6 sqrt(pi) V / A^(3/2) of the initial shape",
              .minimum = 0,
              .maximum = 1,
              .exclusive_minimum = true,
              .when_absent = "the shape's own"},
    p.reduced_volume);
  v(Parameter{.name = "axes",
              .unit = "length",
              .meaning = "semi-axes: along axis, along the y axis made perpendicular to it, along the third direction",
              .minimum = 0,
              .exclusive_minimum = true,
              .when_absent = "only ellipsoids have them"},
    p.axes);
  v(Parameter{.name = "area",
              .unit = "length^2",
              .meaning = "the shape is scaled to this area",
              .minimum = 0,
              .exclusive_minimum = true,
              .when_absent = "4 pi, or as axes or file say"},
    p.area);
  v(Parameter{.name = "radius",
              .unit = "length",
              .meaning = "the shape is scaled to the area of a sphere of this radius",
              .minimum = 0,
              .exclusive_minimum = true,
              .when_absent = "see area"},
    p.radius);
  v(Parameter{.name = "center", .unit = "length", .meaning = "where the shape's origin lies"}, p.center);
  v(Parameter{.name = "axis",
              .unit = "",
              .meaning = "direction of the shape's symmetry axis (of a table: its z axis) and of the grid's pole",
              .when_absent = "[1, 0, 0]; a table keeps its own axes"},
    p.axis);
  v(Parameter{.name = "order",
              .unit = "",
              .meaning = "p, highest degree of the spherical harmonics; auto: as the tolerance asks, changing during a "
                         "run; 8 with fixed steps",
              .minimum = 2,
              .maximum = largest_vesicle_order,
              .zero_is_auto = true},
    p.order);
  v(Parameter{.name = "viscosity_contrast",
              .unit = "",
              .meaning = "lambda, viscosity inside / outside",
              .minimum = 0,
              .exclusive_minimum = true,
              .instead = "0.001 is near a bubble, 1000 near a rigid body"},
    p.viscosity_contrast);
  v(Parameter{.name = "bending_modulus",
              .unit = "force length",
              .meaning = "kappa_b in E = kappa_b oint H^2 dA, twice Helfrich's modulus",
              .minimum = 0},
    p.bending_modulus);
  v(Parameter{.name = "density_difference", .unit = "mass/volume", .meaning = "density inside - outside"},
    p.density_difference);
  v(Parameter{.name = "coefficients",
              .unit = "",
              .meaning = "terms [n, m, value]: radius = 1 + sum of value Y_nm, before scaling"},
    p.coefficients);
  v(
      Parameter{
          .name = "file", .unit = "", .meaning = "table of points or coefficients, beside the scene", .is_path = true},
      p.file);
  v(Parameter{.name = "checksum",
              .unit = "",
              .meaning = "of the file; a file with another one is refused",
              .when_absent = "that of the file, whatever it holds"},
    p.checksum);
}

/// Lengths that follow the vesicles where none are given, in area radii R0 of the smallest.
inline constexpr double default_gap_floor = 1e-3, default_repulsion_range = 0.05, default_placement_gap = 0.05,
                        default_tube_radius = 3;

struct NumericsParameters {
  bool correction = true;
  std::string reparametrization = "moving";
  int least_order = 6, most_order = 24;  ///< of vesicles whose order is automatic
  int upsampling = 0;                    ///< q / p of differentiation; 0: Algorithm 1 chooses per vesicle
  double aliasing_tolerance = 1e-4;
  std::optional<double> gmres_tolerance;  ///< not given: see sim/core/derived.h
  int source_order = 0;                   ///< degree of the rotated source grids; 0: p + 1
  int label_order = 0;                    ///< degree of the material labels; 0: max(2p, 24)
  bool implicit_tension = true;
  std::string preconditioner = "spectral";
  std::string far_field = "auto";
  int interaction_order = 0;  ///< degree of the smooth source grids between vesicles; 0: p^(3/2)
  bool near_rule = true;
  int near_latitudes = 0;   ///< 0: as the tolerance asks
  int near_longitudes = 0;  ///< likewise
  double repulsion_strength = 0;
  std::optional<double> repulsion_range;
  std::optional<double> gap_floor;
  double tail_warning = 0.15;
  double step_area_bound = 0.02;
  double step_energy_bound = 0.5;
  int step_retries = 6;
  int threads = 0;  ///< 0: all processors
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, NumericsParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "correction", .unit = "", .meaning = "restore area and volume after each step"}, p.correction);
  v(Parameter{.name = "reparametrization",
              .unit = "",
              .meaning = "grid points slide along the membrane as part of each step, are moved when needed, at every "
                         "step, or never",
              .choices = reparametrization_names},
    p.reparametrization);
  v(Parameter{.name = "least_order",
              .unit = "",
              .meaning = "least order of vesicles whose order is \"auto\"",
              .minimum = 2,
              .maximum = largest_vesicle_order},
    p.least_order);
  v(Parameter{.name = "most_order",
              .unit = "",
              .meaning = "largest order of vesicles whose order is \"auto\"",
              .minimum = 2,
              .maximum = largest_vesicle_order},
    p.most_order);
  v(Parameter{.name = "upsampling",
              .unit = "",
              .meaning = "grid factor of differentiation; auto: Algorithm 1, per vesicle",
              .minimum = 0,
              .maximum = 8,
              .zero_is_auto = true},
    p.upsampling);
  v(Parameter{.name = "aliasing_tolerance",
              .unit = "",
              .meaning = "relative aliasing error that Algorithm 1 allows",
              .minimum = 0,
              .maximum = 1,
              .exclusive_minimum = true},
    p.aliasing_tolerance);
  v(Parameter{.name = "gmres_tolerance",
              .unit = "",
              .meaning = "relative residual of each linear solve",
              .minimum = 0,
              .maximum = 1e-2,
              .exclusive_minimum = true,
              .when_absent =
                  "0.03 of time.tolerance; with fixed steps a ten-thousandth of the expected error of a step, "
                  "from 1e-10 to 1e-7, and 1e-10 where none is expected yet"},
    p.gmres_tolerance);
  v(Parameter{.name = "source_order",
              .unit = "",
              .meaning = "order of the singular quadrature; auto: p + 1",
              .minimum = 0,
              .maximum = 256,
              .zero_is_auto = true},
    p.source_order);
  v(Parameter{.name = "label_order",
              .unit = "",
              .meaning = "order of the material labels; auto: max(2p, 24)",
              .minimum = 4,
              .maximum = 128,
              .zero_is_auto = true},
    p.label_order);
  v(Parameter{.name = "implicit_tension",
              .unit = "",
              .meaning =
                  "the force of the tension follows the new position; false: that of the old one, as in the paper"},
    p.implicit_tension);
  v(Parameter{.name = "preconditioner",
              .unit = "",
              .meaning = "of the coupled solve: spectral, or a loose solve of each vesicle's own block",
              .choices = preconditioner_names},
    p.preconditioner);
  v(Parameter{.name = "far_field",
              .unit = "",
              .meaning =
                  "sums over all pairs of vesicles: directly, by Fourier transforms to the tolerance of the run, "
                  "or what costs less",
              .choices = far_field_names},
    p.far_field);
  v(Parameter{.name = "interaction_order",
              .unit = "",
              .meaning = "order of the smooth source grids between vesicles; auto: p^(3/2)",
              .minimum = 0,
              .maximum = 512,
              .zero_is_auto = true},
    p.interaction_order);
  v(Parameter{.name = "near_rule", .unit = "", .meaning = "near-singular quadrature between close vesicles"},
    p.near_rule);
  v(Parameter{.name = "near_latitudes",
              .unit = "",
              .meaning = "graded latitudes of the near-singular rule; auto: as the tolerance asks",
              .minimum = 4,
              .maximum = 512,
              .zero_is_auto = true},
    p.near_latitudes);
  v(Parameter{.name = "near_longitudes",
              .unit = "",
              .meaning = "longitudes of the near-singular rule; auto: as the tolerance asks",
              .minimum = 4,
              .maximum = 512,
              .zero_is_auto = true},
    p.near_longitudes);
  v(Parameter{.name = "repulsion_strength",
              .unit = "force/area",
              .meaning = "traction strength exp(-gap/range) that pushes membranes apart (not parts of one); what "
                         "is enough: docs/stepping.md; 0: none",
              .minimum = 0},
    p.repulsion_strength);
  v(Parameter{.name = "repulsion_range",
              .unit = "length",
              .meaning = "range of the repulsion, at least 0.001 R0",
              .minimum = 0,
              .exclusive_minimum = true,
              .when_absent = "0.05 R0 of the smallest vesicle"},
    p.repulsion_range);
  v(Parameter{.name = "gap_floor",
              .unit = "length",
              .meaning = "two membranes nearer than this stop the run",
              .minimum = 0,
              .when_absent = "0.001 R0 of the smallest vesicle"},
    p.gap_floor);
  v(Parameter{.name = "tail_warning",
              .unit = "",
              .meaning =
                  "warn of an unresolved shape when this share of the mean curvature's spectrum lies in its tail",
              .minimum = 0,
              .maximum = 1},
    p.tail_warning);
  v(Parameter{.name = "step_area_bound",
              .unit = "",
              .meaning =
                  "a step that changes the area by more than this share before the correction is repeated shorter",
              .minimum = 0,
              .exclusive_minimum = true},
    p.step_area_bound);
  v(Parameter{.name = "step_energy_bound",
              .unit = "",
              .meaning = "likewise for the bending energy",
              .minimum = 0,
              .exclusive_minimum = true},
    p.step_energy_bound);
  v(Parameter{.name = "step_retries",
              .unit = "",
              .meaning = "how often a failed step is halved before the run stops",
              .minimum = 0,
              .maximum = 30},
    p.step_retries);
  v(Parameter{.name = "threads",
              .unit = "",
              .meaning = "threads of the simulation; auto: all processors",
              .minimum = 0,
              .maximum = 1024,
              .zero_is_auto = true},
    p.threads);
}

struct BuoyancyParameters {
  Vec3 gravity = Vec3::Zero();
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, BuoyancyParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "gravity", .unit = "length/time^2", .meaning = "acts on each vesicle's density_difference"},
    p.gravity);
}

/// A periodic cell round the origin, whose copies fill space. A shear takes its upper and lower neighbours along.
struct CellParameters {
  std::optional<Vec3> size;
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, CellParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "size",
              .unit = "length",
              .meaning =
                  "lengths along x, y and z of the cell round the origin that repeats in all directions; a shear "
                  "takes the copies above and below along",
              .minimum = 0,
              .exclusive_minimum = true,
              .when_absent = "unbounded fluid"},
    p.size);
}

/// Many copies of the scene's last vesicle, so that a scene says "64 vesicles" in three lines. Reading a scene turns a
/// placement into vesicles; the resolved scene lists them.
struct PlacementParameters {
  std::string kind = "lattice";
  int count = 1;
  double volume_fraction = 0.05;
  std::optional<double> radius;  ///< tube
  double jitter = 0;             ///< lattice: share of its spacing that a centre may move
  std::optional<double> gap;     ///< least distance between two membranes
  double size_spread = 0;        ///< standard deviation of the radii over their mean
  std::string orientation = "as-given";
  int seed = 1;
  Vec3 center = Vec3::Zero();
  std::string file;
};
inline constexpr std::array<std::string_view, 2> orientation_names{"as-given", "random"};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, PlacementParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "kind", .unit = "", .meaning = "how the copies are placed", .catalogue = "placements"}, p.kind);
  v(Parameter{.name = "count", .unit = "", .meaning = "number of vesicles", .minimum = 1, .maximum = 100000}, p.count);
  v(Parameter{.name = "volume_fraction",
              .unit = "",
              .meaning = "of the box or tube, which sets its size or length",
              .minimum = 0,
              .maximum = 0.74,
              .exclusive_minimum = true},
    p.volume_fraction);
  v(Parameter{.name = "radius",
              .unit = "length",
              .meaning = "of the tube, whose axis is x",
              .minimum = 0,
              .exclusive_minimum = true,
              .when_absent = "3 R0 of the vesicle",
              .computed = true},
    p.radius);
  v(Parameter{.name = "jitter",
              .unit = "",
              .meaning = "random shift of lattice centres, as a share of the lattice spacing",
              .minimum = 0,
              .maximum = 0.5},
    p.jitter);
  v(Parameter{.name = "gap",
              .unit = "length",
              .meaning = "least distance between two membranes",
              .minimum = 0,
              .when_absent = "0.05 R0 of the vesicle",
              .computed = true},
    p.gap);
  v(Parameter{.name = "size_spread",
              .unit = "",
              .meaning = "standard deviation of the copies' radii over their mean, which is that of the vesicle; "
                         "log-normal",
              .minimum = 0,
              .maximum = 1},
    p.size_spread);
  v(Parameter{.name = "orientation", .unit = "", .meaning = "axis of each copy", .choices = orientation_names},
    p.orientation);
  v(Parameter{.name = "seed",
              .unit = "",
              .meaning = "of the random numbers; the same seed gives the same places and sizes",
              .minimum = 0},
    p.seed);
  v(Parameter{.name = "center", .unit = "length", .meaning = "centre of the box or tube"}, p.center);
  v(Parameter{.name = "file",
              .unit = "",
              .meaning = "table of centres, x y z or x y z with an axis, a row a vesicle",
              .is_path = true},
    p.file);
}

/// A saved state of another run, from which this one starts in place of the shapes of its vesicles.
struct StartParameters {
  std::optional<std::string> from;
  std::optional<double> time;
  std::optional<double> strain;
  std::optional<std::string> checksum;
};

template <class P, class V>
requires std::same_as<std::remove_const_t<P>, StartParameters>
void visit(P& p, V&& v) {
  v(Parameter{.name = "from",
              .unit = "",
              .meaning = "trajectory, beside the scene, in whose state the vesicles begin, at time 0 of this run",
              .when_absent = "the vesicles have the shapes that their tables say",
              .is_path = true},
    p.from);
  v(Parameter{.name = "time",
              .unit = "time",
              .meaning = "of a saved state of that trajectory",
              .minimum = 0,
              .when_absent = "its last state"},
    p.time);
  v(Parameter{.name = "strain",
              .unit = "",
              .meaning = "shear strain of the [cell] in that state, by less than half a cell either way",
              .when_absent = "as the trajectory says: resolved scenes say it"},
    p.strain);
  v(Parameter{.name = "checksum",
              .unit = "",
              .meaning = "of that state; another one is refused",
              .when_absent = "that of the state: resolved scenes say it"},
    p.checksum);
}

/// The physical half of a scene file: everything that the simulation depends on.
struct Scene {
  std::string title;
  std::vector<FlowParameters> flows;
  TimeParameters time;
  std::vector<VesicleParameters> vesicles;
  std::vector<PlacementParameters> placements;  ///< empty once they have been turned into vesicles
  NumericsParameters numerics;
  BuoyancyParameters buoyancy;
  CellParameters cell;
  StartParameters start;
};

/// A table of the scene file.
struct Section {
  std::string_view name;
  std::string_view meaning;
  bool required = false;
};

/// Calls v(const Section&, struct or vector of structs) for each table, in the order of the scene file.
template <class S, class V>
requires std::same_as<std::remove_const_t<S>, Scene>
void visit_sections(S& scene, V&& v) {
  v(Section{"flow", "background flow; [[flow]] several times: their sum", true}, scene.flows);
  v(Section{"time", "duration and steps", true}, scene.time);
  v(Section{"vesicle", "one table a vesicle; a start from a file may leave them to it", true}, scene.vesicles);
  v(Section{"placement", "many copies of the last vesicle; the resolved scene lists them one by one", false},
    scene.placements);
  v(Section{"numerics", "how accurately, and by which means", false}, scene.numerics);
  v(Section{"buoyancy", "sedimentation", false}, scene.buoyancy);
  v(Section{"cell", "periodic cell, of whose copies space is full", false}, scene.cell);
  v(Section{"start", "a saved state of another run to start from", false}, scene.start);
}

}  // namespace sim
