#include "render/scene/section.h"

#include "render/scene/surface.h"

#include "sim/sphere/basis.h"
#include "sim/sphere/legendre.h"
#include "sim/sphere/point_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace render {
namespace {

using sim::Matrix;
using sim::Vec3;

// The net's own symmetry planes must not fall into the cutting plane, where signs would be those of rounding errors:
// it is turned by an angle that no vesicle or flow has.
Eigen::Matrix3d net_turn() {
  return Eigen::AngleAxisd(0.7391, Vec3(0.31, 0.77, -0.56).normalized()).toRotationMatrix();
}

/// The turn as Rz(phi) Ry(theta) Rz(first).
struct EulerAngles {
  double phi, theta, first;
};
EulerAngles angles_of(const Eigen::Matrix3d& r) {
  return {std::atan2(r(1, 2), r(0, 2)), std::acos(std::clamp(r(2, 2), -1.0, 1.0)), std::atan2(r(2, 1), -r(2, 0))};
}

/// Height of the surface above the plane at all vertices of the net: the field is turned instead of the net, whose
/// points stay those of a grid.
sim::Vector heights(const MeshPlan& net, const sim::RotationPlan& rotation, const sim::Coefficients& position,
                    const CutPlane& plane) {
  sim::Coefficients height{position.order, position.values * plane.normal};
  height.values(0, 0) -= std::sqrt(4 * std::numbers::pi) * plane.origin.dot(plane.normal);
  const EulerAngles turn = angles_of(net_turn());
  height.values = rotation.to_pole(height.values, turn.theta, turn.phi);
  const sim::Vector phi = net.phi().array() + turn.first;
  const Matrix all = sim::sample_grid(height, net.theta(), phi).value;
  const Eigen::Index rings = net.latitudes() - 1, columns = net.longitudes();
  sim::Vector at(net.vertices());
  for (Eigen::Index j = 0; j < columns; ++j)
    at.segment(j * rings, rings) = all.col(0).segment(j * (rings + 2) + 1, rings);
  at[columns * rings] = all(0, 0);
  at[columns * rings + 1] = all(rings + 1, 0);
  return at;
}

struct Net {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< that cross the plane; first end is below it
  std::vector<std::array<int, 2>> next;  ///< the two crossing edges that share a triangle with each
};

Net crossing_edges(const MeshPlan& plan, const sim::Vector& height) {
  Net net;
  std::unordered_map<std::uint64_t, int> number;
  std::vector<std::uint8_t> above;
  for (const double h : height) above.push_back(h >= 0);
  const auto edge = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
    const auto [found, fresh] = number.try_emplace(key, static_cast<int>(net.edges.size()));
    if (fresh) {
      net.edges.push_back(above[a] ? std::pair{b, a} : std::pair{a, b});
      net.next.push_back({-1, -1});
    }
    return found->second;
  };
  const auto join = [&](int from, int to) {
    std::array<int, 2>& slots = net.next[static_cast<std::size_t>(from)];
    slots[slots[0] < 0 ? 0 : 1] = to;
  };
  const std::span<const std::uint32_t> index = plan.indices();
  for (std::size_t t = 0; t < index.size(); t += 3) {
    if (above[index[t]] == above[index[t + 1]] && above[index[t]] == above[index[t + 2]]) continue;
    int crossed[3], count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = index[t + k], b = index[t + (k + 1) % 3];
      if (above[a] != above[b]) crossed[count++] = edge(a, b);
    }
    join(crossed[0], crossed[1]);
    join(crossed[1], crossed[0]);
  }
  return net;
}

// Every crossing edge belongs to two triangles, so following neighbours closes every chain.
std::vector<std::vector<int>> loops_of(const Net& net) {
  std::vector<std::vector<int>> loops;
  std::vector<bool> seen(net.edges.size(), false);
  for (std::size_t start = 0; start < net.edges.size(); ++start) {
    if (seen[start]) continue;
    std::vector<int> loop;
    for (int at = static_cast<int>(start); at >= 0 && !seen[static_cast<std::size_t>(at)];) {
      seen[static_cast<std::size_t>(at)] = true;
      loop.push_back(at);
      const std::array<int, 2>& n = net.next[static_cast<std::size_t>(at)];
      at = n[0] >= 0 && !seen[static_cast<std::size_t>(n[0])] ? n[0] : n[1];
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

/// Zero of the height on the arc from `below` to `above`, whose heights are fa < 0 <= fb: regula falsi (Illinois).
Vec3 zero_on_arc(const sim::PointSampler& surface, const CutPlane& plane, const Vec3& below, const Vec3& above,
                 double fa, double fb, double tolerance) {
  double a = 0, b = 1;
  Vec3 s;
  for (int round = 0, side = 0; round < 40; ++round) {
    const double t = (a * fb - b * fa) / (fb - fa);
    s = ((1 - t) * below + t * above).normalized();
    const double f = (surface.position(s) - plane.origin).dot(plane.normal);
    if (std::abs(f) <= tolerance) break;
    if (f < 0) {
      a = t;
      fa = f;
      if (side < 0) fb /= 2;
      side = -1;
    } else {
      b = t;
      fb = f;
      if (side > 0) fa /= 2;
      side = 1;
    }
  }
  return s;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

SectionPlan::SectionPlan(int latitudes) : net_(latitudes, 4 * ((latitudes + 1) / 2)) {
  const Eigen::Matrix3d turn = net_turn();
  for (const glm::vec3& s : net_.parameters()) directions_.push_back(turn * to_sim(s).normalized());
}

std::vector<ClosedCurve> cut(const sim::Coefficients& position, const CutPlane& plane, int latitudes) {
  return SectionPlan(latitudes).cut(position, plane, sim::RotationPlan(position.order));
}

std::vector<ClosedCurve> SectionPlan::cut(const sim::Coefficients& position, const CutPlane& plane,
                                          const sim::RotationPlan& rotation) const {
  const sim::Vector height = heights(net_, rotation, position, plane);
  const Net net = crossing_edges(net_, height);
  if (net.edges.empty()) return {};
  const sim::PointSampler surface(position);
  const double tolerance = 1e-13 * height.cwiseAbs().maxCoeff();
  Matrix parameters(net.edges.size(), 3);
  SurfacePoints found{Matrix(net.edges.size(), 3), Matrix(net.edges.size(), 3)};
  for (std::size_t k = 0; k < net.edges.size(); ++k) {
    const auto [below, above] = net.edges[k];
    const auto row = static_cast<Eigen::Index>(k);
    const Vec3 s =
        zero_on_arc(surface, plane, directions_[below], directions_[above], height[below], height[above], tolerance);
    const sim::PointTangents x = surface.tangents(s);
    parameters.row(row) = s.transpose();
    found.position.row(row) = x.x.transpose();
    found.normal.row(row) = x.a.cross(x.b).stableNormalized().transpose();
  }
  const double size = height.maxCoeff() - height.minCoeff();

  std::vector<ClosedCurve> curves;
  for (const std::vector<int>& loop : loops_of(net)) {
    struct Row {
      Eigen::Vector2d point, tangent;
      int edge;
    };
    std::vector<Row> rows;
    for (const int k : loop) {
      const Vec3 x = found.position.row(k).transpose() - plane.origin, n = found.normal.row(k);
      const Eigen::Vector2d p(x.dot(plane.right), x.dot(plane.up)), out(n.dot(plane.right), n.dot(plane.up));
      if (!(out.norm() > 1e-9)) continue;  // the plane touches the surface here
      const Eigen::Vector2d along = Eigen::Vector2d(-out.y(), out.x()).normalized();
      if (!rows.empty() && (rows.back().point - p).norm() < 1e-9 * size) continue;
      rows.push_back({p, along, k});
    }
    if (rows.size() > 1 && (rows.back().point - rows.front().point).norm() < 1e-9 * size) rows.pop_back();
    if (rows.size() < 3) continue;
    double forward = 0;  // does the chain run the way its tangents point?
    for (std::size_t i = 0; i < rows.size(); ++i)
      forward += (rows[(i + 1) % rows.size()].point - rows[i].point).dot(rows[i].tangent);
    if (forward < 0) std::reverse(rows.begin(), rows.end());
    ClosedCurve curve{Matrix(rows.size(), 2), Matrix(rows.size(), 2), Matrix(rows.size(), 3)};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      curve.points.row(row) = rows[i].point.transpose();
      curve.tangents.row(row) = rows[i].tangent.transpose();
      curve.directions.row(row) = parameters.row(rows[i].edge);
    }
    curves.push_back(std::move(curve));
  }
  std::stable_sort(curves.begin(), curves.end(),
                   [](const ClosedCurve& a, const ClosedCurve& b) { return length(a) > length(b); });
  return curves;
}

std::vector<CubicPiece> cubic_pieces(const ClosedCurve& curve) {
  std::vector<CubicPiece> pieces;
  for (Eigen::Index i = 0; i < curve.points.rows(); ++i) {
    const Eigen::Index j = (i + 1) % curve.points.rows();
    const Eigen::Vector2d p0 = curve.points.row(i), p3 = curve.points.row(j);
    const Eigen::Vector2d t0 = curve.tangents.row(i), t3 = curve.tangents.row(j);
    // the arm of a circular arc: 4/3 tan(angle/4) radii, in terms of the chord
    const double angle = std::acos(std::clamp(t0.dot(t3), -1.0, 1.0));
    const double arm = (p3 - p0).norm() / (3 * std::pow(std::cos(angle / 4), 2));
    pieces.push_back({p0, p0 + arm * t0, p3 - arm * t3, p3});
  }
  return pieces;
}

double enclosed_area(const ClosedCurve& curve) {
  double area = 0;
  for (const CubicPiece& c : cubic_pieces(curve))  // closed form of 1/2 oint x dy - y dx over a cubic
    area += (6 * cross(c.p0, c.p1) + 3 * cross(c.p0, c.p2) + cross(c.p0, c.p3) + 3 * cross(c.p1, c.p2) +
             3 * cross(c.p1, c.p3) + 6 * cross(c.p2, c.p3)) /
            20;
  return area;
}

double length(const ClosedCurve& curve) {
  const sim::GaussLegendre rule = sim::gauss_legendre(5);  // exact to rounding for such short pieces
  double sum = 0;
  for (const CubicPiece& c : cubic_pieces(curve))
    for (Eigen::Index k = 0; k < rule.theta.size(); ++k) {
      const double t = (std::cos(rule.theta[k]) + 1) / 2, u = 1 - t;
      sum +=
          rule.weight[k] / 2 * 3 * (u * u * (c.p1 - c.p0) + 2 * u * t * (c.p2 - c.p1) + t * t * (c.p3 - c.p2)).norm();
    }
  return sum;
}

}  // namespace render
