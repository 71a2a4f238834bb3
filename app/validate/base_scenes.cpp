#include "app/validate/base_scenes.h"

#include "scene_texts.h"

namespace app {

const std::vector<BaseScene>& base_scenes() {
  static const std::vector<BaseScene> scenes{{"tank-treading", 12, tank_treading_scene},
                                             {"tumbling", 12, tumbling_scene},
                                             {"relaxation", 12, relaxation_scene},
                                             {"sedimentation", 12, sedimentation_scene},
                                             {"encounter", 8, encounter_scene},
                                             {"parachute", 8, parachute_scene},
                                             {"slipper", 8, slipper_scene}};
  return scenes;
}

}  // namespace app
