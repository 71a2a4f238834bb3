#include "app/base/version.h"

namespace app {

std::string version() { return TANKTREAD_VERSION; }
std::string build() { return TANKTREAD_BUILD; }

}  // namespace app
