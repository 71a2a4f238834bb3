#include "app/pictures/overlays.h"

#include "app/pictures/cell_images.h"

#include "render/core/places.h"
#include "render/scene/detail.h"
#include "render/scene/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

/// The jump of the lines is told before it comes, and for a while after it.
std::string laid_note(const ViewPanel& p, double time) {
  if (p.view.lines != "material" || !p.view.time_stamp) return {};
  for (const double laid : p.laid)
    if (std::abs(time - laid) <= p.notice)
      return fmt::format("lines {} at {}", time < laid ? "will be laid anew" : "were laid anew",
                         time_caption(p.source.settings.scene, laid, p.time_format));
  return {};
}

}  // namespace

namespace {

/// The box of the cell alone, where vesicles are cut at its faces.
std::optional<render::FaceBox> inset_faces(const ViewPanel& p) {
  render::ViewParameters one = p.view;
  one.copies = {0, 0, 0};
  return faces_of(p.source.settings.scene, one);
}

/// The vesicles whose sections the inset shows, and whose each is.
std::vector<std::pair<std::size_t, sim::Coefficients>> inset_membranes(const ViewPanel& p, const sim::State& state) {
  std::vector<std::pair<std::size_t, sim::Coefficients>> all;
  if (!inset_faces(p)) {
    for (std::size_t v = 0; v < state.vesicles.size(); ++v) all.emplace_back(v, state.vesicles[v].position);
    return all;
  }
  render::ViewParameters one = p.view;
  one.copies = {0, 0, 0};
  std::vector<Whereabouts> places;
  for (const sim::VesicleState& v : state.vesicles)
    places.push_back(whereabouts_of(v, render::bounds_of(render::sketch_of(v))));
  for (const Shown& shown : shown_of(p.source.settings.scene, one, places, state.time))
    all.emplace_back(shown.vesicle, moved(state.vesicles[shown.vesicle], shown.shift).position);
  return all;
}

/// The part of what a closed line encloses that is in a rectangle, by its four sides one after the other (Sutherland
/// and Hodgman).
std::vector<glm::dvec2> within(std::vector<glm::dvec2> polygon, const glm::dvec2& low, const glm::dvec2& high) {
  for (const glm::length_t axis : {0, 1})
    for (const bool upper : {false, true}) {
      const auto outside = [&](const glm::dvec2& q) { return upper ? q[axis] - high[axis] : low[axis] - q[axis]; };
      std::vector<glm::dvec2> kept;
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        const double at_a = outside(a), at_b = outside(b);
        if (at_a <= 0) kept.push_back(a);
        if ((at_a <= 0) != (at_b <= 0)) kept.push_back(a + at_a / (at_a - at_b) * (b - a));
      }
      polygon = std::move(kept);
    }
  return polygon;
}

}  // namespace

void frame_inset(ViewPanel& p, const std::vector<render::StateSummary>& summaries) {
  glm::dvec2 low(1e300), high(-1e300);
  if (const std::optional<render::FaceBox> faces = inset_faces(p); faces && p.framing.vesicle < 0) {
    low = {faces->low.x, faces->low.z};
    high = {faces->high.x, faces->high.z};
    p.inset_centre = (low + high) / 2.0;
    p.inset_half = 1.04 * (high - low) / 2.0;
    return;
  }
  for (const render::StateSummary& summary : summaries) {
    glm::dvec3 origin(0);
    if (p.framing.follows) origin = p.framing.moment(summary).centre;
    const std::size_t each = summary.points_of_each();
    for (std::size_t k = 0; k < summary.points.size(); ++k) {
      // of a vesicle that is followed the neighbours as they come
      if (p.framing.vesicle >= 0 && k / each != static_cast<std::size_t>(p.framing.vesicle)) continue;
      const glm::dvec3 point = summary.point(k) - origin;
      low = glm::min(low, glm::dvec2(point.x, point.z));
      high = glm::max(high, glm::dvec2(point.x, point.z));
    }
  }
  constexpr double room = 1.08;  // a margin; the net of points falls a little short of the surface
  p.inset_centre = (low + high) / 2.0;
  p.inset_half = room * (high - low) / 2.0;
}

glm::dvec2 inset_centre(const ViewPanel& p, const glm::dvec3& centre) {
  return p.framing.follows ? p.inset_centre + glm::dvec2(centre.x, centre.z) : p.inset_centre;
}

double inset_half_height(const ViewPanel& p) { return std::max(p.inset_half.y, p.inset_half.x / render::inset_aspect); }

render::Inset inset_of(const ViewPanel& p, const sim::State& state, const render::Camera& camera,
                       const glm::dvec3& centre) {
  render::Inset inset;
  render::CutPlane plane;
  plane.origin = sim::Vec3(0, camera.target.y, 0);
  inset.centre = inset_centre(p, centre);
  inset.half_height = inset_half_height(p);
  const std::optional<render::FaceBox> faces = inset_faces(p);
  for (const auto& [v, position] : inset_membranes(p, state))
    for (const render::ClosedCurve& curve : render::cut(position, plane)) {
      std::vector<glm::dvec2> points;
      for (Eigen::Index k = 0; k < curve.points.rows(); ++k)
        points.emplace_back(curve.points(k, 0), curve.points(k, 1));
      if (faces) points = within(std::move(points), {faces->low.x, faces->low.z}, {faces->high.x, faces->high.z});
      if (points.size() < 3) continue;
      render::Inset::Curve& drawn = inset.curves.emplace_back();
      drawn.colour = p.painting.bodies[v];
      drawn.points = std::move(points);
    }
  return inset;
}

render::Captions captions_of(const ViewPanel& p, double time) {
  render::Captions captions = p.captions;
  if (!p.stamped) return captions;
  captions.time = time_caption(p.source.settings.scene, time, p.time_format);
  captions.errors = error_caption(p.steps, time);
  captions.note = laid_note(p, time);
  return captions;
}

}  // namespace app
