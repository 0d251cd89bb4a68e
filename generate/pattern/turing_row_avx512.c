// SPDX-License-Identifier: Apache-2.0
// Rows of a Turing field for AVX-512.
#define KERNEL avx512
#include "turing_row_kernel.h"
