// SPDX-License-Identifier: Apache-2.0
// Content hashes against published values; random streams: known values, uniformity, independence.
#include "cmocka_all.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/hash.h>
#include <tsuya/base/rng.h>

static void assert_hash(const void* bytes, size_t size, const char* expected)
{
    char hex[33];
    ty_hash_hex(ty_hash_bytes(bytes, size), hex);
    assert_string_equal(hex, expected);
}

// As `xxhsum -H2` prints them.
static void test_hash_known(void** state)
{
    (void)state;
    assert_hash("", 0, "99aa06d3014798d86001c324468d497f");
    assert_hash("abc", 3, "06b05ab6733a618578af5f94892f3950");
    assert_hash("The quick brown fox jumps over the lazy dog", 43, "ddd650205ca3e7fa24a1cc2e3a8a7651");
}

static void test_hash_stream_is_the_whole(void** state)
{
    (void)state;
    uint8_t bytes[5000];
    for (size_t i = 0; i < sizeof(bytes); i++)
        bytes[i] = (uint8_t)(i * 31 + i / 7);
    ty_hash whole = ty_hash_bytes(bytes, sizeof(bytes));
    for (size_t step = 1; step < sizeof(bytes); step = step * 3 + 1)
    {
        ty_hasher* hasher = ty_hasher_create();
        ty_hasher_add(hasher, NULL, 0);
        for (size_t at = 0; at < sizeof(bytes); at += step)
            ty_hasher_add(hasher, bytes + at, sizeof(bytes) - at < step ? sizeof(bytes) - at : step);
        ty_hash streamed = ty_hasher_end(hasher);
        assert_true(streamed.low == whole.low && streamed.high == whole.high);
    }
    ty_hasher_destroy(ty_hasher_create());
    ty_hasher_destroy(NULL);
}

static ty_hash hash_of_strings(const char* a, const char* b)
{
    ty_hasher* hasher = ty_hasher_create();
    ty_hasher_add_string(hasher, a);
    ty_hasher_add_string(hasher, b);
    return ty_hasher_end(hasher);
}

static void test_hash_strings_have_borders(void** state)
{
    (void)state;
    ty_hash first = hash_of_strings("a", "bc"), second = hash_of_strings("ab", "c"), again = hash_of_strings("a", "bc");
    assert_true(first.low != second.low && first.high != second.high);
    assert_true(first.low == again.low && first.high == again.high);
    // The length is eight bytes, least first, on any machine.
    ty_hash spelled = ty_hash_bytes("\1\0\0\0\0\0\0\0a\2\0\0\0\0\0\0\0bc", 19);
    assert_true(first.low == spelled.low && first.high == spelled.high);
}

static void test_rng_known(void** state)
{
    (void)state;
    // splitmix64 with state 0, as published by its author, is mix64 of multiples of the golden gamma.
    ty_rng plain = {0, 0};
    assert_true(ty_rng_u64(&plain) == 0xe220a8397b1dcdafull);
    assert_true(ty_rng_u64(&plain) == 0x6e789e6aa1b965f4ull);
    assert_true(ty_rng_u64(&plain) == 0x06c45d188009454full);
    assert_true(ty_mix32(0) == 0 && ty_mix32(1) == 0x688990c0u);
    ty_rng keyed = ty_rng_make((ty_seed){7}, 1, 2);
    assert_true(ty_rng_u64(&keyed) == 0xf06057fb5be4091aull);
}

static void test_rng_is_a_function_of_the_counter(void** state)
{
    (void)state;
    ty_rng a = ty_rng_make((ty_seed){3}, 4, 5);
    uint64_t values[100];
    for (int i = 0; i < 100; i++)
        values[i] = ty_rng_u64(&a);
    for (int i = 99; i >= 0; i--)
    {
        ty_rng at = ty_rng_make((ty_seed){3}, 4, 5);
        at.counter = (uint64_t)i;
        assert_true(ty_rng_u64(&at) == values[i]);
    }
}

// chi^2 with 255 degrees of freedom: mean 255, deviation 22.6.
static double chi_squared(const uint32_t counts[256], double expected)
{
    double sum = 0.0;
    for (int i = 0; i < 256; i++)
        sum += (counts[i] - expected) * (counts[i] - expected) / expected;
    return sum;
}

static void test_rng_is_uniform(void** state)
{
    (void)state;
    enum
    {
        count = 1 << 20
    };
    uint32_t top[256] = {0}, low[256] = {0}, pairs[256] = {0};
    ty_rng rng = ty_rng_make((ty_seed){1}, 0, 0);
    uint32_t before = 0;
    double sum = 0.0, product = 0.0, last = 0.5;
    for (int i = 0; i < count; i++)
    {
        uint32_t x = ty_rng_u32(&rng);
        double u = (double)ty_u32_to_float(x);
        assert_true(u >= 0.0 && u < 1.0);
        top[x >> 24]++;
        low[x & 255]++;
        pairs[(before >> 28) << 4 | x >> 28]++;
        sum += u;
        product += (u - 0.5) * (last - 0.5);
        last = u;
        before = x;
    }
    assert_true(fabs(chi_squared(top, count / 256.0) - 255.0) < 4.5 * 22.6);
    assert_true(fabs(chi_squared(low, count / 256.0) - 255.0) < 4.5 * 22.6);
    assert_true(fabs(chi_squared(pairs, count / 256.0) - 255.0) < 4.5 * 22.6);
    assert_true(fabs(sum / count - 0.5) < 4.0 * 0.2887 / sqrt(count));
    assert_true(fabs(product / count) < 4.0 * 0.0833 / sqrt(count));
}

// The first number of neighbouring streams (pixels, grains) must look as random as one stream does.
static void test_rng_streams_are_independent(void** state)
{
    (void)state;
    enum
    {
        side = 1024
    };
    uint32_t values[256] = {0}, across[256] = {0}, down[256] = {0}, seeds[256] = {0};
    for (uint64_t a = 0; a < side; a++)
        for (uint64_t b = 0; b < side; b++)
        {
            ty_rng here = ty_rng_make((ty_seed){9}, a, b), right = ty_rng_make((ty_seed){9}, a + 1, b);
            ty_rng below = ty_rng_make((ty_seed){9}, a, b + 1), other = ty_rng_make((ty_seed){10}, a, b);
            uint32_t x = ty_rng_u32(&here);
            values[x >> 24]++;
            across[(x >> 28) << 4 | ty_rng_u32(&right) >> 28]++;
            down[(x >> 28) << 4 | ty_rng_u32(&below) >> 28]++;
            seeds[(x >> 28) << 4 | ty_rng_u32(&other) >> 28]++;
        }
    double expected = side * side / 256.0;
    assert_true(fabs(chi_squared(values, expected) - 255.0) < 4.5 * 22.6);
    assert_true(fabs(chi_squared(across, expected) - 255.0) < 4.5 * 22.6);
    assert_true(fabs(chi_squared(down, expected) - 255.0) < 4.5 * 22.6);
    assert_true(fabs(chi_squared(seeds, expected) - 255.0) < 4.5 * 22.6);
}

static void test_rng_float_and_range(void** state)
{
    (void)state;
    assert_true(ty_u32_to_float(0) == 0.0f);
    assert_true(ty_u32_to_float(UINT32_MAX) < 1.0f);
    assert_true(ty_u32_to_float(0x80000000u) == 0.5f);
    ty_rng rng = ty_rng_make((ty_seed){2}, 0, 0);
    float least = 100.0f, most = -100.0f;
    for (int i = 0; i < 100000; i++)
    {
        float x = ty_rng_range(&rng, -3.0f, 5.0f);
        least = x < least ? x : least;
        most = x > most ? x : most;
    }
    assert_true(least >= -3.0f && least < -2.99f && most < 5.0f && most > 4.99f);
}

// lowbias32 and splitmix64's finaliser are permutations whose input bits each flip half of the output.
static void test_mix_avalanche(void** state)
{
    (void)state;
    for (int bit = 0; bit < 32; bit++)
    {
        double flips32 = 0.0, flips64 = 0.0;
        for (uint32_t i = 0; i < 4096; i++)
        {
            uint32_t x = ty_mix32(i * 0x9e3779b9u);
            uint64_t y = ty_mix64(i * 0x9e3779b97f4a7c15ull);
            flips32 += __builtin_popcount(ty_mix32(x) ^ ty_mix32(x ^ 1u << bit));
            flips64 += __builtin_popcountll(ty_mix64(y) ^ ty_mix64(y ^ 1ull << 2 * bit));
        }
        assert_true(fabs(flips32 / 4096.0 - 16.0) < 0.3);
        assert_true(fabs(flips64 / 4096.0 - 32.0) < 0.4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hash_known),
        cmocka_unit_test(test_hash_stream_is_the_whole),
        cmocka_unit_test(test_hash_strings_have_borders),
        cmocka_unit_test(test_rng_known),
        cmocka_unit_test(test_rng_is_a_function_of_the_counter),
        cmocka_unit_test(test_rng_is_uniform),
        cmocka_unit_test(test_rng_streams_are_independent),
        cmocka_unit_test(test_rng_float_and_range),
        cmocka_unit_test(test_mix_avalanche),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
