#include "render/core/assets.h"

#include "sim/core/input_file.h"

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
  std::string why = "it is empty";
  std::ifstream file = sim::open_input(path, why);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) throw std::runtime_error("cannot read '" + path.string() + "': " + why);
  return text.str();
}

std::vector<std::string> shader_libraries(std::string_view shader) {
  if (shader == "body.vert" || shader == "outline.vert" || shader == "section.vert") return {"distance.glsl"};
  if (shader == "body.frag") return {"light.glsl", "ground.glsl", "box.glsl", "lines.glsl"};
  if (shader == "arrow.frag" || shader == "section.frag") return {"light.glsl", "ground.glsl"};
  if (shader == "outline.frag") return {"ground.glsl", "box.glsl"};
  if (shader == "ground.frag") return {"ground.glsl"};
  return {};
}

}  // namespace render
