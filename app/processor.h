// Which instructions the program was compiled to use, so that it can say so on a processor that lacks them.
#pragma once

namespace app {

/// Those that a compiler may use only when told to, as bits.
enum Instructions : unsigned { popcnt = 1, sse42 = 2, avx = 4, avx2 = 8, bmi2 = 16, fma = 32, avx512 = 64 };

/// A constant, not a function: to read it takes none of these instructions.
extern const unsigned instructions_used;

}  // namespace app
