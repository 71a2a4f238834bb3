// View-dependent choice and order of triangles.
#pragma once

#include "render/scene/frame.h"

#include <cstdint>
#include <vector>

namespace render {

/// Vertex indices of all triangles of all bodies, farthest from the eye first; vertices of body k are numbered after
/// those of body k - 1. Ties are broken by index, so that the order is the same everywhere.
std::vector<std::uint32_t> back_to_front(const std::vector<Body>& bodies, const Camera& camera);

/// Vertex indices of the triangles at the rim of a body: back faces that appear less than `reach` inside the contour
/// (in half heights of the picture at its target), some farther inside, and all that are partly front and partly
/// back. Pushed outward by less than the reach, they leave no gap at the contour.
std::vector<std::uint32_t> rim_triangles(const Mesh& mesh, const Camera& camera, double reach);

/// For each vertex the distance, along the membrane as the picture shows it, from where the body turns from front to
/// back: the contour. In units of which a half height of the picture has `unit`; true where it is below `reach`,
/// beyond that at least `reach`.
std::vector<float> contour_distances(const Mesh& mesh, const Camera& camera, double unit, double reach);

}  // namespace render
