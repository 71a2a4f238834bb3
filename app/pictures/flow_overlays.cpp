#include "app/pictures/flow_overlays.h"

#include "app/pictures/flow_picture.h"

#include "render/core/places.h"
#include "render/overlay/layout.h"
#include "render/scene/arrow_net.h"
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

/// The parts of a line that are clear of what lies over the picture; heads: indices of its points.
void add_clear_parts(const render::Streamline& line, const std::vector<Eigen::Index>& heads,
                     const render::CutPlane& plane, const render::Camera& camera,
                     const std::vector<render::Box>& overlays, const std::vector<int>& size,
                     std::vector<render::FlowLines::Line>& parts) {
  render::FlowLines::Line part;
  const auto finish = [&] {
    if (part.points.size() > 1) parts.push_back(part);
    part = {};
  };
  for (Eigen::Index k = 0; k < line.points.rows(); ++k) {
    const sim::Vec3 point = plane.origin + line.points(k, 0) * plane.right + line.points(k, 1) * plane.up;
    if (render::clear_of(overlays, camera.picture_place(render::to_glm(point)), size) < 0.2) {
      finish();
      continue;
    }
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
  arrows.points = render::arrow_points(p.framing, moment);
  arrows.velocities = sim::background_velocity(p.source.settings.scene.flows, summary.time, arrows.points);
  arrows.reference_speed = p.arrow_speed;
  arrows.shown = render::arrows_shown(p.framing, moment);
  return arrows;
}

render::FlowLines flow_lines_of(sim::Plans& plans, const ViewPanel& p, const sim::State& state,
                                const render::Camera& camera, const std::vector<render::Box>& overlays) {
  render::FlowLines all;
  if (p.view.streamlines == "off") return all;
  const FlowRequest request = request_of(plans, p, state, camera);
  const double between_heads = 7 * request.spacing;
  for (const render::Streamline& line : flow_picture(plans, p.source.settings.scene, state, request).lines)
    add_clear_parts(line, render::arrow_places(line, between_heads), request.plane, camera, overlays, p.view.size,
                    all.lines);
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
