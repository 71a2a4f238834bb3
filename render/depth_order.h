// The order in which see-through membranes are drawn.
#pragma once

#include "scene.h"

#include <cstdint>
#include <vector>

namespace render {

/// Vertex indices of all triangles of all bodies, farthest from the eye first; vertices of body k are counted on from
/// those of body k - 1. Ties are broken by index, so that the order is the same everywhere.
std::vector<std::uint32_t> back_to_front(const std::vector<Body>& bodies, const Camera& camera);

}  // namespace render
