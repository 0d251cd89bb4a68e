// SPDX-License-Identifier: Apache-2.0
// Aligned, overflow-checked memory; the one place of the project that calls malloc.
#include "exhaustion.h"
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <unistd.h>

enum
{
    memory_alignment = 64
};

static atomic_long fail_countdown = -1;

void ty_memory_fail_after(long call_count)
{
    atomic_store(&fail_countdown, call_count);
}

static bool failure_is_due(void)
{
    if (atomic_load_explicit(&fail_countdown, memory_order_relaxed) < 0)
        return false;
    return atomic_fetch_sub(&fail_countdown, 1) == 0;
}

_Noreturn void ty_memory_exhausted(size_t count, size_t size)
{
    char line[160];
    int length = snprintf(line, sizeof(line), "tsuya: error: out of memory (%zu elements of %zu bytes)\n", count, size);
    // Nothing better is to be done when even this cannot be written.
    ssize_t written = write(STDERR_FILENO, line, (size_t)length);
    (void)written;
    ty_atomic_abort_all();
    _exit(TY_NO_MEMORY);
}

// Not zeroed; NULL on overflow or exhaustion.
static void* aligned_new(size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > PTRDIFF_MAX)
        return NULL;
    void* memory = NULL;
    if (posix_memalign(&memory, memory_alignment, bytes ? bytes : 1))
        return NULL;
    return memory;
}

static void* zeroed_new(size_t count, size_t size)
{
    void* memory = aligned_new(count, size);
    if (memory)
        memset(memory, 0, count * size);
    return memory;
}

void* ty_alloc(size_t count, size_t size)
{
    void* memory = zeroed_new(count, size);
    if (!memory)
        ty_memory_exhausted(count, size);
    return memory;
}

void* ty_try_alloc(size_t count, size_t size)
{
    return failure_is_due() ? NULL : zeroed_new(count, size);
}

// The old memory is freed only when the new one could be had.
static void* resized(void* memory, size_t old_count, size_t new_count, size_t size)
{
    void* grown = aligned_new(new_count, size);
    if (grown && memory)
    {
        memcpy(grown, memory, (old_count < new_count ? old_count : new_count) * size);
        free(memory);
    }
    return grown;
}

void* ty_grow(void* memory, size_t old_count, size_t new_count, size_t size)
{
    void* grown = resized(memory, old_count, new_count, size);
    if (!grown)
        ty_memory_exhausted(new_count, size);
    return grown;
}

void* ty_try_grow(void* memory, size_t old_count, size_t new_count, size_t size)
{
    return failure_is_due() ? NULL : resized(memory, old_count, new_count, size);
}

void ty_free(void* memory)
{
    free(memory);
}

char* ty_string_copy(const char* text)
{
    size_t size = strlen(text) + 1;
    return memcpy(ty_alloc(size, 1), text, size);
}

char* ty_string_format(const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    TY_ASSERT(length >= 0);
    char* text = ty_alloc((size_t)length + 1, 1);
    va_start(arguments, format);
    vsnprintf(text, (size_t)length + 1, format, arguments);
    va_end(arguments);
    return text;
}
