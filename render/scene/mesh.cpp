#include "render/scene/mesh.h"

#include "render/scene/surface.h"

#include "sim/sphere/basis.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

// A zero label cannot be normalised; it can only come from a damaged file, and draws as the pole.
glm::dvec3 unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : glm::dvec3(0, 0, 1);
}

// phi = 0 and pi/2 are columns 0 and longitudes/4: the tangents of a pole.
glm::dvec3 pole_normal(const sim::FirstDerivatives& x, Eigen::Index row0, Eigen::Index row90, double side) {
  return unit(side * glm::cross(to_glm(x.t.row(row0)), to_glm(x.t.row(row90))));
}

}  // namespace

MeshPlan::MeshPlan(int latitudes, int longitudes) : latitudes_(latitudes), longitudes_(longitudes) {
  if (latitudes < 4 || longitudes < 8 || longitudes % 4 != 0)
    throw std::invalid_argument("a mesh needs 4 latitudes and 8 longitudes, a multiple of 4");
  const auto rings = static_cast<std::uint32_t>(latitudes - 1), columns = static_cast<std::uint32_t>(longitudes);
  const std::uint32_t north = rings * columns, south = north + 1;
  theta_ = sim::Vector::LinSpaced(latitudes + 1, 0, std::numbers::pi);
  phi_ = sim::Vector::LinSpaced(longitudes + 1, 0, 2 * std::numbers::pi).head(longitudes);
  for (std::uint32_t j = 0; j < columns; ++j) {
    const std::uint32_t here = j * rings, next = (j + 1) % columns * rings;
    indices_.insert(indices_.end(), {north, here, next});
    for (std::uint32_t i = 0; i + 1 < rings; ++i)
      indices_.insert(indices_.end(), {here + i, here + i + 1, next + i + 1, here + i, next + i + 1, next + i});
    indices_.insert(indices_.end(), {south, next + rings - 1, here + rings - 1});
  }
  parameters_.resize(static_cast<std::size_t>(vertices()));
  for (std::uint32_t j = 0; j < columns; ++j)
    for (std::uint32_t i = 0; i < rings; ++i) {
      const double t = theta_[i + 1], f = phi_[j];
      parameters_[j * rings + i] = glm::dvec3(std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t));
    }
  parameters_[north] = {0, 0, 1};
  parameters_[south] = {0, 0, -1};
}

Mesh make_mesh(std::shared_ptr<const MeshPlan> plan, const sim::VesicleState& state, const sim::Coefficients* scalar) {
  const auto rings = static_cast<Eigen::Index>(plan->latitudes() - 1);
  const Eigen::Index columns = plan->longitudes(), rows = rings + 2;  // sampled latitudes include both poles
  const auto count = static_cast<std::size_t>(plan->vertices());
  const std::size_t north = count - 2, south = count - 1;
  Mesh mesh;
  mesh.position.resize(count);
  mesh.normal.resize(count);
  mesh.label.resize(count);

  const sim::FirstDerivatives x = sim::sample_grid(state.position, plan->theta(), plan->phi());
  const sim::FirstDerivatives s = sim::sample_grid(state.labels, plan->theta(), plan->phi());
  double area = 0;  // trapezoidal rule; W vanishes at the poles
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rings; ++i) {
      const Eigen::Index from = j * rows + i + 1;
      const auto to = static_cast<std::size_t>(j * rings + i);
      const glm::dvec3 n = glm::cross(to_glm(x.t.row(from)), to_glm(x.f.row(from)));
      area += glm::length(n);
      mesh.position[to] = to_glm(x.value.row(from));
      mesh.normal[to] = unit(n);
      mesh.label[to] = unit(to_glm(s.value.row(from)));
    }
  area *= std::numbers::pi / plan->latitudes() * 2 * std::numbers::pi / plan->longitudes();
  mesh.area_radius = std::sqrt(area / (4 * std::numbers::pi));
  const Eigen::Index quarter = columns / 4 * rows;
  mesh.position[north] = to_glm(x.value.row(0));
  mesh.position[south] = to_glm(x.value.row(rows - 1));
  mesh.normal[north] = pole_normal(x, 0, quarter, 1);
  mesh.normal[south] = pole_normal(x, rows - 1, quarter + rows - 1, -1);
  mesh.label[north] = unit(to_glm(s.value.row(0)));
  mesh.label[south] = unit(to_glm(s.value.row(rows - 1)));

  if (scalar) {
    const sim::FirstDerivatives f = sim::sample_grid(*scalar, plan->theta(), plan->phi());
    mesh.scalar.resize(count);
    for (Eigen::Index j = 0; j < columns; ++j)
      for (Eigen::Index i = 0; i < rings; ++i)
        mesh.scalar[static_cast<std::size_t>(j * rings + i)] = f.value(j * rows + i + 1, 0);
    mesh.scalar[north] = f.value(0, 0);
    mesh.scalar[south] = f.value(rows - 1, 0);
  }
  if (state.tracers.rows() > 0) {
    const SurfacePoints dots = surface_points(state.position, state.tracers);
    for (Eigen::Index k = 0; k < state.tracers.rows(); ++k)
      mesh.tracers.push_back(
          {to_glm(dots.position.row(k)), to_glm(dots.normal.row(k)), tracer_is_bright(static_cast<int>(k))});
  }
  mesh.plan = std::move(plan);
  return mesh;
}

std::vector<glm::vec2> nearest_tracers(const Mesh& mesh) {
  std::vector<glm::vec2> nearest(mesh.position.size(), glm::vec2(-1));
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    double first = std::numeric_limits<double>::infinity(), second = first;
    for (std::size_t k = 0; k < mesh.tracers.size(); ++k) {
      const Mesh::Tracer& dot = mesh.tracers[k];
      const glm::dvec3 away = mesh.position[v] - dot.position;
      const double d = glm::dot(away, away);
      if (d >= second || glm::dot(mesh.normal[v], dot.normal) < 0.2F)
        continue;  // the far side of a thin disc is near as well
      if (d < first) {
        second = first;
        first = d;
        nearest[v] = {static_cast<float>(k), nearest[v].x};
      } else {
        second = d;
        nearest[v].y = static_cast<float>(k);
      }
    }
  }
  return nearest;
}

bool tracer_is_bright(int k) {
  if (k < 6) return k % 2 == 0;  // +x -x +y -y +z -z
  // corners counted in binary, x the highest bit, 0 for +1: bright when at most one of x, y, z is negative
  const int corner = (k - 6) % 8;
  return ((corner >> 2) & 1) + ((corner >> 1) & 1) + (corner & 1) <= 1;
}

}  // namespace render
