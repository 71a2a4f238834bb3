#include "render/scene/hidden.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace render {
namespace {

constexpr float nothing = -1;  // no depth: all are positive

struct Corner {
  glm::dvec2 place;  // cells
  double depth;      // distance from the eye along the line of sight
};

// The part of the cover of cells round one body, and the depth of its front where it covers the middle of a cell.
struct Patch {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<float> depth;
  float& at(int x, int y) {
    return depth[static_cast<std::size_t>(y - top) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x - left)];
  }
};

struct Cover {
  int width, height;
  double cell;               // px
  std::vector<float> front;  // farthest point of the nearest that covers the cell
  float& at(int x, int y) {
    return front[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

void cover(Patch& patch, const Corner& a, const Corner& b, const Corner& c) {
  const auto twice_area = [](const glm::dvec2& p, const glm::dvec2& q, const glm::dvec2& r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  };
  if (!(twice_area(a.place, b.place, c.place) > 0)) return;  // seen from inside
  const auto low = [](double x, double y, double z) { return static_cast<int>(std::floor(std::min({x, y, z}))); };
  const auto high = [](double x, double y, double z) { return static_cast<int>(std::ceil(std::max({x, y, z}))); };
  const int x0 = std::max(low(a.place.x, b.place.x, c.place.x), patch.left),
            x1 = std::min(high(a.place.x, b.place.x, c.place.x), patch.left + patch.width - 1),
            y0 = std::max(low(a.place.y, b.place.y, c.place.y), patch.top),
            y1 = std::min(high(a.place.y, b.place.y, c.place.y), patch.top + patch.height - 1);
  const auto depth = static_cast<float>(std::max({a.depth, b.depth, c.depth}));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const glm::dvec2 middle(x + 0.5, y + 0.5);
      if (twice_area(a.place, b.place, middle) < 0 || twice_area(b.place, c.place, middle) < 0 ||
          twice_area(c.place, a.place, middle) < 0)
        continue;
      float& there = patch.at(x, y);
      there = there == nothing ? depth : std::min(there, depth);  // of several layers the front one
    }
}

// Corners counter-clockwise on the picture, y upward, where the body is seen from outside.
Patch patch_of(const std::vector<Corner>& corners, int margin) {
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Corner& c : corners) low = glm::min(low, c.place), high = glm::max(high, c.place);
  Patch patch;
  patch.left = static_cast<int>(std::floor(low.x)) - margin;
  patch.top = static_cast<int>(std::floor(low.y)) - margin;
  patch.width = static_cast<int>(std::ceil(high.x)) + margin - patch.left + 1;
  patch.height = static_cast<int>(std::ceil(high.y)) + margin - patch.top + 1;
  patch.depth.assign(static_cast<std::size_t>(patch.width) * static_cast<std::size_t>(patch.height), nothing);
  constexpr std::size_t rows = Sketch::latitudes + 1, columns = Sketch::longitudes;
  for (std::size_t j = 0; j < columns; ++j)
    for (std::size_t i = 0; i + 1 < rows; ++i) {
      const std::size_t here = j * rows + i, next = (j + 1) % columns * rows + i;
      cover(patch, corners[here], corners[here + 1], corners[next + 1]);
      cover(patch, corners[here], corners[next + 1], corners[next]);
    }
  return patch;
}

// Is every cell within `margin` of the body covered by something nearer?
bool is_behind(Cover& cover, Patch& patch, int margin, double nearest) {
  for (int y = patch.top + margin; y < patch.top + patch.height - margin; ++y)
    for (int x = patch.left + margin; x < patch.left + patch.width - margin; ++x) {
      if (patch.at(x, y) == nothing) continue;
      for (int v = y - margin; v <= y + margin; ++v)
        for (int u = x - margin; u <= x + margin; ++u)
          if (cover.inside(u, v) && !(static_cast<double>(cover.at(u, v)) < nearest)) return false;
    }
  return true;
}

// Cells that the body covers with all within `reach` of them.
void add(Cover& cover, Patch& patch, int reach) {
  for (int y = patch.top + reach; y + reach < patch.top + patch.height; ++y)
    for (int x = patch.left + reach; x + reach < patch.left + patch.width; ++x) {
      if (!cover.inside(x, y) || patch.at(x, y) == nothing) continue;
      float farthest = nothing;
      bool whole = true;
      for (int v = y - reach; v <= y + reach && whole; ++v)
        for (int u = x - reach; u <= x + reach; ++u) {
          whole = whole && patch.at(u, v) != nothing;
          farthest = std::max(farthest, patch.at(u, v));
        }
      if (whole) cover.at(x, y) = std::min(cover.at(x, y), farthest);
    }
}

}  // namespace

std::vector<bool> hidden(std::span<const Sketch> sketches, const Camera& camera, const ViewParameters& view,
                         const std::optional<FaceBox>& faces) {
  constexpr double cells_high = 720;
  const int width = view.size[0], height = view.size[1];
  const double cell = std::max(1.0, height / cells_high);
  Cover cover{static_cast<int>(std::ceil(width / cell)), static_cast<int>(std::ceil(height / cell)), cell, {}};
  cover.front.assign(static_cast<std::size_t>(cover.width) * static_cast<std::size_t>(cover.height),
                     std::numeric_limits<float>::infinity());
  const glm::dvec3 back = glm::normalize(camera.eye - camera.target);
  const auto depth_of = [&](const glm::dvec3& p) { return glm::dot(camera.eye - p, back) / camera.half_height; };
  std::vector<std::pair<double, std::size_t>> order;  // by the nearest point
  for (std::size_t k = 0; k < sketches.size(); ++k) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& p : sketches[k].points) nearest = std::min(nearest, depth_of(p));
    order.emplace_back(nearest - sketches[k].sagitta / camera.half_height, k);
  }
  std::sort(order.begin(), order.end());
  std::vector<bool> result(sketches.size(), false);
  std::vector<Corner> corners;
  for (const auto& [nearest, k] : order) {
    const Sketch& sketch = sketches[k];
    if (!(nearest > 0)) continue;  // beside the eye
    corners.clear();
    for (const glm::dvec3& p : sketch.points) {
      const glm::dvec2 place = (camera.picture_place(p) + 1.0) / 2.0 * glm::dvec2(width, height) / cell;
      corners.push_back({place, depth_of(p)});
    }
    const double pixels = pixels_at(camera, sketch.centre, height), error = sketch.sagitta * pixels;
    constexpr double coarse = 6;      // px
    if (!(error < coarse)) continue;  // so large that the sketch says too little: neither hidden nor in the way
    const double least = std::min(1.0, view.outline_width);  // px, as outlines are drawn
    const double outline =
        detail_of(view, sketch.radius * pixels).outline * std::max(view.outline_width * height / 1080.0, least);
    const int margin = static_cast<int>(std::ceil((outline + error) / cell + 0.5));
    const int inside = static_cast<int>(std::ceil(std::max(error / cell, 1.0)));
    Patch patch = patch_of(corners, std::max(margin, inside));
    result[k] = is_behind(cover, patch, margin, nearest);
    if (faces && crosses(bounds_of(sketch), *faces)) continue;
    if (!result[k]) add(cover, patch, inside);
  }
  return result;
}

}  // namespace render
