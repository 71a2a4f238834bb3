#include "app/pictures/flow_overlays.h"

#include "app/pictures/cell_images.h"
#include "app/pictures/flow_picture.h"

#include "render/core/paint.h"
#include "render/core/places.h"
#include "render/draw/clearance.h"
#include "render/overlay/layout.h"
#include "render/scene/arrow_net.h"
#include "render/scene/detail.h"
#include "sim/membrane/flows.h"

#include <algorithm>

namespace app {

namespace {

/// The coordinate plane that faces the viewer most, as for the arrows.
render::CutPlane plane_facing(const render::Framing& framing, const glm::dvec3& origin) {
  Eigen::Index normal = 0, across = 0;
  render::to_sim(framing.axes.back).cwiseAbs().maxCoeff(&normal);
  sim::Vec3 right = render::to_sim(framing.axes.right);
  right[normal] = 0;
  right.cwiseAbs().maxCoeff(&across);
  render::CutPlane plane;
  plane.origin = render::to_sim(origin);
  plane.right = sim::Vec3::Unit(across);
  plane.up = sim::Vec3::Unit(3 - normal - across);
  plane.normal = -plane.right.cross(plane.up);
  return plane;
}

FlowRequest request_of(sim::Plans& plans, const ViewPanel& p, const sim::State& state, const render::Camera& camera) {
  constexpr double beyond = 1.15;  // of the picture: perspective and oblique views see more of the plane
  FlowRequest request;
  request.plane = plane_facing(p.framing, camera.target);
  request.x = {-beyond * camera.half_width, beyond * camera.half_width};
  request.y = {-beyond * camera.half_height, beyond * camera.half_height};
  if (p.view.streamlines == "vesicles") request.frame_velocity = frame_velocity(plans, state);
  request.spacing = camera.half_height / 9;
  request.length = p.captions.scale_length;
  request.with_speed = false;
  return request;
}

/// The parts of a line that are in the picture and clear of what lies over it, none shorter than `shortest`; heads:
/// indices of its points.
void add_clear_parts(const render::Streamline& line, const std::vector<Eigen::Index>& heads,
                     const render::CutPlane& plane, const render::Camera& camera,
                     const std::vector<render::Box>& overlays, const std::vector<int>& size, double shortest,
                     std::vector<render::FlowLines::Line>& parts) {
  render::FlowLines::Line part;
  double seen = 0;  // of its length: what is beyond the edge of the picture makes no stub longer
  bool was_in = false;
  const auto finish = [&] {
    if (part.points.size() > 1 && seen >= shortest) parts.push_back(part);
    part = {};
    seen = 0;
    was_in = false;
  };
  for (Eigen::Index k = 0; k < line.points.rows(); ++k) {
    const sim::Vec3 point = plane.origin + line.points(k, 0) * plane.right + line.points(k, 1) * plane.up;
    const glm::dvec2 place = camera.picture_place(render::to_glm(point));
    if (render::clear_of(overlays, place, size) < 0.2) {
      finish();
      continue;
    }
    const bool in = std::max(std::abs(place.x), std::abs(place.y)) < 1;
    if (in && was_in) seen += glm::distance(part.points.back(), render::to_glm(point));
    was_in = in;
    if (std::find(heads.begin(), heads.end(), k) != heads.end()) part.heads.push_back(part.points.size());
    part.points.push_back(render::to_glm(point));
  }
  part.closed = line.closed && static_cast<Eigen::Index>(part.points.size()) == line.points.rows();
  finish();
}

}  // namespace

render::FlowArrows arrows_of(const ViewPanel& p, const render::StateSummary& summary) {
  render::FlowArrows arrows;
  if (!p.view.flow_arrows || p.view.streamlines != "off") return arrows;
  const render::Moment moment = p.framing.moment(summary);
  arrows.points = render::arrow_points(p.framing, moment, p.arrow_net);
  arrows.velocities = sim::background_velocity(p.source.settings.scene.flows, summary.time, arrows.points);
  arrows.reference_speed = p.arrow_speed;
  arrows.shown = render::arrows_shown(p.framing, moment);
  return arrows;
}

namespace {

/// What vesicles and copies cover, by the few points that are known of them.
std::vector<render::Shadow> shadows_of(const sim::Scene& scene, const render::ViewParameters& view,
                                       const render::StateSummary& summary, const render::Camera& camera) {
  // Half the distance of these points on a sphere, which are 18 degrees apart, as a share of its radius.
  constexpr double between = 0.16;
  const std::size_t each = summary.points_of_each();
  std::vector<Whereabouts> places;
  for (std::size_t v = 0; v < summary.centroids.size(); ++v) {
    Whereabouts& place = places.emplace_back();
    place.middle = render::to_sim(summary.centroids[v]);
    place.bounds = {place.middle, place.middle};
    for (std::size_t k = v * each; k < (v + 1) * each; ++k) {
      const sim::Vec3 point = render::to_sim(summary.point(k));
      place.bounds = sim::united(place.bounds, {point, point});
    }
  }
  const std::optional<render::FaceBox> faces = faces_of(scene, view);
  std::vector<render::Shadow> shadows;
  for (const Shown& shown : shown_of(scene, view, places, summary.time)) {
    std::vector<glm::dvec3> points;
    for (std::size_t k = 0; k < each; ++k) {
      const glm::dvec3 point = summary.point(shown.vesicle * each + k) + render::to_glm(shown.shift);
      if (!faces || faces->holds(point)) points.push_back(point);
    }
    if (points.empty()) continue;
    shadows.push_back(render::shadow_of(camera, points));
    shadows.back().reach = between * shadows.back().radius;
  }
  return shadows;
}

/// How many arrows are seen at one instant.
double clear_arrows(const ViewPanel& p, const render::StateSummary& summary, const std::vector<render::Shadow>& shadows,
                    const render::Camera& camera) {
  const render::FlowArrows arrows = arrows_of(p, summary);
  const double fastest = arrows.points.rows() > 0 ? arrows.velocities.rowwise().norm().maxCoeff() : 0;
  double clear = 0;
  for (Eigen::Index k = 0; fastest > 0 && k < arrows.points.rows(); ++k) {
    const glm::dvec3 share = render::to_glm(arrows.velocities.row(k)) / fastest;
    if (glm::length(share) < render::weakest_arrow) continue;
    const glm::dvec3 middle = render::to_glm(arrows.points.row(k));
    const glm::dvec3 half = share * render::longest_arrow * camera.half_height / 2.0;
    const glm::dvec2 aspect(camera.half_width / camera.half_height, 1);
    const double shown = render::clear_of_bodies(shadows, aspect * camera.picture_place(middle - half),
                                                 aspect * camera.picture_place(middle + half));
    if (shown > 0.8) ++clear;
  }
  return clear;
}

}  // namespace

int arrow_net_of(const ViewPanel& p, const std::vector<render::StateSummary>& summaries) {
  constexpr double enough = 8;  // arrows, on the mean
  const sim::Scene& scene = p.source.settings.scene;
  int best = 1;
  double most = 0;
  for (int net = 1; net <= render::finest_arrow_net && most < enough; ++net) {  // mostly the first one does
    ViewPanel finer = p;
    finer.arrow_net = net;
    double clear = 0;
    for (const render::StateSummary& summary : summaries) {
      const render::Camera camera = render::make_camera(p.framing, p.framing.moment(summary));
      clear += clear_arrows(finer, summary, shadows_of(scene, p.view, summary, camera), camera) /
               static_cast<double>(summaries.size());
    }
    if (clear > most) {
      best = net;
      most = clear;
    }
  }
  return best;
}

render::FlowLines flow_lines_of(sim::Plans& plans, const ViewPanel& p, const sim::State& state,
                                const render::Camera& camera, const std::vector<render::Box>& overlays) {
  render::FlowLines all;
  if (p.view.streamlines == "off") return all;
  const FlowRequest request = request_of(plans, p, state, camera);
  const double between_heads = 7 * request.spacing;
  for (const render::Streamline& line : flow_picture(plans, p.source.settings.scene, state, request).lines)
    add_clear_parts(line, render::arrow_places(line, between_heads), request.plane, camera, overlays, p.view.size,
                    1.5 * request.spacing, all.lines);
  return all;
}

render::FlowProfile profile_of(const ViewPanel& p, const render::Camera& camera, double time) {
  constexpr int count = 25;                                       // points: an arrow stands at every fourth
  const glm::dmat3 turn(glm::transpose(glm::mat3(camera.view)));  // columns: right, up, back
  sim::Matrix points(count, 3);
  std::vector<double> heights;
  for (int k = 0; k < count; ++k) {
    heights.push_back(render::profile_reach * (2.0 * k / (count - 1) - 1));
    points.row(k) = render::to_sim(camera.target + heights.back() * camera.half_height * turn[1]).transpose();
  }
  const sim::Matrix velocity = sim::background_velocity(p.source.settings.scene.flows, time, points);
  render::FlowProfile profile;
  for (int k = 0; k < count; ++k)
    profile.points.emplace_back(heights[static_cast<std::size_t>(k)],
                                glm::dot(render::to_glm(velocity.row(k)), turn[0]));
  return profile;
}

}  // namespace app
