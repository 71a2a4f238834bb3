// Level of detail: how finely a vesicle is sampled and painted, by the size at which the picture shows it. Sizes change
// continuously, and so does everything seen: weights and widths are smooth in the size, and meshes are so fine that one
// looks like the next.
#pragma once

#include "render/scene/camera.h"
#include "render/scene/mesh.h"

#include <array>
#include <optional>

namespace render {

/// Weights, 0 to 1, of what is painted on a vesicle.
struct Detail {
  float lines = 1;      ///< all lines of the grid
  float few_lines = 0;  ///< in their place: the equator and four meridians
  float tracers = 1;
  float outline = 1;  ///< of the width of the contour
};
/// radius: of the sphere of the same area, px of the finished picture.
Detail detail_of(const ViewParameters& view, double radius);

/// Pixels of the finished picture that a length of 1 at this point takes.
double pixels_at(const Camera& camera, const glm::dvec3& point, int picture_height);

/// Share by which the farthest fades into the ground: view.depth_cue, or a value for this number of vesicles.
double depth_cue_of(const ViewParameters& view, std::size_t vesicles);

/// What is known of a vesicle before it is sampled finely: a mesh of 12 x 24, poles included, latitude varying fastest.
struct Sketch {
  static constexpr int latitudes = 12, longitudes = 24;
  std::vector<glm::dvec3> points;
  std::vector<glm::dvec3> areas;  ///< outward normals times the area that a point stands for; none for poles
  glm::dvec3 centre{0};           ///< mean of a coarse mesh
  double radius = 0;              ///< the ball about it holds the vesicle
  double sagitta = 0;             ///< largest of an edge
};
Sketch sketch_of(const sim::VesicleState& state);
/// Opposite corners of a box along the axes that holds the vesicle.
std::array<glm::dvec3, 2> bounds_of(const Sketch& sketch);

/// The meshes to choose from, each built once.
class MeshLevels {
 public:
  explicit MeshLevels(int finest = 96);
  /// The coarsest whose edges leave the outline by some 0.2 px at most, and that resolves the surface's degree.
  std::shared_ptr<const MeshPlan> choose(const Sketch& sketch, int degree, double pixels_per_length) const;
  std::shared_ptr<const MeshPlan> finest() const { return plans_.back(); }

 private:
  std::vector<std::shared_ptr<const MeshPlan>> plans_;  ///< the coarsest first
};

/// Is some of the ball inside the picture, or so close to its edge that an outline or an arrow might be?
bool in_picture(const Camera& camera, const Sketch& sketch);

}  // namespace render
