// The store of plans a simulation uses: built when first requested, immutable afterwards, returned by reference.
#pragma once

#include "sim/fast/fast_sum.h"
#include "sim/layers/layer_potentials.h"
#include "sim/sphere/basis.h"
#include "sim/sphere/rotation.h"

#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace sim {

/// Safe for concurrent use: the thread that asks first builds a plan, and only those who ask for that very plan wait
/// for it.
class Plans {
 public:
  const Basis& basis(int order, int grid_order) { return get(bases_, std::pair(order, grid_order), order, grid_order); }
  const LayerPotentials& layers(int order, int source_order) {
    return get(layers_, std::pair(order, source_order), order, source_order);
  }
  const RotationPlan& rotation(int order) { return get(rotations_, order, order); }

  /// What fast sums share, for one caller at a time.
  template <class Use>
  auto with_fast_parts(Use&& use) {
    const std::lock_guard lock(fast_mutex_);
    return use(fast_);
  }

  /// Between two steps, while nobody holds a reference: drops what has not been asked for in the last `rounds` calls,
  /// so that a run whose orders change keeps no more than it needs.
  void forget_unused(int rounds = 100);
  std::size_t size() const;  ///< number of plans

 private:
  template <class Plan>
  struct Slot {
    std::once_flag once;
    std::unique_ptr<const Plan> plan;
    std::int64_t used = 0;  ///< round in which it was last asked for
  };
  template <class Key, class Plan>
  using Table = std::map<Key, std::unique_ptr<Slot<Plan>>>;

  template <class Key, class Plan, class... Arguments>
  const Plan& get(Table<Key, Plan>& table, const Key& key, Arguments... arguments) {
    Slot<Plan>* slot = nullptr;
    {
      const std::lock_guard lock(mutex_);
      auto& place = table[key];
      if (!place) place = std::make_unique<Slot<Plan>>();
      slot = place.get();
      slot->used = round_;
    }
    std::call_once(slot->once, [&] { slot->plan = std::make_unique<const Plan>(arguments...); });
    return *slot->plan;
  }

  mutable std::mutex mutex_;
  std::int64_t round_ = 0;
  Table<std::pair<int, int>, Basis> bases_;
  Table<std::pair<int, int>, LayerPotentials> layers_;
  Table<int, RotationPlan> rotations_;
  std::mutex fast_mutex_;
  FastParts fast_;
};

}  // namespace sim
