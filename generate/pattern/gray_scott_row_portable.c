// SPDX-License-Identifier: Apache-2.0
// A row of Gray–Scott: a cell after the other.
#define GS_PORTABLE
#define GS_KERNEL gs_row_portable
#include "gray_scott_kernel.h"
