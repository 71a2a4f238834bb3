#include "app/scene/trajectory_scene.h"

#include "app/scene/scene_file.h"

#include <fmt/format.h>

namespace app {

Settings scene_in(const sim::TrajectoryReader& trajectory, const std::filesystem::path& path,
                  const std::vector<std::string>& changes) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  Settings settings =
      parse_scene(trajectory.header().scene, path.string() + " (its scene)", folder, changes, SceneUse::draw);
  const auto wrong = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("trajectory '{}' is damaged: {}", path.string(), why));
  };
  const sim::TrajectoryLayout& layout = trajectory.layout();
  if (settings.scene.vesicles.size() != static_cast<std::size_t>(layout.vesicles))
    wrong(
        fmt::format("its scene has {} vesicles, its states have {}", settings.scene.vesicles.size(), layout.vesicles));
  for (const sim::VesicleParameters& v : settings.scene.vesicles)
    if (v.order > layout.order) wrong(fmt::format("its scene has order {}, its states have {}", v.order, layout.order));
  return settings;
}

}  // namespace app
