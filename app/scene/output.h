// Output files and folders: complete or absent, and never those of another scene.
#pragma once

#include "app/base/owned_files.h"
#include "app/scene/settings.h"

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

/// Names of the files of a figure in an output folder.
std::vector<std::string> figure_names(const render::FigureParameters&);

/// What an output folder of `run` already contains.
enum class FolderState {
  fresh,        ///< new, or discarded by --force
  same,         ///< exactly this scene, pictures included
  same_physics  ///< this simulation with other pictures or another end time
};

/// Record of what a movie was made from, a hidden file beside its frames: the frames alone do not tell the frame
/// rate.
std::string record_of_movie(const std::string& movie);
/// Adopts a movie of an earlier version, which kept no list; its record contains its length.
void adopt_movie(OwnedFiles&, const std::string& movie);
/// Throws, before anything is changed, when a name needed for frames, movie or poster is taken by a file of the user.
void require_pictures(const OwnedFiles&, const Settings&);

/// State of the folder; throws the refusals of `run`: another scene without `force`, and files not made by this
/// program. Changes nothing on the disk.
FolderState inspect_folder(OwnedFiles&, const Settings&, bool force);
/// Writes the resolved scene.toml to the folder, and removes results of earlier runs that do not belong to this
/// scene.
void claim_folder(OwnedFiles&, const Settings&, FolderState);

}  // namespace app
