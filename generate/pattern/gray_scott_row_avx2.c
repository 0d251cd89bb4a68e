// SPDX-License-Identifier: Apache-2.0
// A row of Gray–Scott: eight cells side by side.
#if defined(__AVX2__)
#define GS_KERNEL gs_row_avx2
#include "gray_scott_kernel.h"
#else
typedef int gs_no_avx2; // not of this machine
#endif
