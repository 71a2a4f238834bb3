// Preloaded: every clock jumps by up to a day, forwards and backwards, from one reading to the next.
#include <dlfcn.h>
#include <time.h>

#include <atomic>
#include <cstdint>

namespace {

std::atomic<std::uint64_t> readings{0};

long jump() {
  std::uint64_t x = ++readings * 0x9e3779b97f4a7c15ULL;
  x ^= x >> 29;
  return static_cast<long>(x % 172800) - 86400;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* t) {
  using Function = int (*)(clockid_t, timespec*);
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = real(clock, t);
  if (result == 0) t->tv_sec += jump();
  return result;
}
