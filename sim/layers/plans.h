// Cache of the plans of a simulation: built on first use, immutable afterwards, returned by reference.
#pragma once

#include "sim/sphere/basis.h"
#include "sim/layers/layer_potentials.h"
#include "sim/sphere/rotation.h"

#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace sim {

/// Safe for concurrent use: a plan is built once, by the thread that asks first.
class Plans {
 public:
  const Basis& basis(int order, int grid_order) { return get(bases_, std::pair(order, grid_order), order, grid_order); }
  const LayerPotentials& layers(int order, int source_order) {
    return get(layers_, std::pair(order, source_order), order, source_order);
  }
  const RotationPlan& rotation(int order) { return get(rotations_, order, order); }

 private:
  template <class Map, class Key, class... Arguments>
  typename Map::mapped_type::element_type& get(Map& map, const Key& key, Arguments... arguments) {
    const std::lock_guard lock(mutex_);
    auto& slot = map[key];
    if (!slot) slot = std::make_unique<typename Map::mapped_type::element_type>(arguments...);
    return *slot;
  }
  std::mutex mutex_;
  std::map<std::pair<int, int>, std::unique_ptr<Basis>> bases_;
  std::map<std::pair<int, int>, std::unique_ptr<LayerPotentials>> layers_;
  std::map<int, std::unique_ptr<RotationPlan>> rotations_;
};

}  // namespace sim
