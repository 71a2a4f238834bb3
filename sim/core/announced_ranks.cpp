#include "sim/core/started_ranks.h"

#include <algorithm>
#include <cstdlib>

namespace sim {

int announced_ranks() {
  const auto number = [](const char* name) {
    const char* text = std::getenv(name);
    return text ? std::clamp(std::atoi(text), 0, 10'000'000) : 0;
  };
  int count = std::max(number("OMPI_COMM_WORLD_SIZE"), number("PMI_SIZE"));
  if (count == 0 && std::getenv("PMIX_RANK")) count = number("SLURM_STEP_NUM_TASKS");
  return std::max(count, 1);
}

}  // namespace sim
