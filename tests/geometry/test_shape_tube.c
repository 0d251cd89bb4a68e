// SPDX-License-Identifier: Apache-2.0
// Tubes along a curve: closed, through their points, with the area, volume and curvature of the formula, untwisted; and
// what is said about impossible ones.
#include "shape_meshes.h"
#include <string.h>

static ty_shape_def tube_of(const ty_vec3* points, int count, float radius, int divisions)
{
    ty_shape_def def = shape_of(TY_SHAPE_TUBE);
    def.points = (ty_param_list){(void*)points, count};
    def.radius = radius;
    def.divisions = divisions;
    return def;
}

enum
{
    ROUND_POINTS = 25,
    KNOT_POINTS = 40
};

// Three quarters of a circle about y.
static void make_arc(ty_vec3 points[ROUND_POINTS], double radius)
{
    for (int i = 0; i < ROUND_POINTS; i++)
    {
        double a = 1.5 * M_PI * i / (ROUND_POINTS - 1);
        points[i] = ty_vec3_make((float)(radius * sin(a)), 0.0f, (float)(radius * cos(a)));
    }
}

// A line with torsion, and points at very different distances.
static void make_knot(ty_vec3 points[KNOT_POINTS])
{
    for (int i = 0; i < KNOT_POINTS; i++)
    {
        double a = 4.0 * M_PI * (i + 0.35 * (i & 1)) / KNOT_POINTS, r = 2.0 + cos(1.5 * a);
        points[i] = ty_vec3_make((float)(0.01 * r * cos(a)), (float)(0.01 * sin(1.5 * a)), (float)(0.01 * r * sin(a)));
    }
}

static void test_tubes_are_closed_and_go_through_their_points(void** state)
{
    (void)state;
    ty_vec3 arc[ROUND_POINTS], knot[KNOT_POINTS];
    make_arc(arc, 0.05);
    make_knot(knot);
    const ty_vec3 two[2] = {{0.1f, 0.2f, -0.1f}, {0.1f, 0.2f, 0.3f}},
                  bend[3] = {{0, 0, 0}, {0, 0.1f, 0}, {0.1f, 0.1f, 0}};
    const ty_shape_def defs[] = {tube_of(two, 2, 0.02f, 8),
                                 tube_of(two, 2, 0.02f, 97),
                                 tube_of(bend, 3, 0.01f, 40),
                                 tube_of(bend, 3, 1e-4f, 13),
                                 tube_of(arc, ROUND_POINTS, 0.02f, 64),
                                 tube_of(knot, KNOT_POINTS, 0.002f, 48)};
    for (size_t i = 0; i < sizeof(defs) / sizeof(defs[0]); i++)
    {
        ty_mesh* mesh = make(&defs[i]);
        ty_mesh_topology t;
        ty_mesh_analyse(mesh, &t);
        assert_true(t.closed && t.components == 1);
        assert_int_equal(t.nonmanifold_edges + t.misoriented_edges, 0);
        assert_int_equal(ty_mesh_validate(mesh, "tube", NULL), TY_OK);
        if (defs[i].divisions >= 40)
            check_surface(mesh);
        const ty_vec3* points = defs[i].points.items;
        for (int k = 0; k < defs[i].points.count; k++)
        {
            float nearest = TY_FLOAT_MAX;
            for (uint32_t v = 0; v < mesh->vertex_count; v++)
                nearest = ty_min(nearest, ty_length(ty_sub(mesh->positions[v], points[k])));
            assert_float_equal(nearest, defs[i].radius, 1e-6f);
        }
        ty_mesh_destroy(mesh);
    }
}

// Of a tube of length L: area 2 pi r L and volume pi r^2 L, whatever its bends (Pappus), and a ball for its ends.
static void test_tubes_have_the_area_and_volume_of_their_length(void** state)
{
    (void)state;
    ty_vec3 arc[ROUND_POINTS], knot[KNOT_POINTS];
    make_arc(arc, 0.05);
    make_knot(knot);
    const ty_vec3 two[2] = {{0.1f, 0.2f, -0.1f}, {0.1f, 0.2f, 0.3f}};
    const ty_shape_def defs[] = {tube_of(two, 2, 0.02f, 96), tube_of(arc, ROUND_POINTS, 0.02f, 96),
                                 tube_of(knot, KNOT_POINTS, 0.002f, 96)};
    const double lengths[] = {0.4, 1.5 * M_PI * 0.05, 0.0};
    for (int i = 0; i < 3; i++)
    {
        ty_mesh_topology t = topology_of(&defs[i]);
        double r = (double)defs[i].radius, length = t.area / (2.0 * M_PI * r) - 2.0 * r;
        if (lengths[i] > 0.0)
            assert_true(fabs(length / lengths[i] - 1.0) < 4e-3);
        assert_true(fabs(t.volume / (M_PI * r * r * (length + 4.0 / 3.0 * r)) - 1.0) < 4e-3);
    }
}

// Bent in a circle it is part of a torus; its ends are balls.
static void test_tube_curvature_is_that_of_a_torus(void** state)
{
    (void)state;
    ty_vec3 arc[ROUND_POINTS];
    make_arc(arc, 0.05);
    ty_shape_def def = tube_of(arc, ROUND_POINTS, 0.02f, 64);
    ty_mesh* mesh = make(&def);
    int body = 0, ends = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 p = mesh->positions[i];
        float r = sqrtf(p.x * p.x + p.z * p.z), along = (r - 0.05f) / (0.02f * r), v = mesh->uvs[i].y;
        float round = ty_max(1.0f / 0.02f, along), other = ty_min(1.0f / 0.02f, along);
        assert_float_equal(mesh->curvature_1[i], 50.0f, 1e-3f);
        if (v > 0.16f && v < 0.84f) // the spline's own ends are straighter
        {
            assert_float_equal(mesh->curvature_1[i], round, 0.02f * round);
            assert_float_equal(mesh->curvature_2[i], other, 0.05f * fabsf(other) + 0.6f);
            assert_true(fabsf(ty_dot(mesh->direction_1[i], ty_vec3_make(p.z / r, 0.0f, -p.x / r))) < 1e-3f);
            body++;
        }
        if (v < 0.06f || v > 0.94f)
        {
            assert_float_equal(mesh->curvature_2[i], 50.0f, 1e-3f);
            ends++;
        }
    }
    assert_true(body > 2000 && ends > 500);
    ty_mesh_destroy(mesh);
}

// The line where u begins turns with the curve's tangent alone: its normal never moves sideways.
static void test_tubes_do_not_twist(void** state)
{
    (void)state;
    ty_vec3 knot[KNOT_POINTS];
    make_knot(knot);
    ty_shape_def def = tube_of(knot, KNOT_POINTS, 0.002f, 256);
    ty_mesh* mesh = make(&def);
    uint32_t ring = (uint32_t)def.divisions + 1, cap = (uint32_t)def.divisions + 63 * ring;
    double sideways = 0.0, turned = 0.0;
    for (uint32_t i = cap + ring; i + cap < mesh->vertex_count; i += ring)
    {
        ty_vec3 n = mesh->normals[i], before = mesh->normals[i - ring], change = ty_sub(n, before);
        assert_true(mesh->uvs[i].x == 0.0f);
        sideways += (double)ty_dot(change, mesh->normals[i + ring / 4]);
        turned += (double)ty_length(change);
    }
    assert_true(turned > 6.0 && fabs(sideways) < 0.02);
    ty_mesh_destroy(mesh);
}

static void assert_tube_refused(ty_shape_def def, const char* said)
{
    ty_mesh* mesh = (ty_mesh*)&def;
    ty_error error = {0};
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_BAD_INPUT);
    assert_null(mesh);
    if (!strstr(error.text, said))
        print_message("%s\n", error.text);
    assert_non_null(strstr(error.text, said));
}

static void test_bad_tubes_are_refused(void** state)
{
    (void)state;
    const ty_vec3 doubled[3] = {{0, 0, 0}, {0, 0.1f, 0}, {0, 0.1f, 0}},
                  back[3] = {{0, 0, 0}, {0, 0.1f, 0}, {0, 0.02f, 0}},
                  bend[3] = {{0, 0, 0}, {0, 0.1f, 0}, {0.1f, 0.1f, 0}}, odd[2] = {{0, 0, 0}, {0, NAN, 0}},
                  wide[2] = {{0, 0, 0}, {0, 2e4f, 0}}, far[2] = {{1000, 0, 0}, {1001, 0, 0}};
    assert_tube_refused(tube_of(doubled, 3, 0.001f, 16), "points: point 3 coincides");
    assert_tube_refused(tube_of(back, 3, 0.001f, 16), "points: the curve turns back on itself at point 2");
    assert_tube_refused(tube_of(bend, 3, 0.09f, 16), "too tight for a tube of radius 0.09 m");
    assert_tube_refused(tube_of(odd, 2, 0.001f, 16), "points: point 2");
    assert_tube_refused(tube_of(wide, 2, 0.001f, 16), "points: point 2");
    assert_tube_refused(tube_of(far, 2, 1e-4f, 16), "radius");
    assert_tube_refused(tube_of(bend, 1, 0.001f, 16), "points: 1 points");
    assert_tube_refused(tube_of(NULL, 0, 0.001f, 16), "points: 0 points");
    assert_tube_refused(tube_of(bend, 4097, 0.001f, 16), "points: 4097 points");
    assert_tube_refused(tube_of(bend, 3, 0.0f, 16), "radius");
    ty_vec3 arc[ROUND_POINTS];
    make_arc(arc, 0.05);
    assert_tube_refused(tube_of(arc, ROUND_POINTS, 0.02f, 4096), "divisions");
    for (long i = 0; i < 12; i++)
    {
        ty_shape_def def = tube_of(bend, 3, 0.01f, 64);
        ty_mesh* mesh;
        ty_memory_fail_after(i);
        ty_status status = ty_shape_create(&def, &mesh, NULL);
        ty_memory_fail_after(-1);
        assert_true(status == TY_OK ? mesh != NULL : status == TY_NO_MEMORY && !mesh);
        assert_true(i > 0 || status == TY_NO_MEMORY);
        ty_mesh_destroy(mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tubes_are_closed_and_go_through_their_points),
        cmocka_unit_test(test_tubes_have_the_area_and_volume_of_their_length),
        cmocka_unit_test(test_tube_curvature_is_that_of_a_torus),
        cmocka_unit_test(test_tubes_do_not_twist),
        cmocka_unit_test(test_bad_tubes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
