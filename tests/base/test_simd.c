// SPDX-License-Identifier: Apache-2.0
// The sixteen-wide operations: those of the build against plain arithmetic, bit for bit.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include <stdbool.h>
#include <string.h>
#include <tsuya/base/rng.h>
#include <tsuya/base/simd.h>

typedef struct lanes
{
    _Alignas(64) float v[TY_LANES];
} lanes;

static float any_float(ty_rng* rng)
{
    static const float special[] = {0.0f, -0.0f, 1.0f, -1.0f, INFINITY, -INFINITY, NAN, 1e-38f, 3e38f};
    uint32_t pick = (uint32_t)(ty_rng_float(rng) * 40.0f);
    if (pick < sizeof special / sizeof special[0])
        return special[pick];
    return (ty_rng_float(rng) - 0.5f) * (pick % 2 ? 1e-6f : 1e6f);
}

static void same(ty_f16 value, const lanes* expected)
{
    lanes got;
    ty_f16_store(got.v, value);
    for (int i = 0; i < TY_LANES; i++)
    {
        bool both_nan = isnan(got.v[i]) && isnan(expected->v[i]);
        assert_true(both_nan || memcmp(&got.v[i], &expected->v[i], sizeof(float)) == 0);
    }
}

#define CHECK(operation, expression)                                                                                   \
    do                                                                                                                 \
    {                                                                                                                  \
        lanes expected;                                                                                                \
        for (int i = 0; i < TY_LANES; i++)                                                                             \
        {                                                                                                              \
            float x = a.v[i], y = b.v[i], z = c.v[i];                                                                  \
            (void)(y + z);                                                                                             \
            expected.v[i] = (expression);                                                                              \
        }                                                                                                              \
        same(operation, &expected);                                                                                    \
    } while (0)

static void operations_are_plain_arithmetic(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make((ty_seed){31}, 0, 0);
    for (int round = 0; round < 2000; round++)
    {
        lanes a, b, c;
        for (int i = 0; i < TY_LANES; i++)
        {
            a.v[i] = any_float(&rng);
            b.v[i] = any_float(&rng);
            c.v[i] = any_float(&rng);
        }
        ty_f16 va = ty_f16_load(a.v), vb = ty_f16_load(b.v), vc = ty_f16_load(c.v);
        CHECK(va, x);
        lanes third;
        for (int i = 0; i < TY_LANES; i++)
            third.v[i] = a.v[3];
        same(ty_f16_set(a.v[3]), &third);
        CHECK(ty_f16_add(va, vb), x + y);
        CHECK(ty_f16_sub(va, vb), x - y);
        CHECK(ty_f16_mul(va, vb), x * y);
        CHECK(ty_f16_div(va, vb), x / y);
        CHECK(ty_f16_sqrt(va), sqrtf(x));
        CHECK(ty_f16_abs(va), fabsf(x));
        CHECK(ty_f16_min(va, vb), x < y ? x : y);
        CHECK(ty_f16_max(va, vb), x > y ? x : y);
        CHECK(ty_f16_fma(va, vb, vc), fmaf(x, y, z));
        CHECK(ty_f16_fms(va, vb, vc), fmaf(x, y, -z));
        CHECK(ty_f16_fnma(va, vb, vc), fmaf(-x, y, z));
        CHECK(ty_f16_dot3(va, vb, vc, va, vb, vc), fmaf(x, y, fmaf(z, x, y * z)));
        uint32_t le = 0, lt = 0;
        for (int i = 0; i < TY_LANES; i++)
        {
            le |= (uint32_t)(a.v[i] <= b.v[i]) << i;
            lt |= (uint32_t)(a.v[i] < b.v[i]) << i;
        }
        assert_int_equal(ty_f16_le(va, vb), le);
        assert_int_equal(ty_f16_lt(va, vb), lt);
        _Alignas(64) uint32_t numbers[TY_LANES];
        uint32_t equal = 0;
        for (int i = 0; i < TY_LANES; i++)
        {
            numbers[i] = 0xfffffffcu + (uint32_t)(ty_rng_float(&rng) * 8.0f);
            equal |= (uint32_t)(numbers[i] == 0xffffffffu) << i;
        }
        assert_int_equal(ty_u32_equal16(numbers, 0xffffffffu), equal);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(operations_are_plain_arithmetic)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
