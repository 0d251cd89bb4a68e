// SPDX-License-Identifier: Apache-2.0
// Solids on grids: distances, volumes, surfaces and curvatures against formulas, and meshes that are closed whatever
// the field.
#include "shape_meshes.h"
#include <string.h>
#include <tsuya/geometry/voxels.h>

static ty_voxels field_of(const ty_shape_def* def, float step, float margin)
{
    ty_mesh* mesh = make(def);
    ty_voxels v;
    ty_error error;
    if (ty_voxels_from_mesh(mesh, step, margin, &v, &error) != TY_OK)
        fail_msg("%s", error.text);
    ty_mesh_destroy(mesh);
    return v;
}

static ty_mesh* net_of(const ty_voxels* v, float cell, int relax, bool hollow)
{
    ty_voxel_net_def def = {cell, relax, hollow};
    ty_mesh* mesh;
    ty_error error;
    if (ty_voxels_net(v, &def, &mesh, &error) != TY_OK)
        fail_msg("%s", error.text);
    return mesh;
}

static ty_vec3 place(const ty_voxels* v, int i, int j, int k)
{
    return ty_mad(v->origin, ty_vec3_make((float)i, (float)j, (float)k), v->step);
}

typedef float distance_fn(ty_vec3 p);

static float sphere_distance(ty_vec3 p)
{
    return ty_length(p) - 0.01f;
}
static float box_distance(ty_vec3 p)
{
    ty_vec3 q = {fabsf(p.x) - 0.01f, fabsf(p.y) - 0.006f, fabsf(p.z) - 0.004f};
    ty_vec3 zero = {0.0f, 0.0f, 0.0f};
    return ty_length(ty_max3(q, zero)) + ty_min(ty_max(q.x, ty_max(q.y, q.z)), 0.0f);
}
static float torus_distance(ty_vec3 p)
{
    float x = sqrtf(p.x * p.x + p.z * p.z) - 0.01f;
    return sqrtf(x * x + p.y * p.y) - 0.004f;
}

// The worst error in steps, of nodes up to four steps from the surface and of those beyond.
static void worst_distance(const ty_voxels* v, distance_fn* distance, double worst[2])
{
    worst[0] = worst[1] = 0.0;
    for (int k = 0, n = 0; k < v->size[2]; k++)
        for (int j = 0; j < v->size[1]; j++)
            for (int i = 0; i < v->size[0]; i++, n++)
            {
                double d = (double)distance(place(v, i, j, k)), *most = &worst[fabs(d) > 4.0 * (double)v->step];
                *most = fmax(*most, fabs((double)v->values[n] - d) / (double)v->step);
            }
}

static ty_shape_def shape_small(int kind, int divisions)
{
    ty_shape_def def = shape_of(kind);
    def.radius = 0.01f;
    def.tube = 0.004f;
    def.size = ty_vec3_make(0.01f, 0.006f, 0.004f);
    def.rounding = 0.0f;
    def.divisions = divisions;
    return def;
}

static void test_distances(void** state)
{
    (void)state;
    static const int kinds[] = {TY_SHAPE_SPHERE, TY_SHAPE_BOX, TY_SHAPE_TORUS};
    static distance_fn* const distances[] = {sphere_distance, box_distance, torus_distance};
    for (int i = 0; i < 3; i++)
    {
        ty_shape_def def = shape_small(kinds[i], kinds[i] == TY_SHAPE_BOX ? 8 : 256);
        ty_voxels v = field_of(&def, 0.00037f, 0.003f);
        double worst[2];
        worst_distance(&v, distances[i], worst);
        assert_true(worst[0] < 0.1);
        assert_true(worst[1] < 0.5);
        ty_voxels_term(&v);
    }
}

// Two bodies of one mesh that overlap are one solid: winding numbers of 2 are inside too.
static void test_overlapping_bodies(void** state)
{
    (void)state;
    ty_shape_def def = shape_small(TY_SHAPE_SPHERE, 64);
    ty_mesh* one = make(&def);
    ty_mesh* two = ty_mesh_create(2 * one->vertex_count, 2 * one->triangle_count);
    for (uint32_t i = 0; i < two->vertex_count; i++)
    {
        two->positions[i] = one->positions[i % one->vertex_count];
        two->positions[i].x += i < one->vertex_count ? -0.004f : 0.004f;
    }
    for (uint32_t t = 0; t < two->triangle_count; t++)
        for (int e = 0; e < 3; e++)
            two->triangles[t][e] =
                one->triangles[t % one->triangle_count][e] + (t < one->triangle_count ? 0 : one->vertex_count);
    ty_voxels v;
    ty_error error;
    assert_int_equal(ty_voxels_from_mesh(two, 0.0005f, 0.002f, &v, &error), TY_OK);
    for (int k = 0, n = 0; k < v.size[2]; k++)
        for (int j = 0; j < v.size[1]; j++)
            for (int i = 0; i < v.size[0]; i++, n++)
            {
                ty_vec3 p = place(&v, i, j, k), to = {fabsf(p.x) - 0.004f, p.y, p.z};
                if (fabsf(sphere_distance(to)) > 2e-5f)
                    assert_true((v.values[n] < 0.0f) == (sphere_distance(to) < 0.0f));
            }
    ty_voxels_term(&v);
    ty_mesh_destroy(one);
    ty_mesh_destroy(two);
}

static double area_of(const ty_mesh* mesh, double* volume)
{
    ty_mesh_topology t;
    ty_mesh_analyse(mesh, &t);
    assert_true(t.closed);
    *volume = t.volume;
    return t.area;
}

static void test_volumes_and_surfaces(void** state)
{
    (void)state;
    const double r = 0.01, tube = 0.004;
    static const int kinds[] = {TY_SHAPE_SPHERE, TY_SHAPE_BOX, TY_SHAPE_TORUS};
    const double volumes[] = {4.0 / 3.0 * M_PI * r * r * r, 8.0 * 0.01 * 0.006 * 0.004,
                              2.0 * M_PI * M_PI * r * tube * tube};
    const double areas[] = {4.0 * M_PI * r * r, 8.0 * (0.01 * 0.006 + 0.006 * 0.004 + 0.004 * 0.01),
                            4.0 * M_PI * M_PI * r * tube};
    for (int i = 0; i < 3; i++)
    {
        ty_shape_def def = shape_small(kinds[i], 192);
        ty_voxels v = field_of(&def, 0.0003f, 0.0015f);
        for (int coarse = 0; coarse < 2; coarse++)
        {
            ty_mesh* mesh = net_of(&v, coarse ? 0.0011f : 0.0003f, 2, false);
            double volume, area = area_of(mesh, &volume);
            assert_true(fabs(volume / volumes[i] - 1.0) < (coarse ? 0.06 : 0.01));
            assert_true(fabs(area / areas[i] - 1.0) < (coarse ? 0.1 : 0.03));
            ty_mesh_destroy(mesh);
        }
        ty_voxels_term(&v);
    }
}

static void test_curvature(void** state)
{
    (void)state;
    static const int kinds[] = {TY_SHAPE_SPHERE, TY_SHAPE_TORUS, TY_SHAPE_ELLIPSOID};
    for (int i = 0; i < 3; i++)
    {
        ty_shape_def def = shape_small(kinds[i], 320);
        ty_voxels v = field_of(&def, 0.00025f, 0.0015f);
        ty_error error;
        assert_int_equal(ty_voxels_smooth(&v, 0.5f * v.step * v.step, &error), TY_OK);
        ty_mesh* mesh = net_of(&v, 0.0005f, 2, false);
        double mean = 0.0, worst = 0.0;
        for (uint32_t n = 0; n < mesh->vertex_count; n++)
        {
            ty_vec3 p = mesh->positions[n];
            double k1 = 100.0, k2 = 100.0;
            if (kinds[i] == TY_SHAPE_TORUS)
            {
                double x = sqrt((double)p.x * p.x + (double)p.z * p.z);
                k1 = 250.0, k2 = (x - 0.01) / 0.004 / x;
            }
            if (kinds[i] == TY_SHAPE_ELLIPSOID)
            {
                double a = 1e-4, b = 3.6e-5, c = 1.6e-5, x = p.x, y = p.y, z = p.z;
                double s = x * x / (a * a) + y * y / (b * b) + z * z / (c * c);
                double gauss = 1.0 / (a * b * c * s * s);
                double h = (a + b + c - x * x - y * y - z * z) / (2.0 * a * b * c * pow(s, 1.5));
                double root = sqrt(fmax(h * h - gauss, 0.0));
                k1 = h + root, k2 = h - root;
            }
            double e = fmax(fabs((double)mesh->curvature_1[n] - k1), fabs((double)mesh->curvature_2[n] - k2)) / k1;
            mean += e / mesh->vertex_count;
            worst = fmax(worst, e);
        }
        assert_true(mean < 0.02);
        assert_true(worst < (kinds[i] == TY_SHAPE_ELLIPSOID ? 0.1 : 0.03)); // its tip has a radius of six steps
        ty_mesh_destroy(mesh);
        ty_voxels_term(&v);
    }
}

// --- balls, planes, offsets, smoothing ---

static void test_balls_are_exact(void** state)
{
    (void)state;
    ty_shape_def def = shape_small(TY_SHAPE_BOX, 8);
    ty_voxels v = field_of(&def, 0.0004f, 0.004f);
    ty_vec3 at = {0.01f, 0.001f, 0.0f}, off = {-0.004f, 0.0f, 0.0f};
    ty_voxels_add_ball(&v, at, 0.0025f, 1.0f);
    ty_voxels_take_ball(&v, off, 0.002f, 0.001f);
    for (int k = 0, n = 0; k < v.size[2]; k++)
        for (int j = 0; j < v.size[1]; j++)
            for (int i = 0; i < v.size[0]; i++, n++)
            {
                ty_vec3 p = place(&v, i, j, k);
                float ball = ty_length(ty_sub(p, at)) - 0.0025f, hole = 0.002f - ty_length(ty_sub(p, off));
                if (box_distance(p) > 0.0f && ball < box_distance(p))
                    assert_true(fabsf(v.values[n] - ball) < 1e-6f);
                if (hole > -0.0007f && hole > box_distance(p))
                    assert_true(fabsf(v.values[n] - hole) < 1e-6f);
            }
    ty_mesh* mesh = net_of(&v, 0.0004f, 2, true);
    double volume, cap = 0.0;
    (void)area_of(mesh, &volume);
    for (int i = 0; i < 1000; i++) // what of the ball is beyond the face at x = .01
        cap += M_PI * (6.25e-6 - pow((i + 0.5) * 2.5e-6, 2.0)) * 2.5e-6;
    double expected = 8.0 * 0.01 * 0.006 * 0.004 + cap - 4.0 / 3.0 * M_PI * 8e-9;
    assert_true(fabs(volume / expected - 1.0) < 0.01);
    ty_mesh_destroy(mesh);
    mesh = net_of(&v, 0.0004f, 2, false); // the cavity is not seen from outside
    (void)area_of(mesh, &volume);
    assert_true(fabs(volume / (expected + 4.0 / 3.0 * M_PI * 8e-9) - 1.0) < 0.01);
    ty_mesh_destroy(mesh);
    ty_voxels_cut(&v, ty_vec3_make(1.0f, 0.0f, 0.0f), -0.004f); // through its middle
    mesh = net_of(&v, 0.0004f, 2, false);
    (void)area_of(mesh, &volume);
    expected = 0.006 * 0.012 * 0.008 - 2.0 / 3.0 * M_PI * 8e-9;
    assert_true(fabs(volume / expected - 1.0) < 0.02);
    ty_mesh_destroy(mesh);
    ty_voxels_term(&v);
}

static double radius_of(const ty_voxels* v)
{
    ty_mesh* mesh = net_of(v, v->step, 1, false);
    double volume;
    (void)area_of(mesh, &volume);
    ty_mesh_destroy(mesh);
    return cbrt(volume * 0.75 / M_PI);
}

// A ball that flows by its mean curvature has r^2 less by four times the time; an offset moves it outwards, a scale
// makes it larger.
static void test_ball_shrinks_and_grows(void** state)
{
    (void)state;
    ty_shape_def def = shape_small(TY_SHAPE_SPHERE, 128);
    ty_voxels v = field_of(&def, 0.0005f, 0.004f);
    ty_error error;
    double before = radius_of(&v);
    assert_int_equal(ty_voxels_smooth(&v, 2e-6f, &error), TY_OK);
    double after = radius_of(&v);
    assert_true(fabs((before * before - after * after) / 8e-6 - 1.0) < 0.03);
    ty_voxels_offset(&v, 0.0007f);
    double outer = sqrt((before + 0.0007) * (before + 0.0007) - 8e-6); // the level set there has flowed as well
    assert_true(fabs(radius_of(&v) - outer) < 1e-5);
    ty_voxels_scale(&v, 1.5f);
    assert_true(fabs(radius_of(&v) / (1.5 * outer) - 1.0) < 1e-3);
    ty_voxels_term(&v);
}

// --- meshes ---

// The triangles about each vertex are one fan: one walks from each over the vertex's edges to all of them.
static void assert_one_fan(const ty_mesh* mesh)
{
    uint32_t* degree = TY_ALLOC(uint32_t, mesh->vertex_count);
    uint32_t(*fan)[24][2] = ty_alloc(mesh->vertex_count, sizeof(*fan)); // from the next corner to the one after
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int e = 0; e < 3; e++)
        {
            uint32_t v = mesh->triangles[t][e], *side = fan[v][degree[v]++];
            assert_true(degree[v] <= 24);
            side[0] = mesh->triangles[t][(e + 1) % 3];
            side[1] = mesh->triangles[t][(e + 2) % 3];
        }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        uint32_t steps = 0, at = fan[v][0][0];
        do
        {
            uint32_t i = 0;
            while (i < degree[v] && fan[v][i][0] != at)
                i++;
            assert_true(i < degree[v]);
            at = fan[v][i][1];
            steps++;
        } while (at != fan[v][0][0]);
        assert_int_equal(steps, degree[v]);
    }
    ty_free(degree);
    ty_free(fan);
}

// Noise at the nodes: the worst there is for sheets that touch in edges and corners.
static void test_closed_whatever_the_field(void** state)
{
    (void)state;
    ty_shape_def def = shape_small(TY_SHAPE_SPHERE, 32);
    ty_voxels v = field_of(&def, 0.001f, 0.003f);
    size_t count = (size_t)v.size[0] * (size_t)v.size[1] * (size_t)v.size[2];
    for (uint32_t round = 0; round < 4; round++)
    {
        uint32_t state_of = 12345 + round;
        for (size_t i = 0; i < count; i++)
        {
            state_of = state_of * 1664525u + 1013904223u;
            v.values[i] = 1e-3f * ((float)(state_of >> 8) / 8388608.0f - 1.0f);
        }
        ty_mesh* mesh = net_of(&v, round & 1 ? 0.0013f : 0.001f, (int)round, true);
        ty_mesh_topology t;
        ty_mesh_analyse(mesh, &t);
        assert_int_equal(t.boundary_edges, 0);
        assert_int_equal(t.nonmanifold_edges, 0);
        assert_int_equal(t.misoriented_edges, 0);
        assert_true(mesh->triangle_count > 5000);
        assert_one_fan(mesh);
        for (uint32_t i = 0; i < mesh->vertex_count; i++)
            assert_true(ty_is_finite3(mesh->positions[i]) && isfinite(mesh->curvature_1[i]));
        ty_mesh_destroy(mesh);
    }
    ty_voxels_term(&v);
}

// Vertices lie on the surface, but for what keeps them off the sides of their cells, and normals are those of the ball,
// at any resolution.
static void test_vertices_lie_on_the_surface(void** state)
{
    (void)state;
    ty_shape_def def = shape_small(TY_SHAPE_SPHERE, 256);
    ty_voxels v = field_of(&def, 0.0005f, 0.002f);
    for (int i = 1; i < 4; i++)
    {
        ty_mesh* mesh = net_of(&v, 0.0004f * (float)(i * i), 3, false);
        for (uint32_t n = 0; n < mesh->vertex_count; n++)
        {
            assert_true(fabsf(sphere_distance(mesh->positions[n])) < 1.5e-5f + 1.2e-5f * (float)(i * i));
            assert_true(ty_dot(mesh->normals[n], ty_normalize(mesh->positions[n])) > 0.9995f);
        }
        ty_mesh_destroy(mesh);
    }
    ty_voxels_term(&v);
}

// --- what cannot be ---

static void test_refusals(void** state)
{
    (void)state;
    ty_shape_def def = shape_small(TY_SHAPE_SPHERE, 32);
    ty_mesh *mesh = make(&def), *out;
    ty_voxels v;
    ty_error error;
    assert_int_equal(ty_voxels_from_mesh(mesh, 1e-7f, 0.001f, &v, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "at most 128 million"));
    assert_null(v.values);
    for (long n = 0; n < 8; n++)
    {
        ty_memory_fail_after(n);
        assert_int_equal(ty_voxels_from_mesh(mesh, 0.001f, 0.003f, &v, &error), TY_NO_MEMORY);
        ty_memory_fail_after(-1);
        assert_null(v.values);
    }
    assert_int_equal(ty_voxels_from_mesh(mesh, 0.001f, 0.003f, &v, &error), TY_OK);
    ty_voxel_net_def net = {0.001f, 2, false};
    for (long n = 0; n < 16; n++)
    {
        ty_memory_fail_after(n);
        assert_int_equal(ty_voxels_net(&v, &net, &out, &error), TY_NO_MEMORY);
        ty_memory_fail_after(-1);
        assert_null(out);
    }
    ty_memory_fail_after(0);
    assert_int_equal(ty_voxels_smooth(&v, 1e-6f, &error), TY_NO_MEMORY);
    ty_memory_fail_after(-1);
    ty_voxels_offset(&v, -0.02f);
    assert_int_equal(ty_voxels_net(&v, &net, &out, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "nothing of the solid"));
    ty_voxels_term(&v);
    ty_mesh_destroy(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_distances),
        cmocka_unit_test(test_overlapping_bodies),
        cmocka_unit_test(test_volumes_and_surfaces),
        cmocka_unit_test(test_curvature),
        cmocka_unit_test(test_balls_are_exact),
        cmocka_unit_test(test_ball_shrinks_and_grows),
        cmocka_unit_test(test_closed_whatever_the_field),
        cmocka_unit_test(test_vertices_lie_on_the_surface),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
