#include "render/scene/detail.h"

#include "sim/sphere/basis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace render {
namespace {

constexpr double crowd = 20;             // vesicles
constexpr double crowd_cue = 0.65;       // share that the farthest fades
constexpr double largest_sagitta = 0.2;  // px

float rise(double from, double to, double x) { return static_cast<float>(glm::smoothstep(from, to, x)); }

}  // namespace

Detail detail_of(const ViewParameters& view, double radius) {
  if (view.detail == "full") return {};
  Detail detail;
  // Spacing of the meridians at the equator in widths of a line, as for the grid of 24.
  const double line = std::max({view.line_width * view.size[1] / 1080.0, std::min(view.line_width, 0.84), 1e-3});
  const double spacing = std::numbers::pi / 12 * radius / line;
  detail.lines = rise(4.5, 7.5, spacing);
  detail.few_lines = rise(1.8, 3.2, spacing);
  constexpr double dot = 0.088;  // radii, as the tracers are drawn
  detail.tracers = rise(1.6, 2.8, dot * radius);
  const double width = view.outline_width * view.size[1] / 1080.0;
  if (width > 0) detail.outline = static_cast<float>(std::clamp(radius / (20 * width), 0.45, 1.0));
  return detail;
}

double pixels_at(const Camera& camera, const glm::dvec3& point, int picture_height) {
  const double away = glm::distance(camera.eye, camera.target);
  const glm::dvec3 back = (camera.eye - camera.target) / away;
  const double near = camera.perspective ? away / std::max(glm::dot(camera.eye - point, back), 0.02 * away) : 1;
  return near * picture_height / (2 * camera.half_height);
}

double depth_cue_of(const ViewParameters& view, std::size_t vesicles) {
  return view.depth_cue.value_or(static_cast<double>(vesicles) >= crowd ? crowd_cue : 0.0);
}

Sketch sketch_of(const sim::VesicleState& state) {
  const sim::Vector theta = sim::Vector::LinSpaced(Sketch::latitudes + 1, 0, std::numbers::pi);
  const sim::Vector phi =
      sim::Vector::LinSpaced(Sketch::longitudes + 1, 0, 2 * std::numbers::pi).head(Sketch::longitudes);
  const sim::FirstDerivatives x = sim::sample_grid(state.position, theta, phi);
  const Eigen::Index rows = Sketch::latitudes + 1, columns = Sketch::longitudes;
  Sketch sketch;
  sketch.centre = to_glm(x.value.colwise().mean());
  std::vector<glm::dvec3> normals;
  for (Eigen::Index k = 0; k < x.value.rows(); ++k) {
    sketch.points.push_back(to_glm(x.value.row(k)));
    sketch.radius = std::max(sketch.radius, glm::distance(to_glm(x.value.row(k)), sketch.centre));
    const glm::dvec3 n = glm::cross(to_glm(x.t.row(k)), to_glm(x.f.row(k)));
    const double length = glm::length(n);
    constexpr double step = std::numbers::pi / Sketch::latitudes;  // of both angles
    sketch.areas.push_back(k % (Sketch::latitudes + 1) % Sketch::latitudes == 0 ? glm::dvec3(0) : n * (step * step));
    normals.push_back(length > 0 ? n / length : glm::dvec3(0));
  }
  const auto edge = [&](Eigen::Index a, Eigen::Index b) {
    const double chord = glm::distance(to_glm(x.value.row(a)), to_glm(x.value.row(b)));
    const double turn = glm::distance(normals[static_cast<std::size_t>(a)], normals[static_cast<std::size_t>(b)]);
    sketch.sagitta = std::max(sketch.sagitta, chord * turn / 8);
  };
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 1; i + 1 < rows; ++i) {  // without the poles, where no normal is known
      if (i + 2 < rows) edge(j * rows + i, j * rows + i + 1);
      edge(j * rows + i, (j + 1) % columns * rows + i);
      if (i + 2 < rows) edge(j * rows + i, (j + 1) % columns * rows + i + 1);  // of two triangles
    }
  sketch.radius *= 1.1;  // between the points
  return sketch;
}

std::array<glm::dvec3, 2> bounds_of(const Sketch& sketch) {
  glm::dvec3 low = sketch.points.front(), high = low;
  for (const glm::dvec3& p : sketch.points) low = glm::min(low, p), high = glm::max(high, p);
  const double beyond = 2 * sketch.sagitta;  // between the points
  return {low - beyond, high + beyond};
}

MeshLevels::MeshLevels(int finest) {
  for (const int latitudes : {10, 12, 14, 16, 18, 20, 24, 28, 32, 40, 48, 64})
    if (latitudes < finest) plans_.push_back(std::make_shared<const MeshPlan>(latitudes, 2 * latitudes));
  plans_.push_back(std::make_shared<const MeshPlan>(finest, 2 * finest));
}

std::shared_ptr<const MeshPlan> MeshLevels::choose(const Sketch& sketch, int degree, double pixels_per_length) const {
  const double needed =
      std::max(Sketch::latitudes * std::sqrt(sketch.sagitta * pixels_per_length / largest_sagitta), 1.0 * degree);
  for (const std::shared_ptr<const MeshPlan>& plan : plans_)
    if (plan->latitudes() >= needed) return plan;
  return finest();
}

bool in_picture(const Camera& camera, const Sketch& sketch) {
  constexpr double margin = 0.1;  // half heights
  const glm::dvec3 eye = glm::dmat4(camera.view) * glm::dvec4(camera.place(sketch.centre), 1);
  const double radius = sketch.radius / camera.half_height;
  const double wide = camera.half_width / camera.half_height + margin, high = 1 + margin;
  if (!camera.perspective) return std::abs(eye.x) < wide + radius && std::abs(eye.y) < high + radius;
  // The sides of the pyramid of sight: their normals turn away from it.
  const double away = glm::distance(camera.eye, camera.target) / camera.half_height;
  if (-eye.z < -radius) return false;
  const auto beyond = [&](double across, double half) {
    return (std::abs(across) * away - -eye.z * half) / std::hypot(away, half) > radius;
  };
  return !beyond(eye.x, wide) && !beyond(eye.y, high);
}

}  // namespace render
