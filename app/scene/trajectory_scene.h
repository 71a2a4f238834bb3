// The scene stored in a trajectory.
#pragma once

#include "app/scene/settings.h"

#include "sim/trajectory/trajectory.h"

#include <filesystem>

namespace app {

/// With `--set` changes to its pictures applied. Throws std::runtime_error when it is not a scene, or does not match
/// the states.
Settings scene_in(const sim::TrajectoryReader&, const std::filesystem::path&,
                  const std::vector<std::string>& changes = {});

}  // namespace app
