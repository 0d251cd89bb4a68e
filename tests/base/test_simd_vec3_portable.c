// SPDX-License-Identifier: Apache-2.0
// The same of plain floats.
#define TY_SIMD_PORTABLE
#include "test_simd_vec3.c"
