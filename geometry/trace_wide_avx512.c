// SPDX-License-Identifier: Apache-2.0
// The wide top level for AVX-512, or the plain one under that name where the compiler knows none.
#define KERNEL avx512
#include "trace_wide_kernel.h"
