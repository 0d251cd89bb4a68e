// SPDX-License-Identifier: Apache-2.0
// Containers beyond the turned shapes: a vessel from a mesh, a heap without walls, a pile that is cut open.
#include "recipe_made.h"
#include <tsuya/base/rng.h>

static ty_aggregate_recipe small(void)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    set_bowl(&r.container.shape, 0.024f, 0.021f, 0.0025f, 0.010f, 0.003f);
    r.element.variants = 3;
    r.element.divisions = 6;
    r.fill.count = 160;
    r.fill.heap = 4e-3f;
    return r;
}

static void mesh_write(char* path, const ty_shape_def* shape, bool inverted)
{
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_shape_create(shape, &mesh, &error), TY_OK);
    for (uint32_t i = 0; inverted && i < mesh->triangle_count; i++)
    {
        uint32_t first = mesh->triangles[i][0];
        mesh->triangles[i][0] = mesh->triangles[i][1];
        mesh->triangles[i][1] = first;
    }
    mesh_keep(mesh, path);
    ty_mesh_destroy(mesh);
}

// The bowl's own mesh as a vessel holds what the bowl holds, to a step of its grid.
static void a_mesh_is_a_vessel(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small();
    r.container.shape.kind = TY_SHAPE_BOWL;
    char path[] = "/tmp/tsuya_vessel_XXXXXX.ply";
    mesh_write(path, &r.container.shape, false);
    ty_container *bowl, *vessel;
    ty_error error;
    assert_int_equal(ty_container_create(&r.container, NULL, &bowl, &error), TY_OK);
    r.container.kind = TY_CONTAINER_MESH;
    r.container.mesh = path;
    r.container.role = TY_CONTAINER_VESSEL;
    assert_int_equal(ty_container_create(&r.container, NULL, &vessel, &error), TY_OK);
    assert_true(ty_container_is_open(vessel));
    ty_bounds a = ty_container_interior(bowl), b = ty_container_interior(vessel);
    assert_true(fabsf(a.high.y - b.high.y) < 1.2e-3f && fabsf(a.low.y - b.low.y) < 1.2e-3f);
    assert_true(fabsf(a.high.x - b.high.x) < 1.2e-3f);
    ty_rng rng = ty_rng_make((ty_seed){3}, 1, 1);
    int in = 0, differ = 0;
    for (int i = 0; i < 4000; i++)
    {
        ty_vec3 n, p = {ty_rng_range(&rng, -0.024f, 0.024f), ty_rng_range(&rng, 0.0f, 0.018f), 0.0f};
        if (fabsf(ty_container_wall(bowl, 0, p, &n)) < 0.8e-3f)
            continue;
        in += ty_container_holds(bowl, p);
        differ += ty_container_holds(bowl, p) != ty_container_holds(vessel, p);
    }
    assert_true(in > 1000 && differ == 0);
    assert_true(ty_container_lost(vessel, ty_vec3_make(0.03f, 0.0f, 0.0f)));
    assert_false(ty_container_lost(vessel, ty_vec3_make(0.0f, 0.1f, 0.0f)));
    ty_container_destroy(bowl);
    ty_container_destroy(vessel);
    ty_aggregate* heap = made(&r, NULL);
    for (uint32_t i = 0; i < heap->instance_count; i++)
        assert_true(heap->transforms[i].t.y > b.low.y && fabsf(heap->transforms[i].t.x) < 0.024f);
    ty_aggregate_destroy(heap);
    unlink(path);
}

static void what_holds_nothing_is_refused(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small();
    ty_shape_def ball = ty_shape_def_default();
    ball.kind = TY_SHAPE_SPHERE;
    ball.radius = 0.02f;
    char path[] = "/tmp/tsuya_ball_XXXXXX.ply", turned[] = "/tmp/tsuya_turned_XXXXXX.ply";
    mesh_write(path, &ball, false);
    mesh_write(turned, &ball, true);
    r.container.kind = TY_CONTAINER_MESH;
    r.container.role = TY_CONTAINER_VESSEL;
    r.container.mesh = path;
    assert_refused(&r, "holds nothing", "");
    r.container.role = TY_CONTAINER_VOLUME;
    r.container.mesh = turned;
    assert_refused(&r, "faces inwards", "");
    r.container.mesh = path;
    r.element.length = r.element.width = r.element.thickness = 0.035f;
    assert_refused(&r, "its inside", "");
    unlink(path);
    unlink(turned);
}

// Without walls a heap stands by friction: a slope that is neither flat nor steep, and flatter with less friction.
static void a_heap_stands_on_the_ground(void** state)
{
    (void)state;
    float height[2];
    for (int i = 0; i < 2; i++)
    {
        ty_aggregate_recipe r = small();
        r.container.kind = TY_CONTAINER_GROUND;
        r.container.shape.radius = 0.036f;
        r.fill.count = 260;
        r.fill.sprinkle = 0.0f;
        r.settle.friction = i == 0 ? 0.6f : 0.15f;
        ty_aggregate* a = made(&r, NULL);
        assert_int_equal(a->instance_count, 260);
        double sum = 0.0;
        for (uint32_t k = 0; k < a->instance_count; k++)
        {
            assert_true(a->transforms[k].t.y > 0.5e-3f);
            sum += (double)a->transforms[k].t.y;
        }
        height[i] = (float)sum / 260.0f;
        ty_aggregate_destroy(a);
    }
    assert_true(height[0] > 2.5e-3f && height[0] > 1.15f * height[1]);
}

// Elements in the cut are gone and only they; the others lie as without the cut.
static void a_cut_takes_its_elements(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small();
    ty_aggregate* whole = made(&r, NULL);
    r.container.cut = (ty_cut_def){TY_CUT_SPHERE, {0.01f, 0.018f, 0.0f}, 0.009f, {0.0f, 0.0f, 1.0f}};
    ty_aggregate* open = made(&r, NULL);
    uint32_t at = 0;
    for (uint32_t i = 0; i < whole->instance_count; i++)
    {
        ty_vec3 p = whole->transforms[i].t;
        if (ty_length(ty_sub(p, r.container.cut.center)) < r.container.cut.radius)
            continue;
        assert_true(at < open->instance_count);
        assert_memory_equal(&p, &open->transforms[at].t, sizeof p);
        at++;
    }
    assert_int_equal(at, open->instance_count);
    assert_true(at < whole->instance_count);
    ty_aggregate_destroy(whole);
    ty_aggregate_destroy(open);
    r.container.cut.kind = TY_CUT_PLANE;
    r.container.cut.center = ty_vec3_make(0.0f, 0.0f, -1.0f);
    assert_refused(&r, "container.cut", "");
    r.container.cut.center = ty_vec3_make(0.0f, 0.0f, 0.0f);
    open = made(&r, NULL);
    for (uint32_t i = 0; i < open->instance_count; i++)
        assert_true(open->transforms[i].t.z <= 0.0f);
    ty_aggregate_destroy(open);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mesh_is_a_vessel),
        cmocka_unit_test(what_holds_nothing_is_refused),
        cmocka_unit_test(a_heap_stands_on_the_ground),
        cmocka_unit_test(a_cut_takes_its_elements),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
