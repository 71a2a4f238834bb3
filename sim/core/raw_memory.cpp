#include "sim/core/raw_memory.h"

#include <sys/mman.h>

#include <new>

namespace sim {

namespace {

constexpr std::size_t huge_page = std::size_t(2) << 20, large = std::size_t(32) << 20;  // bytes

}  // namespace

void* allocate_raw(std::size_t bytes) {
  if (bytes < large) return ::operator new(bytes);
  void* p = ::operator new(bytes, std::align_val_t(huge_page));
  madvise(p, bytes, MADV_HUGEPAGE);  // a hint: without it only time is lost
  return p;
}

void free_raw(void* p, std::size_t bytes) {
  if (bytes < large)
    ::operator delete(p);
  else
    ::operator delete(p, std::align_val_t(huge_page));
}

}  // namespace sim
