#include "app/pictures/overlays.h"

#include "render/core/places.h"
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

void frame_inset(ViewPanel& p, const std::vector<render::StateSummary>& summaries) {
  glm::dvec2 low(1e300), high(-1e300);
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
  for (std::size_t v = 0; v < state.vesicles.size(); ++v)
    for (const render::ClosedCurve& curve : render::cut(state.vesicles[v].position, plane)) {
      render::Inset::Curve& drawn = inset.curves.emplace_back();
      drawn.colour = p.painting.bodies[v];
      for (Eigen::Index k = 0; k < curve.points.rows(); ++k)
        drawn.points.emplace_back(curve.points(k, 0), curve.points(k, 1));
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
