// Ambient occlusion and soft shadows: how much of the sky, and of the light from the key's direction, other parts of
// the membrane and other vesicles hide from a point. Every vesicle stands for a set of small discs; of the sky a disc
// of area A hides A cos(p) cos(q) / (pi r^2 + A), the cosines those between the line to it and both normals. Double
// precision with the four operations and roots only: the same on every machine.
#pragma once

#include "render/scene/detail.h"
#include "render/scene/faces.h"

namespace render {

/// The discs of a vesicle, in place of Sketch::points and areas.
struct Discs {
  std::vector<glm::dvec3> places, normals;  ///< normals are unit vectors
  std::vector<double> areas;
};
struct Occluder {
  Discs fine, coarse;  ///< 11 x 24, and a quarter of that
};
/// What the faces cut off hides no light.
Occluder occluder_of(const Sketch& sketch, const std::optional<FaceBox>& faces = {});

/// Sets mesh.light of vesicle `self`. radius: of the vesicle in px; small ones get by with coarse discs.
void shade(Mesh& mesh, std::size_t self, std::span<const Sketch> sketches, std::span<const Occluder> occluders,
           const Camera& camera, double radius);

}  // namespace render
