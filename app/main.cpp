// tanktread: lipid vesicles in Stokes flow, from a scene to a movie.
#include "app/base/processor.h"
#include "app/commands/cli.h"

#include <limits>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#if defined(__x86_64__)
#include <unistd.h>

#include <cstring>

namespace {

void say(const char* text) {
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) ::_exit(1);
}

/// Everything else may use instructions that this processor lacks, initialisers of static objects among it: this file
/// is compiled for every processor of the architecture, and 101 is the first place that a program may take among
/// constructors.
[[gnu::constructor(101)]] void check_processor() {
  __builtin_cpu_init();
  const struct {
    unsigned bit;
    bool here;
    const char* name;
  } rows[] = {{app::popcnt, __builtin_cpu_supports("popcnt") != 0, "POPCNT"},
              {app::sse42, __builtin_cpu_supports("sse4.2") != 0, "SSE4.2"},
              {app::avx, __builtin_cpu_supports("avx") != 0, "AVX"},
              {app::avx2, __builtin_cpu_supports("avx2") != 0, "AVX2"},
              {app::bmi2, __builtin_cpu_supports("bmi2") != 0, "BMI2"},
              {app::fma, __builtin_cpu_supports("fma") != 0, "FMA"},
              {app::avx512, __builtin_cpu_supports("avx512f") != 0, "AVX-512"}};
  bool lacks = false;
  for (const auto& row : rows) {
    if (!(app::instructions_used & row.bit) || row.here) continue;
    say(lacks ? ", " : "tanktread: this program was compiled for a newer processor; this one lacks ");
    say(row.name);
    lacks = true;
  }
  if (!lacks) return;
  say(" (build it with cmake -DTANKTREAD_ARCH=x86-64, which runs everywhere and slower)\n");
  ::_exit(1);
}

}  // namespace
#endif

namespace {

/// Operators and frames are made anew all the time. Memory that is given back to the system comes again as pages that
/// it has to clear first, a third of a step of two threads at order 24; so it is kept.
void keep_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_memory();
  return app::main(argc, argv);
}
