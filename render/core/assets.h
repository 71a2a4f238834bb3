// Files embedded in the program at build time: the shaders and the font.
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

/// Throws std::runtime_error when no asset has that name.
std::span<const unsigned char> asset(std::string_view name);

/// Text of a shader file: from `folder` if given (so that shaders can be edited without a build), otherwise embedded.
/// Throws std::runtime_error with the path when the file cannot be read.
std::string shader_text(std::string_view name, const std::filesystem::path& folder);
/// Files that stand before a shader NAME.vert or NAME.frag, in order. They are GLSL 3.30 and ES 3.00 alike, as all
/// shaders are.
std::vector<std::string> shader_libraries(std::string_view shader);

}  // namespace render
