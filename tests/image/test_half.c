// SPDX-License-Identifier: Apache-2.0
// Half conversion against an independent definition: the nearest of all halves, found by search.
#include "base/cmocka_all.h"
#include <math.h>
#include <stdbool.h>
#include <tsuya/image/half.h>
#include <xmmintrin.h>

// The value by its definition, in double.
static double half_value(int half)
{
    int exponent = (half >> 10) & 31, mantissa = half & 1023;
    double value = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return half & 0x8000 ? -value : value;
}

static void test_all_halves_keep_their_bits(void** state)
{
    (void)state;
    for (int half = 0; half < 65536; half++)
    {
        float value = ty_half_to_float((uint16_t)half);
        bool special = ((half >> 10) & 31) == 31;
        if (!special)
            assert_true((double)value == half_value(half));
        if (special && (half & 1023))
        {
            assert_true(isnan(value));
            assert_true(isnan(ty_half_to_float(ty_half_from_float(value))));
        }
        else
            assert_int_equal(ty_half_from_float(value), half);
    }
    assert_true(isinf(ty_half_to_float(0x7c00)) && isinf(ty_half_to_float(0xfc00)));
}

// The nearest finite half of |value| by bisection over the ordered positive halves, ties to the even one.
static int nearest(double value)
{
    int low = 0, high = 0x7bff;
    while (high - low > 1)
    {
        int middle = (low + high) / 2;
        if (half_value(middle) <= value)
            low = middle;
        else
            high = middle;
    }
    double below = value - half_value(low), above = half_value(high) - value;
    return below < above || (below == above && low % 2 == 0) ? low : high;
}

static void check_float(float value)
{
    int expected = nearest(fabs((double)value)) | (signbit(value) ? 0x8000 : 0);
    assert_int_equal(ty_half_from_float(value), expected);
}

static void test_floats_round_to_nearest_even(void** state)
{
    (void)state;
    uint32_t random = 1;
    for (int i = 0; i < 300000; i++)
    {
        random = random * 1664525u + 1013904223u;
        float value;
        uint32_t bits = random;
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value))
            check_float(value);
        // and one in the range of halves
        bits = (random & 0x807fffffu) | (100u + (random >> 8) % 46u) << 23;
        memcpy(&value, &bits, sizeof value);
        check_float(value);
    }
    for (int half = 0; half < 0x7bff; half++) // the middles between neighbours, and the floats beside them
    {
        float middle = (float)((half_value(half) + half_value(half + 1)) / 2);
        check_float(middle);
        check_float(nextafterf(middle, 0.0f));
        check_float(-nextafterf(middle, 1e9f));
    }
}

static void test_the_finite_stays_finite(void** state)
{
    (void)state;
    assert_int_equal(ty_half_from_float(65504.0f), 0x7bff);
    assert_int_equal(ty_half_from_float(65520.0f), 0x7bff);
    assert_int_equal(ty_half_from_float(3e38f), 0x7bff);
    assert_int_equal(ty_half_from_float(-3e38f), 0xfbff);
    assert_int_equal(ty_half_from_float(INFINITY), 0x7c00);
    assert_int_equal(ty_half_from_float(-INFINITY), 0xfc00);
    assert_true(isnan(ty_half_to_float(ty_half_from_float(NAN))));
}

// Render threads flush denormals to zero; a denormal half must not become zero there.
static void test_flush_to_zero_changes_nothing(void** state)
{
    (void)state;
    unsigned saved = _mm_getcsr();
    _mm_setcsr(saved | 0x8040u);
    float smallest = ty_half_to_float(1);
    uint16_t back = ty_half_from_float(smallest);
    _mm_setcsr(saved);
    assert_true(smallest == 0x1p-24f);
    assert_int_equal(back, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_halves_keep_their_bits),
        cmocka_unit_test(test_floats_round_to_nearest_even),
        cmocka_unit_test(test_the_finite_stays_finite),
        cmocka_unit_test(test_flush_to_zero_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
