#include "app/pictures/pictures.h"

#include "app/pictures/cell_images.h"
#include "app/pictures/flow_overlays.h"
#include "app/pictures/instants.h"
#include "app/pictures/overlays.h"

#include "render/core/ground.h"
#include "render/core/style.h"
#include "render/overlay/layout.h"
#include "render/overlay/panels.h"
#include "render/scene/cutaway.h"
#include "render/scene/hidden.h"
#include "render/scene/occlusion.h"
#include "render/scene/surface.h"
#include "sim/measures/diagnostics.h"
#include "sim/membrane/cell.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

render::Sketch shifted(render::Sketch sketch, const glm::dvec3& shift) {
  for (glm::dvec3& point : sketch.points) point += shift;
  sketch.centre += shift;
  return sketch;
}

/// A mesh for each vesicle and each copy that may be seen, as fine as the picture shows it, with its colour and field,
/// opened where the style opens it. centre: of all.
std::vector<render::Body> bodies_of(Studio& studio, const ViewPanel& p, const sim::State& state,
                                    const render::Camera& camera, const glm::dvec3& centre) {
  const sim::Scene& scene = p.source.settings.scene;
  const std::optional<render::FaceBox> faces = faces_of(scene, p.view);
  const bool full = p.view.detail == "full";
  const render::StyleRow& style = render::find_style(p.view.style);
  std::vector<render::Sketch> own, sketches;
  std::vector<Whereabouts> places;
  for (const sim::VesicleState& vesicle : state.vesicles) {
    own.push_back(render::sketch_of(vesicle));
    places.push_back(whereabouts_of(vesicle, render::bounds_of(own.back())));
  }
  const std::vector<Shown> shown = shown_of(scene, p.view, places, state.time);
  for (const Shown& s : shown) sketches.push_back(shifted(own[s.vesicle], render::to_glm(s.shift)));
  std::vector<bool> hidden(sketches.size(), false);
  if (!style.see_through && !style.cut && sketches.size() > 2) hidden = render::hidden(sketches, camera, p.view, faces);
  const sim::Vec3 plane = sim::Vec3(centre.x, centre.y, centre.z) + p.view.cut_offset * p.view.cut_normal.normalized();
  std::vector<render::Occluder> occluders;
  if (style.occluded && p.view.occlusion > 0)
    for (const render::Sketch& sketch : sketches) occluders.push_back(render::occluder_of(sketch, faces));
  std::vector<render::Body> bodies;
  sim::Surroundings surroundings(sim::cell_at(scene, state.time));
  std::vector<std::optional<sim::Coefficients>> fields(state.vesicles.size());
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const render::Sketch& sketch = sketches[k];
    if (hidden[k] || !render::in_picture(camera, sketch)) continue;
    const std::size_t v = shown[k].vesicle;
    const sim::VesicleState vesicle = moved(state.vesicles[v], shown[k].shift);
    const double pixels = render::pixels_at(camera, sketch.centre, p.view.size[1]);
    if (p.painting.field && !fields[v])
      fields[v] = painted_field(studio.plans, p.painting, p.source.settings, state, v, surroundings);
    render::Body& body = bodies.emplace_back();
    body.mesh =
        render::make_mesh(full ? studio.meshes.finest() : studio.meshes.choose(sketch, vesicle.position.order, pixels),
                          vesicle, fields[v] ? &*fields[v] : nullptr);
    body.colour = p.painting.bodies[v];
    if (!occluders.empty()) render::shade(body.mesh, k, sketches, occluders, camera, body.mesh.area_radius * pixels);
    if (!style.cut) continue;
    if (!studio.sections) studio.sections.emplace(render::rim_latitudes);
    const sim::Vec3 through = p.view.cut == "common" ? plane
                                                     : sim::Vec3(render::volume_moments(vesicle.position).centroid +
                                                                 p.view.cut_offset * p.view.cut_normal.normalized());
    body.cut = render::make_cut(*studio.sections, studio.plans.rotation(vesicle.position.order), vesicle.position,
                                p.view.cut_normal, through);
  }
  return bodies;
}

render::Frame frame_of(Studio& studio, const ViewPanel& p, const sim::State& state) {
  const sim::Scene& scene = p.source.settings.scene;
  const render::StateSummary summary = summary_of(scene, state);
  const render::Moment moment = p.framing.moment(summary);
  render::Frame frame;
  frame.view = p.view;
  frame.camera = render::make_camera(p.framing, moment);
  frame.bodies = bodies_of(studio, p, state, frame.camera, summary.centroid);
  frame.vesicles = state.vesicles.size() * cells_shown(scene, p.view);
  frame.faces = faces_of(scene, p.view);
  frame.legend = p.painting.legend;
  frame.arrows = arrows_of(p, summary);
  if (p.view.flow_profile) frame.profile = profile_of(p, frame.camera, state.time);
  if (p.view.inset) frame.inset = inset_of(p, state, frame.camera, moment.centre);
  frame.captions = captions_of(p, state.time);
  frame.flow_lines = flow_lines_of(studio.plans, p, state, frame.camera, render::lay_out(frame, studio.font).boxes());
  if (!frame.faces || cells_shown(scene, p.view) > 1)
    for (render::FlowLines::Line& edge : edges_of_cell(scene)) frame.flow_lines.lines.push_back(edge);
  return frame;
}

/// The panels of one picture on white or on nothing, all of one size.
render::Image joined(const Production& production, const std::vector<render::Image>& parts) {
  render::Image whole(production.width, production.height, parts.front().channels);
  // Between panels white shows, or on dark ground what is written on it in grey.
  const render::Ground ground = render::ground_of(production.panels.front().view.background);
  const render::Colour between = ground.dark() ? render::inks_on(ground).arrow : render::white;
  if (whole.channels == 3) std::fill(whole.pixels.begin(), whole.pixels.end(), std::uint8_t{255});
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto column = static_cast<int>(k) % production.columns, row = static_cast<int>(k) / production.columns;
    render::paste(whole, parts[k], column * parts[k].width, row * parts[k].height);
  }
  const std::vector<int>& size = production.panels.front().view.size;
  render::draw_separators(whole, production.columns, production.rows, size[0], size[1], between);
  return whole;
}

/// The settings without anything that lies over the picture.
Settings plain_settings(const Settings& settings, const std::string& background) {
  Settings plain = settings;
  plain.view.projection = "orthographic";
  plain.view.background = background;
  plain.view.flow_arrows = plain.view.time_stamp = plain.view.caption = plain.view.errors = plain.view.scale_bar =
      false;
  plain.view.title = plain.view.triad = plain.view.flow_profile = plain.view.inset = plain.view.colour_bar = false;
  plain.view.streamlines = "off";
  plain.view.copies = {0, 0, 0};
  plain.view.eye.reset();
  plain.view.target.reset();
  return plain;
}

Painting painting_of_movie(const PictureSource& source) {
  sim::Plans plans;
  const double area = sim::measure(plans, source.trajectory.state(0).vesicles.front(), 1, 1).area;
  return plan_painting(source.trajectory, instants_to_look_at(source.trajectory), source.settings,
                       std::sqrt(area / sim::default_area));
}

ViewPanel panel_of(const Still& still, const PictureSource& source, const Painting& painting, const sim::State& state) {
  ViewPanel p{.source = source, .view = source.settings.view};
  p.view.size = {still.width, still.height};
  p.painting = painting;
  p.stamped = false;
  p.framing = render::frame_trajectory(std::vector{render::summarize(state)}, p.view);
  const glm::dvec3 target = render::to_glm(still.target);
  p.framing.depth += glm::length(target - p.framing.target);
  p.framing.follows = false;
  p.framing.target = target;
  p.framing.half_height = still.half_height;
  return p;
}

}  // namespace

Studio::Studio(const render::GlChoice& choice, const std::filesystem::path& shader_dir, int picture_height)
    : renderer(choice, shader_dir),
      meshes(picture_height > 1440 ? 128 : 96) {}  // finer where the outline would show its corners

render::Image draw_picture(Studio& studio, const Production& production, double time) {
  std::vector<render::Image> parts;
  for (const ViewPanel& panel : production.panels) {
    const sim::State state = boxed(panel.source.settings.scene, state_at(panel.source.trajectory, time));
    parts.push_back(render::draw_frame(studio.renderer, frame_of(studio, panel, state)));
  }
  render::Image whole = parts.size() == 1 && !production.plots ? std::move(parts.front()) : joined(production, parts);
  if (production.plots) add_plots(whole, *production.plots, studio.font, time);
  return whole;
}

Studio studio_of_stills(const Options& options) {
  return {render::parse_gl_choice(options.gl), options.shader_dir, 1080};
}

DrawnStills draw_stills(Studio& studio, const PictureSource& source, const std::optional<render::Legend>& legend,
                        const std::string& background, const std::vector<Still>& stills) {
  const auto& [trajectory, settings] = source;
  const Settings plain = plain_settings(settings, background);
  Painting painting = painting_of_movie({trajectory, plain});
  if (legend && painting.field) painting.legend = legend;
  DrawnStills drawn;
  if (painting.field != nullptr || plain.view.colour_by != "order") drawn.legend = painting.legend;
  for (const Still& still : stills) {
    sim::State state = boxed(settings.scene, state_at(trajectory, still.time));
    if (still.alone) state.vesicles.resize(1);
    ViewPanel panel = panel_of(still, {trajectory, plain}, painting, state);
    if (still.alone) panel.view.faces = "whole";
    drawn.images.push_back(render::draw_frame(studio.renderer, frame_of(studio, panel, state)));
  }
  return drawn;
}

std::optional<render::Legend> shared_legend(const std::vector<PictureSource>& sources) {
  const render::FieldRange& range = sources.front().settings.view.field_range;
  if (!range.shared) return {};
  std::vector<Painting> own;
  std::vector<Painting*> paintings;
  for (const PictureSource& source : sources) own.push_back(painting_of_movie(source));
  for (Painting& painting : own) paintings.push_back(&painting);
  share_legend(paintings, range);
  return own.front().field ? own.front().legend : std::nullopt;
}

}  // namespace app
