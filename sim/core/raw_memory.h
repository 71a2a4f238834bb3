// Memory for numbers that are all written before they are read: uninitialised, and in huge pages when it is so large
// that the C library requests it from the kernel each time. A fresh small page costs as much as the arithmetic on its
// contents, and operators of high order are rebuilt at every step.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace sim {

void* allocate_raw(std::size_t bytes);
void free_raw(void*, std::size_t bytes);

template <class T>
struct RawAllocator {
  using value_type = T;

  RawAllocator() = default;
  template <class U>
  RawAllocator(const RawAllocator<U>&) {}

  T* allocate(std::size_t n) { return static_cast<T*>(allocate_raw(n * sizeof(T))); }
  void deallocate(T* p, std::size_t n) { free_raw(p, n * sizeof(T)); }
  /// vector(n) leaves its elements uninitialised.
  template <class U>
  void construct(U* p) noexcept {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Arguments>
  void construct(U* p, Arguments&&... arguments) {
    ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const RawAllocator&, const RawAllocator&) { return true; }
};

template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace sim
