// Summaries of a scene or a file in a few lines, for --dry-run and `tanktread info`.
#pragma once

#include "app/scene/settings.h"

#include <filesystem>
#include <string>

namespace app {

/// Lines that begin with "# ", so that they can precede the resolved scene.
std::string scene_summary(const Settings&);
std::string trajectory_summary(const std::filesystem::path&);
/// What a run says of its errors, in one line; empty before its first step.
std::string error_summary(const std::filesystem::path&);
std::string picture_summary(const std::filesystem::path&);

}  // namespace app
