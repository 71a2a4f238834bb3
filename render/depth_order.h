// Which triangles are drawn, and in what order, as far as the eye decides it.
#pragma once

#include "scene.h"

#include <cstdint>
#include <vector>

namespace render {

/// Vertex indices of all triangles of all bodies, farthest from the eye first; vertices of body k are counted on from
/// those of body k - 1. Ties are broken by index, so that the order is the same everywhere.
std::vector<std::uint32_t> back_to_front(const std::vector<Body>& bodies, const Camera& camera);

/// Vertex indices of the triangles at the rim of a body: back faces that the picture shows less than `reach` inside of the
/// contour (in half heights of the picture at its target), some that lie deeper, and all that have a front and a back. Pushed
/// outward by less than the reach, they leave no gap at the contour.
std::vector<std::uint32_t> rim_triangles(const Mesh& mesh, const Camera& camera, double reach);

}  // namespace render
