// Version and build of the program, for --version, trajectories and pictures.
#pragma once

#include <string>

namespace app {

std::string version();  ///< "0.1.0"
std::string build();    ///< compiler, instruction set, build type

}  // namespace app
