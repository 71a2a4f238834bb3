#include "sim/core/started_ranks.h"

#include <fmt/format.h>

namespace sim {

Ranks started_ranks() {
  if (const int count = announced_ranks(); count > 1)
    throw std::runtime_error(
        fmt::format("this program was built without MPI, so {} processes cannot share one simulation; build it with "
                    "-DTANKTREAD_MPI=ON, or start it without mpirun",
                    count));
  return {};
}

}  // namespace sim
