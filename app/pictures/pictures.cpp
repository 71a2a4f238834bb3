#include "app/pictures/pictures.h"

#include "app/base/printable.h"
#include "app/scene/scene_text.h"
#include "app/pictures/flow_picture.h"
#include "app/base/version.h"

#include "render/core/places.h"
#include "render/overlay/panels.h"
#include "render/scene/arrow_net.h"
#include "render/scene/cutaway.h"
#include "render/scene/section.h"
#include "render/scene/sequence.h"
#include "render/core/style.h"
#include "sim/measures/diagnostics.h"
#include "sim/membrane/flows.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

namespace app {

sim::State state_at(const sim::TrajectoryReader& trajectory, double time) {
  std::int64_t low = 0, high = trajectory.count() - 1;
  while (low < high) {  // first state at or after `time`
    const std::int64_t middle = (low + high) / 2;
    if (trajectory.time(middle) < time) low = middle + 1;
    else high = middle;
  }
  sim::State after = trajectory.state(low);
  if (low == 0 || time >= after.time) return after;
  return render::interpolated(trajectory.state(low - 1), after, time);
}

namespace {

/// A few hundred instants are enough to frame a movie and to know the range of its field.
std::vector<std::int64_t> instants_to_look_at(const sim::TrajectoryReader& trajectory) {
  const std::int64_t states = trajectory.count(), stride = std::max<std::int64_t>(1, states / 400);
  std::vector<std::int64_t> chosen;
  for (std::int64_t k = 0; k < states; k = k + 1 < states ? std::min(k + stride, states - 1) : states) chosen.push_back(k);
  return chosen;
}

render::FlowArrows arrows_of(const ViewPanel& p, const render::StateSummary& summary) {
  render::FlowArrows arrows;
  if (!p.view.flow_arrows || p.view.streamlines != "off") return arrows;
  arrows.points = render::arrow_points(p.framing, p.framing.moment(summary));
  arrows.velocities = sim::background_velocity(p.source.settings.scene.flows, summary.time, arrows.points);
  arrows.reference_speed = p.arrow_speed;
  arrows.shown = render::arrows_shown(p.framing, p.framing.moment(summary));
  return arrows;
}

/// The velocity to the right of the picture along the vertical line through its middle.
render::FlowProfile profile_of(const ViewPanel& p, const render::Camera& camera, double time) {
  constexpr int count = 25;
  constexpr double reach = 0.62;  // of the picture's half height
  const glm::dmat3 turn(glm::transpose(glm::mat3(camera.view)));  // columns: right, up, back
  sim::Matrix points(count, 3);
  std::vector<double> heights;
  for (int k = 0; k < count; ++k) {
    heights.push_back(reach * (2.0 * k / (count - 1) - 1));
    points.row(k) = render::to_sim(camera.target + heights.back() * camera.half_height * turn[1]).transpose();
  }
  const sim::Matrix velocity = sim::background_velocity(p.source.settings.scene.flows, time, points);
  render::FlowProfile profile;
  for (int k = 0; k < count; ++k)
    profile.points.emplace_back(heights[static_cast<std::size_t>(k)], glm::dot(render::to_glm(velocity.row(k)), turn[0]));
  return profile;
}

/// Streamlines of the whole flow in the plane of the arrows, as far as the picture reaches; none under the captions.
render::FlowLines lines_of(sim::Plans& plans, const ViewPanel& p, const sim::State& state, const render::Camera& camera) {
  render::FlowLines all;
  if (p.view.streamlines == "off") return all;
  Eigen::Index normal = 0, across = 0;
  render::to_sim(p.framing.axes.back).cwiseAbs().maxCoeff(&normal);
  sim::Vec3 right = render::to_sim(p.framing.axes.right);
  right[normal] = 0;
  right.cwiseAbs().maxCoeff(&across);
  FlowRequest request;
  request.plane.origin = render::to_sim(camera.target);
  request.plane.right = sim::Vec3::Unit(across);
  request.plane.up = sim::Vec3::Unit(3 - normal - across);
  request.plane.normal = -request.plane.right.cross(request.plane.up);
  constexpr double beyond = 1.15;  // of the picture: perspective and oblique views see more of the plane
  request.x = {-beyond * camera.half_width, beyond * camera.half_width};
  request.y = {-beyond * camera.half_height, beyond * camera.half_height};
  if (p.view.streamlines == "vesicles") request.frame_velocity = frame_velocity(plans, state);
  request.spacing = camera.half_height / 9;
  request.length = p.captions.scale_length;
  request.with_speed = false;
  for (const render::Streamline& line : flow_picture(plans, p.source.settings.scene, state, request).lines) {
    const std::vector<Eigen::Index> heads = render::arrow_places(line, 7 * request.spacing);
    render::FlowLines::Line part;
    const auto finish = [&] {
      if (part.points.size() > 1) all.lines.push_back(part);
      part = {};
    };
    for (Eigen::Index k = 0; k < line.points.rows(); ++k) {
      const sim::Vec3 point =
          request.plane.origin + line.points(k, 0) * request.plane.right + line.points(k, 1) * request.plane.up;
      if (render::clear_of_captions(camera.picture_place(render::to_glm(point))) < 0.5) {
        finish();
        continue;
      }
      if (std::find(heads.begin(), heads.end(), k) != heads.end()) part.heads.push_back(part.points.size());
      part.points.push_back(render::to_glm(point));
    }
    part.closed = line.closed && static_cast<Eigen::Index>(part.points.size()) == line.points.rows();
    finish();
  }
  return all;
}

/// What the insets of all frames must hold.
void frame_inset(ViewPanel& p, const std::vector<render::StateSummary>& summaries) {
  glm::dvec2 low(1e300), high(-1e300);
  for (const render::StateSummary& summary : summaries) {
    glm::dvec3 origin(0);
    if (p.framing.follows) origin = p.framing.moment(summary).centre;
    const std::size_t each = summary.points.size() / summary.centroids.size();
    for (std::size_t k = 0; k < summary.points.size(); ++k) {
      if (p.framing.vesicle >= 0 && k / each != static_cast<std::size_t>(p.framing.vesicle)) continue;  // its neighbours as they come
      const glm::dvec3 point = summary.point(k) - origin;
      low = glm::min(low, glm::dvec2(point.x, point.z));
      high = glm::max(high, glm::dvec2(point.x, point.z));
    }
  }
  constexpr double room = 1.08;  // a margin; the net of points falls a little short of the surface
  p.inset_centre = (low + high) / 2.0;
  p.inset_half = room * (high - low) / 2.0;
}

/// All vesicles cut by the plane y = that of what the camera follows or aims at.
render::Inset inset_of(const ViewPanel& p, const sim::State& state, const render::Camera& camera, const glm::dvec3& centre) {
  render::Inset inset;
  render::CutPlane plane;
  plane.origin = sim::Vec3(0, camera.target.y, 0);
  inset.centre = p.inset_centre;
  if (p.framing.follows) inset.centre += glm::dvec2(centre.x, centre.z);
  inset.half_height = std::max(p.inset_half.y, p.inset_half.x / render::inset_aspect);
  for (std::size_t v = 0; v < state.vesicles.size(); ++v)
    for (const render::ClosedCurve& curve : render::cut(state.vesicles[v].position, plane)) {
      render::Inset::Curve& drawn = inset.curves.emplace_back();
      drawn.colour = p.painting.bodies[v];
      for (Eigen::Index k = 0; k < curve.points.rows(); ++k) drawn.points.emplace_back(curve.points(k, 0), curve.points(k, 1));
    }
  return inset;
}

ViewPanel make_panel(const PictureSource& source, const render::ViewParameters& view, const Painting& painting,
                 const std::vector<render::StateSummary>& summaries, const render::Captions& captions) {
  ViewPanel p{source, view, render::frame_trajectory(summaries, view, source.settings.key_frames), 0, {}, {}, captions, painting, true, {}, 0};
  render::check_framing(p.framing, summaries);
  frame_inset(p, summaries);
  for (const render::StateSummary& summary : summaries) {
    const render::FlowArrows arrows = arrows_of(p, summary);
    if (arrows.velocities.rows() > 0)
      p.arrow_speed = std::max(p.arrow_speed, arrows.velocities.rowwise().norm().maxCoeff());
  }
  return p;
}

/// The jump of the lines is told before it comes, and for a while after it.
std::string laid_note(const ViewPanel& p, double time) {
  if (p.view.lines != "material" || !p.view.time_stamp) return {};
  for (const double laid : p.laid)
    if (std::abs(time - laid) <= p.notice)
      return fmt::format("lines {} at {}", time < laid ? "will be laid anew" : "were laid anew",
                         time_caption(p.source.settings.scene, laid, p.time_format));
  return {};
}

/// Scene time from frame to frame.
double time_of_frame(const PictureSource& source) {
  const render::MovieParameters& movie = source.settings.movie;
  const std::int64_t states = source.trajectory.count();
  return movie.time_per_frame > 0 ? movie.time_per_frame
         : states > 1             ? source.trajectory.time(states - 1) / static_cast<double>(states - 1)
                                  : 0;
}

render::Frame frame_of(Studio& studio, const ViewPanel& p, const sim::State& state) {
  render::Frame frame;
  frame.view = p.view;
  const render::StyleRow& style = render::find_style(frame.view.style);
  sim::Surroundings surroundings;
  for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
    const sim::Coefficients& position = state.vesicles[v].position;
    std::optional<sim::Coefficients> field;
    if (p.painting.field) field = painted_field(studio.plans, p.painting, p.source.settings, state, v, surroundings);
    frame.bodies.push_back(
        {render::make_mesh(studio.mesh, state.vesicles[v], field ? &*field : nullptr), p.painting.bodies[v], {}});
    if (style.cut) frame.bodies.back().cut = render::make_cut(position, frame.view.cut_normal, frame.view.cut_offset);
  }
  frame.legend = p.painting.legend;
  const render::StateSummary summary = render::summarize(state);
  frame.camera = render::make_camera(p.framing, p.framing.moment(summary));
  frame.arrows = arrows_of(p, summary);
  frame.flow_lines = lines_of(studio.plans, p, state, frame.camera);
  if (frame.view.flow_profile) frame.profile = profile_of(p, frame.camera, state.time);
  if (frame.view.inset) frame.inset = inset_of(p, state, frame.camera, p.framing.moment(summary).centre);
  frame.captions = p.captions;
  if (p.stamped) {
    frame.captions.time = time_caption(p.source.settings.scene, state.time, p.time_format);
    frame.captions.note = laid_note(p, state.time);
  }
  return frame;
}

/// One range for all, so that equal colours mean equal values; about zero if that of one is, unless it was `given`.
void share_legend(std::vector<Painting>& paintings, bool given) {
  for (Painting& p : paintings)
    if (!p.legend || !p.field || p.field != paintings.front().field) return;
  const auto mirrored = std::find_if(paintings.begin(), paintings.end(), [](const Painting& p) { return p.legend->mirrored; });
  render::Legend all = *(mirrored != paintings.end() ? *mirrored : paintings.front()).legend;
  for (const Painting& p : paintings) {
    all.low = std::min(all.low, p.legend->low);
    all.high = std::max(all.high, p.legend->high);
    all.below = all.below || p.legend->below;
    all.above = all.above || p.legend->above;
  }
  if (all.mirrored && !given) {
    all.high = std::max(std::abs(all.low), std::abs(all.high));
    all.low = -all.high;
  }
  all.mirrored = all.mirrored && all.low == -all.high;
  for (Painting& p : paintings) p.legend = all;
}

}  // namespace

Production prepare_pictures(const std::vector<PictureSource>& sources, std::optional<double> still) {
  Production production;
  std::vector<Painting> paintings;
  std::vector<std::vector<render::StateSummary>> summaries(sources.size());
  std::vector<render::Captions> captions;
  std::vector<std::vector<double>> laid;
  const render::ViewParameters& first = sources.front().settings.view;
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const auto& [trajectory, settings] = sources[k];
    const std::vector<std::int64_t> chosen = instants_to_look_at(trajectory);
    std::set<double> times;
    for (const std::int64_t i : chosen) {
      const sim::State state = trajectory.state(i);
      summaries[k].push_back(render::summarize(state));
      for (const sim::VesicleState& v : state.vesicles)
        if (v.labels_laid > 0) times.insert(v.labels_laid_time);
    }
    laid.emplace_back(times.begin(), times.end());
    sim::Plans plans;
    const sim::VesicleMeasures measures = sim::measure(plans, trajectory.state(0).vesicles.front(), 1, 1);
    const double area_radius = std::sqrt(measures.area / sim::default_area);
    std::optional<sim::State> only;
    if (still) only = state_at(trajectory, *still);
    paintings.push_back(plan_painting(trajectory, chosen, settings, area_radius, only ? &*only : nullptr));
    render::Captions c;
    c.parameters = parameter_caption(settings.scene, area_radius, measures.reduced_volume);
    c.scale_length = area_radius;
    if (settings.view.title || sources.size() > 1) c.title = printable(settings.scene.title);
    captions.push_back(c);
    production.hash += fmt::format("{}-{}-", picture_hash(settings), trajectory.count());
  }
  share_legend(paintings, !first.field_range.empty());
  production.hash += version();
  if (still) production.hash += "-still";

  std::vector<std::string> cameras = first.views;
  if (cameras.empty()) cameras = {first.camera};
  const bool grid = sources.size() > 1 && cameras.size() > 1;
  const auto count = static_cast<int>(sources.size() * cameras.size());
  production.width = first.size[0];
  production.height = first.size[1];
  production.columns = grid ? static_cast<int>(cameras.size()) : render::panel_columns(count, first.size[0], first.size[1]);
  production.rows = (count + production.columns - 1) / production.columns;
  const int width = production.width / production.columns, height = production.height / production.rows;
  if (width < 16 || height < 16)
    throw std::invalid_argument(fmt::format("{} views need a larger picture than {} x {}", count, first.size[0], first.size[1]));
  for (std::size_t k = 0; k < sources.size(); ++k)
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      render::ViewParameters view = sources[k].settings.view;
      view.size = {width, height};
      view.supersampling = first.supersampling;
      view.camera = cameras[c];
      const bool last = k + 1 == sources.size() && c + 1 == cameras.size();
      view.colour_bar = view.colour_bar && last;
      if (cameras.size() > 1) {
        view.caption = view.caption && c == 0;
        captions[k].panel = cameras[c];
      }
      production.panels.push_back(make_panel(sources[k], view, paintings[k], summaries[k], captions[k]));
      constexpr double notice = 1.2;  // seconds
      production.panels.back().stamped = c == 0;
      production.panels.back().laid = laid[k];
      const double per_frame = time_of_frame(sources[k]);
      const std::int64_t states = sources[k].trajectory.count();
      production.panels.back().notice = notice * sources[k].settings.movie.frame_rate * per_frame;
      production.panels.back().time_format =
          time_format(sources[k].settings.scene, per_frame, states > 0 ? sources[k].trajectory.time(states - 1) : 0);
    }
  return production;
}

Studio::Studio(const render::GlChoice& choice, const std::filesystem::path& shader_dir, int picture_height)
    : renderer(choice, shader_dir),
      // finer where the outline would show its corners
      mesh(picture_height > 1440 ? std::make_shared<const render::MeshPlan>(128, 256)
                                 : std::make_shared<const render::MeshPlan>()) {}

render::Image draw_picture(Studio& studio, const Production& production, double time) {
  const std::vector<ViewPanel>& panels = production.panels;
  const auto draw_panel = [&](const ViewPanel& p) {
    return render::draw_frame(studio.renderer, frame_of(studio, p, state_at(p.source.trajectory, time)));
  };
  if (panels.size() == 1) return draw_panel(panels.front());
  render::Image whole(production.width, production.height, 3);
  std::fill(whole.pixels.begin(), whole.pixels.end(), std::uint8_t{255});
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const auto column = static_cast<int>(k) % production.columns, row = static_cast<int>(k) / production.columns;
    const render::Image part = draw_panel(panels[k]);
    render::paste(whole, part, column * part.width, row * part.height);
  }
  const int width = panels.front().view.size[0], height = panels.front().view.size[1];
  render::draw_separators(whole, production.columns, production.rows, width, height);
  return whole;
}

std::vector<render::Image> draw_stills(const sim::TrajectoryReader& trajectory, const Settings& settings,
                                       const std::vector<Still>& stills, const Options& options) {
  Settings plain = settings;
  plain.view.projection = "orthographic";
  plain.view.background = "white";
  plain.view.flow_arrows = plain.view.time_stamp = plain.view.caption = plain.view.scale_bar = false;
  plain.view.title = plain.view.triad = plain.view.flow_profile = plain.view.inset = plain.view.colour_bar = false;
  plain.view.streamlines = "off";
  plain.view.eye.reset();
  plain.view.target.reset();
  Studio studio(render::parse_gl_choice(options.gl), options.shader_dir, 1080);
  const double area = sim::measure(studio.plans, trajectory.state(0).vesicles.front(), 1, 1).area;
  const Painting painting =
      plan_painting(trajectory, instants_to_look_at(trajectory), plain, std::sqrt(area / sim::default_area));
  std::vector<render::Image> images;
  for (const Still& still : stills) {
    const sim::State state = state_at(trajectory, still.time);
    plain.view.size = {still.width, still.height};
    ViewPanel p{{trajectory, plain}, plain.view, render::frame_trajectory(std::vector{render::summarize(state)}, plain.view), 0, {}, {}, {},
            painting, false, {}, 0};
    const glm::dvec3 target = render::to_glm(still.target);
    p.framing.depth += glm::length(target - p.framing.target);
    p.framing.follows = false;
    p.framing.target = target;
    p.framing.half_height = still.half_height;
    images.push_back(render::draw_frame(studio.renderer, frame_of(studio, p, state)));
  }
  return images;
}

}  // namespace app
