#include "app/scene/output.h"

#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"
#include "app/tables/movie_formats.h"

#include "render/figures/figure.h"
#include "sim/core/input_file.h"
#include "sim/trajectory/trajectory.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <optional>
#include <system_error>

namespace app {

namespace fs = std::filesystem;

void write_whole_file(const fs::path& path, const std::string& text) {
  if (path == "-") {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
      throw std::system_error(errno, std::generic_category(), "cannot write to standard output");
    return;
  }
  sim::write_file(path, text);
}

std::string read_whole_file(const fs::path& path) {
  std::string why;
  std::ifstream in = sim::open_input(path, why);
  if (!in) throw std::runtime_error(fmt::format("cannot read '{}': {}", path.string(), why));
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string base64(std::string_view bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::vector<std::string> figure_names(const render::FigureParameters& figure) {
  std::vector<std::string> names;
  for (const char* extension : render::figure_extensions)
    names.push_back((figure.out.empty() ? figure.kind : figure.out) + extension);
  return names;
}

namespace {

constexpr const char scene_name[] = "scene.toml", trajectory_name[] = "trajectory.h5";

/// A folder of an earlier version, which kept no list: a resolved scene beside its trajectory is ours, and so are the
/// figures that the scene asks for.
void adopt_earlier(OwnedFiles& files, const Settings& there, const std::string& text) {
  if (!files.unlisted() || text != write_scene(there) || !sim::holds_trajectory(files.folder() / trajectory_name))
    return;
  try {
    const sim::TrajectoryReader trajectory(files.folder() / trajectory_name);
    const Settings simulated = parse_scene(trajectory.header().scene, "its scene", files.folder(), {}, SceneUse::draw);
    if (!continuable(physics_differences(simulated.scene, there.scene))) return;
  } catch (const std::exception&) {
    return;
  }
  files.adopt(scene_name);
  for (const render::FigureParameters& figure : there.figures)
    for (const std::string& name : figure_names(figure)) files.adopt(name);
}

/// The trajectory tells by itself whose it is, and grows.
void require_own_trajectory(const OwnedFiles& files) {
  const fs::path path = files.folder() / trajectory_name;
  const fs::file_status status = fs::symlink_status(path);
  if (!fs::exists(status)) return;
  if (fs::is_regular_file(status) && (fs::file_size(path) == 0 || sim::holds_trajectory(path))) return;
  throw std::runtime_error(fmt::format("'{}' {}; it is left as it is: move it away, or give another -o", path.string(),
                                       fs::is_symlink(status)
                                           ? "is a link, and links are not followed out of a folder of results"
                                           : "is not a trajectory of this program"));
}

}  // namespace

void adopt_movie(OwnedFiles& files, const std::string& movie) {
  const fs::path path = files.folder() / movie, record = files.folder() / record_of_movie(movie);
  if (!files.unlisted() || !fs::is_regular_file(path) || !fs::is_regular_file(record)) return;
  if (read_whole_file(record).find(fmt::format(", {} bytes, ", fs::file_size(path))) == std::string::npos) return;
  files.adopt(record_of_movie(movie));
  files.adopt(movie);
}

std::string record_of_movie(const std::string& movie) { return "frames/." + movie; }

void require_pictures(const OwnedFiles& files, const Settings& settings) {
  files.require_frames(true);
  const std::string movie = movie_name(find_movie_format(settings.movie.format));
  files.require(movie);
  files.require(record_of_movie(movie));
  if (settings.movie.poster) files.require(poster_name);
}

FolderState inspect_folder(OwnedFiles& files, const Settings& settings, bool force) {
  const fs::path& folder = files.folder();
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw std::runtime_error(fmt::format("'{}' is not a folder", folder.string()));
  const fs::path scene = folder / scene_name;
  require_own_trajectory(files);
  FolderState state = FolderState::fresh;
  if (!fs::exists(fs::symlink_status(scene))) {
    if (fs::exists(folder / trajectory_name) && !force)
      throw std::runtime_error(
          fmt::format("folder '{}' holds a trajectory without its scene.toml; give another -o, or "
                      "--force to replace it",
                      folder.string()));
  } else {
    const std::string text = fs::is_regular_file(fs::symlink_status(scene)) ? read_whole_file(scene) : std::string();
    std::optional<Settings> there;
    std::string complaint;
    try {
      there = parse_scene(text, scene.string(), folder, {}, SceneUse::draw);
      adopt_earlier(files, *there, text);
      there->scene.numerics.threads = settings.scene.numerics.threads;
    } catch (const std::exception& error) {
      complaint = error.what();
    }
    const auto differences = there ? physics_differences(there->scene, settings.scene) : std::vector<SceneDifference>();
    const bool same_simulation = there && continuable(differences);
    if (same_simulation && !force)
      state = write_scene(*there) == write_scene(settings) ? FolderState::same : FolderState::same_physics;
    // A scene that says what the resolved one would say stays, whoever wrote it.
    if (state != FolderState::same && text != write_scene(settings)) files.require(scene_name);
    if (!there && !force)
      throw std::runtime_error(
          fmt::format("folder '{}' holds a scene that cannot be read ({}); give another -o, or --force "
                      "to replace it",
                      folder.string(), complaint));
    if (!same_simulation && !force)
      throw std::runtime_error(
          fmt::format("folder '{}' belongs to another scene: {}; give another -o, or --force to replace it",
                      folder.string(), text_of(differences)));
  }
  adopt_movie(files, movie_name(find_movie_format(settings.movie.format)));
  require_pictures(files, settings);
  for (const render::FigureParameters& figure : settings.figures)
    for (const std::string& name : figure_names(figure)) files.require(name);
  return state;
}

void claim_folder(OwnedFiles& files, const Settings& settings, FolderState state) {
  if (state == FolderState::same) return;
  const fs::path& folder = files.folder();
  const std::string text = write_scene(settings);
  const bool there = fs::is_regular_file(folder / scene_name) && read_whole_file(folder / scene_name) == text;
  std::optional<sim::Draft> scene;  // on the disk before anything is removed
  if (!there) scene.emplace(files.prepare(scene_name, text));
  // From here on the folder says that its movie and poster are of this scene.
  files.remove(poster_name);
  if (state == FolderState::same_physics) {
    files.remove(movie_name(find_movie_format(settings.movie.format)));
  } else {
    // No scene first, so that what a kill leaves belongs to none.
    if (!there) files.remove(scene_name);
    for (const MovieFormat& format : movie_formats()) files.remove(movie_name(format));
    files.remove_frames(0);
    std::error_code error;
    fs::remove(folder / trajectory_name, error);
  }
  if (scene) files.publish(*scene, scene_name);
}

}  // namespace app
