#include "app/base/processor.h"

namespace app {

// This file is compiled with the options of all others, so the compiler's own words tell what they allow.
constinit const unsigned instructions_used = 0
#ifdef __POPCNT__
                                             | popcnt
#endif
#ifdef __SSE4_2__
                                             | sse42
#endif
#ifdef __AVX__
                                             | avx
#endif
#ifdef __AVX2__
                                             | avx2
#endif
#ifdef __BMI2__
                                             | bmi2
#endif
#ifdef __FMA__
                                             | fma
#endif
#ifdef __AVX512F__
                                             | avx512
#endif
    ;

}  // namespace app
