#include "render/scene/section.h"

#include "render/scene/mesh.h"
#include "render/scene/surface.h"

#include "sim/sphere/basis.h"
#include "sim/sphere/legendre.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace render {
namespace {

using sim::Matrix;
using sim::Vec3;

// The net's own symmetry planes must not fall into the cutting plane, where signs would be those of rounding errors:
// it is turned by an angle that no vesicle or flow has.
Matrix net_directions(const MeshPlan& plan) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7391, Vec3(0.31, 0.77, -0.56).normalized()).toRotationMatrix();
  Matrix s(plan.vertices(), 3);
  for (Eigen::Index i = 0; i < s.rows(); ++i) {
    const Vec3 p = to_sim(plan.parameters()[static_cast<std::size_t>(i)]);
    s.row(i) = (turn * p.normalized()).transpose();
  }
  return s;
}

struct Net {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< that cross the plane; first end is below it
  std::vector<std::array<int, 2>> next;  ///< the two crossing edges that share a triangle with each
};

Net crossing_edges(const MeshPlan& plan, const sim::Vector& height) {
  Net net;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> number;
  const auto above = [&](std::uint32_t v) { return height[static_cast<Eigen::Index>(v)] >= 0; };
  const auto edge = [&](std::uint32_t a, std::uint32_t b) {
    const auto key = std::minmax(a, b);
    const auto [found, fresh] = number.try_emplace({key.first, key.second}, static_cast<int>(net.edges.size()));
    if (fresh) {
      net.edges.push_back(above(a) ? std::pair{b, a} : std::pair{a, b});
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
    int crossed[3], count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = index[t + k], b = index[t + (k + 1) % 3];
      if (above(a) != above(b)) crossed[count++] = edge(a, b);
    }
    if (count == 2) {
      join(crossed[0], crossed[1]);
      join(crossed[1], crossed[0]);
    }
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

// Zero of the height along the arc between the ends of each edge: all edges at once, regula falsi (Illinois).
Matrix zeros_on_edges(const sim::Coefficients& position, const CutPlane& plane, const Net& net, const Matrix& s,
                      const sim::Vector& height) {
  const auto count = static_cast<Eigen::Index>(net.edges.size());
  sim::Vector a = sim::Vector::Zero(count), b = sim::Vector::Ones(count), fa(count), fb(count);
  const auto ends = [&](Eigen::Index i) { return net.edges[static_cast<std::size_t>(i)]; };
  for (Eigen::Index i = 0; i < count; ++i) {
    fa[i] = height[ends(i).first];
    fb[i] = height[ends(i).second];
  }
  const auto points_at = [&](const sim::Vector& t) {
    Matrix p(count, 3);
    for (Eigen::Index i = 0; i < count; ++i)
      p.row(i) = ((1 - t[i]) * s.row(ends(i).first) + t[i] * s.row(ends(i).second)).normalized();
    return p;
  };
  const double tolerance = 1e-13 * height.cwiseAbs().maxCoeff();
  sim::Vector t(count), side = sim::Vector::Zero(count);
  for (int round = 0; round < 40; ++round) {
    for (Eigen::Index i = 0; i < count; ++i) t[i] = (a[i] * fb[i] - b[i] * fa[i]) / (fb[i] - fa[i]);
    const sim::Vector f =
        (sim::sample_points(position, points_at(t)).rowwise() - plane.origin.transpose()) * plane.normal;
    if (f.cwiseAbs().maxCoeff() <= tolerance) break;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (std::abs(f[i]) <= tolerance) {  // done: stays where it is
        a[i] = b[i] = t[i];
        fa[i] = -1;
        fb[i] = 1;
      } else if (f[i] < 0) {
        a[i] = t[i];
        fa[i] = f[i];
        if (side[i] < 0) fb[i] /= 2;
        side[i] = -1;
      } else {
        b[i] = t[i];
        fb[i] = f[i];
        if (side[i] > 0) fa[i] /= 2;
        side[i] = 1;
      }
    }
  }
  return points_at(t);
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

std::vector<ClosedCurve> cut(const sim::Coefficients& position, const CutPlane& plane, int latitudes) {
  const MeshPlan plan(latitudes, 4 * ((latitudes + 1) / 2));
  const Matrix s = net_directions(plan);
  const sim::Vector height = (sim::sample_points(position, s).rowwise() - plane.origin.transpose()) * plane.normal;
  const Net net = crossing_edges(plan, height);
  if (net.edges.empty()) return {};
  const Matrix parameters = zeros_on_edges(position, plane, net, s, height);
  const SurfacePoints found = surface_points(position, parameters);
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
