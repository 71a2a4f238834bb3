#include "sim/layers/plans.h"

namespace sim {

void Plans::forget_unused(int rounds) {
  const std::lock_guard lock(mutex_);
  ++round_;
  const auto drop = [&](auto& table) {
    std::erase_if(table, [&](const auto& entry) { return round_ - entry.second->used > rounds; });
  };
  drop(bases_);
  drop(layers_);
  drop(rotations_);
}

std::size_t Plans::size() const {
  const std::lock_guard lock(mutex_);
  return bases_.size() + layers_.size() + rotations_.size();
}

}  // namespace sim
