// SPDX-License-Identifier: Apache-2.0
// Meshes whose vertices move while the shutter is open, against the same motion of a whole object.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "trace_meshes.h"
#include <string.h>

#define STEPS 4

static ty_world* new_world(ty_trace_path path)
{
    ty_world_def def = {.path = path};
    ty_world* world = NULL;
    ty_error error;
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    return world;
}

static void add(ty_world* world, const ty_mesh* mesh, ty_motion motion)
{
    ty_error error;
    uint32_t prototype, object;
    ty_object_flags flags = {.mask = TY_MASK_OPAQUE};
    assert_int_equal(ty_world_add_prototype(world, mesh, &prototype, &error), TY_OK);
    assert_int_equal(ty_world_add_object(world, prototype, motion, flags, &object, &error), TY_OK);
}

static void commit(ty_world* world)
{
    ty_error error;
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
}

// Where the mesh goes: along a bent line, thicker and thicker. No turn: maps and vertices both go straight between
// steps.
static ty_affine step_map(int step)
{
    static const ty_vec3 places[STEPS] = {{-1, 0, 0}, {0, 0.5f, 0}, {0.5f, 0, 0.4f}, {0.3f, -0.6f, 0}};
    float size = 0.5f + 0.2f * (float)step;
    return ty_affine_from_trs(places[step], ty_quat_identity(), (ty_vec3){size, 0.6f, size});
}

static void set_steps(ty_mesh* mesh)
{
    assert_true(ty_mesh_make_steps(mesh, STEPS));
    for (int k = 0; k < STEPS; k++)
    {
        ty_mesh* moved = ty_mesh_copy(mesh);
        ty_affine map = step_map(k);
        ty_mesh_transform(moved, &map);
        size_t size = mesh->vertex_count * sizeof(ty_vec3), at = (size_t)k * mesh->vertex_count;
        memcpy(mesh->step_positions + at, moved->positions, size);
        memcpy(mesh->step_normals + at, moved->normals, size);
        ty_mesh_destroy(moved);
    }
}

static void assert_near3(ty_vec3 a, ty_vec3 b, float limit)
{
    if (!(ty_length(ty_sub(a, b)) <= limit))
        fail_msg("(%g %g %g), expected (%g %g %g)", (double)a.x, (double)a.y, (double)a.z, (double)b.x, (double)b.y,
                 (double)b.z);
}

// Both found the same point of the same triangle.
static void compare_hits(const ty_world* bending, const ty_world* flying, const ty_hit* a, const ty_hit* b)
{
    ty_surface_point p, q;
    assert_int_equal(a->triangle, b->triangle);
    assert_true(fabsf(a->t - b->t) < 2e-5f);
    ty_world_surface(bending, a, &p);
    ty_world_surface(flying, b, &q);
    assert_near3(p.position, q.position, 2e-5f);
    assert_near3(p.ng, q.ng, 2e-3f);
    // Shading normals are blended from the steps' own here and made by the blended map there.
    assert_near3(p.ns, q.ns, 0.06f);
    assert_false(p.convex);
    ty_vec3 pu, pv, qu, qv;
    assert_true(ty_world_tangents(bending, &p, &pu, &pv));
    assert_true(ty_world_tangents(flying, &q, &qu, &qv));
    assert_near3(pu, qu, 2e-3f * ty_length(qu));
    assert_near3(pv, qv, 2e-3f * ty_length(qv));
}

// Rays at random times against vertices that move and an object that does; outer is a map of both.
static void compare(ty_trace_path path, const ty_affine* outer, int outer_count)
{
    ty_mesh *mesh = make_sphere(24, 15), *still = ty_mesh_copy(mesh);
    mesh->uvs = TY_ALLOC(ty_vec2, mesh->vertex_count);
    still->uvs = TY_ALLOC(ty_vec2, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->uvs[i] = still->uvs[i] =
            (ty_vec2){mesh->positions[i].x + 0.3f * mesh->positions[i].z, mesh->positions[i].y};
    set_steps(mesh);
    ty_affine maps[STEPS];
    for (int k = 0; k < STEPS; k++)
    {
        ty_affine map = step_map(k);
        maps[k] = ty_affine_multiply(&outer[outer_count > 1 ? k : 0], &map);
    }
    ty_world *bending = new_world(path), *flying = new_world(path);
    add(bending, mesh, (ty_motion){.steps = outer, .step_count = outer_count});
    add(flying, still, (ty_motion){.steps = maps, .step_count = STEPS});
    commit(bending);
    commit(flying);
    assert_true(ty_world_is_moving(bending, 0));
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    int hits = 0, differing = 0;
    for (int i = 0; i < 9000; i++)
    {
        ty_ray ray = ty_ray_make(random_point(&rng, 2.0f), random_direction(&rng), TY_FLOAT_MAX);
        ray.time = ty_rng_float(&rng);
        ty_hit a, b, alone;
        bool found = ty_world_intersect(bending, &ray, &a), expected = ty_world_intersect(flying, &ray, &b);
        assert_int_equal(ty_world_occluded(bending, &ray), found);
        bool inside =
            ty_world_intersect_instance(bending, 0, 0, ray.time, ray.origin, ray.direction, TY_FLOAT_MAX, &alone);
        differing += found != expected || (found && a.triangle != b.triangle) || inside != found;
        if (!found || !expected || a.triangle != b.triangle)
            continue;
        hits++;
        compare_hits(bending, flying, &a, &b);
        assert_true(fabsf(alone.t - a.t) < 1e-5f && alone.triangle == a.triangle);
    }
    print_message("  %d hits, %d differ\n", hits, differing);
    assert_true(hits > 300 && differing < 10);
    ty_bounds box = ty_world_bounds(bending), expected = ty_world_bounds(flying);
    assert_true(box.low.x <= expected.low.x + 1e-4f && box.high.x >= expected.high.x - 1e-4f);
    ty_world_destroy(bending);
    ty_world_destroy(flying);
    ty_mesh_destroy(mesh);
    ty_mesh_destroy(still);
}

static void vertices_move_as_an_object_would(void** state)
{
    (void)state;
    ty_affine identity = ty_affine_identity();
    ty_affine aside = ty_affine_from_trs((ty_vec3){0.2f, 0.1f, 0}, ty_quat_axis_angle((ty_vec3){0, 1, 0}, 1.0f),
                                         (ty_vec3){0.8f, 0.8f, 0.8f});
    for (int path = 0; path < 2; path++)
    {
        compare((ty_trace_path)path, &identity, 1);
        compare((ty_trace_path)path, &aside, 1);
    }
}

// An object that shifts while its vertices move: shifts are linear between the same steps, so both are one motion.
static void objects_carry_their_vertices(void** state)
{
    (void)state;
    ty_affine shifts[STEPS];
    for (int k = 0; k < STEPS; k++)
    {
        shifts[k] = ty_affine_identity();
        shifts[k].t = (ty_vec3){0.1f * (float)k, -0.2f * (float)(k * k % 3), 0.0f};
    }
    for (int path = 0; path < 2; path++)
        compare((ty_trace_path)path, shifts, STEPS);
}

// Questions without a time are about the frame's own moment, and so are a mesh's instances in an aggregate.
static void the_frame_keeps_its_moment(void** state)
{
    (void)state;
    ty_mesh* mesh = make_sphere(24, 15);
    ty_aggregate* one = ty_aggregate_create(1, 1);
    one->prototypes[0] = make_sphere(24, 15);
    one->transforms[0] = ty_affine_identity();
    set_steps(mesh);
    set_steps(one->prototypes[0]);
    for (int path = 0; path < 2; path++)
    {
        ty_world *world = new_world((ty_trace_path)path), *grains = new_world((ty_trace_path)path);
        ty_affine identity = ty_affine_identity();
        add(world, mesh, ty_motion_at_rest(&identity));
        commit(world);
        ty_closest closest;
        ty_hit hit;
        assert_true(ty_world_inside(world, 0, (ty_vec3){0, 0.9f, 0}));
        assert_true(ty_world_closest(world, 0, (ty_vec3){0, 2, 0}, 3.0f, &closest));
        assert_true(fabsf(closest.distance - 1.0f) < 1e-5f);
        assert_true(
            ty_world_intersect_prototype(world, 0, (ty_vec3){0, 2, 0.001f}, (ty_vec3){0, -1, 0}, 9, &hit, NULL));
        assert_true(fabsf(hit.t - 1.0f) < 1e-2f);
        uint32_t object;
        ty_error error;
        assert_int_equal(ty_world_add_aggregate(grains, one, ty_motion_at_rest(&identity),
                                                (ty_object_flags){.mask = TY_MASK_OPAQUE}, &object, &error),
                         TY_OK);
        commit(grains);
        assert_false(ty_world_is_moving(grains, 0));
        ty_ray ray = ty_ray_make((ty_vec3){0.1f, 2, 0.2f}, (ty_vec3){0, -1, 0}, TY_FLOAT_MAX);
        ray.time = 0.7f;
        ty_surface_point point;
        assert_true(ty_world_intersect(grains, &ray, &hit));
        ty_world_surface(grains, &hit, &point);
        assert_true(fabsf(ty_length(point.position) - 1.0f) < 1e-2f && fabsf(2.0f - hit.t - point.position.y) < 1e-5f);
        ty_world_destroy(world);
        ty_world_destroy(grains);
    }
    ty_mesh_destroy(mesh);
    ty_aggregate_destroy(one);
}

// A copy has steps of its own, and what forgets them stands still.
static void steps_belong_to_the_mesh(void** state)
{
    (void)state;
    ty_mesh* mesh = make_sphere(12, 7);
    set_steps(mesh);
    ty_mesh* copy = ty_mesh_copy(mesh);
    size_t size = STEPS * mesh->vertex_count * sizeof(ty_vec3);
    assert_int_equal(copy->step_count, STEPS);
    assert_memory_equal(copy->step_positions, mesh->step_positions, size);
    assert_memory_equal(copy->step_normals, mesh->step_normals, size);
    ty_mesh_forget_steps(mesh);
    assert_int_equal(mesh->step_count, 0);
    ty_world* world = new_world(TY_TRACE_FAST);
    ty_affine identity = ty_affine_identity();
    add(world, mesh, ty_motion_at_rest(&identity));
    commit(world);
    assert_false(ty_world_is_moving(world, 0));
    ty_world_destroy(world);
    ty_mesh_destroy(mesh);
    ty_mesh_destroy(copy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices_move_as_an_object_would),
        cmocka_unit_test(objects_carry_their_vertices),
        cmocka_unit_test(the_frame_keeps_its_moment),
        cmocka_unit_test(steps_belong_to_the_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
