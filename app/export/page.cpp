#include "app/export/page.h"

#include "app/base/markup.h"
#include "app/base/printable.h"
#include "app/base/version.h"
#include "app/export/json_members.h"
#include "app/export/page_series.h"
#include "app/pictures/cell_images.h"
#include "app/pictures/flow_overlays.h"
#include "app/pictures/instants.h"
#include "app/pictures/overlays.h"
#include "app/pictures/production.h"
#include "app/scene/output.h"
#include "page_files.h"

#include "render/core/assets.h"
#include "render/core/ground.h"
#include "render/core/paint.h"
#include "render/core/places.h"
#include "render/core/style.h"
#include "render/draw/arrow_shape.h"
#include "render/image/text.h"
#include "render/overlay/colour_bar.h"
#include "render/scene/detail.h"
#include "sim/measures/diagnostics.h"
#include "sim/membrane/cell.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <stdexcept>

namespace app {

namespace {

static_assert(std::endian::native == std::endian::little, "pages hold numbers in the machine's byte order");

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                bytes.size(), Z_BEST_COMPRESSION) != Z_OK)
    throw std::runtime_error("zlib cannot compress the page");
  packed.resize(size);
  return packed;
}

template <class T>
std::string memory_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// With variables between U+E000 and U+E001: a page sets them in italics.
std::string marked(const std::string& text) {
  std::string all;
  for (const render::TextRun& run : render::text_runs(text)) {
    const std::string inner = run.italic ? "\ue000" + run.text + "\ue001" : run.text;
    all += run.level == 0 ? inner : fmt::format("{}{{{}}}", run.level < 0 ? '_' : '^', inner);
  }
  return all;
}

/// The histories of one vesicle; all of them in the order of the page's bytes.
struct VesicleSeries {
  PageSeries position, labels, tracers, field;
  std::vector<std::size_t> breaks = {};  ///< frames before which the parametrisation or the labels began anew
  std::int64_t relabelled = 0, laid = 0;
  sim::Vec3 middle = sim::Vec3::Zero();  ///< of the last frame
};

class Recorder {
 public:
  Recorder(const ViewPanel& panel, const sim::TrajectoryReader& trajectory)
      : panel_(panel),
        arrows_(1e-4),
        targets_(1e-4),
        profile_(1e-3),
        through_(1e-4),
        inset_(1e-4),
        radius_(panel.captions.scale_length) {
    const sim::State first = trajectory.state(0);
    int order = 1, label_order = 1;
    for (std::int64_t k = 0; k < trajectory.count(); k += std::max<std::int64_t>(1, trajectory.count() / 20))
      for (const sim::VesicleState& v : trajectory.state(k).vesicles) {
        order = std::max(order, v.position.order);
        label_order = std::max(label_order, v.labels.order);
      }
    for (std::size_t v = 0; v < first.vesicles.size(); ++v) {
      all_.push_back({PageSeries(page_quantum(page_position_error, order)),
                      PageSeries(page_quantum(page_label_error, label_order)), PageSeries(page_tracer_error),
                      PageSeries(page_quantum(page_field_error, order))});
      radii_.push_back(std::sqrt(sim::measure(plans_, first.vesicles[v], 1, 1).area / sim::default_area) / radius_);
    }
  }

  void add(const sim::State& unwrapped, const Settings& settings) {
    const sim::State state = boxed(settings.scene, unwrapped);
    const render::StateSummary summary = summary_of(settings.scene, state);
    const render::Camera camera = render::make_camera(panel_.framing, panel_.framing.moment(summary));
    sim::Surroundings surroundings(sim::cell_at(settings.scene, state.time));
    for (std::size_t v = 0; v < all_.size(); ++v) {
      const sim::VesicleState& vesicle = state.vesicles[v];
      VesicleSeries& s = all_[v];
      // In a periodic cell another image is shown once the vesicle has left the box.
      const sim::Vec3 middle = vesicle.position.values.row(0).transpose() / std::sqrt(4 * std::numbers::pi);
      const bool jumped = settings.scene.cell.size &&
                          ((middle - s.middle).cwiseAbs().array() > settings.scene.cell.size->array() / 2).any();
      s.middle = middle;
      if (frames_ > 0 && (vesicle.relabelled != s.relabelled || vesicle.labels_laid != s.laid || jumped))
        s.breaks.push_back(frames_);
      s.relabelled = vesicle.relabelled;
      s.laid = vesicle.labels_laid;
      sim::Coefficients position = vesicle.position;
      position.values.row(0) -= std::sqrt(4 * std::numbers::pi) * render::to_sim(camera.target).transpose();
      add_rows(s.position, position.values / radius_);
      add_rows(s.labels, vesicle.labels.values);
      add_rows(s.tracers, vesicle.tracers);
      if (panel_.painting.field) add_field(s.field, settings, state, v, surroundings);
    }
    for (std::size_t k = 0; k < summary.points.size(); ++k)
      reach_ =
          std::max(reach_, std::abs(camera.picture_place(summary.point(k)).x) * camera.half_width / camera.half_height);
    add_arrows(camera, summary);
    if (panel_.view.flow_profile) add_profile(camera, state.time);
    const sim::Vec3 target = render::to_sim(camera.target) / radius_;
    if (settings.scene.cell.size) targets_.add({target.data(), 3});
    if (panel_.view.cut == "common") add_vector(through_, render::to_sim(summary.centroid) / radius_ - target);
    if (panel_.view.inset) {
      const glm::dvec2 centre = inset_centre(panel_, panel_.framing.moment(summary).centre);
      add_vector(inset_, sim::Vec3(centre.x, 0, centre.y) / radius_ - sim::Vec3(target[0], 0, target[2]));
    }
    times_.push_back(panel_.stamped ? marked(captions_of(panel_, state.time).time) : "");
    ++frames_;
  }

  /// Everything that the page knows of the trajectory; `bytes` are the series, as the rows below count them.
  void write(Members& page) const {
    std::string bytes;
    const auto series = [&](const PageSeries& s) {
      bytes += s.bytes();
      return fmt::format("[{},{:.9g}]", s.rows(), s.quantum());
    };
    std::vector<std::string> vesicles;
    for (std::size_t v = 0; v < all_.size(); ++v) {
      const VesicleSeries& s = all_[v];
      const render::Colour& own = panel_.painting.bodies[v];
      Members m;
      m.vector("colour", render::linear(own));
      const render::Ground ground = render::ground_of(panel_.view.background);
      m.vector("contour", render::vector_of(render::outline_colour(own, ground, false)));
      const render::Colour core{0.5 + 0.5 * own.r, 0.5 + 0.5 * own.g, 0.5 + 0.5 * own.b};
      m.vector("cut_edge", render::vector_of(core));
      m.text("section", fmt::format("rgb({:.0f} {:.0f} {:.0f})", 255 * own.r, 255 * own.g, 255 * own.b));
      m.vector("ghost_contour", render::vector_of(render::outline_colour(own, ground, true)));
      m.number("radius", radii_[v]);
      m.raw("breaks", fmt::format("[{}]", fmt::join(s.breaks, ",")));
      m.raw("position", series(s.position));
      m.raw("labels", series(s.labels));
      m.raw("tracers", series(s.tracers));
      m.raw("field", series(s.field));
      vesicles.push_back(m.whole());
    }
    page.number("reach", reach_ / render::bodies_width);
    page.raw("frames", fmt::format("{}", frames_));
    page.raw("times", texts_of(times_));
    page.raw("vesicles", list_of(vesicles));
    page.flag("rests", rests_);
    page.raw("arrows", series(arrows_));
    page.raw("targets", series(targets_));
    page.raw("profile", series(profile_));
    page.raw("through", series(through_));
    page.raw("inset_centre", series(inset_));
    page.raw("arrow_counts", fmt::format("[{}]", fmt::join(arrow_counts_, ",")));
    page.text("bytes", base64(deflated(bytes)));
  }

 private:
  static void add_rows(PageSeries& series, const sim::Matrix& values) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = values;
    series.add({rows.data(), static_cast<std::size_t>(rows.size())});
  }

  static void add_vector(PageSeries& series, const sim::Vec3& v) { series.add({v.data(), 3}); }

  void add_field(PageSeries& series, const Settings& settings, const sim::State& state, std::size_t vesicle,
                 sim::Surroundings& surroundings) {
    const render::Legend& legend = *panel_.painting.legend;
    sim::Coefficients field = painted_field(plans_, panel_.painting, settings, state, vesicle, surroundings);
    field.values(0, 0) -= std::sqrt(4 * std::numbers::pi) * legend.low;
    add_rows(series, field.values / (legend.high - legend.low));
  }

  /// Middle and vector of each, in area radii.
  void add_arrows(const render::Camera& camera, const render::StateSummary& summary) {
    const render::FlowArrows flow = arrows_of(panel_, summary);
    std::vector<double> numbers;
    const double longest = render::longest_arrow * camera.half_height / radius_;
    // A fluid at rest has beads instead, where the camera moves.
    rests_ = flow.reference_speed <= 0;
    if (!rests_ || camera.follows)
      for (Eigen::Index i = 0; i < flow.points.rows(); ++i) {
        const sim::Vec3 middle = (flow.points.row(i).transpose() - render::to_sim(camera.target)) / radius_;
        sim::Vec3 vector = sim::Vec3::Zero();
        if (!rests_) vector = flow.velocities.row(i).transpose() / flow.reference_speed * longest;
        numbers.insert(numbers.end(), {middle[0], middle[1], middle[2], vector[0], vector[1], vector[2]});
      }
    arrow_counts_.push_back(numbers.size() / 6);
    arrows_.add(numbers);
  }

  /// Velocities from the lowest point to the highest, shares of the fastest.
  void add_profile(const render::Camera& camera, double time) {
    std::vector<double> velocities;
    double fastest = 0;
    for (const glm::dvec2& point : profile_of(panel_, camera, time).points) {
      velocities.push_back(point.y);
      fastest = std::max(fastest, std::abs(point.y));
    }
    for (double& v : velocities) v = fastest > 0 ? v / fastest : 0;
    profile_.add(velocities);
  }

  const ViewPanel& panel_;
  std::vector<VesicleSeries> all_;
  std::vector<double> radii_;
  PageSeries arrows_, targets_, profile_;
  PageSeries through_;  ///< what the common plane of cuts goes through, but for its offset
  PageSeries inset_;    ///< middle of the inset
  std::vector<std::size_t> arrow_counts_;
  std::vector<std::string> times_;
  bool rests_ = false;  ///< there is no background flow
  double radius_, reach_ = 0;
  std::size_t frames_ = 0;
  sim::Plans plans_;
};

std::string axes_of(const render::ViewAxes& axes) {
  Members m;
  m.vector("right", axes.right);
  m.vector("up", axes.up);
  m.vector("back", axes.back);
  return m.whole();
}

void write_camera(Members& page, const ViewPanel& panel, double time) {
  const render::Framing& framing = panel.framing;
  const double zoom = render::camera_at(framing.keys, time).zoom, radius = panel.captions.scale_length;
  Members camera;
  camera.raw("axes", axes_of(framing.axes_at(time)));
  camera.number("half_height", framing.half_height / zoom / radius);
  camera.number("distance", framing.distance / zoom / radius);
  camera.number("depth", framing.depth / radius);
  camera.number("aspect", framing.aspect);
  camera.flag("perspective", framing.perspective);
  camera.flag("follows", framing.follows);
  page.raw("camera", camera.whole());
  std::vector<std::string> views;
  for (const render::CameraRow& row : render::cameras()) {
    Members view;
    view.text("name", row.name);
    view.text("meaning", row.meaning);
    view.raw("axes", axes_of(row.axes));
    views.push_back(view.whole());
  }
  page.raw("views", list_of(views));
}

void write_styles(Members& page, const ViewPanel& panel, std::size_t tracers) {
  std::vector<std::string> styles;
  for (const render::StyleRow& row : render::styles()) {
    if (row.field && !panel.painting.field) continue;
    Members style;
    style.text("name", row.name);
    style.text("meaning", row.meaning);
    const bool dots = row.field && panel.painting.legend->mirrored && panel.view.sign_dots;
    const bool occluded = row.occluded && panel.view.occlusion > 0;
    std::string defines = render::body_defines(row, panel.view, true, false, tracers > 0, dots, occluded);
    if (row.cut) defines += "#define CUT_BY_SAMPLE\n";
    style.text("defines", defines);
    style.flag("occluded", occluded);
    style.flag("tracers", row.tracers && panel.view.tracers && tracers > 0);
    style.flag("own_colour", row.own_colour);
    style.flag("see_through", row.see_through);
    style.flag("field", row.field);
    style.flag("cut", row.cut);
    styles.push_back(style.whole());
  }
  page.raw("styles", list_of(styles));
}

/// fades: far ones into the ground.
void write_shaders(Members& page, bool fades) {
  Members files, libraries;
  std::set<std::string> names;
  for (const std::string program : {"ground", "body", "outline", "arrow", "ribbon"})
    for (const std::string& file : {program + ".vert", program + ".frag"}) {
      const std::vector<std::string> before = render::shader_libraries(file);
      libraries.raw(file, texts_of(before));
      names.insert(before.begin(), before.end());
      names.insert(file);
    }
  for (const std::string& name : names) files.text(name, render::shader_text(name, {}));
  page.text("light", render::light_defines());
  page.text("defines", fades ? "#define DEPTH_CUE\n" : "");
  page.raw("shaders", files.whole());
  page.raw("libraries", libraries.whole());
  const render::ArrowShape arrow = render::arrow_shape();
  std::vector<float> numbers;
  for (const auto& vertices : {arrow.position, arrow.normal})
    for (const glm::vec3& v : vertices) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  page.text("arrow_shape", base64(memory_of(numbers)));
}

/// What the passes of draw_frame() set.
void write_paint(Members& page, const render::ViewParameters& view, double cue) {
  Members paint;
  const render::Ground ground = render::ground_of(view.background);
  paint.vector("top", render::vector_of(ground.top));
  paint.vector("bottom", render::vector_of(ground.bottom));
  paint.flag("dark", ground.dark());
  paint.number("depth_cue", cue);
  paint.vector("arrow", render::linear(render::inks_on(ground).arrow));
  paint.vector("ring", static_cast<float>(render::end_on_shade) * render::vector_of(render::inks_on(ground).arrow));
  paint.vector("flow_line", render::vector_of(render::inks_on(ground).flow_line));
  paint.vector("line_ink", render::line_ink);
  paint.vector("tracer_bright", render::linear(render::tracer_bright));
  paint.vector("tracer_dark", render::linear(render::tracer_dark));
  paint.number("tracer_radius", render::tracer_radius);
  paint.number("edge_step", render::edge_step);
  paint.number("arrow_thickness", render::arrow_thickness);
  paint.number("longest_arrow", render::longest_arrow);
  paint.number("weakest_arrow", render::weakest_arrow);
  paint.number("end_on_radius", render::end_on_radius);
  paint.number("profile_width", render::profile_width);
  paint.number("bodies_width", render::bodies_width);
  paint.number("profile_reach", render::profile_reach);
  paint.vector("key_light", render::key_light);
  paint.number("occlusion", view.occlusion);
  paint.number("line_width", view.line_width);
  paint.number("outline_width", view.outline_width);
  paint.number("opacity", view.opacity);
  paint.number("sign_dot_spacing", render::SignDots::spacing);
  paint.number("sign_dot_least", render::SignDots::least);
  paint.flag("full_detail", view.detail == "full");
  paint.flag("grid_lines", view.lines == "grid");
  page.raw("paint", paint.whole());
}

void write_cut(Members& page, const ViewPanel& panel) {
  Members cut;
  cut.vector("normal", sim::Vec3(panel.view.cut_normal.normalized()));
  cut.number("offset", panel.view.cut_offset / panel.captions.scale_length);
  cut.flag("common", panel.view.cut == "common");
  page.raw("cut", cut.whole());
}

void write_inset(Members& page, const ViewPanel& panel) {
  if (!panel.view.inset) return page.raw("inset", "null");
  Members inset;
  inset.number("half_height", inset_half_height(panel) / panel.captions.scale_length);
  inset.number("height", render::inset_height);
  inset.number("aspect", render::inset_aspect);
  page.raw("inset", inset.whole());
}

void write_legend(Members& page, const ViewPanel& panel) {
  if (!panel.painting.field) return page.raw("legend", "null");
  const std::optional<render::Legend>& legend = panel.painting.legend;
  Members m;
  m.text("label", marked(legend->label));
  std::string colours;
  for (const auto& entry : legend->colours) colours.append(entry.begin(), entry.end());
  m.text("colours", base64(colours));
  const std::vector<double> ticks = render::bar_ticks(legend->low, legend->high);
  std::vector<double> shares;
  for (const double tick : ticks) shares.push_back((tick - legend->low) / (legend->high - legend->low));
  m.raw("ticks", fmt::format("[{:.6f}]", fmt::join(shares, ",")));
  m.raw("texts", texts_of(render::number_texts(ticks)));
  page.raw("legend", m.whole());
}

/// One camera, and the field of the scene where it has one.
Settings page_settings(const Settings& settings, std::size_t vesicles) {
  Settings s = settings;
  s.view.views.clear();
  s.view.faces = "whole";  // a page has one image of each vesicle
  s.view.style =
      sim::find_field(s.view.field).needs_neighbours && vesicles < 2 && !s.scene.cell.size ? "opaque" : "field";
  return s;
}

}  // namespace

double page_quantum(double error, int order) {
  // Rounding errors are even over the quantum, and the squares of the (p + 1)^2 harmonics have the mean 1 / 4 pi.
  return error * std::sqrt(12 * 4 * std::numbers::pi) / (order + 1);
}

std::vector<double> page_times(const sim::TrajectoryReader& trajectory, const render::MovieParameters& movie) {
  std::vector<double> all = frame_times(trajectory, movie);
  const auto count = static_cast<std::int64_t>(all.size());
  if (count <= most_page_frames) return all;
  std::vector<double> times;
  for (std::int64_t k = 0; k < most_page_frames; ++k)
    times.push_back(all[static_cast<std::size_t>(k * (count - 1) / (most_page_frames - 1))]);
  return times;
}

std::string page_text(const sim::TrajectoryReader& trajectory, const Settings& settings,
                      const std::vector<double>& times, const PageProgress& progress) {
  const sim::State first = trajectory.state(0);
  const Settings shown = page_settings(settings, first.vesicles.size());
  const Production production = prepare_pictures({{trajectory, shown}});
  const ViewPanel& panel = production.panels.front();
  Recorder recorder(panel, trajectory);
  const auto count = static_cast<std::int64_t>(times.size());
  for (std::int64_t k = 0; k < count; ++k) {
    if (!progress(k, count)) return {};
    recorder.add(state_at(trajectory, times[static_cast<std::size_t>(k)]), shown);
  }
  std::size_t tracers = 0;
  for (const sim::VesicleState& v : first.vesicles)
    tracers = std::max(tracers, static_cast<std::size_t>(v.tracers.rows()));
  const std::string title = printable(settings.scene.title);
  const std::int64_t frames = static_cast<std::int64_t>(frame_times(trajectory, settings.movie).size());
  Members page;
  page.text("title", title);
  page.text("parameters", marked(panel.captions.parameters));
  page.text("style", settings.view.style);
  page.number("seconds", static_cast<double>(std::max<std::int64_t>(frames - 1, 1)) / settings.movie.frame_rate);
  if (const std::optional<sim::Vec3>& cell = settings.scene.cell.size)
    page.vector("cell", sim::Vec3(*cell / 2 / panel.captions.scale_length));  // half its edges
  write_camera(page, panel, times.front());
  const double cue = render::depth_cue_of(panel.view, first.vesicles.size());
  write_paint(page, panel.view, cue);
  write_styles(page, panel, tracers);
  write_cut(page, panel);
  write_inset(page, panel);
  write_legend(page, panel);
  write_shaders(page, cue > 0);
  recorder.write(page);
  std::string data;
  for (const char c : page.whole())
    data += c == '<' ? "\\u003c" : std::string(1, c);  // so that no text ends the script
  return filled(page_html, {{"title", markup_text(title.empty() ? "Tanktread" : title)},
                            {"program", markup_text("tanktread " + version())},
                            {"style", page_css},
                            {"script", page_script},
                            {"data", data}});
}

}  // namespace app
