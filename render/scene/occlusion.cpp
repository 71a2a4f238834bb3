#include "render/scene/occlusion.h"

#include "render/core/paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace render {
namespace {

// Of a sketch, poles included.
constexpr int net_rings = Sketch::latitudes + 1, net_columns = Sketch::longitudes;
constexpr double large = 80;  // px: from here on all discs count

std::size_t index_of(int i, int j) {
  return static_cast<std::size_t>((j + net_columns) % net_columns) * net_rings + static_cast<std::size_t>(i);
}

// The share of a disc of this area that is in the box, smoothly from 0 to 1 while it comes in.
double share_inside(const std::optional<FaceBox>& faces, const glm::dvec3& place, double size) {
  if (!faces) return 1;
  const glm::dvec3 deep = glm::min(place - faces->low, faces->high - place);
  const double radius = std::sqrt(size / std::numbers::pi);
  return glm::smoothstep(-radius, radius, std::min({deep.x, deep.y, deep.z}));
}

void add(Discs& discs, const glm::dvec3& place, const glm::dvec3& area, const std::optional<FaceBox>& faces) {
  const double whole = glm::length(area), size = whole * share_inside(faces, place, whole);
  if (!(size > 0)) return;
  discs.places.push_back(place);
  discs.normals.push_back(area / whole);
  discs.areas.push_back(size);
}

// Shares that the discs hide: of the sky, weighted by the cosine, and of a wide
// lobe round the key light.
glm::dvec2 hidden_by(const Discs& discs, const glm::dvec3& place, const glm::dvec3& normal, const glm::dvec3& key) {
  constexpr double pi = std::numbers::pi;
  double sky = 0, sun = 0;
  for (std::size_t k = 0; k < discs.places.size(); ++k) {
    const glm::dvec3 to = discs.places[k] - place;
    const double up = glm::dot(to, normal), facing = -glm::dot(to, discs.normals[k]);
    if (!(up > 0) || !(facing > 0)) continue;
    const double r2 = glm::dot(to, to), spread = discs.areas[k] / (pi * r2 + discs.areas[k]);
    sky += up * facing / r2 * spread;
    const double along = glm::dot(to, key);
    if (!(along > 0)) continue;
    const double c2 = along * along / r2;
    sun += 2.5 * c2 * c2 * facing / std::sqrt(r2) * spread;  // the lobe cos^4 has the integral 2 pi / 5
  }
  return {std::min(sky, 1.0), std::min(sun, 1.0)};
}

// A cubic through four values in a row, between the second and the third.
glm::dvec2 cubic(const std::array<glm::dvec2, 4>& v, double t) {
  return v[1] + 0.5 * t *
                    (v[2] - v[0] +
                     t * (2.0 * v[0] - 5.0 * v[1] + 4.0 * v[2] - v[3] + t * (3.0 * (v[1] - v[2]) + v[3] - v[0])));
}

// A net of values over the sphere, `stride` of the sketch's points apart;
// beyond a pole it goes on at the other side.
struct Values {
  int stride;
  std::vector<glm::dvec2> at;  // as Sketch::points
  const glm::dvec2& operator()(int i, int j) const {
    if (i < 0) i = -i, j += net_columns / 2;
    if (i > net_rings - 1) i = 2 * (net_rings - 1) - i, j += net_columns / 2;
    return at[index_of(i, j % net_columns)];
  }
  glm::dvec2 between(double row, double column) const {
    const int i = static_cast<int>(std::floor(row / stride)), j = static_cast<int>(std::floor(column / stride));
    std::array<glm::dvec2, 4> along{};
    for (int b = 0; b < 4; ++b) {
      std::array<glm::dvec2, 4> across{};
      for (int a = 0; a < 4; ++a)
        across[static_cast<std::size_t>(a)] = (*this)((i + a - 1) * stride, (j + b - 1) * stride + net_columns);
      along[static_cast<std::size_t>(b)] = cubic(across, row / stride - i);
    }
    return cubic(along, column / stride - j);
  }
};

}  // namespace

Occluder occluder_of(const Sketch& sketch, const std::optional<FaceBox>& faces) {
  Occluder occluder;
  for (int j = 0; j < net_columns; ++j)
    for (int i = 1; i < net_rings - 1; ++i)
      add(occluder.fine, sketch.points[index_of(i, j)], sketch.areas[index_of(i, j)], faces);
  for (int j = 0; j < net_columns; j += 2)
    for (int i = 0; i < net_rings - 1; i += 2) {
      glm::dvec3 place(0), area(0);
      double sum = 0;
      for (const std::size_t k : {index_of(i, j), index_of(i + 1, j), index_of(i, j + 1), index_of(i + 1, j + 1)}) {
        const double size = glm::length(sketch.areas[k]);
        place += size * sketch.points[k];
        area += sketch.areas[k];
        sum += size;
      }
      if (sum > 0) add(occluder.coarse, place / sum, area, faces);
    }
  return occluder;
}

void shade(Mesh& mesh, std::size_t self, std::span<const Sketch> sketches, std::span<const Occluder> occluders,
           const Camera& camera, double radius) {
  const Sketch& own = sketches[self];
  const bool fine = radius > large;
  const glm::dvec3 key = glm::transpose(glm::dmat3(camera.view)) * glm::normalize(key_light);
  struct Neighbour {
    const Discs* discs;
    double share;  // 1, smoothly to 0 where it is so far off that it does not
                   // matter
  };
  std::vector<Neighbour> neighbours;
  for (std::size_t k = 0; k < sketches.size(); ++k) {
    if (k == self) continue;
    const double reach = own.radius + sketches[k].radius, away = glm::distance(own.centre, sketches[k].centre);
    const double share = 1 - glm::smoothstep(1.3 * reach, 2.2 * reach, away);
    if (share > 0) neighbours.push_back({fine ? &occluders[k].fine : &occluders[k].coarse, share});
  }
  Values values{fine ? 1 : 2, std::vector<glm::dvec2>(own.points.size(), glm::dvec2(1))};
  for (int j = 0; j < net_columns; j += values.stride)
    for (int i = 0; i < net_rings; i += values.stride) {
      const bool pole = i == 0 || i == net_rings - 1;
      if (pole && j > 0) {
        values.at[index_of(i, j)] = values.at[index_of(i, 0)];
        continue;
      }
      glm::dvec3 area = own.areas[index_of(i, j)];
      if (pole)
        for (int around = 0; around < net_columns; ++around)
          area += own.areas[index_of(i == 0 ? 1 : net_rings - 2, around)];
      const glm::dvec3 normal = area / std::max(glm::length(area), 1e-300), place = own.points[index_of(i, j)];
      glm::dvec2 open = 1.0 - hidden_by(fine ? occluders[self].fine : occluders[self].coarse, place, normal, key);
      for (const Neighbour& n : neighbours) open *= 1.0 - n.share * hidden_by(*n.discs, place, normal, key);
      values.at[index_of(i, j)] = open;
    }
  const MeshPlan& plan = *mesh.plan;
  const int rings = plan.latitudes() - 1;
  mesh.light.clear();
  mesh.light.reserve(mesh.position.size());
  const auto put = [&](double row, double column) {
    mesh.light.emplace_back(glm::clamp(values.between(row, column), 0.0, 1.0));
  };
  for (int j = 0; j < plan.longitudes(); ++j)
    for (int i = 0; i < rings; ++i)
      put(static_cast<double>(i + 1) * (net_rings - 1) / plan.latitudes(),
          static_cast<double>(j) * net_columns / plan.longitudes());
  put(0, 0);
  put(net_rings - 1, 0);
}

}  // namespace render
