// The store of plans a simulation uses: built when first asked for, immutable afterwards, handed out by reference.
#pragma once

#include "basis.h"
#include "layer_potentials.h"

#include <map>
#include <memory>
#include <utility>

namespace sim {

/// Not safe for concurrent first requests: ask for all plans before a parallel region.
class Plans {
 public:
  const Basis& basis(int order, int grid_order) {
    auto& slot = bases_[{order, grid_order}];
    if (!slot) slot = std::make_unique<Basis>(order, grid_order);
    return *slot;
  }
  const LayerPotentials& layers(int order, int source_order) {
    auto& slot = layers_[{order, source_order}];
    if (!slot) slot = std::make_unique<LayerPotentials>(order, source_order);
    return *slot;
  }

 private:
  std::map<std::pair<int, int>, std::unique_ptr<Basis>> bases_;
  std::map<std::pair<int, int>, std::unique_ptr<LayerPotentials>> layers_;
};

}  // namespace sim
