// SPDX-License-Identifier: Apache-2.0
// The wide top level for what every machine of the build has.
#define KERNEL base
#include "trace_wide_kernel.h"
