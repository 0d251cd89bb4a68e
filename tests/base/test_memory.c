// SPDX-License-Identifier: Apache-2.0
// The heap and the arena: alignment, zeros, overflow, failure on demand, marks, poison.
#include "alloc_sweep.h"
#include "cmocka_all.h"
#include "process.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/arena.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define WITH_ASAN 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define WITH_ASAN 1
#endif
#ifdef WITH_ASAN
#include <sanitizer/asan_interface.h>
#endif

// Sanitizers end the process at an impossible size unless told to answer as malloc does.
const char* __asan_default_options(void);
const char* __tsan_default_options(void);
const char* __asan_default_options(void)
{
    return "allocator_may_return_null=1";
}
const char* __tsan_default_options(void)
{
    return "allocator_may_return_null=1";
}

static bool is_zero(const void* memory, size_t size)
{
    const unsigned char* bytes = memory;
    for (size_t i = 0; i < size; i++)
        if (bytes[i])
            return false;
    return true;
}

static void test_alloc_is_zeroed_and_aligned(void** state)
{
    (void)state;
    for (size_t size = 1; size < 5000; size = size * 3 / 2 + 1)
    {
        // Twice, so that the second gets memory that is not fresh.
        for (int pass = 0; pass < 2; pass++)
        {
            unsigned char* memory = ty_alloc(size, 3);
            assert_int_equal((uintptr_t)memory % 64, 0);
            assert_true(is_zero(memory, 3 * size));
            memset(memory, 0xa5, 3 * size);
            ty_free(memory);
        }
    }
    void* empty = ty_alloc(0, 8);
    assert_non_null(empty);
    ty_free(empty);
    ty_free(NULL);
}

static void test_try_alloc_refuses_overflow(void** state)
{
    (void)state;
    assert_null(ty_try_alloc(SIZE_MAX / 2, 3));
    assert_null(ty_try_alloc(SIZE_MAX / 8 + 2, 8));
    assert_null(ty_try_alloc(SIZE_MAX, 1));
    int* kept = TY_ALLOC(int, 1);
    *kept = 41;
    assert_null(ty_try_grow(kept, 1, SIZE_MAX / 2, 4));
    assert_int_equal(*kept, 41); // the old memory is untouched
    ty_free(kept);
}

static void exhaust(void* context)
{
    ty_atomic_file file;
    if (ty_atomic_begin(&file, context, NULL))
        _exit(99);
    ty_free(ty_alloc(SIZE_MAX / 4, 1));
}

static void test_exhaustion_ends_with_one_line(void** state)
{
    (void)state;
    char folder[] = "/tmp/tsuya_memory_XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof(path), "%s/out.exr", folder);
    process_end end = process_run(exhaust, path);
    assert_int_equal(end.exit_status, TY_NO_MEMORY);
    const char* line = strstr(end.text, "tsuya: error: out of memory");
    assert_non_null(line);
    assert_non_null(strchr(line, '\n'));
    // The folder is empty again: the pending temporary went as well.
    assert_int_equal(rmdir(folder), 0);
}

static void test_grow_keeps_content(void** state)
{
    (void)state;
    uint32_t* numbers = NULL;
    size_t count = 0;
    for (size_t next = 1; next < 20000; next = next * 2 + 1)
    {
        numbers = ty_grow(numbers, count, next, sizeof(*numbers));
        assert_int_equal((uintptr_t)numbers % 64, 0);
        for (size_t i = 0; i < count; i++)
            assert_int_equal(numbers[i], i * 7);
        for (size_t i = count; i < next; i++)
            numbers[i] = (uint32_t)(i * 7);
        count = next;
    }
    numbers = ty_grow(numbers, count, 5, sizeof(*numbers));
    for (size_t i = 0; i < 5; i++)
        assert_int_equal(numbers[i], i * 7);
    ty_free(numbers);
}

static void test_strings(void** state)
{
    (void)state;
    char* copy = ty_string_copy("艶");
    assert_string_equal(copy, "艶");
    ty_free(copy);
    char* text = ty_string_format("%s-%04d", "grain", 42);
    assert_string_equal(text, "grain-0042");
    ty_free(text);
    char* empty = ty_string_format("%s", "");
    assert_string_equal(empty, "");
    ty_free(empty);
}

static void test_failure_on_demand(void** state)
{
    (void)state;
    ty_memory_fail_after(1);
    void* first = ty_try_alloc(1, 1);
    void* second = ty_try_alloc(1, 1);
    void* third = ty_try_alloc(1, 1);
    assert_non_null(first);
    assert_null(second);
    assert_non_null(third); // once only
    ty_memory_fail_after(0);
    void* sure = ty_alloc(1, 1); // not a ty_try_ call
    assert_non_null(sure);
    assert_null(ty_try_grow(NULL, 0, 4, 4));
    ty_memory_fail_after(-1);
    for (int i = 0; i < 10; i++)
    {
        void* memory = ty_try_alloc(1, 1);
        assert_non_null(memory);
        ty_free(memory);
    }
    ty_free(first);
    ty_free(third);
    ty_free(sure);
}

// Three checked allocations, in the way of a reader.
static ty_status three_allocations(void* context)
{
    int* parts = context;
    ty_status status = TY_OK;
    void* memory[3] = {NULL, NULL, NULL};
    for (int i = 0; i < 3 && !status; i++)
    {
        memory[i] = ty_try_alloc(8, 8);
        if (memory[i])
            ++*parts;
        else
            status = TY_NO_MEMORY;
    }
    for (int i = 0; i < 3; i++)
        ty_free(memory[i]);
    return status;
}

static ty_status swallows_failure(void* context)
{
    void* memory = ty_try_alloc(8, 8);
    ty_free(memory);
    return memory || context ? TY_OK : TY_BAD_FILE;
}

static void test_sweep(void** state)
{
    (void)state;
    int parts = 0;
    assert_int_equal(ty_alloc_sweep(three_allocations, &parts), 3);
    assert_int_equal(parts, 0 + 1 + 2 + 3);
    assert_int_equal(ty_alloc_sweep(swallows_failure, NULL), -1);
}

static void test_arena_content(void** state)
{
    (void)state;
    ty_arena* arena = ty_arena_create(256);
    enum
    {
        allocations = 200
    };
    unsigned char* parts[allocations];
    for (int pass = 0; pass < 3; pass++)
    {
        for (int i = 0; i < allocations; i++)
        {
            size_t size = (size_t)(i * i % 700);
            parts[i] = ty_arena_alloc(arena, size, 1);
            assert_int_equal((uintptr_t)parts[i] % 16, 0);
            assert_true(is_zero(parts[i], size)); // also after a reset
            memset(parts[i], i & 0xff, size);
        }
        for (int i = 0; i < allocations; i++)
            for (int k = 0; k < i * i % 700; k++)
                assert_int_equal(parts[i][k], i & 0xff); // nobody wrote over it
        ty_arena_reset(arena);
    }
    ty_arena_destroy(arena);
    ty_arena_destroy(NULL);
}

static void test_arena_keeps_blocks(void** state)
{
    (void)state;
    ty_arena* arena = ty_arena_create(0);
    void* first = ty_arena_alloc(arena, 100, 1);
    void* large = ty_arena_alloc(arena, 1000000, 1);
    void* third = ty_arena_alloc(arena, 60000, 1);
    ty_arena_reset(arena);
    assert_ptr_equal(ty_arena_alloc(arena, 100, 1), first);
    assert_ptr_equal(ty_arena_alloc(arena, 1000000, 1), large);
    assert_ptr_equal(ty_arena_alloc(arena, 60000, 1), third);
    // Another order makes do with the same blocks.
    ty_arena_reset(arena);
    assert_ptr_equal(ty_arena_alloc(arena, 60000, 1), first);
    assert_ptr_equal(ty_arena_alloc(arena, 900000, 1), large);
    ty_arena_destroy(arena);
}

static void test_arena_marks(void** state)
{
    (void)state;
    ty_arena* arena = ty_arena_create(128);
    ty_arena_mark empty = ty_arena_begin(arena);
    char* kept = ty_arena_string(arena, "kept");
    ty_arena_mark mark = ty_arena_begin(arena);
    void* after = ty_arena_alloc(arena, 8, 1);
    for (int i = 0; i < 50; i++)
        ty_arena_alloc(arena, 100, 1);
    ty_arena_end(arena, mark);
    assert_string_equal(kept, "kept");
    assert_ptr_equal(ty_arena_alloc(arena, 8, 1), after);
    ty_arena_end(arena, empty);
    assert_ptr_equal(ty_arena_alloc(arena, 5, 1), kept);
    assert_string_equal(ty_arena_format(arena, "%d/%s", 12, "x"), "12/x");
    ty_arena_destroy(arena);
}

static void arena_overflow(void* context)
{
    ty_arena_alloc(context, SIZE_MAX / 4 + 2, 4); // wraps to 4 bytes
}

static void test_arena_overflow_is_exhaustion(void** state)
{
    (void)state;
    ty_arena* arena = ty_arena_create(0);
    assert_int_equal(process_run(arena_overflow, arena).exit_status, TY_NO_MEMORY);
    ty_arena_destroy(arena);
}

#ifdef WITH_ASAN
static void test_arena_poison(void** state)
{
    (void)state;
    ty_arena* arena = ty_arena_create(4096);
    ty_arena_alloc(arena, 16, 1);
    ty_arena_mark mark = ty_arena_begin(arena);
    char* part = ty_arena_alloc(arena, 24, 1);
    assert_false(__asan_address_is_poisoned(part));
    assert_false(__asan_address_is_poisoned(part + 23));
    assert_true(__asan_address_is_poisoned(part + 24)); // the gap behind
    assert_true(__asan_address_is_poisoned(part - 1));  // and before
    ty_arena_end(arena, mark);
    assert_true(__asan_address_is_poisoned(part));
    char* again = ty_arena_alloc(arena, 24, 1);
    assert_ptr_equal(again, part);
    assert_false(__asan_address_is_poisoned(part));
    ty_arena_reset(arena);
    assert_true(__asan_address_is_poisoned(part));
    ty_arena_destroy(arena);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_alloc_is_zeroed_and_aligned),
        cmocka_unit_test(test_try_alloc_refuses_overflow),
        cmocka_unit_test(test_exhaustion_ends_with_one_line),
        cmocka_unit_test(test_grow_keeps_content),
        cmocka_unit_test(test_strings),
        cmocka_unit_test(test_failure_on_demand),
        cmocka_unit_test(test_sweep),
        cmocka_unit_test(test_arena_content),
        cmocka_unit_test(test_arena_keeps_blocks),
        cmocka_unit_test(test_arena_marks),
        cmocka_unit_test(test_arena_overflow_is_exhaustion),
#ifdef WITH_ASAN
        cmocka_unit_test(test_arena_poison),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
