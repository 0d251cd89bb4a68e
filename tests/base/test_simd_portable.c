// SPDX-License-Identifier: Apache-2.0
// The same of the plain loops.
#define TY_SIMD_PORTABLE
#include "test_simd.c"
