// SPDX-License-Identifier: Apache-2.0
// Processor time of the whole program, which other programs on the machine do not change much.
#pragma once
#include <time.h>

static inline double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
