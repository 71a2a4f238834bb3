#include "assets.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace render {

std::span<const unsigned char> asset(std::string_view name) {
  for (const Asset& a : assets())
    if (a.name == name) return a.bytes;
  throw std::runtime_error("no file " + std::string(name) + " in the program");
}

std::string shader_text(std::string_view name, const std::filesystem::path& folder) {
  if (folder.empty()) {
    const std::span<const unsigned char> bytes = asset(name);
    return {bytes.begin(), bytes.end()};
  }
  const std::filesystem::path path = folder / name;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) throw std::runtime_error(path.string() + ": cannot be read");
  return text.str();
}

}  // namespace render
