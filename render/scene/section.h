// The intersection of a plane with a vesicle: closed curves on the spectral surface, with tangents.
#pragma once

#include "render/scene/mesh.h"

#include "sim/core/types.h"
#include "sim/sphere/rotation.h"

#include <vector>

namespace render {

/// A plane with axes in it; right, up, normal are orthonormal and right x up = -normal for the flow-gradient plane.
struct CutPlane {
  sim::Vec3 origin = sim::Vec3::Zero();
  sim::Vec3 normal = sim::Vec3::UnitY();
  sim::Vec3 right = sim::Vec3::UnitX();
  sim::Vec3 up = sim::Vec3::UnitZ();
};

/// A closed curve in the plane, inside on the left. The last point is joined to the first.
struct ClosedCurve {
  sim::Matrix points;      ///< count x 2: along right and up, relative to the plane's origin
  sim::Matrix tangents;    ///< count x 2, unit vectors in the direction of travel
  sim::Matrix directions;  ///< count x 3: parameters of the points on the unit sphere
};

/// What sections of many surfaces share: a net of `latitudes` x 2 latitudes cells on the unit sphere, which must be
/// finer than the smallest feature of interest. Immutable.
class SectionPlan {
 public:
  explicit SectionPlan(int latitudes);
  /// All curves, longest first. The zero set of (x(s) - origin) . normal is traced on the net; each point is then moved
  /// along its edge of the net until it lies on plane and spectral surface to 1e-12 of the vesicle's size. Empty when
  /// the plane misses the vesicle. rotation: of the surface's degree.
  std::vector<ClosedCurve> cut(const sim::Coefficients& position, const CutPlane& plane,
                               const sim::RotationPlan& rotation) const;

 private:
  MeshPlan net_;
  std::vector<sim::Vec3> directions_;  ///< of its vertices
};
/// Of one surface.
std::vector<ClosedCurve> cut(const sim::Coefficients& position, const CutPlane& plane, int latitudes = 48);

/// The curve between two neighbouring points as a Bezier cubic: ends p0, p3, arms p1, p2.
struct CubicPiece {
  Eigen::Vector2d p0, p1, p2, p3;
};
/// One piece per point; the arms reproduce a circle to fourth order.
std::vector<CubicPiece> cubic_pieces(const ClosedCurve& curve);

/// Of the cubic pieces; a curve around a hole has negative area.
double enclosed_area(const ClosedCurve& curve);
double length(const ClosedCurve& curve);

}  // namespace render
