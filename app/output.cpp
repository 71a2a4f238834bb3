#include "output.h"

#include "movie_formats.h"
#include "scene_file.h"
#include "scene_text.h"

#include "render/file.h"
#include "sim/input_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace app {

namespace fs = std::filesystem;

void write_whole_file(const fs::path& path, const std::string& text) {
  if (path == "-") {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
      throw std::system_error(errno, std::generic_category(), "cannot write to standard output");
    return;
  }
  render::write_file(path, text);
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

void remove_frames(const fs::path& folder, std::int64_t first) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string stem = entry.path().stem().string();
    const bool ours = entry.path().extension() == ".png" && stem.size() >= 6 && stem.size() < 12 &&
                      stem.find_first_not_of("0123456789") == std::string::npos;
    if (ours && std::stoll(stem) >= first) fs::remove(entry.path(), error);
  }
}

FolderState inspect_folder(const fs::path& folder, const Settings& settings, bool force) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw std::runtime_error(fmt::format("'{}' is not a folder", folder.string()));
  const fs::path scene = folder / "scene.toml";
  if (!fs::exists(scene)) {
    if (fs::exists(folder / "trajectory.h5") && !force)
      throw std::runtime_error(fmt::format("folder '{}' holds a trajectory without its scene.toml; give another -o, or "
                                           "--force to replace it", folder.string()));
    return FolderState::fresh;
  }
  Settings there;
  try {
    there = parse_scene(read_whole_file(scene), scene.string(), folder, {}, SceneUse::draw);
  } catch (const std::exception& error) {
    if (force) return FolderState::fresh;
    throw std::runtime_error(fmt::format("folder '{}' holds a scene that cannot be read ({}); give another -o, or --force "
                                         "to replace it", folder.string(), error.what()));
  }
  if (force) return FolderState::fresh;
  const auto differences = physics_differences(there.scene, settings.scene);
  if (continuable(differences)) {
    there.scene.numerics.threads = settings.scene.numerics.threads;
    return write_scene(there) == write_scene(settings) ? FolderState::same : FolderState::same_physics;
  }
  throw std::runtime_error(fmt::format("folder '{}' belongs to another scene: {}; give another -o, or --force to replace it",
                                       folder.string(), text_of(differences)));
}

void release_folder(const fs::path& folder) {
  if (fs::exists(folder / "trajectory.h5")) return;
  std::error_code error;
  fs::remove(folder / "scene.toml", error);
  fs::remove(folder, error);  // if it is empty
}

FolderState claim_folder(const fs::path& folder, const Settings& settings, bool force) {
  const FolderState state = inspect_folder(folder, settings, force);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("cannot make folder '{}': {}", folder.string(), error.message()));
  // Only what an earlier run of ours left there: its scene.toml says so.
  if (state == FolderState::fresh && fs::exists(folder / "scene.toml")) {
    for (const char* old : {"trajectory.h5", "poster.png", "scene.toml"}) fs::remove(folder / old, error);
    for (const MovieFormat& format : movie_formats()) fs::remove(folder / movie_name(format), error);
    remove_frames(folder / "frames", 0);
  }
  // From here on the folder says that its movie and poster are of this scene.
  if (state == FolderState::same_physics)
    for (const std::string& old : {movie_name(find_movie_format(settings.movie.format)), std::string("poster.png")})
      fs::remove(folder / old, error);
  if (state != FolderState::same) write_whole_file(folder / "scene.toml", write_scene(settings));
  return state;
}

}  // namespace app
