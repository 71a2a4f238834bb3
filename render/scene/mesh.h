// A vesicle as triangles: positions, analytic normals and material labels on one shared grid of latitudes and
// longitudes.
#pragma once

#include "render/core/vectors.h"

#include "sim/core/types.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace render {

/// Plan: theta_i = i pi / latitudes, i = 1..latitudes-1, times `longitudes` columns, and one vertex on each pole.
/// Columns wrap by index, so the surface is watertight and has no seam. Immutable, safe to share between threads.
class MeshPlan {
 public:
  explicit MeshPlan(int latitudes = 96, int longitudes = 192);

  int vertices() const { return (latitudes_ - 1) * longitudes_ + 2; }
  /// Three vertices per triangle, counter-clockwise seen from outside.
  std::span<const std::uint32_t> indices() const { return indices_; }
  /// Vertices: first the grid, latitude varying fastest, then the poles theta = 0 and theta = pi.
  const sim::Vector& theta() const { return theta_; }  ///< with both poles: latitudes + 1
  const sim::Vector& phi() const { return phi_; }
  /// The parameter s of every vertex, a unit vector.
  const std::vector<glm::vec3>& parameters() const { return parameters_; }
  int latitudes() const { return latitudes_; }
  int longitudes() const { return longitudes_; }

 private:
  int latitudes_, longitudes_;
  sim::Vector theta_, phi_;
  std::vector<std::uint32_t> indices_;
  std::vector<glm::vec3> parameters_;
};

/// One element per vertex in every array; scalar may be empty.
struct Mesh {
  std::shared_ptr<const MeshPlan> plan;
  std::vector<glm::dvec3> position;  ///< in the scene
  std::vector<glm::vec3> normal;     ///< outward unit vectors
  std::vector<glm::vec3> label;      ///< material label, unit vectors
  std::vector<double> scalar;        ///< for fields
  std::vector<glm::vec2> light;      ///< shares of sky and key light that reach a vertex; empty: all
  double area_radius = 0;            ///< of the sphere of the same area
  struct Tracer {
    glm::dvec3 position;
    glm::vec3 normal;
    bool bright;  ///< x + y + z of its initial direction > 0
  };
  std::vector<Tracer> tracers;
};

/// Samples position, normal and label; tracers at their parameters. `scalar` (1 field) is optional.
Mesh make_mesh(std::shared_ptr<const MeshPlan> plan, const sim::VesicleState& state,
               const sim::Coefficients* scalar = nullptr);

/// For each vertex the indices of the two nearest tracers on its side of the membrane, -1 where there is none.
std::vector<glm::vec2> nearest_tracers(const Mesh& mesh);

/// Initial direction of tracer k: the axes +x -x +y -y +z -z, then the corners of the cube; only the sign of
/// x + y + z is used here.
bool tracer_is_bright(int k);

}  // namespace render
