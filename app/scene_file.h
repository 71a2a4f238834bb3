// Reads and writes scene files (TOML). Everything that can be wrong with one is told in a sentence with file, line and
// column, and the nearest word that would have been right.
#pragma once

#include "settings.h"

#include <filesystem>

namespace app {

/// What a scene is read for. Drawing needs neither the initial shapes nor the files they come from.
enum class SceneUse { simulate, draw };

/// Reads a scene file and lays `--set key=value` overrides over it. Errors are std::runtime_error.
Settings read_scene(const std::filesystem::path&, const std::vector<std::string>& overrides = {});
/// The same for text; `name` stands for the file in messages, file names in the scene are relative to `folder`.
Settings parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                     const std::vector<std::string>& overrides = {}, SceneUse use = SceneUse::simulate);

/// Is a key read, given the words that select a kind in the same table (its `kind` or `shape`, and `time_factor`)?
bool key_applies(std::string_view section, std::string_view key, std::string_view kind, std::string_view time_factor);
/// For a key that is not: "a key of flow 'poiseuille', not of 'shear'".
std::string key_belongs_to(std::string_view section, std::string_view key, std::string_view kind);

}  // namespace app
