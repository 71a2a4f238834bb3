// Files inside the program: the shaders and the font, embedded when it was built.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace render {

struct Asset {
  std::string_view name;  ///< file name without folder
  std::span<const unsigned char> bytes;
};
const std::vector<Asset>& assets();

/// Throws std::runtime_error when there is none of that name.
std::span<const unsigned char> asset(std::string_view name);

/// Text of a shader file: from `folder` when that is given (so shaders can be edited without building), else embedded.
/// Throws std::runtime_error with the path when the file cannot be read.
std::string shader_text(std::string_view name, const std::filesystem::path& folder);

}  // namespace render
