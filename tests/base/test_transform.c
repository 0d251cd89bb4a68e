// SPDX-License-Identifier: Apache-2.0
// Vectors, frames, affine maps, quaternions and bounds: identities over random input.
#include "cmocka_all.h"
#include <tsuya/base/math.h>
#include <tsuya/base/rng.h>

static const ty_seed seed = {20240229};

static ty_vec3 random_vector(ty_rng* rng, float size)
{
    float x = ty_rng_range(rng, -size, size), y = ty_rng_range(rng, -size, size), z = ty_rng_range(rng, -size, size);
    return (ty_vec3){x, y, z};
}

static ty_quat random_quat(ty_rng* rng)
{
    float u1 = ty_rng_float(rng), u2 = ty_rng_float(rng), u3 = ty_rng_float(rng);
    return ty_quat_uniform(u1, u2, u3);
}

static float distance(ty_vec3 a, ty_vec3 b)
{
    return ty_length(ty_sub(a, b));
}

static void assert_near(ty_vec3 a, ty_vec3 b, float tolerance)
{
    if (!(distance(a, b) <= tolerance))
        fail_msg("(%g %g %g) is not (%g %g %g)", (double)a.x, (double)a.y, (double)a.z, (double)b.x, (double)b.y,
                 (double)b.z);
}

static float quat_length(ty_quat q)
{
    return sqrtf(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
}

static void test_frame(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make(seed, 1, 0);
    for (int i = 0; i < 2000; i++)
    {
        ty_vec3 n = ty_normalize(random_vector(&rng, 1.0f));
        if (i < 2)
            n = (ty_vec3){0, 0, i ? -1.0f : 1.0f};
        ty_frame f = ty_frame_from_normal(n);
        assert_true(fabsf(ty_dot(f.t, f.b)) < 1e-6f && fabsf(ty_dot(f.t, n)) < 1e-6f);
        assert_near(ty_cross(f.t, f.b), n, 2e-6f); // right-handed and of unit length
        ty_vec3 v = random_vector(&rng, 3.0f);
        assert_near(ty_to_world(f, ty_to_local(f, v)), v, 4e-6f);
        assert_near(ty_to_local(f, n), (ty_vec3){0, 0, 1}, 1e-6f);
    }
}

static void test_vectors(void** state)
{
    (void)state;
    assert_near(ty_normalize((ty_vec3){0, 0, 0}), (ty_vec3){0, 0, 0}, 0.0f);
    assert_near(ty_cross((ty_vec3){1, 0, 0}, (ty_vec3){0, 1, 0}), (ty_vec3){0, 0, 1}, 0.0f);
    assert_near(ty_reflect((ty_vec3){1, 2, 3}, (ty_vec3){0, 0, 1}), (ty_vec3){-1, -2, 3}, 0.0f);
    assert_near(ty_lerp3((ty_vec3){0, 2, 4}, (ty_vec3){2, 2, 0}, 0.25f), (ty_vec3){0.5f, 2, 3}, 1e-6f);
    assert_true(fabsf(ty_luminance((ty_rgb){1, 1, 1}) - 1.0f) < 1e-6f);
    assert_true(ty_safe_sqrt(-1e-9f) == 0.0f);
    assert_true(ty_clamp(3, 0, 1) == 1 && ty_clamp(-3, 0, 1) == 0 && ty_clamp(0.5f, 0, 1) == 0.5f);
    assert_false(ty_is_finite3((ty_vec3){0, INFINITY, 0}));
    assert_true(fabsf(ty_radians(180.0f) - TY_PI) < 1e-6f);
}

static ty_affine random_affine(ty_rng* rng, float scale)
{
    return (ty_affine){random_vector(rng, scale), random_vector(rng, scale), random_vector(rng, scale),
                       random_vector(rng, 10.0f)};
}

static void test_affine_inverse(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make(seed, 2, 0);
    int inverted = 0;
    for (int i = 0; i < 5000; i++)
    {
        float scale = ty_pow(10.0f, ty_rng_range(&rng, -4.0f, 4.0f));
        ty_affine m = random_affine(&rng, scale), inverse;
        float shape = fabsf(ty_affine_determinant(&m)) / (ty_length(m.x) * ty_length(m.y) * ty_length(m.z));
        if (shape < 0.05f)
            continue;
        assert_true(ty_affine_invert(&m, &inverse));
        ty_vec3 p = random_vector(&rng, 1.0f);
        assert_near(ty_map_vector(&inverse, ty_map_vector(&m, p)), p, 1e-4f);
        assert_near(ty_map_point(&m, ty_map_point(&inverse, p)), p, 1e-4f * (10.0f + scale));
        ty_affine product = ty_affine_multiply(&inverse, &m);
        assert_near(product.x, (ty_vec3){1, 0, 0}, 1e-4f);
        assert_near(product.z, (ty_vec3){0, 0, 1}, 1e-4f);
        assert_near(product.t, (ty_vec3){0, 0, 0}, 1e-4f * (1.0f + 10.0f / scale));
        inverted++;
    }
    assert_true(inverted > 4000);
}

static void test_affine_singular(void** state)
{
    (void)state;
    const ty_affine marker = ty_affine_identity();
    ty_affine inverse = marker;
    const ty_affine bad[] = {
        {{1, 2, 3}, {2, 4, 6}, {0, 0, 1}, {0, 0, 0}},
        {{0.1f, 0.2f, 0.3f}, {0.7f, 1.4f, 2.1f}, {0.3f, -0.4f, 0.2f}, {0, 0, 0}},
        {{1, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}},
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
        {{NAN, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}},
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {NAN, 0, 0}},
        {{INFINITY, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}},
        {{1, 0, 0}, {0.1f, 0.7f, 0}, {0.3f, 2.1f, 0}, {0, 0, 0}},
    };
    for (size_t i = 0; i < sizeof(bad) / sizeof(bad[0]); i++)
    {
        assert_false(ty_affine_invert(&bad[i], &inverse));
        assert_memory_equal(&inverse, &marker, sizeof(inverse));
    }
    // Small and flat is not singular.
    const ty_affine flat = {{1e-3f, 0, 0}, {0, 1e-9f, 0}, {0, 0, 1e3f}, {1, 2, 3}};
    assert_true(ty_affine_invert(&flat, &inverse));
    assert_near(ty_map_point(&inverse, (ty_vec3){1, 2, 3}), (ty_vec3){0, 0, 0}, 1e-5f);
}

static void test_normals_follow_the_inverse_transpose(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make(seed, 3, 0);
    for (int i = 0; i < 500; i++)
    {
        ty_affine m = random_affine(&rng, 1.0f), inverse;
        if (fabsf(ty_affine_determinant(&m)) < 0.1f || !ty_affine_invert(&m, &inverse))
            continue;
        ty_vec3 u = random_vector(&rng, 1.0f), v = random_vector(&rng, 1.0f), n = ty_cross(u, v);
        ty_vec3 mapped = ty_normalize(ty_map_transpose(&inverse, n));
        assert_true(fabsf(ty_dot(mapped, ty_normalize(ty_map_vector(&m, u)))) < 1e-4f);
        assert_true(fabsf(ty_dot(mapped, ty_normalize(ty_map_vector(&m, v)))) < 1e-4f);
    }
}

static void test_quat_axis_angle(void** state)
{
    (void)state;
    ty_quat quarter = ty_quat_axis_angle((ty_vec3){0, 0, 1}, 0.5f * TY_PI);
    assert_near(ty_quat_rotate(quarter, (ty_vec3){1, 0, 0}), (ty_vec3){0, 1, 0}, 1e-6f);
    assert_near(ty_quat_rotate(quarter, (ty_vec3){0, 1, 0}), (ty_vec3){-1, 0, 0}, 1e-6f);
    ty_rng rng = ty_rng_make(seed, 4, 0);
    for (int i = 0; i < 1000; i++)
    {
        ty_vec3 axis = ty_normalize(random_vector(&rng, 1.0f)), v = random_vector(&rng, 2.0f);
        float angle = ty_rng_range(&rng, -7.0f, 7.0f);
        // Rodrigues' formula
        ty_vec3 expected = ty_mul(v, ty_cos(angle));
        expected = ty_mad(expected, ty_cross(axis, v), ty_sin(angle));
        expected = ty_mad(expected, axis, ty_dot(axis, v) * (1.0f - ty_cos(angle)));
        assert_near(ty_quat_rotate(ty_quat_axis_angle(axis, angle), v), expected, 4e-6f);
    }
}

static void test_quat_against_matrices(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make(seed, 5, 0);
    for (int i = 0; i < 2000; i++)
    {
        ty_quat a = random_quat(&rng), b = random_quat(&rng);
        ty_vec3 v = random_vector(&rng, 1.0f), one = {1, 1, 1}, none = {0, 0, 0};
        ty_affine ma = ty_affine_from_trs(none, a, one), mb = ty_affine_from_trs(none, b, one);
        assert_true(fabsf(ty_affine_determinant(&ma) - 1.0f) < 4e-6f);
        assert_near(ty_map_vector(&ma, v), ty_quat_rotate(a, v), 2e-6f);
        ty_affine both = ty_affine_multiply(&ma, &mb);
        ty_quat product = ty_quat_multiply(a, b);
        assert_near(ty_map_vector(&both, v), ty_quat_rotate(product, v), 4e-6f);
        // Back from the matrix: the same rotation, up to the sign.
        ty_quat back = ty_quat_from_columns(ma.x, ma.y, ma.z);
        float same = back.x * a.x + back.y * a.y + back.z * a.z + back.w * a.w;
        assert_true(fabsf(fabsf(same) - 1.0f) < 2e-6f);
        assert_true(fabsf(quat_length(back) - 1.0f) < 1e-6f);
    }
}

// Half turns are where a formula that divides by w breaks down.
static void test_quat_from_half_turns(void** state)
{
    (void)state;
    const ty_vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6f, 0.8f, 0}, {0, 0.6f, 0.8f}, {0.8f, 0, -0.6f}};
    for (int i = 0; i < 6; i++)
    {
        ty_quat q = {axes[i].x, axes[i].y, axes[i].z, 0};
        ty_affine m = ty_affine_from_trs((ty_vec3){0, 0, 0}, q, (ty_vec3){1, 1, 1});
        ty_quat back = ty_quat_from_columns(m.x, m.y, m.z);
        assert_true(fabsf(fabsf(back.x * q.x + back.y * q.y + back.z * q.z) - 1.0f) < 1e-6f);
    }
}

static void test_quat_euler_order(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make(seed, 6, 0);
    for (int i = 0; i < 500; i++)
    {
        ty_vec3 e = random_vector(&rng, 4.0f), v = random_vector(&rng, 1.0f);
        ty_vec3 r = ty_quat_rotate(ty_quat_axis_angle((ty_vec3){1, 0, 0}, e.x), v);
        r = ty_quat_rotate(ty_quat_axis_angle((ty_vec3){0, 1, 0}, e.y), r);
        r = ty_quat_rotate(ty_quat_axis_angle((ty_vec3){0, 0, 1}, e.z), r);
        assert_near(ty_quat_rotate(ty_quat_euler(e), v), r, 4e-6f);
    }
}

static void test_quat_normalize(void** state)
{
    (void)state;
    ty_quat q = ty_quat_normalize((ty_quat){0, 3, 0, 4});
    assert_true(fabsf(q.y - 0.6f) < 1e-6f && fabsf(q.w - 0.8f) < 1e-6f);
    q = ty_quat_normalize((ty_quat){0, 0, 0, 0});
    assert_true(q.w == 1.0f);
}

// Uniform over rotations: the images of an axis have mean zero and covariance one third, and the angle between two
// rotations has the density (1 - cos a) / pi, of mean pi/2 + 2/pi.
static void test_quat_uniform(void** state)
{
    (void)state;
    enum
    {
        count = 200000
    };
    ty_rng rng = ty_rng_make(seed, 7, 0);
    double mean[3] = {0}, square[3] = {0}, angle = 0.0;
    for (int i = 0; i < count; i++)
    {
        ty_quat q = random_quat(&rng);
        assert_true(fabsf(quat_length(q) - 1.0f) < 1e-6f);
        ty_vec3 v = ty_quat_rotate(q, (ty_vec3){1, 0, 0});
        mean[0] += (double)v.x, mean[1] += (double)v.y, mean[2] += (double)v.z;
        square[0] += (double)(v.x * v.x), square[1] += (double)(v.y * v.y), square[2] += (double)(v.z * v.z);
        angle += 2.0 * (double)ty_acos(fabsf(q.w));
    }
    for (int i = 0; i < 3; i++)
    {
        assert_true(fabs(mean[i] / count) < 4.0 * 0.577 / sqrt(count));
        assert_true(fabs(square[i] / count - 1.0 / 3.0) < 4.0 * 0.298 / sqrt(count));
    }
    double expected = 3.14159265 / 2.0 + 2.0 / 3.14159265;
    assert_true(fabs(angle / count - expected) < 4.0 * 0.65 / sqrt(count));
}

static void test_trs_order(void** state)
{
    (void)state;
    ty_quat quarter = ty_quat_axis_angle((ty_vec3){0, 1, 0}, 0.5f * TY_PI);
    ty_affine m = ty_affine_from_trs((ty_vec3){10, 20, 30}, quarter, (ty_vec3){2, 3, 4});
    // Scaled, then turned, then moved.
    assert_near(ty_map_point(&m, (ty_vec3){1, 0, 0}), (ty_vec3){10, 20, 28}, 1e-5f);
    assert_near(ty_map_point(&m, (ty_vec3){0, 1, 0}), (ty_vec3){10, 23, 30}, 1e-5f);
    assert_near(ty_map_point(&m, (ty_vec3){0, 0, 1}), (ty_vec3){14, 20, 30}, 1e-5f);
    assert_true(fabsf(ty_affine_determinant(&m) - 24.0f) < 1e-4f);
}

static void test_look_at(void** state)
{
    (void)state;
    ty_vec3 position = {1, 2, 3}, target = {-2, 0.5f, 1}, up = {0, 1, 0};
    ty_affine m = ty_affine_look_at(position, target, up);
    ty_vec3 forward = ty_normalize(ty_sub(target, position));
    assert_near(ty_map_vector(&m, (ty_vec3){0, 0, -1}), forward, 1e-6f);
    assert_near(ty_map_point(&m, (ty_vec3){0, 0, 0}), position, 0.0f);
    assert_true(fabsf(m.x.y) < 1e-6f && m.y.y > 0.0f); // the horizon is level, up is up
    assert_true(fabsf(ty_affine_determinant(&m) - 1.0f) < 2e-6f);
    const ty_vec3 hard_targets[] = {{1, 9, 3}, {1, -9, 3}, {1, 2, 3}};
    for (int i = 0; i < 3; i++)
    {
        m = ty_affine_look_at(position, hard_targets[i], up);
        assert_true(fabsf(ty_affine_determinant(&m) - 1.0f) < 2e-6f);
    }
}

static void test_bounds(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make(seed, 8, 0);
    for (int i = 0; i < 500; i++)
    {
        ty_affine m = random_affine(&rng, 2.0f);
        ty_bounds box = ty_bounds_empty(), corners = ty_bounds_empty();
        box = ty_bounds_add(box, random_vector(&rng, 1.0f));
        box = ty_bounds_add(box, random_vector(&rng, 1.0f));
        for (int k = 0; k < 8; k++)
        {
            ty_vec3 p = {k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                         k & 4 ? box.high.z : box.low.z};
            corners = ty_bounds_add(corners, ty_map_point(&m, p));
        }
        ty_bounds mapped = ty_bounds_map(&m, box);
        assert_near(mapped.low, corners.low, 1e-5f);
        assert_near(mapped.high, corners.high, 1e-5f);
    }
    ty_affine m = random_affine(&rng, 2.0f);
    ty_bounds empty = ty_bounds_map(&m, ty_bounds_empty());
    assert_true(empty.low.x > empty.high.x);
    ty_bounds joined = ty_bounds_union(empty, (ty_bounds){{0, 1, 2}, {3, 4, 5}});
    assert_near(joined.low, (ty_vec3){0, 1, 2}, 0.0f);
    assert_near(joined.high, (ty_vec3){3, 4, 5}, 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frame),
        cmocka_unit_test(test_vectors),
        cmocka_unit_test(test_affine_inverse),
        cmocka_unit_test(test_affine_singular),
        cmocka_unit_test(test_normals_follow_the_inverse_transpose),
        cmocka_unit_test(test_quat_axis_angle),
        cmocka_unit_test(test_quat_against_matrices),
        cmocka_unit_test(test_quat_from_half_turns),
        cmocka_unit_test(test_quat_euler_order),
        cmocka_unit_test(test_quat_normalize),
        cmocka_unit_test(test_quat_uniform),
        cmocka_unit_test(test_trs_order),
        cmocka_unit_test(test_look_at),
        cmocka_unit_test(test_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
