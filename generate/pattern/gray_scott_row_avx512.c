// SPDX-License-Identifier: Apache-2.0
// A row of Gray–Scott: sixteen cells side by side.
#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512VL__)
#define GS_KERNEL gs_row_avx512
#include "gray_scott_kernel.h"
#else
typedef int gs_no_avx512; // not of this machine
#endif
