// The scenes that validations change, inside the program: those of scenes/, and some of their own.
#pragma once

#include <string_view>
#include <vector>

namespace app {

struct BaseScene {
  std::string_view name;  ///< NAME.toml
  int order;              ///< of its vesicles where a validation gives none: its orders are known, not automatic
  const char* text;       ///< TOML
  bool in_folder = true;  ///< scenes/NAME.toml is the same
};
const std::vector<BaseScene>& base_scenes();
/// Throws std::logic_error for another name.
const BaseScene& find_base_scene(std::string_view name);

}  // namespace app
