// Scene files: text, then, after a NUL, one `--set`. What is accepted must write itself as a scene that means the same.
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"
#include "support.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(bytes), size);
  const std::string text = input.substr(0, input.find('\0'));
  std::vector<std::string> changes;
  if (text.size() < input.size()) changes.push_back(input.substr(text.size() + 1));
  std::string resolved;
  if (!fuzz::accepted(
          [&] { resolved = app::write_scene(app::parse_scene(text, "scene", ".", changes, app::SceneUse::draw)); }))
    return 0;
  std::string again;
  if (!fuzz::accepted(
          [&] { again = app::write_scene(app::parse_scene(resolved, "resolved", ".", {}, app::SceneUse::draw)); }))
    fuzz::broken("a resolved scene is a scene");
  if (again != resolved) fuzz::broken("a resolved scene resolves to itself");
  return 0;
}
