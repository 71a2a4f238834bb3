#include "app/validate/base_scenes.h"

#include "scene_texts.h"

#include <stdexcept>

namespace app {

namespace {

constexpr char waves_scene[] = R"([flow]
kind = "none"

[time]
end = 0.1
tolerance = 1e-6

[[vesicle]]
shape = "harmonics"
coefficients = [[2, 0, 0.004], [3, 0, 0.0028], [4, 0, 0.002]]
axis = [0, 0, 1]
bending_modulus = 1.0

[numerics]
gmres_tolerance = 1e-10
)";

constexpr char crowd_scene[] = R"([flow]
kind = "shear"
rate = 1.0

[time]
end = 6.0
save_every = 0.25

[cell]
size = [6.0, 6.0, 6.0]

[[vesicle]]
shape = "prolate"
reduced_volume = 0.9
axis = [1, 0, 0]
bending_modulus = 0.1

[[placement]]
kind = "box"
count = 16

[numerics]
repulsion_strength = 60.0
repulsion_range = 0.05
)";

}  // namespace

const std::vector<BaseScene>& base_scenes() {
  static const std::vector<BaseScene> scenes{{"tank-treading", 12, tank_treading_scene},
                                             {"tumbling", 12, tumbling_scene},
                                             {"relaxation", 12, relaxation_scene},
                                             {"sedimentation", 12, sedimentation_scene},
                                             {"encounter", 8, encounter_scene},
                                             {"parachute", 8, parachute_scene},
                                             {"slipper", 8, slipper_scene},
                                             {"waves", 12, waves_scene, false},
                                             {"crowd", 8, crowd_scene, false}};
  return scenes;
}

const BaseScene& find_base_scene(std::string_view name) {
  for (const BaseScene& scene : base_scenes())
    if (scene.name == name) return scene;
  throw std::logic_error("no such base scene");
}

}  // namespace app
