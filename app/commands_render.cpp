// Commands that draw what has been simulated: render, figure.
#include "commands.h"
#include "figures.h"
#include "frames.h"
#include "interrupt.h"
#include "scene_file.h"
#include "scene_text.h"

#include <fmt/format.h>

namespace app {

namespace fs = std::filesystem;

namespace {

/// The scene of a trajectory with changes to its pictures; changes to its physics are refused.
Settings scene_of(const sim::TrajectoryReader& trajectory, const fs::path& path, const std::vector<std::string>& changes) {
  if (trajectory.count() == 0) throw std::runtime_error(fmt::format("trajectory '{}' has no state", path.string()));
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const std::string name = path.string() + " (its scene)";
  const std::string& text = trajectory.header().scene;
  const Settings simulated = parse_scene(text, name, folder, {}, SceneUse::draw);
  Settings changed = parse_scene(text, name, folder, changes, SceneUse::draw);
  if (physics_hash(changed.scene) != physics_hash(simulated.scene))
    throw std::runtime_error(fmt::format("'{}' has been simulated already: --set can change its view, movie and figures "
                                         "only", path.string()));
  return changed;
}

}  // namespace

int render(const Options& options) {
  const fs::path& path = options.inputs.front();
  const sim::TrajectoryReader trajectory(path);
  const Settings settings = scene_of(trajectory, path, options.set);
  const fs::path folder = !options.output.empty() ? options.output : path.has_parent_path() ? path.parent_path() : ".";
  const FrameReport report = render_frames(trajectory, settings, folder, options, true);
  if (report.interrupted) {
    fmt::print(stderr, "tanktread: interrupted; the same command continues\n");
    return interrupted_status;
  }
  if (!options.quiet) {
    fmt::print("{}: {} frames drawn, {} kept\n", (folder / "frames").string(), report.drawn, report.kept);
    if (report.movie) fmt::print("{}\n", (folder / "movie.mp4").string());
  }
  if (!report.remark.empty()) fmt::print(stderr, "tanktread: {}\n", report.remark);
  return report.movie_failed ? 1 : 0;
}

int figure(const Options& options) {
  std::vector<std::string> changes = options.set;
  changes.push_back("figure.kind=" + options.word);
  std::vector<sim::TrajectoryReader> trajectories;
  std::vector<Settings> settings;
  for (const fs::path& path : options.inputs) {
    trajectories.emplace_back(path);
    settings.push_back(scene_of(trajectories.back(), path, changes));
  }
  const auto folder_of = [](const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); };
  fs::path stem = options.output.empty() ? folder_of(options.inputs.front()) / options.word : options.output;
  for (const char* extension : {".png", ".svg", ".pdf", ".csv"})
    if (stem.extension() == extension) stem.replace_extension();
  std::error_code error;
  fs::create_directories(folder_of(stem), error);

  // Curves of several trajectories share a figure; pictures of states get one each.
  std::vector<std::vector<FigureSource>> sets;
  for (std::size_t k = 0; k < trajectories.size(); ++k) {
    const std::string name = trajectories.size() > 1 ? settings[k].scene.title : std::string();
    if (sets.empty() || options.word != "time-series") sets.emplace_back();
    sets.back().push_back({trajectories[k], settings[k], name});
  }
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const fs::path file = sets.size() == 1 ? stem : fs::path(fmt::format("{}-{}", stem.string(), k));
    for (const fs::path& written : draw_figure(sets[k], sets[k].front().settings.figures.front(), file))
      if (!options.quiet) fmt::print("{}\n", written.string());
  }
  return 0;
}

}  // namespace app
