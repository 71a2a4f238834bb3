#include "render/scene/cutaway.h"

#include "render/scene/surface.h"

namespace render {

Cut make_cut(const SectionPlan& plan, const sim::RotationPlan& rotation, const sim::Coefficients& position,
             const sim::Vec3& normal, const sim::Vec3& point) {
  CutPlane plane;
  plane.normal = normal.normalized();
  plane.origin = point;
  plane.right = plane.normal.unitOrthogonal();
  plane.up = plane.normal.cross(plane.right);
  Cut result{to_glm(plane.normal), to_glm(plane.origin), {}};
  for (const ClosedCurve& curve : plan.cut(position, plane, rotation)) {
    std::vector<glm::dvec3>& edge = result.edges.emplace_back();
    for (Eigen::Index k = 0; k < curve.points.rows(); ++k)
      edge.push_back(to_glm(plane.origin + curve.points(k, 0) * plane.right + curve.points(k, 1) * plane.up));
  }
  return result;
}

Cut make_cut(const sim::Coefficients& position, const sim::Vec3& normal, double offset) {
  return make_cut(SectionPlan(rim_latitudes), sim::RotationPlan(position.order), position, normal,
                  volume_moments(position).centroid + offset * normal.normalized());
}

}  // namespace render
