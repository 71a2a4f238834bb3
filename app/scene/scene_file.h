// Reads and writes scene files (TOML). Every error is reported in a sentence with file, line and column, and the
// nearest valid word.
#pragma once

#include "app/scene/settings.h"

#include <filesystem>

namespace app {

/// Purpose of reading a scene. Drawing needs neither the initial shapes nor their files.
enum class SceneUse { simulate, draw };

/// Reads a scene file and applies `--set key=value` overrides. Errors are std::runtime_error. `continued`: a trajectory
/// that may be there already, of a run that is then continued. It holds the state in which it once started, so that
/// the file where that came from is not looked at again.
Settings read_scene(const std::filesystem::path&, const std::vector<std::string>& overrides = {},
                    const std::filesystem::path& continued = {});
/// The same for text; `name` is the file name in messages, file names in the scene are relative to `folder`.
Settings parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                     const std::vector<std::string>& overrides = {}, SceneUse use = SceneUse::simulate,
                     const std::filesystem::path& continued = {});

/// Whether a key is used, given the words that select a kind in the same table (its `kind` or `shape`, and
/// `time_factor`).
bool key_applies(std::string_view section, std::string_view key, std::string_view kind, std::string_view time_factor);
/// For an unused key: "a key of flow 'poiseuille', not of 'shear'".
std::string key_belongs_to(std::string_view section, std::string_view key, std::string_view kind);

}  // namespace app
