#include "app/pictures/production.h"

#include "app/base/printable.h"
#include "app/base/version.h"
#include "app/pictures/cell_images.h"
#include "app/pictures/flow_overlays.h"
#include "app/pictures/instants.h"
#include "app/pictures/overlays.h"
#include "app/scene/scene_text.h"

#include "render/core/paint.h"
#include "render/overlay/panels.h"
#include "sim/measures/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

namespace app {

namespace {

/// What one pass over a trajectory says about all its frames.
struct SourceMeasures {
  std::vector<render::StateSummary> summaries;  ///< of the instants that were looked at
  std::vector<double> laid;                     ///< times at which labels were reset on any vesicle
  Painting painting;
  render::Captions captions;
};

/// titled: the title is needed to tell several sources apart.
SourceMeasures measures_of(const PictureSource& source, bool titled, std::optional<double> still) {
  const auto& [trajectory, settings] = source;
  const std::vector<std::int64_t> chosen = instants_to_look_at(trajectory);
  SourceMeasures m;
  std::set<double> laid;
  for (const std::int64_t i : chosen) {
    const sim::State state = boxed(settings.scene, trajectory.state(i));
    m.summaries.push_back(summary_of(settings.scene, state));
    for (const sim::VesicleState& v : state.vesicles)
      if (v.labels_laid > 0) laid.insert(v.labels_laid_time);
  }
  m.laid.assign(laid.begin(), laid.end());
  sim::Plans plans;
  const sim::State start = trajectory.state(0);
  const sim::VesicleMeasures first = sim::measure(plans, start.vesicles.front(), 1, 1);
  std::vector<double> radii;
  for (std::size_t k = 0; k < start.vesicles.size(); ++k) {
    const auto &own = settings.scene.vesicles[k], &front = settings.scene.vesicles.front();
    const bool as_first = own.radius == front.radius && own.area == front.area &&
                          own.axes == front.axes;  // most are: they cost no measuring
    radii.push_back(
        std::sqrt((as_first ? first : sim::measure(plans, start.vesicles[k], 1, 1)).area / sim::default_area));
  }
  const auto [least, most] = std::minmax_element(radii.begin(), radii.end());
  constexpr double alike = 1.01;
  const bool of_one_size = *most < alike * *least;
  // Of many sizes, the mean is the measure of lengths, and the scale bar says so.
  const double area_radius =
      of_one_size ? radii.front() : std::accumulate(radii.begin(), radii.end(), 0.0) / double(radii.size());
  std::optional<sim::State> only;
  if (still && !settings.view.field_range.shared) only = boxed(settings.scene, state_at(trajectory, *still));
  m.painting = plan_painting(trajectory, chosen, settings, area_radius, only ? &*only : nullptr);
  m.captions.parameters = parameter_caption(settings.scene, radii, first.reduced_volume);
  m.captions.scale_length = area_radius;
  if (!of_one_size) m.captions.scale = "mean R_{0}";
  if (settings.view.title || titled) m.captions.title = printable(settings.scene.title);
  return m;
}

std::string hash_of(const std::vector<PictureSource>& sources, bool still) {
  std::string hash;
  for (const auto& [trajectory, settings] : sources)
    hash += fmt::format("{}-{}-", picture_hash(settings), trajectory.count());
  return hash + version() + (still ? "-still" : "");
}

/// Columns and rows of the panels in a picture of the first view's size; a row for each source when there are several
/// sources and several cameras.
Production arranged(const render::ViewParameters& first, std::size_t sources, std::size_t cameras,
                    std::optional<PlotStrip> plots) {
  const auto count = static_cast<int>(sources * cameras);
  Production production;
  production.width = first.size[0];
  production.height = first.size[1];
  production.views_width = plots ? plots->views_width : production.width;
  production.views_height = plots ? plots->views_height : production.height;
  production.plots = std::move(plots);
  production.columns = sources > 1 && cameras > 1
                           ? static_cast<int>(cameras)
                           : render::panel_columns(count, production.views_width, production.views_height);
  production.rows = (count + production.columns - 1) / production.columns;
  constexpr int least = 16;  // px
  if (production.views_width / production.columns < least || production.views_height / production.rows < least)
    throw std::invalid_argument(
        fmt::format("{} views need a larger picture than {} x {}", count, production.width, production.height));
  return production;
}

/// Of what is cut at the faces nothing reaches out of their box.
render::StateSummary corners_alone(const render::FaceBox& box, double time) {
  render::StateSummary corners;
  corners.time = time;
  corners.centroids = {glm::dvec3(0)};
  for (int k = 0; k < 8; ++k)
    corners.points.emplace_back((k & 1) ? box.high.x : box.low.x, (k & 2) ? box.high.y : box.low.y,
                                (k & 4) ? box.high.z : box.low.z);
  return corners;
}

/// In a periodic cell, the corners of all that is drawn stand for one vesicle more, so that the picture holds it: of
/// the box, or of its copies and of what reaches out of them as the vesicles reach out of the box.
std::vector<render::StateSummary> with_cell(const PictureSource& source, const render::ViewParameters& view,
                                            std::vector<render::StateSummary> summaries) {
  const std::optional<sim::Vec3>& size = source.settings.scene.cell.size;
  if (!size) return summaries;
  if (const std::optional<render::FaceBox> faces = faces_of(source.settings.scene, view)) {
    for (render::StateSummary& s : summaries) s = corners_alone(*faces, s.time);
    return summaries;
  }
  const sim::Vec3 number(view.copies[0], view.copies[1], view.copies[2]);
  for (render::StateSummary& s : summaries) {
    const std::size_t points = s.points_of_each();
    sim::Vec3 low = -*size / 2, high = *size / 2;
    if (!number.isZero())
      for (std::size_t k = 0; k < s.points.size(); ++k) {
        low = low.cwiseMin(render::to_sim(s.point(k)));
        high = high.cwiseMax(render::to_sim(s.point(k)));
      }
    low -= number.cwiseProduct(*size);
    high += number.cwiseProduct(*size);
    s.centroids.emplace_back(0);
    for (std::size_t k = 0; k < points; ++k) {
      const sim::Vec3 corner(k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]);
      s.points.emplace_back(render::to_glm(corner));
      s.areas.emplace_back(0);
    }
  }
  return summaries;
}

/// The view with its framing and captions.
ViewPanel framed_panel(const PictureSource& source, const render::ViewParameters& view, const SourceMeasures& m) {
  ViewPanel p{.source = source, .view = view};
  p.framing = render::frame_trajectory(view.follow == "vesicle" ? m.summaries : with_cell(source, view, m.summaries),
                                       view, source.settings.key_frames);
  p.captions = m.captions;
  p.painting = m.painting;
  p.laid = m.laid;
  return p;
}

/// Panels of one camera show lengths alike, in area radii of their own vesicles: none is larger than the widest allows.
/// Placed eyes and zooms of the scenes stay.
void share_scale(const std::vector<ViewPanel*>& panels) {
  const auto of_zoom_one = [](const ViewPanel& p) {
    return p.framing.half_height * p.view.zoom / p.captions.scale_length;
  };
  double widest = 0;
  for (const ViewPanel* p : panels)
    if (!p->framing.placed) widest = std::max(widest, of_zoom_one(*p));
  for (ViewPanel* p : panels) {
    if (p->framing.placed) continue;
    const double factor = widest / of_zoom_one(*p);
    p->framing.half_height *= factor;
    p->framing.distance *= factor;
  }
}

/// The largest of 1, 2, 5, 10, 20 ... that is not above the value.
double round_factor(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  return power * (value >= 5 * power ? 5 : value >= 2 * power ? 2 : 1);
}

/// An arrow is the way of the fluid in one and the same time in all panels; the fastest fluid has the longest arrow.
/// Their speeds are in lengths of the scene, and arrows are shares of the picture's height. Of a trajectory that is so
/// slow that its arrows would hardly be seen they are longer, and its panels say by how much. each: panels of one
/// trajectory, one after the other.
void share_arrows(std::vector<ViewPanel>& panels, std::size_t each) {
  constexpr double seen = 2 * render::weakest_arrow;  // of the longest arrow
  const auto rate_of = [](const ViewPanel& p) { return p.arrow_speed / p.framing.half_height; };
  double rate = 0;
  for (const ViewPanel& p : panels) rate = std::max(rate, rate_of(p));
  for (std::size_t first = 0; first < panels.size(); first += each) {
    double own = 0;
    for (std::size_t k = first; k < first + each; ++k) own = std::max(own, rate_of(panels[k]));
    const double factor = own > 0 && own < seen * rate ? round_factor(rate / own) : 1;
    for (std::size_t k = first; k < first + each; ++k) {
      ViewPanel& p = panels[k];
      p.arrow_speed = rate * p.framing.half_height / factor;
      if (factor == 1) continue;
      if (!p.captions.panel.empty()) p.captions.panel += ", ";
      p.captions.panel += fmt::format("arrows × {:.0f}", factor);
    }
  }
}

/// Titles of panels side by side stand beside the time in all of them or above it.
void align_titles(std::vector<ViewPanel>& panels) {
  if (panels.size() < 2) return;
  std::string title, parameters;  // by the number of bytes: texts of one font
  for (const ViewPanel& p : panels) {
    if (p.captions.title.size() > title.size()) title = p.captions.title;
    if (p.captions.parameters.size() > parameters.size()) parameters = p.captions.parameters;
  }
  for (ViewPanel& p : panels) {
    p.captions.widest_title = title;
    p.captions.widest_parameters = parameters;
  }
}

/// What else all frames of the panel share: room of the inset, speed of the longest arrow.
void complete(ViewPanel& p, const SourceMeasures& m) {
  const PictureSource& source = p.source;
  render::check_framing(p.framing, m.summaries);
  frame_inset(p, m.summaries);
  p.arrow_net = arrow_net_of(p, m.summaries);
  for (const render::StateSummary& summary : m.summaries) {
    const render::FlowArrows arrows = arrows_of(p, summary);
    if (arrows.velocities.rows() > 0)
      p.arrow_speed = std::max(p.arrow_speed, arrows.velocities.rowwise().norm().maxCoeff());
  }
  if (p.view.errors) p.steps = source.trajectory.steps();
  const render::MovieParameters& movie = source.settings.movie;
  const double per_frame = time_of_frame(source.trajectory, movie);
  const std::int64_t states = source.trajectory.count();
  constexpr double notice = 1.2;  // seconds of the movie
  p.notice = notice * movie.frame_rate * per_frame;
  p.time_format = time_format(source.settings.scene, per_frame, states > 0 ? source.trajectory.time(states - 1) : 0);
}

}  // namespace

Production prepare_pictures(const std::vector<PictureSource>& sources, std::optional<double> still,
                            std::optional<PlotStrip> plots) {
  const render::ViewParameters& first = sources.front().settings.view;
  std::vector<SourceMeasures> measures;
  for (const PictureSource& source : sources) measures.push_back(measures_of(source, sources.size() > 1, still));
  std::vector<Painting*> paintings;
  for (SourceMeasures& m : measures) paintings.push_back(&m.painting);
  share_legend(paintings, first.field_range);

  std::vector<std::string> cameras = first.views;
  if (cameras.empty()) cameras = {first.camera};
  Production production = arranged(first, sources.size(), cameras.size(), std::move(plots));
  production.hash = hash_of(sources, still.has_value());
  for (std::size_t k = 0; k < sources.size(); ++k)
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const bool last = k + 1 == sources.size() && c + 1 == cameras.size(), several = cameras.size() > 1;
      render::ViewParameters view = sources[k].settings.view;
      view.size = {production.views_width / production.columns, production.views_height / production.rows};
      view.supersampling = first.supersampling;
      view.camera = cameras[c];
      view.colour_bar = view.colour_bar && last;
      if (several) view.caption = view.caption && c == 0;
      ViewPanel& panel = production.panels.emplace_back(framed_panel(sources[k], view, measures[k]));
      if (several) panel.captions.panel = cameras[c];
      panel.stamped = c == 0;
    }
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    std::vector<ViewPanel*> alike;
    for (std::size_t k = 0; k < sources.size(); ++k) alike.push_back(&production.panels[k * cameras.size() + c]);
    share_scale(alike);
  }
  align_titles(production.panels);
  for (std::size_t k = 0; k < production.panels.size(); ++k)
    complete(production.panels[k], measures[k / cameras.size()]);
  share_arrows(production.panels, cameras.size());
  return production;
}

}  // namespace app
