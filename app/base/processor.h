// The instruction sets the program was compiled for, so that it can report a processor that lacks them.
#pragma once

namespace app {

/// Optional instruction sets that a compiler uses only on request, as bits.
enum Instructions : unsigned { popcnt = 1, sse42 = 2, avx = 4, avx2 = 8, bmi2 = 16, fma = 32, avx512 = 64 };

/// A constant, not a function: reading it needs none of these instructions.
extern const unsigned instructions_used;

}  // namespace app
