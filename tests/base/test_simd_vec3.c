// SPDX-License-Identifier: Apache-2.0
// Vectors in a register: those of the build against math.h, bit for bit.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include <string.h>
#include <tsuya/base/rng.h>
#include <tsuya/base/simd_vec3.h>

static ty_vec3 any_vector(ty_rng* rng)
{
    float v[3];
    for (int i = 0; i < 3; i++)
    {
        float u = ty_rng_float(rng);
        v[i] = u < 0.05f ? 0.0f : u < 0.1f ? -1.0f : (ty_rng_float(rng) - 0.5f) * (u < 0.5f ? 1e-6f : 1e6f);
    }
    return (ty_vec3){v[0], v[1], v[2]};
}

static void same(ty_f4 value, ty_vec3 expected)
{
    // What lies behind stays as it is.
    struct
    {
        ty_vec3 v;
        float next;
    } got = {.next = 7.0f};
    ty_f4_store(&got.v, value);
    assert_memory_equal(&got.v, &expected, sizeof expected);
    assert_true(got.next == 7.0f);
}

static void operations_are_those_of_vectors(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make((ty_seed){33}, 0, 0);
    for (int i = 0; i < 5000; i++)
    {
        ty_vec3 a = any_vector(&rng), b = any_vector(&rng), c = any_vector(&rng);
        ty_affine m = {a, b, c, {0, 0, 0}};
        ty_f4 va = ty_f4_load(&a), vb = ty_f4_load(&b), vc = ty_f4_load(&c);
        ty_f4_columns columns = ty_f4_columns_of(&m);
        ty_vec3 magnitude = {fabsf(a.x), fabsf(a.y), fabsf(a.z)};
        same(va, a);
        same(ty_f4_set(a.y), ty_vec3_make(a.y, a.y, a.y));
        same(ty_f4_xxx(va), ty_vec3_make(a.x, a.x, a.x));
        same(ty_f4_yyy(va), ty_vec3_make(a.y, a.y, a.y));
        same(ty_f4_zzz(va), ty_vec3_make(a.z, a.z, a.z));
        same(ty_f4_yzx(va), ty_vec3_make(a.y, a.z, a.x));
        same(ty_f4_add(va, vb), ty_add(a, b));
        same(ty_f4_sub(va, vb), ty_sub(a, b));
        same(ty_f4_mul(va, vb), ty_mul3(a, b));
        same(ty_f4_abs(va), magnitude);
        same(ty_f4_max(va, vb), ty_max3(a, b));
        same(ty_f4_mad(va, vb, ty_f4_set(c.x)), ty_mad(a, b, c.x));
        same(ty_f4_cross(va, vb), ty_cross(a, b));
        same(ty_f4_map_vector(&columns, vc), ty_map_vector(&m, c));
        assert_true(ty_f4_x(va) == a.x);
        assert_true(ty_f4_dot(va, vb) == ty_dot(a, b));
        assert_true(ty_f4_largest(va) == ty_max(a.x, ty_max(a.y, a.z)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(operations_are_those_of_vectors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
