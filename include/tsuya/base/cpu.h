// SPDX-License-Identifier: Apache-2.0
// What this CPU can, for the choice between kernels that give the same bits.
#pragma once
#include <stdbool.h>

// The parts of AVX-512 that Embree asks for as well, which our kernels are compiled with: F, DQ, CD, BW and VL.
static inline bool ty_cpu_has_avx512(void)
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}
