// Commands that draw what has been simulated: render, figure.
#include "app/base/folder_lock.h"
#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/base/owned_files.h"
#include "app/base/printable.h"
#include "app/base/result_files.h"
#include "app/commands/commands.h"
#include "app/figures/figures.h"
#include "app/figures/movie_plots.h"
#include "app/pictures/frames.h"
#include "app/pictures/pictures.h"
#include "app/pictures/workers.h"
#include "app/scene/output.h"
#include "app/scene/scene_text.h"
#include "app/scene/trajectory_scene.h"
#include "app/tables/movie_formats.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace fs = std::filesystem;

namespace {

/// The scene of a trajectory with changes to its pictures; changes to its physics are refused.
Settings scene_of(const sim::TrajectoryReader& trajectory, const fs::path& path,
                  const std::vector<std::string>& changes) {
  if (trajectory.count() == 0) throw std::runtime_error(fmt::format("trajectory '{}' has no state", path.string()));
  const Settings simulated = scene_in(trajectory, path);
  Settings changed = scene_in(trajectory, path, changes);
  if (physics_hash(changed.scene) != physics_hash(simulated.scene))
    throw std::runtime_error(
        fmt::format("'{}' has been simulated already: --set can change its view, movie and figures "
                    "only",
                    path.string()));
  return changed;
}

/// With names that tell several apart.
std::vector<FigureSource> figure_sources(const std::vector<sim::TrajectoryReader>& trajectories,
                                         const std::vector<Settings>& settings, const std::vector<fs::path>& paths) {
  std::vector<sim::Scene> scenes;
  std::vector<std::string> names;
  for (const fs::path& path : paths) names.push_back(path.string());
  for (const Settings& one : settings) scenes.push_back(one.scene);
  if (scenes.size() > 1) names = distinct_names(scenes, names);
  std::vector<FigureSource> sources;
  for (std::size_t k = 0; k < trajectories.size(); ++k)
    sources.push_back({trajectories[k], settings[k], trajectories.size() > 1 ? printable(names[k]) : std::string(),
                       paths[k].string()});
  return sources;
}

}  // namespace

int render(const Options& options) {
  std::vector<sim::TrajectoryReader> trajectories;
  std::vector<Settings> settings;
  for (const fs::path& path : options.inputs) {
    trajectories.emplace_back(path);
    settings.push_back(scene_of(trajectories.back(), path, options.set));
  }
  std::vector<PictureSource> sources;
  for (std::size_t k = 0; k < trajectories.size(); ++k) sources.push_back({trajectories[k], settings[k]});
  const std::vector<FigureSource> curves = figure_sources(trajectories, settings, options.inputs);
  const fs::path& path = options.inputs.front();
  const fs::path here = path.has_parent_path() ? path.parent_path() : ".";

  if (options.time) {
    fs::path still = options.output.empty() ? here / "still.png" : options.output;
    if (fs::is_directory(still)) still /= "still.png";
    ResultFiles files(options.inputs, options.force);
    files.require(still);
    limit_drawing_threads(options.jobs);
    render_still(sources, *options.time, still, files, options, movie_plots(curves));
    files.settle();
    if (!options.quiet) fmt::print("{}\n", printable(still.string()));
    return 0;
  }
  // One that this command asks for; a run that ended before its own poster can still be drawn.
  if (const auto poster = settings.front().movie.poster;
      poster && poster != scene_in(trajectories.front(), path).movie.poster) {
    double end = 0;
    for (const sim::TrajectoryReader& trajectory : trajectories)
      end = std::max(end, trajectory.time(trajectory.count() - 1));
    try {
      require_time(*poster, end);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("movie.poster: {}", error.what()));
    }
  }
  const fs::path folder = options.output.empty() ? here : options.output;
  const auto stopped = [&] {
    const bool told_by_parent = options.shards > 1 && options.quiet;
    if (!told_by_parent) tell("interrupted; the same command continues");
    return interrupted_status;
  };
  {
    OwnedFiles there(folder);
    adopt_movie(there, movie_name(find_movie_format(settings.front().movie.format)));
    require_pictures(there, settings.front());
  }
  std::int64_t by_processes = 0;
  if (options.jobs > 1 && options.shards == 1) {
    check_movie(find_movie_format(settings.front().movie.format), settings.front().view.size[0],
                settings.front().view.size[1]);
    const std::optional<std::int64_t> drawn = draw_in_processes(options, folder);
    if (!drawn) return stopped();
    by_processes = *drawn;
  }
  const FolderLock lock(folder, options.shard, options.shards);
  OwnedFiles files(folder);
  limit_drawing_threads(options.jobs);
  const FrameReport report = render_frames(sources, files, options, movie_plots(curves));
  if (report.interrupted) return stopped();
  if (!options.quiet) {
    fmt::print("{}: {} frames drawn, {} kept\n", printable((folder / "frames").string()), report.drawn + by_processes,
               report.kept - by_processes);
    for (const fs::path& file : {report.movie, report.poster})
      if (!file.empty()) fmt::print("{}\n", printable(file.string()));
  }
  if (!report.poster_remark.empty()) tell(report.poster_remark);
  if (!report.remark.empty()) tell(report.remark);
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
  const auto folder_of = [](const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
  };
  fs::path stem = options.output.empty() ? folder_of(options.inputs.front()) / options.word : options.output;
  for (const char* extension : render::figure_extensions)
    if (stem.extension() == extension) stem.replace_extension();
  std::error_code error;
  fs::create_directories(folder_of(stem), error);

  // Curves of several trajectories share a figure; pictures of states get one each.
  std::optional<render::Legend> legend;
  if (render::find_figure(options.word).needs == render::FigureNeeds::stills) {
    std::vector<PictureSource> pictures;
    for (std::size_t k = 0; k < trajectories.size(); ++k) pictures.push_back({trajectories[k], settings[k]});
    legend = shared_legend(pictures);
  }
  std::vector<std::vector<FigureSource>> sets;
  for (FigureSource& source : figure_sources(trajectories, settings, options.inputs)) {
    source.legend = legend;
    if (sets.empty() || !takes_several(options.word)) sets.emplace_back();
    sets.back().push_back(std::move(source));
  }
  ResultFiles files(options.inputs, options.force);
  std::vector<fs::path> stems;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    stems.push_back(sets.size() == 1 ? stem : fs::path(fmt::format("{}-{}", stem.string(), k)));
    for (const char* extension : render::figure_extensions) files.require(stems.back().string() + extension);
  }
  for (std::size_t k = 0; k < sets.size(); ++k)
    for (const fs::path& written :
         draw_figure(sets[k], sets[k].front().settings.figures.front(), stems[k], files.writer(), options))
      if (!options.quiet) fmt::print("{}\n", printable(written.string()));
  files.settle();
  return 0;
}

}  // namespace app
