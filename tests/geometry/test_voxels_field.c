// SPDX-License-Identifier: Apache-2.0
// Distances from any mesh against formulas: closed, overlapping, turned inside out, open, sheets; winding numbers.
#include "shape_meshes.h"
#include <string.h>
#include <tsuya/geometry/voxels.h>

static ty_voxels field_of(ty_mesh* mesh, float step, ty_workers* workers)
{
    ty_voxels v;
    ty_error error;
    ty_mesh_compute_welds(mesh);
    if (ty_voxels_around_mesh(mesh, step, 8.0f * step, workers, &v, NULL, &error) != TY_OK)
        fail_msg("%s", error.text);
    return v;
}

// Both as one, the second moved and perhaps turned inside out.
static ty_mesh* both(const ty_mesh* a, const ty_mesh* b, ty_vec3 move, bool turned)
{
    ty_mesh* mesh = ty_mesh_create(a->vertex_count + b->vertex_count, a->triangle_count + b->triangle_count);
    memcpy(mesh->positions, a->positions, a->vertex_count * sizeof(ty_vec3));
    memcpy(mesh->triangles, a->triangles, a->triangle_count * sizeof(*a->triangles));
    for (uint32_t v = 0; v < b->vertex_count; v++)
        mesh->positions[a->vertex_count + v] = ty_add(b->positions[v], move);
    for (uint32_t t = 0; t < b->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[a->triangle_count + t][k] = a->vertex_count + b->triangles[t][turned ? 2 - k : k];
    return mesh;
}

// What of the mesh lies above y.
static ty_mesh* cut(ty_mesh* mesh, float y)
{
    uint32_t kept = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        if (mesh->positions[c[0]].y + mesh->positions[c[1]].y + mesh->positions[c[2]].y > 3.0f * y)
            memmove(mesh->triangles[kept++], c, sizeof *mesh->triangles);
    }
    mesh->triangle_count = kept;
    return mesh;
}

typedef float distance_fn(ty_vec3 p);

static float ball(ty_vec3 p)
{
    return ty_length(p) - 0.01f;
}
static float box(ty_vec3 p)
{
    ty_vec3 q = {fabsf(p.x) - 0.01f, fabsf(p.y) - 0.006f, fabsf(p.z) - 0.004f}, zero = {0.0f, 0.0f, 0.0f};
    return ty_length(ty_max3(q, zero)) + ty_min(ty_max(q.x, ty_max(q.y, q.z)), 0.0f);
}
static float torus(ty_vec3 p)
{
    float x = sqrtf(p.x * p.x + p.z * p.z) - 0.01f;
    return sqrtf(x * x + p.y * p.y) - 0.004f;
}
// Of the union: inside from what of either is not within the other, and from the circle where they meet.
static float balls(ty_vec3 p)
{
    ty_vec3 far = {0.012f, 0.0f, 0.0f}, b = ty_sub(p, far);
    float least = ty_min(ball(p), ball(b));
    if (least >= 0.0f)
        return least;
    float circle = sqrtf(ty_sqr(p.x - 0.006f) + ty_sqr(sqrtf(p.y * p.y + p.z * p.z) - 0.008f));
    if (ball(ty_sub(ty_mul(p, 0.01f / ty_max(ty_length(p), 1e-9f)), far)) > 0.0f)
        circle = ty_min(circle, fabsf(ball(p)));
    if (ball(ty_add(ty_mul(b, 0.01f / ty_max(ty_length(b), 1e-9f)), far)) > 0.0f)
        circle = ty_min(circle, fabsf(ball(b)));
    return -circle;
}

// The worst error in steps near the surface and beyond four steps; nodes below `lowest` are left out.
static void check(const ty_voxels* v, distance_fn* distance, double near, double far, float lowest)
{
    double worst[2] = {0.0, 0.0};
    for (int k = 0, n = 0; k < v->size[2]; k++)
        for (int j = 0; j < v->size[1]; j++)
            for (int i = 0; i < v->size[0]; i++, n++)
            {
                ty_vec3 p = ty_mad(v->origin, ty_vec3_make((float)i, (float)j, (float)k), v->step);
                double d = (double)distance(p), *most = &worst[fabs(d) > 4.0 * (double)v->step];
                double error = fabs(d - (double)v->values[n]) / (double)v->step;
                if (p.y >= lowest && error > *most)
                    *most = error;
            }
    print_message("worst %.4f, %.4f steps\n", worst[0], worst[1]);
    assert_true(worst[0] < near && worst[1] < far);
}

static ty_mesh* shape(ty_shape_kind kind, int divisions)
{
    ty_shape_def def = ty_shape_def_default();
    def.kind = kind;
    def.radius = 0.01f;
    def.tube = 0.004f;
    def.size = (ty_vec3){0.01f, 0.006f, 0.004f};
    def.divisions = divisions;
    return make(&def);
}

static void check_mesh(ty_mesh* mesh, distance_fn* distance, double near, double far, float lowest)
{
    ty_voxels v = field_of(mesh, 0.0004f, NULL);
    check(&v, distance, near, far, lowest);
    ty_voxels_term(&v);
    ty_mesh_destroy(mesh);
}

static void closed_shapes_have_their_distance(void** state)
{
    (void)state;
    check_mesh(shape(TY_SHAPE_SPHERE, 256), ball, 0.1, 0.75, -1.0f);
    check_mesh(shape(TY_SHAPE_BOX, 8), box, 0.1, 0.75, -1.0f);
    check_mesh(shape(TY_SHAPE_TORUS, 256), torus, 0.1, 0.75, -1.0f);
}

static void bodies_may_overlap_or_be_inside_out(void** state)
{
    (void)state;
    ty_mesh* one = shape(TY_SHAPE_SPHERE, 256);
    check_mesh(both(one, one, ty_vec3_make(0.012f, 0.0f, 0.0f), false), balls, 0.75, 0.75, -1.0f);
    ty_mesh* turned = ty_mesh_copy(one);
    for (uint32_t t = 0; t < turned->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            turned->triangles[t][k] = one->triangles[t][2 - k];
    check_mesh(turned, ball, 0.1, 0.75, -1.0f);
    ty_mesh* inner = ty_mesh_copy(one); // a wall about a hollow
    for (uint32_t v = 0; v < inner->vertex_count; v++)
        inner->positions[v] = ty_mul(inner->positions[v], 0.5f);
    ty_mesh* wall = both(one, inner, ty_vec3_make(0.0f, 0.0f, 0.0f), true);
    ty_voxels v = field_of(wall, 0.0004f, NULL);
    assert_true(ty_voxels_value(&v, ty_vec3_make(0.0f, 0.0f, 0.0f)) > 0.0f);
    assert_true(ty_voxels_value(&v, ty_vec3_make(0.0f, 0.0075f, 0.0f)) < 0.0f);
    ty_voxels_term(&v);
    ty_mesh_destroy(wall);
    ty_mesh_destroy(inner);
    ty_mesh_destroy(one);
}

static void open_ones_are_closed_by_a_lid(void** state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++)
    {
        ty_mesh* dome = cut(shape(TY_SHAPE_SPHERE, 256), 0.0f);
        for (uint32_t t = 0; t < dome->triangle_count && turned; t++)
        {
            uint32_t a = dome->triangles[t][0];
            dome->triangles[t][0] = dome->triangles[t][1];
            dome->triangles[t][1] = a;
        }
        ty_voxels v = field_of(dome, 0.0004f, NULL);
        float inside = ty_voxels_value(&v, ty_vec3_make(0.0f, 0.004f, 0.0f));
        assert_float_equal(inside, -0.004f, 0.0008f); // the lid is the disc, of winding number 1/2, where facets end
        assert_float_equal(ty_voxels_value(&v, ty_vec3_make(0.0f, -0.002f, 0.0f)), 0.002f, 0.0008f);
        assert_float_equal(ty_voxels_value(&v, ty_vec3_make(0.0f, 0.008f, 0.0f)), -0.002f, 1e-4f);
        assert_float_equal(ty_voxels_value(&v, ty_vec3_make(0.0f, 0.012f, 0.0f)), 0.002f, 1e-4f);
        ty_voxels_term(&v);
        ty_mesh_destroy(dome);
    }
    // a small hole moves the bottom up to its lid and changes nothing else
    check_mesh(cut(shape(TY_SHAPE_SPHERE, 256), -0.0095f), ball, 0.1, 2.0, -0.004f);
}

static void sheets_have_two_outsides(void** state)
{
    (void)state;
    for (int bent = 0; bent < 2; bent++)
    {
        ty_mesh* sheet = bent ? cut(shape(TY_SHAPE_SPHERE, 256), 0.0095f) : shape(TY_SHAPE_PLANE, 64);
        ty_voxels v = field_of(sheet, bent ? 0.0001f : 0.0004f, NULL);
        for (int n = 0; n < v.size[0] * v.size[1] * v.size[2]; n++)
            assert_true(v.values[n] >= 0.0f);
        ty_voxels_term(&v);
        ty_mesh_destroy(sheet);
    }
}

static void workers_change_no_bit(void** state)
{
    (void)state;
    ty_error error;
    ty_mesh *one = shape(TY_SHAPE_SPHERE, 96), *dome = cut(shape(TY_SHAPE_SPHERE, 96), 0.0f);
    ty_mesh* mesh = both(one, dome, ty_vec3_make(0.006f, 0.003f, 0.0f), false);
    ty_voxels first = field_of(mesh, 0.0005f, NULL);
    for (int threads = 1; threads <= 3; threads++)
    {
        ty_workers* workers;
        assert_int_equal(ty_workers_create(threads, &workers, &error), TY_OK);
        ty_voxels v = field_of(mesh, 0.0005f, workers);
        assert_memory_equal(v.values, first.values,
                            (size_t)v.size[0] * (size_t)v.size[1] * (size_t)v.size[2] * sizeof(float));
        ty_voxels_term(&v);
        ty_workers_destroy(workers);
    }
    ty_voxels_term(&first);
    ty_mesh_destroy(mesh);
    ty_mesh_destroy(dome);
    ty_mesh_destroy(one);
}

static void what_cannot_be_is_refused(void** state)
{
    (void)state;
    ty_error error;
    ty_voxels v;
    ty_mesh* mesh = cut(shape(TY_SHAPE_SPHERE, 32), 0.0f);
    ty_mesh_compute_welds(mesh);
    assert_int_equal(ty_voxels_around_mesh(mesh, 1e-7f, 0.001f, NULL, &v, NULL, &error), TY_BAD_INPUT);
    ty_status status = TY_NO_MEMORY;
    for (long i = 0; status != TY_OK && i < 200; i++)
    {
        int32_t* nearest = NULL;
        ty_memory_fail_after(i);
        status = ty_voxels_around_mesh(mesh, 0.001f, 0.003f, NULL, &v, &nearest, &error);
        ty_memory_fail_after(-1);
        assert_true(status == TY_OK ? nearest != NULL : status == TY_NO_MEMORY && !v.values);
        ty_free(nearest);
        ty_voxels_term(&v);
    }
    assert_int_equal(status, TY_OK);
    mesh->triangle_count = 0;
    assert_int_equal(ty_voxels_around_mesh(mesh, 0.001f, 0.001f, NULL, &v, NULL, &error), TY_BAD_INPUT);
    ty_mesh_destroy(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_shapes_have_their_distance),
        cmocka_unit_test(bodies_may_overlap_or_be_inside_out),
        cmocka_unit_test(open_ones_are_closed_by_a_lid),
        cmocka_unit_test(sheets_have_two_outsides),
        cmocka_unit_test(workers_change_no_bit),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
