// SPDX-License-Identifier: Apache-2.0
// Samples of a volume for AVX-512, or the plain ones under that name where the compiler knows none.
#define KERNEL avx512
#include "loop_sample_kernel.h"
