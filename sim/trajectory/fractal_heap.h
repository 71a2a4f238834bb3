// The objects of a fractal heap that the index of an HDF5 file names. Internal to the trajectory.
#pragma once

#include "sim/trajectory/file_blocks.h"

#include <string>
#include <vector>

namespace sim::file {

/// The attributes that the index at one address names in the heap at another, as messages. Unread: an index of more
/// than two levels, a heap of indirect rows, which some hundred attributes need.
std::vector<std::string> dense_attributes(Blocks&, std::uint64_t heap, std::uint64_t index);

}  // namespace sim::file
