// Memory for numbers that are all written before they are read: uninitialised, and in huge pages when it is so large
// that the C library requests it from the kernel each time. A fresh small page costs as much as the arithmetic on its
// contents, and operators of high order are rebuilt at every step.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include <sys/mman.h>

namespace sim {

template <class T>
struct RawAllocator {
  using value_type = T;
  static constexpr std::size_t huge_page = std::size_t(2) << 20, large = std::size_t(32) << 20;  ///< bytes

  RawAllocator() = default;
  template <class U>
  RawAllocator(const RawAllocator<U>&) {}

  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    if (bytes < large) return static_cast<T*>(::operator new(bytes));
    void* p = ::operator new(bytes, std::align_val_t(huge_page));
    madvise(p, bytes, MADV_HUGEPAGE);  // a hint: without it only time is lost
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t n) {
    if (n * sizeof(T) < large) ::operator delete(p);
    else ::operator delete(p, std::align_val_t(huge_page));
  }
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
