// Output files and folders: whole or absent, and never another scene's.
#pragma once

#include "owned_files.h"
#include "settings.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace app {

/// By sim::write_file(); "-" is standard output.
void write_whole_file(const std::filesystem::path&, const std::string& text);
std::string read_whole_file(const std::filesystem::path&);

std::string base64(std::string_view bytes);

inline constexpr const char poster_name[] = "poster.png";

/// Files of a figure in an output folder.
std::vector<std::string> figure_names(const render::FigureParameters&);

/// What an output folder of `run` already holds.
enum class FolderState {
  fresh,      ///< new, or given up by --force
  same,       ///< this very scene, pictures included
  same_physics  ///< this simulation with other pictures, or to another end
};

/// What a movie was made of, in a hidden file beside its frames: the frames alone do not tell how fast they were shown.
std::string record_of_movie(const std::string& movie);
/// A movie of an earlier version, which kept no list: its record says how long it is.
void adopt_movie(OwnedFiles&, const std::string& movie);
/// Throws, before anything is changed, where a name that frames, movie and poster need belongs to somebody else.
void require_pictures(const OwnedFiles&, const Settings&);

/// What is there, and the refusals of `run`: another scene without `force`, and whatever was not made by this program. Changes
/// nothing on the disk.
FolderState inspect_folder(OwnedFiles&, const Settings&, bool force);
/// Leaves the resolved scene.toml in the folder, and removes what an earlier run of ours left that is not of this scene.
void claim_folder(OwnedFiles&, const Settings&, FolderState);

}  // namespace app
