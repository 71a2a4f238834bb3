// The box that a picture shows of a periodic suspension: membranes end at its faces, where their sections are drawn as
// lines. What leaves by one face comes in by the opposite one.
#pragma once

#include "render/scene/camera.h"
#include "render/scene/mesh.h"

#include <span>
#include <vector>

namespace render {

/// Sides along the axes of the scene. Faces are numbered 2 * axis + (0: the low end, 1: the high end).
struct FaceBox {
  static constexpr int faces = 6;
  glm::dvec3 low{0}, high{0};
  bool holds(const glm::dvec3& point) const {
    return glm::all(glm::lessThanEqual(low, point)) && glm::all(glm::lessThanEqual(point, high));
  }
};

/// Is one of these points outside?
bool crosses(std::span<const glm::dvec3> points, const FaceBox& box);

/// The half space of all x with dot(normal, x) <= offset.
struct HalfSpace {
  glm::dvec3 normal{0};
  double offset = 0;
};

/// A line through points; of a closed one the first point is not repeated.
struct SpaceLine {
  std::vector<glm::dvec3> points;
  bool closed = false;
};
/// The parts of a line that lie in all of these half spaces.
std::vector<SpaceLine> parts_within(const SpaceLine& line, std::span<const HalfSpace> kept);
/// The half spaces that make the box, but for that of one face; -1: all.
std::vector<HalfSpace> half_spaces(const FaceBox& box, int without = -1);

/// Where a mesh meets a face.
struct FaceSection {
  std::vector<SpaceLine> lines;       ///< the membrane
  std::vector<glm::dvec3> triangles;  ///< what it encloses within the box, three points each
};
/// overlap: by which triangles reach into their neighbours, so that no sample falls between them.
FaceSection face_section(const Mesh& mesh, const FaceBox& box, int face, double overlap = 0);

/// Does this face turn to the eye: is it in front of all that is in the box, or behind it?
bool faces_eye(const FaceBox& box, int face, const Camera& camera);

struct BoxEdge {
  SpaceLine line;
  bool in_front;  ///< of all that is in the box
};
/// The twelve edges, in short pieces.
std::vector<BoxEdge> edges_of(const FaceBox& box, const Camera& camera);

}  // namespace render
