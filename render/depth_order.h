// Which triangles are drawn, and in what order, as far as the eye decides it.
#pragma once

#include "scene.h"

#include <cstdint>
#include <vector>

namespace render {

/// Vertex indices of all triangles of all bodies, farthest from the eye first; vertices of body k are counted on from
/// those of body k - 1. Ties are broken by index, so that the order is the same everywhere.
std::vector<std::uint32_t> back_to_front(const std::vector<Body>& bodies, const Camera& camera);

/// Vertex indices of the triangles at the rim of a body: back faces whose normal is nearly square to the line of sight, and
/// all that have a front and a back. An outline comes from these alone.
std::vector<std::uint32_t> rim_triangles(const Mesh& mesh, const Camera& camera);

}  // namespace render
