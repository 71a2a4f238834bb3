// `--set section.key=value`: changes to a parsed scene before it is interpreted.
#pragma once

#include "app/scene/scene_values.h"

namespace app {

/// Applies one override to the scene: `time.step=0.05`, `vesicle.order=12` (every vesicle), `vesicle.0.order=12`. The
/// value is TOML; a bare word is a string.
void apply_override(toml::table& scene, const std::string& override_text);

}  // namespace app
