// The scenes that validations change: those of scenes/, inside the program.
#pragma once

#include <string_view>
#include <vector>

namespace app {

struct BaseScene {
  std::string_view name;  ///< scenes/NAME.toml
  int order;              ///< of its vesicles where a validation gives none: its orders are known, not automatic
  const char* text;       ///< TOML
};
const std::vector<BaseScene>& base_scenes();

}  // namespace app
