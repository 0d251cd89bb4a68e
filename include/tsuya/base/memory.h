// SPDX-License-Identifier: Apache-2.0
// The only door to the heap. Sizes that come from input use the ty_try_ calls; all others cannot fail.
#pragma once
#include <tsuya/base/status.h>

// Zeroed memory for count elements of size bytes, 64-byte aligned. Overflow or exhaustion calls the handler, which
// prints one line and exits with TY_NO_MEMORY. count 0 gives a valid pointer. Callable from any thread.
void* ty_alloc(size_t count, size_t size);

// The same, but NULL on overflow or exhaustion: for sizes that come from a file or a user.
TY_CHECKED void* ty_try_alloc(size_t count, size_t size);

// Grows or shrinks; the new part is not zeroed; alignment 64 is kept. old_count elements are preserved.
void* ty_grow(void* memory, size_t old_count, size_t new_count, size_t size);
TY_CHECKED void* ty_try_grow(void* memory, size_t old_count, size_t new_count, size_t size);

void ty_free(void* memory); // NULL is allowed
char* ty_string_copy(const char* text);
char* ty_string_format(const char* format, ...) TY_PRINTF(1, 2); // caller frees with ty_free

// For tests: the n-th ty_try_ call from now (0 = the next) fails once; negative = never.
void ty_memory_fail_after(long call_count);

// Typed short forms.
#define TY_ALLOC(type, count) ((type*)ty_alloc((size_t)(count), sizeof(type)))
#define TY_TRY_ALLOC(type, count) ((type*)ty_try_alloc((size_t)(count), sizeof(type)))
