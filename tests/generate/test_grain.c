// SPDX-License-Identifier: Apache-2.0
// The rice grain: closed, smooth, without slivers, of its formula's volume, met by its balls, each variant its
// own.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/generate/element.h>

static const ty_seed seed = {11};

static ty_element_def def_complete(void)
{
    ty_element_def def = ty_element_def_default();
    ty_error error;
    assert_int_equal(ty_element_complete(&def, "element", &error), TY_OK);
    return def;
}

static ty_element grain_make(const ty_element_def* def, int variant)
{
    ty_element grain;
    ty_error error;
    assert_int_equal(ty_element_init(def, seed, variant, &grain, &error), TY_OK);
    return grain;
}

static void test_closed_and_outward(void** state)
{
    (void)state;
    ty_element_def def = def_complete();
    for (int v = 0; v < 4; v++)
    {
        ty_element grain = grain_make(&def, v);
        ty_mesh_topology topology;
        ty_mesh_analyse(grain.mesh, &topology);
        assert_true(topology.closed);
        assert_int_equal(topology.components, 1);
        assert_int_equal(topology.welded_vertices + grain.mesh->triangle_count, topology.edges + 2); // a sphere
        assert_in_range(grain.mesh->triangle_count, 1500, 2500);
        assert_true(fabs(topology.volume / (double)grain.volume - 1.0) < 1e-4);
        ty_element_term(&grain);
    }
}

// Without variation and dent, what ridges and bend change counts for little: 2 pi abc * integral of 1 - x^3 over 0..1.
static void test_volume(void** state)
{
    (void)state;
    ty_element_def def = def_complete();
    def.variation = 0.0f;
    def.notch = 0.0f;
    double expected = 1.5 * 3.14159265358979 * (double)def.length * (double)def.width * (double)def.thickness / 8.0;
    double mean = 0.0;
    for (int v = 0; v < 8; v++)
    {
        ty_element grain = grain_make(&def, v);
        mean += (double)grain.volume / 8.0;
        ty_element_term(&grain);
    }
    assert_true(fabs(mean / expected - 1.0) < 0.03);
}

static double corner_angle(const ty_mesh* mesh, uint32_t triangle, int corner)
{
    const uint32_t* t = mesh->triangles[triangle];
    ty_vec3 p = mesh->positions[t[corner]];
    ty_vec3 u = ty_normalize(ty_sub(mesh->positions[t[(corner + 1) % 3]], p));
    ty_vec3 w = ty_normalize(ty_sub(mesh->positions[t[(corner + 2) % 3]], p));
    return acos((double)ty_dot(u, w)) * 180.0 / 3.14159265358979;
}

static void test_no_slivers_and_smooth(void** state)
{
    (void)state;
    ty_element_def def = def_complete();
    for (int v = 0; v < 4; v++)
    {
        ty_element grain = grain_make(&def, v);
        const ty_mesh* mesh = grain.mesh;
        double least = 180.0;
        for (uint32_t t = 0; t < mesh->triangle_count; t++)
            for (int k = 0; k < 3; k++)
                least = fmin(least, corner_angle(mesh, t, k));
        assert_true(least > 24.0);
        for (uint32_t t = 0; t < mesh->triangle_count; t++) // a triangle's corners see nearly the same normal
        {
            const uint32_t* at = mesh->triangles[t];
            assert_true(ty_dot(mesh->normals[at[0]], mesh->normals[at[1]]) > 0.75f);
        }
        assert_non_null(mesh->curvature_1);
        assert_non_null(mesh->welds);
        ty_element_term(&grain);
    }
}

// Distance of p from the union of the balls; negative inside.
static float union_distance(const ty_element* grain, ty_vec3 p)
{
    float least = TY_FLOAT_MAX;
    for (int i = 0; i < grain->ball_count; i++)
        least = ty_min(least, ty_length(ty_sub(p, grain->balls[i].center)) - grain->balls[i].radius);
    return least;
}

static void test_balls_meet_the_surface(void** state)
{
    (void)state;
    ty_element_def def = def_complete();
    def.notch = 0.0f;
    for (int v = 0; v < 8; v++)
    {
        ty_element grain = grain_make(&def, v);
        double square = 0.0, mean = 0.0, worst = 0.0;
        for (uint32_t i = 0; i < grain.mesh->vertex_count; i++)
        {
            double d = (double)union_distance(&grain, grain.mesh->positions[i]) / (double)grain.width;
            square += d * d / grain.mesh->vertex_count;
            mean += d / grain.mesh->vertex_count;
            worst = fmax(worst, fabs(d));
        }
        assert_true(sqrt(square) < 0.028);
        assert_true(fabs(mean) < 0.01);
        assert_true(worst < 0.08);
        assert_true(fabs(sqrt(square) - (double)(grain.fit_rms / grain.width)) < 1e-3);
        ty_element_term(&grain);
    }
}

// The dent of the germ takes away volume, on one side near one end.
static void test_notch(void** state)
{
    (void)state;
    ty_element_def def = def_complete();
    ty_element dented = grain_make(&def, 0);
    def.notch = 0.0f;
    ty_element whole = grain_make(&def, 0);
    assert_true(dented.volume < 0.998f * whole.volume);
    assert_true(dented.volume > 0.97f * whole.volume);
    float deepest = 0.0f;
    ty_vec3 at = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < whole.mesh->vertex_count; i++)
    {
        float d = ty_length(ty_sub(whole.mesh->positions[i], dented.mesh->positions[i]));
        if (d > deepest)
        {
            deepest = d;
            at = whole.mesh->positions[i];
        }
    }
    assert_true(deepest > 0.06f * whole.width && deepest < 0.16f * whole.width);
    assert_true(at.x > 0.25f * def.length && at.y > 0.0f);
    ty_element_term(&dented);
    ty_element_term(&whole);
}

// Inverse inertia against the ellipsoid of the same sizes: (b^2 + c^2) / 5 and so on, larger as the ends are fuller.
static void test_inertia(void** state)
{
    (void)state;
    ty_element_def def = def_complete();
    def.variation = 0.0f;
    ty_element grain = grain_make(&def, 0);
    double a = (double)def.length / 2, b = (double)def.width / 2, c = (double)def.thickness / 2;
    double ellipsoid[3] = {(b * b + c * c) / 5, (a * a + c * c) / 5, (a * a + b * b) / 5};
    for (int i = 0; i < 3; i++)
    {
        double ratio = 1.0 / ((double)grain.inverse_inertia[i] * ellipsoid[i]);
        assert_true(ratio > 0.98 && ratio < 1.2);
    }
    ty_element_term(&grain);
}

static void test_variants_differ_and_repeat(void** state)
{
    (void)state;
    ty_element_def def = def_complete();
    ty_element a = grain_make(&def, 0), again = grain_make(&def, 0), b = grain_make(&def, 1);
    size_t size = a.mesh->vertex_count * sizeof(ty_vec3);
    assert_memory_equal(a.mesh->positions, again.mesh->positions, size);
    assert_memory_equal(a.balls, again.balls, sizeof a.balls);
    assert_true(fabsf(a.volume / b.volume - 1.0f) > 1e-3f);
    double sum = 0.0, square = 0.0;
    for (int v = 0; v < 64; v++)
    {
        ty_element g = grain_make(&def, v);
        double w = (double)(g.width / def.width) - 1.0;
        sum += w / 64;
        square += w * w / 64;
        ty_element_term(&g);
    }
    double deviation = sqrt(square - sum * sum);
    assert_true(deviation > 0.03 && deviation < 0.07); // .8 of the recipe's .06
    ty_element_term(&a);
    ty_element_term(&again);
    ty_element_term(&b);
}

static void test_no_memory(void** state)
{
    (void)state;
    ty_element_def def = def_complete();
    for (long n = 0; n < 2; n++)
    {
        ty_element grain;
        ty_error error;
        ty_memory_fail_after(n);
        assert_int_equal(ty_element_init(&def, seed, 0, &grain, &error), TY_NO_MEMORY);
        ty_memory_fail_after(-1);
        assert_null(grain.mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_and_outward),
        cmocka_unit_test(test_volume),
        cmocka_unit_test(test_no_slivers_and_smooth),
        cmocka_unit_test(test_balls_meet_the_surface),
        cmocka_unit_test(test_notch),
        cmocka_unit_test(test_inertia),
        cmocka_unit_test(test_variants_differ_and_repeat),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
