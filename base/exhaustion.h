// SPDX-License-Identifier: Apache-2.0
// What happens when memory that cannot fail is not to be had.
#pragma once
#include <stddef.h>

// Removes pending temporaries, prints one line to standard error and ends the process with TY_NO_MEMORY.
_Noreturn void ty_memory_exhausted(size_t count, size_t size);
