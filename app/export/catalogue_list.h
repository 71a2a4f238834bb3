// What `tanktread list` and the reference page list: the catalogues of scenes, and those of commands.
#pragma once

#include "app/scene/catalogues.h"

namespace app {

const std::vector<Catalogue>& listed_catalogues();

}  // namespace app
