// SPDX-License-Identifier: Apache-2.0
// Rows of a Turing field for what every machine of the build has.
#define KERNEL base
#include "turing_row_kernel.h"
