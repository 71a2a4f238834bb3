#include "render/scene/faces.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

namespace render {

using glm::dvec3;

bool crosses(std::span<const dvec3> points, const FaceBox& box) {
  return std::any_of(points.begin(), points.end(), [&](const dvec3& p) { return !box.holds(p); });
}

namespace {

double outside(const HalfSpace& space, const dvec3& point) { return glm::dot(space.normal, point) - space.offset; }

/// The shares of the way from a to b between which it lies in all half spaces; nothing where it never does.
std::optional<std::pair<double, double>> kept_share(const dvec3& a, const dvec3& b, std::span<const HalfSpace> kept) {
  double from = 0, to = 1;
  for (const HalfSpace& space : kept) {
    const double at_a = outside(space, a), at_b = outside(space, b);
    if (at_a > 0 && at_b > 0) return {};
    if (at_a > 0) from = std::max(from, at_a / (at_a - at_b));
    if (at_b > 0) to = std::min(to, at_a / (at_a - at_b));
  }
  if (from >= to) return {};
  return std::pair{from, to};
}

}  // namespace

std::vector<SpaceLine> parts_within(const SpaceLine& line, std::span<const HalfSpace> kept) {
  const std::size_t n = line.points.size();
  const auto is_kept = [&](const dvec3& p) {
    return std::all_of(kept.begin(), kept.end(), [&](const HalfSpace& s) { return outside(s, p) <= 0; });
  };
  std::size_t first = 0;  // of a closed line a point that is cut away, if there is one
  if (line.closed) {
    while (first < n && is_kept(line.points[first])) ++first;
    if (first == n) return {line};
  }
  std::vector<SpaceLine> parts;
  SpaceLine part;
  const auto finish = [&] {
    if (part.points.size() > 1) parts.push_back(std::move(part));
    part = {};
  };
  for (std::size_t k = 0; k + (line.closed ? 0 : 1) < n; ++k) {
    const dvec3 &a = line.points[(first + k) % n], &b = line.points[(first + k + 1) % n];
    const auto share = kept_share(a, b, kept);
    if (!share) {
      finish();
      continue;
    }
    if (share->first > 0) finish();
    if (part.points.empty()) part.points.push_back(a + share->first * (b - a));
    part.points.push_back(a + share->second * (b - a));
    if (share->second < 1) finish();
  }
  finish();
  return parts;
}

std::vector<HalfSpace> half_spaces(const FaceBox& box, int without) {
  std::vector<HalfSpace> all;
  for (int face = 0; face < FaceBox::faces; ++face) {
    if (face == without) continue;
    HalfSpace space;
    const bool high = face % 2 == 1;
    space.normal[face / 2] = high ? 1 : -1;
    space.offset = high ? box.high[face / 2] : -box.low[face / 2];
    all.push_back(space);
  }
  return all;
}

namespace {

/// Closed curves where a mesh meets the plane x[axis] = place, straight within each triangle.
std::vector<SpaceLine> sections(const Mesh& mesh, int axis, double place) {
  std::vector<bool> beyond;
  beyond.reserve(mesh.position.size());
  for (const dvec3& p : mesh.position) beyond.push_back(p[axis] >= place);
  if (std::find(beyond.begin(), beyond.end(), !beyond.front()) == beyond.end()) return {};
  std::vector<dvec3> points;
  std::vector<std::array<int, 2>> neighbours;  // of each crossing of an edge: in the two triangles that share it
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> numbers;
  const auto crossing = [&](std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [found, is_new] = numbers.try_emplace({low, high}, static_cast<int>(points.size()));
    if (is_new) {
      const dvec3 &p = mesh.position[low], &q = mesh.position[high];
      dvec3 point = p + (place - p[axis]) / (q[axis] - p[axis]) * (q - p);
      point[axis] = place;
      points.push_back(point);
      neighbours.push_back({-1, -1});
    }
    return found->second;
  };
  const std::span<const std::uint32_t> indices = mesh.plan->indices();
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    std::array<int, 2> found{-1, -1};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = indices[i + k], b = indices[i + (k + 1) % 3];
      if (beyond[a] != beyond[b]) found[count++] = crossing(a, b);
    }
    if (count < 2) continue;
    for (const std::size_t side : {0U, 1U}) {
      std::array<int, 2>& own = neighbours[static_cast<std::size_t>(found[side])];
      own[own[0] < 0 ? 0 : 1] = found[1 - side];
    }
  }
  // Each crossing belongs to two triangles, so following neighbours closes every curve.
  std::vector<SpaceLine> curves;
  std::vector<bool> seen(points.size(), false);
  for (std::size_t start = 0; start < points.size(); ++start) {
    SpaceLine curve;
    curve.closed = true;
    for (int at = static_cast<int>(start); at >= 0;) {
      const auto here = static_cast<std::size_t>(at);
      if (seen[here]) break;
      seen[here] = true;
      curve.points.push_back(points[here]);
      at = -1;
      for (const int next : neighbours[here])
        if (next >= 0 && !seen[static_cast<std::size_t>(next)]) at = next;
    }
    if (curve.points.size() > 2) curves.push_back(std::move(curve));
  }
  return curves;
}

/// What closed curves in a plane enclose, by the even-odd rule, within the rectangle: strips between all heights at
/// which something begins or ends, cut at the curves. u, v: the axes in the plane.
std::vector<dvec3> filled(const std::vector<SpaceLine>& curves, const FaceBox& box, glm::length_t u, glm::length_t v,
                          double overlap) {
  struct Side {
    dvec3 low, high;  // by v
    double at(double height, glm::length_t axis) const {
      return low[axis] + (height - low[v]) / (high[v] - low[v]) * (high[axis] - low[axis]);
    }
    glm::length_t v;
  };
  std::vector<Side> sides;
  std::vector<double> heights{box.low[v], box.high[v]};
  const auto add_height = [&](double height) {
    if (height > box.low[v] && height < box.high[v]) heights.push_back(height);
  };
  for (const SpaceLine& curve : curves)
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
      const dvec3 &a = curve.points[k], &b = curve.points[(k + 1) % curve.points.size()];
      add_height(a[v]);
      if (a[v] == b[v]) continue;
      sides.push_back(a[v] < b[v] ? Side{a, b, v} : Side{b, a, v});
      for (const double edge : {box.low[u], box.high[u]})
        if ((a[u] < edge) != (b[u] < edge)) add_height(a[v] + (edge - a[u]) / (b[u] - a[u]) * (b[v] - a[v]));
    }
  std::sort(heights.begin(), heights.end());
  std::vector<dvec3> triangles;
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    const double low = heights[k], high = heights[k + 1], middle = (low + high) / 2;
    std::vector<std::pair<double, const Side*>> across;
    for (const Side& side : sides)
      if (side.low[v] <= middle && middle < side.high[v]) across.emplace_back(side.at(middle, u), &side);
    std::sort(across.begin(), across.end());
    for (std::size_t i = 0; i + 1 < across.size(); i += 2) {
      std::array<dvec3, 4> corners{};
      for (std::size_t c = 0; c < 4; ++c) {
        const Side& side = *across[i + c % 2].second;
        const double height = c < 2 ? low : high;
        corners[c] = side.low;
        corners[c][u] = std::clamp(side.at(height, u), box.low[u], box.high[u]);
        corners[c][v] = c < 2 ? low - overlap : high + overlap;
      }
      if (corners[0][u] == corners[1][u] && corners[2][u] == corners[3][u]) continue;
      for (const std::size_t c : {0U, 1U, 2U, 2U, 1U, 3U}) triangles.push_back(corners[c]);
    }
  }
  return triangles;
}

}  // namespace

FaceSection face_section(const Mesh& mesh, const FaceBox& box, int face, double overlap) {
  const glm::length_t axis = face / 2;
  const std::vector<SpaceLine> curves = sections(mesh, face / 2, face % 2 == 1 ? box.high[axis] : box.low[axis]);
  const std::vector<HalfSpace> kept = half_spaces(box, face);
  FaceSection section;
  for (const SpaceLine& curve : curves)
    for (SpaceLine& part : parts_within(curve, kept)) section.lines.push_back(std::move(part));
  section.triangles = filled(curves, box, (axis + 1) % 3, (axis + 2) % 3, overlap);
  return section;
}

bool faces_eye(const FaceBox& box, int face, const Camera& camera) {
  const int axis = face / 2;
  const double sign = face % 2 == 1 ? 1 : -1, place = face % 2 == 1 ? box.high[axis] : box.low[axis];
  const double sight = camera.perspective ? camera.eye[axis] - place : camera.eye[axis] - camera.target[axis];
  return sign * sight > 0;
}

std::vector<BoxEdge> edges_of(const FaceBox& box, const Camera& camera) {
  constexpr int parts = 24;  // each fades on its own under what lies over the picture
  std::vector<BoxEdge> edges;
  for (int along = 0; along < 3; ++along)
    for (const int b : {0, 1})
      for (const int c : {0, 1}) {
        const int second = (along + 1) % 3, third = (along + 2) % 3;
        BoxEdge& edge = edges.emplace_back();
        edge.in_front = faces_eye(box, 2 * second + b, camera) || faces_eye(box, 2 * third + c, camera);
        for (int k = 0; k <= parts; ++k) {
          dvec3 point = box.low;
          point[along] += (box.high[along] - box.low[along]) * k / parts;
          if (b == 1) point[second] = box.high[second];
          if (c == 1) point[third] = box.high[third];
          edge.line.points.push_back(point);
        }
      }
  return edges;
}

}  // namespace render
