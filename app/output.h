// Output files and folders: whole or absent, and never another scene's.
#pragma once

#include "settings.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace app {

/// By render::write_file(); "-" is standard output.
void write_whole_file(const std::filesystem::path&, const std::string& text);
std::string read_whole_file(const std::filesystem::path&);

std::string base64(std::string_view bytes);

/// Removes 000000.png, 000001.png, ... from number `first` on; nothing else.
void remove_frames(const std::filesystem::path& folder, std::int64_t first);

/// What an output folder of `run` already holds.
enum class FolderState {
  fresh,      ///< new, or without a scene of ours
  same,       ///< this very scene, pictures included
  same_physics  ///< this simulation with other pictures, or to another end
};

/// Makes the folder and leaves the resolved scene.toml in it. A folder with another scene's simulation is refused
/// unless `force`, which removes whatever simulation, frames and movie an earlier run left there.
FolderState claim_folder(const std::filesystem::path&, const Settings&, bool force);
/// After a simulation that could not even start: takes back what claim_folder() made.
void release_folder(const std::filesystem::path&);
/// The refusal alone, for --dry-run.
FolderState inspect_folder(const std::filesystem::path&, const Settings&, bool force);

}  // namespace app
