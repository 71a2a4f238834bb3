// Commands that only look: info, export, list.
#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/base/printable.h"
#include "app/base/progress.h"
#include "app/base/result_files.h"
#include "app/commands/commands.h"
#include "app/export/catalogue_list.h"
#include "app/export/csv.h"
#include "app/export/mesh_export.h"
#include "app/export/page.h"
#include "app/export/reference.h"
#include "app/export/summary.h"
#include "app/pictures/frames.h"
#include "app/scene/output.h"
#include "app/scene/scene_file.h"
#include "app/scene/trajectory_scene.h"

#include "sim/core/input_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace app {

int info(const Options& options) {
  const std::filesystem::path& path = options.inputs.front();
  if (std::filesystem::is_directory(path))
    throw std::runtime_error(
        fmt::format("'{}' is a folder; give a trajectory, a scene or a frame in it", path.string()));
  if (!std::filesystem::exists(path)) throw std::runtime_error(fmt::format("there is no file '{}'", path.string()));
  std::string why;
  std::ifstream in = sim::open_input(path, why);
  if (!in) throw std::runtime_error(fmt::format("cannot read '{}': {}", path.string(), why));
  std::string start(8, '\0');
  start.resize(static_cast<std::size_t>(in.read(start.data(), 8).gcount()));
  // A beginning alone is told to be one.
  const auto begins = [&start](std::string_view signature) { return start.size() > 1 && signature.starts_with(start); };
  if (begins("\211HDF\r\n\032\n"))
    fmt::print("{}", trajectory_summary(path));
  else if (begins("\211PNG\r\n\032\n"))
    fmt::print("{}", picture_summary(path));
  else
    fmt::print("{}", scene_summary(read_scene(path, options.set)));
  return 0;
}

namespace {

/// Numbers of the states to write, the second not among them: all, or the one nearest to a time.
std::pair<std::int64_t, std::int64_t> chosen_states(const sim::TrajectoryReader& trajectory,
                                                    std::optional<double> time) {
  if (!time) return {0, trajectory.count()};
  require_time(*time, trajectory.count() > 0 ? trajectory.time(trajectory.count() - 1) : std::nan(""));
  std::int64_t nearest = 0;
  for (std::int64_t k = 1; k < trajectory.count(); ++k)
    if (std::abs(trajectory.time(k) - *time) < std::abs(trajectory.time(nearest) - *time)) nearest = k;
  return {nearest, nearest + 1};
}

/// False when it was interrupted.
bool write_page(const Options& options, const sim::TrajectoryReader& trajectory, std::int64_t first, std::int64_t end,
                ResultFiles& files) {
  const Settings settings = scene_in(trajectory, options.inputs.front(), options.set);
  if (first == end) throw std::runtime_error("the trajectory has no states");
  const std::vector<double> times =
      options.time ? std::vector{trajectory.time(first)} : page_times(trajectory, settings.movie);
  Progress progress("exporting", options.quiet);
  const std::string page = page_text(trajectory, settings, times, [&](std::int64_t k, std::int64_t count) {
    progress.show(static_cast<double>(k) / static_cast<double>(count), fmt::format("frame {} of {}", k + 1, count));
    return !interrupted();
  });
  progress.clear();
  if (page.empty()) {
    files.settle();
    tell("interrupted");
    return false;
  }
  files.write(options.html, page);
  if (!options.quiet && options.html != "-")
    fmt::print("{}: {} frames, {} kB\n", printable(options.html.string()), times.size(), page.size() / 1000);
  return true;
}

/// A table that was asked for.
struct WantedTable {
  std::filesystem::path path;
  std::string (*text)(const sim::TrajectoryReader&, const sim::Scene&, std::int64_t first, std::int64_t end);
};
std::vector<WantedTable> wanted_tables(const Options& o) {
  const auto motion = [](const sim::TrajectoryReader& trajectory, const sim::Scene& scene, std::int64_t, std::int64_t) {
    return motion_csv(trajectory, scene);
  };
  std::vector<WantedTable> all;
  for (const WantedTable& table :
       {WantedTable{o.csv, csv_text}, {o.motion, motion}, {o.suspension, suspension_csv}, {o.pairs, pairs_csv}})
    if (!table.path.empty()) all.push_back(table);
  return all;
}

}  // namespace

int export_states(const Options& options) {
  const std::vector<WantedTable> tables = wanted_tables(options);
  if (tables.empty() && options.html.empty() && options.vtk.empty() && options.ply.empty())
    throw std::runtime_error(
        "say what to write: --csv FILE, --motion FILE, --suspension FILE, --pairs FILE, --html FILE, --vtk DIR or "
        "--ply DIR");
  if (!options.set.empty() && options.html.empty())
    throw std::runtime_error("--set changes the pictures of --html FILE; there are no others");
  const auto to_output = [](const WantedTable& table) { return table.path == "-"; };
  if (std::count_if(tables.begin(), tables.end(), to_output) > 1)
    throw std::runtime_error("only one table can go to standard output");
  if (!options.motion.empty() && options.time)
    throw std::runtime_error("--motion is of the whole trajectory; leave out --time");
  const sim::TrajectoryReader trajectory(options.inputs.front());
  const auto [first, end] = chosen_states(trajectory, options.time);
  ResultFiles files(options.inputs, options.force);
  // Before the first of them is written.
  for (const WantedTable& table : tables) files.require(table.path);
  if (!options.html.empty()) files.require(options.html);
  if (!options.vtk.empty()) files.require_inside(options.vtk / vtk_series);
  for (std::int64_t k = first; k < end; ++k) {
    if (!options.vtk.empty()) files.require_inside(options.vtk / vtk_name(k));
    for (int v = 0; !options.ply.empty() && v < trajectory.layout().vesicles; ++v)
      files.require_inside(options.ply / ply_name(static_cast<std::size_t>(v), k));
  }
  if (!tables.empty()) {
    const sim::Scene scene = scene_in(trajectory, options.inputs.front()).scene;
    for (const WantedTable& table : tables) files.write(table.path, table.text(trajectory, scene, first, end));
  }
  if (!options.html.empty() && !write_page(options, trajectory, first, end, files)) return interrupted_status;
  struct Kind {
    const std::filesystem::path& folder;
    std::int64_t (*write)(const sim::TrajectoryReader&, const MeshExport&, const sim::FileWriter&,
                          const ExportProgress&);
  };
  for (const auto& [folder, write] : {Kind{options.vtk, export_vtk}, Kind{options.ply, export_ply}}) {
    if (folder.empty()) continue;
    Progress progress("exporting", options.quiet);
    const std::int64_t states = write(trajectory, {folder, first, end, options.latitudes}, files.writer_inside(),
                                      [&](std::int64_t k, std::int64_t count) {
                                        progress.show(static_cast<double>(k) / static_cast<double>(count),
                                                      fmt::format("state {} of {}", k + 1, count));
                                        return !interrupted();
                                      });
    progress.clear();
    if (states < end - first) {
      files.settle();
      tell(fmt::format("interrupted; {} of {} states are in '{}'", states, end - first, folder.string()));
      return interrupted_status;
    }
    if (!options.quiet && std::none_of(tables.begin(), tables.end(), to_output))
      fmt::print("{}: {} states\n", printable(folder.string()), states);
  }
  files.settle();
  return 0;
}

int list(const Options& options) {
  if (options.markdown && options.word != "parameters")
    throw std::runtime_error("--markdown goes with 'list parameters'");
  if (options.word == "parameters") {
    fmt::print("{}", options.markdown ? reference_page() : parameter_list());
    return 0;
  }
  std::vector<std::string_view> names;
  for (const Catalogue& catalogue : listed_catalogues()) {
    names.push_back(catalogue.name);
    if (options.word.empty()) fmt::print("{:<12} {}\n", catalogue.name, catalogue.meaning);
    if (options.word != catalogue.name) continue;
    for (const auto& row : catalogue.rows) {
      std::string keys;
      for (const std::string_view key : row.keys) keys += fmt::format("{}{}", keys.empty() ? "; keys: " : ", ", key);
      fmt::print("{:<20} {}{}\n", row.name, row.meaning, keys);
    }
    return 0;
  }
  names.push_back("parameters");
  if (!options.word.empty())
    throw std::runtime_error(
        fmt::format("'{}' is not a catalogue{}", options.word, sim::suggestion(options.word, names)));
  fmt::print("{:<12} {}\n", "parameters", "every key of a scene file");
  return 0;
}

}  // namespace app
