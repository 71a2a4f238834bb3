// The scene that a trajectory carries with it.
#pragma once

#include "settings.h"

#include "sim/trajectory.h"

#include <filesystem>

namespace app {

/// With changes that `--set` makes to its pictures. Throws std::runtime_error when it is none, or not that of the states.
Settings scene_in(const sim::TrajectoryReader&, const std::filesystem::path&, const std::vector<std::string>& changes = {});

}  // namespace app
