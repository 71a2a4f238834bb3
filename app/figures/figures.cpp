#include "app/figures/figures.h"

#include "app/base/message.h"
#include "app/base/printable.h"
#include "app/figures/phase_diagram.h"
#include "app/figures/plots.h"
#include "app/pictures/cell_images.h"
#include "app/pictures/flow_picture.h"
#include "app/pictures/pictures.h"
#include "app/scene/scene_text.h"

#include "render/core/style.h"
#include "render/scene/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

void add_series(render::FigureInput& input, const std::vector<FigureSource>& sources) {
  const SharedScales scales = shared_scales(sources);
  std::vector<const QuantityRow*> rows;
  const std::vector<std::string> only{std::string("inclination")};
  for (const std::string& name : input.parameters.kind == "inclination" ? only : input.parameters.quantities)
    rows.push_back(&find_quantity(name));
  input.time_factor = 1;  // the series bring their own
  input.time_symbol = scales.time.symbol;
  for (const FigureSource& source : sources)
    for (render::Series& series : series_of(source, scales, rows, false)) input.series.push_back(std::move(series));
}

std::string hex_of(const render::Colour& c) {
  const auto byte = [](double v) { return static_cast<int>(std::lround(255 * v)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
}

/// That of a dark page, and white on all others.
std::string ground_of_stills(const render::FigureParameters& parameters) {
  const render::Theme theme = render::page_of(parameters).theme;
  if (!theme.is_dark()) return "white";
  return hex_of(theme.ground);
}

void add_stills(render::FigureInput& input, const FigureSource& source, const Options& options) {
  Settings settings = source.settings;
  settings.view.supersampling = std::max(settings.view.supersampling, 3);
  input.camera = settings.view.camera;
  const double pixels = render::dots_per_inch(input.parameters) / 72;
  input.shows_field = render::find_style(settings.view.style).field || settings.view.colour_by != "order";
  // In a periodic cell vesicles are shown in the box, wherever they have drifted to.
  render::ViewParameters cut = settings.view;
  cut.faces = "cut";
  cut.copies = {0, 0, 0};
  input.box = faces_of(settings.scene, cut);
  if (input.box && settings.view.faces == "whole") {  // they stand out of it
    input.box->low -= input.length;
    input.box->high += input.length;
  }
  constexpr int least = 16;  // px
  std::vector<Still> stills;
  const render::Sheet sheet = render::sheet_layout(input);
  for (std::size_t k = 0; k < sheet.panels.size(); ++k) {
    const render::SheetPanel& p = sheet.panels[k];
    stills.push_back({.time = input.states[k].time,
                      .target = p.target,
                      .half_height = p.half_height,
                      .width = std::max(least, static_cast<int>(std::lround(p.width * pixels))),
                      .height = std::max(least, static_cast<int>(std::lround(p.height * pixels)))});
  }
  Studio studio = studio_of_stills(options);
  DrawnStills drawn =
      draw_stills(studio, {source.trajectory, settings}, source.legend, ground_of_stills(input.parameters), stills);
  input.stills = std::move(drawn.images);
  input.field = std::move(drawn.legend);
  if (input.field) input.field->mirrored = input.field->mirrored && settings.view.sign_dots;
}

/// The first vesicle of each in the course of its motion, seen as the sections cut it.
void add_diagram_pictures(render::FigureInput& input, const std::vector<FigureSource>& sources,
                          const Options& options) {
  const auto [side, reach] = render::diagram_picture(input);
  const int pixels = std::max(16, static_cast<int>(std::lround(side * render::dots_per_inch(input.parameters) / 72)));
  Studio studio = studio_of_stills(options);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    render::DiagramPoint& point = input.diagram.points[k];
    Settings settings = sources[k].settings;
    render::ViewParameters& view = settings.view;
    view.supersampling = std::max(view.supersampling, 3);
    if (render::find_style(view.style).field) view.style = "opaque";
    view.colour_by = "order";
    view.colours = {hex_of(render::diagram_colour(render::page_of(input.parameters).theme, point.kind))};
    view.depth_cue = 0;
    view.tracers = false;  // they would look like the marks of places
    // Other instants are sections, which only this view shows as they are.
    if (view.camera != "flow-gradient" || input.parameters.plane_normal.normalized().cwiseAbs() != sim::Vec3::UnitY())
      point.outlines.clear();
    const sim::State state = state_at(sources[k].trajectory, point.time);
    const sim::Vec3 target = render::volume_moments(state.vesicles.front().position).centroid;
    const Still still{.time = point.time,
                      .target = target,
                      .half_height = reach * length_of(sources[k].trajectory),
                      .width = pixels,
                      .height = pixels,
                      .alone = true};
    point.picture = draw_stills(studio, {sources[k].trajectory, settings}, {}, "transparent", {still}).images.front();
  }
}

void add_flow(render::FigureInput& input, const FigureSource& source) {
  sim::Plans plans;
  const sim::Scene& scene = source.settings.scene;
  const TimeUnit unit = time_unit(scene);
  const sim::State state = boxed(scene, input.states.front());
  const FlowRequest request = flow_request(plans, state, input.parameters, input.length);
  input.flow = flow_picture(plans, scene, state, request);
  WindowMembranes shown = membranes_in(scene, state, request);
  input.states.front() = std::move(shown.state);
  input.flow.owners = std::move(shown.owners);
  const std::string speed = input.parameters.frame == "vesicle" ? "in-plane |u\u00a0−\u00a0U|" : "in-plane |u|";
  if (unit.symbol != "t") {
    input.flow.speed_factor = 1 / (unit.factor * input.length);
    input.flow.speed_label = speed + " /\u00a0γ̇R_{0}";
  } else {
    input.flow.speed_label = speed;
  }
}

}  // namespace

bool takes_several(std::string_view kind) {
  return kind == "time-series" || kind == "inclination" || kind == "phase" || kind == "phase-diagram" ||
         kind == "tank-treading" || kind == "pair-distribution";
}

render::Figure make_figure(const std::vector<FigureSource>& sources, const render::FigureParameters& parameters,
                           const Options& options) {
  const render::FigureRow& kind = render::find_figure(parameters.kind);
  const FigureSource& first = sources.front();
  const sim::TrajectoryReader& trajectory = first.trajectory;
  render::FigureInput input;
  input.parameters = parameters;
  const TimeUnit unit = time_unit(first.settings.scene);
  input.time_symbol = unit.symbol;
  input.time_factor = unit.factor;
  input.length = length_of(trajectory);
  std::vector<double> times;
  for (std::int64_t k = 0; k < trajectory.count(); ++k) times.push_back(trajectory.time(k));
  const auto take = [&](const std::vector<double>& chosen) {
    for (const double time : chosen) {
      input.states.push_back(state_at(trajectory, time));
      input.states.back().time = std::min(time, times.back());
    }
  };
  switch (kind.needs) {
    case render::FigureNeeds::series:
      add_series(input, sources);
      break;
    case render::FigureNeeds::plots:
      if (kind.name == "phase") {
        input.plots = phase_plots(sources, parameters);
      } else if (kind.name == "spectra") {
        take(render::chosen_times(times, parameters));
        input.plots = spectra_plots(input);
      } else if (kind.name == "pair-distribution") {
        input.plots = pair_plots(sources, parameters);
      } else {
        input.plots = steady_plots(sources);
      }
      break;
    case render::FigureNeeds::instants:
      take(render::chosen_times(times, parameters));
      break;
    case render::FigureNeeds::stills:
      take(render::chosen_times(times, parameters));
      add_stills(input, first, options);
      break;
    case render::FigureNeeds::flow:
      if (parameters.times.empty())
        take({times.back()});
      else
        take({render::chosen_times(times, parameters).front()});
      add_flow(input, first);
      break;
    case render::FigureNeeds::diagram: {
      input.diagram = phase_diagram(sources, parameters);
      if (parameters.vesicles == "pictures") add_diagram_pictures(input, sources, options);
      break;
    }
  }
  return kind.draw(input);
}

std::vector<std::filesystem::path> draw_figure(const std::vector<FigureSource>& sources,
                                               const render::FigureParameters& parameters,
                                               const std::filesystem::path& stem, const sim::FileWriter& write,
                                               const Options& options) {
  render::Figure figure = make_figure(sources, parameters, options);
  std::string titles;
  std::string& subject = figure.drawing.subject;
  for (const FigureSource& source : sources) {
    const std::string title = printable(source.settings.scene.title);
    if (!title.empty() && titles.find(title) == std::string::npos)
      titles.append(titles.empty() ? "" : "; ").append(title);
    subject.append(subject.empty() ? "" : "\n").append(write_scene(source.settings.scene));
  }
  figure.drawing.title = fmt::format("{}{}{}", parameters.kind, titles.empty() ? "" : ": ", titles);
  if (const std::string missing = render::missing_letters(figure.drawing); !missing.empty())
    tell(fmt::format("no font has the letters '{}': they are drawn as empty boxes", missing));
  return render::write_figure(figure, stem, {}, write);
}

}  // namespace app
