// SPDX-License-Identifier: Apache-2.0
// Objects that move while the shutter is open, masks, and worlds that are cleared and filled again.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "trace_meshes.h"
#include <string.h>

static const float times[] = {0.0f, 0.3f, 1.0f};
static const ty_vec3 down = {0, 0, -1};

static ty_world* new_world(ty_trace_path path)
{
    ty_world_def def = {.path = path};
    ty_world* world = NULL;
    ty_error error;
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    return world;
}

static void add(ty_world* world, const ty_mesh* mesh, ty_motion motion, uint32_t mask)
{
    ty_error error;
    uint32_t prototype, object;
    ty_object_flags flags = {.mask = mask};
    assert_int_equal(ty_world_add_prototype(world, mesh, &prototype, &error), TY_OK);
    assert_int_equal(ty_world_add_object(world, prototype, motion, flags, &object, &error), TY_OK);
}

static void commit(ty_world* world)
{
    ty_error error;
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
}

// A ball of radius .2 that flies along x is where it should be, for every query.
static void flies(void** state)
{
    (void)state;
    ty_mesh* ball = make_sphere(64, 41);
    ty_affine steps[2] = {ty_affine_identity(), ty_affine_identity()};
    for (int i = 0; i < 2; i++)
        steps[i] =
            ty_affine_from_trs((ty_vec3){3.0f * (float)i, 0, 0}, ty_quat_identity(), (ty_vec3){0.2f, 0.2f, 0.2f});
    for (int path = 0; path < 2; path++)
    {
        ty_world* world = new_world((ty_trace_path)path);
        add(world, ball, (ty_motion){.steps = steps, .step_count = 2}, TY_MASK_OPAQUE);
        commit(world);
        assert_true(ty_world_is_moving(world, 0));
        for (int i = 0; i < 3; i++)
        {
            float x = 3.0f * times[i];
            ty_hit hit, same;
            ty_ray ray = ty_ray_make((ty_vec3){x, 0, 2}, down, TY_FLOAT_MAX);
            ray.time = times[i];
            assert_true(ty_world_intersect(world, &ray, &hit));
            assert_true(fabsf(hit.t - 1.8f) < 1e-3f);
            ty_surface_point point;
            ty_world_surface(world, &hit, &point);
            assert_true(fabsf(point.position.x - x) < 1e-4f && fabsf(point.position.z - 0.2f) < 1e-3f);
            assert_true(point.time == times[i] && point.ng.z > 0.99f);
            assert_true(ty_world_occluded(world, &ray));
            assert_true(ty_world_intersect_instance(world, 0, 0, times[i], ray.origin, down, 10.0f, &same));
            assert_true(fabsf(same.t - hit.t) < 1e-5f);
            // Beside it, and where it is at another time: nothing.
            ray.origin.x = x + 0.21f;
            assert_false(ty_world_intersect(world, &ray, &hit) || ty_world_occluded(world, &ray));
            ray.origin.x = x;
            ray.time = times[i] < 0.5f ? 0.6f : 0.5f;
            assert_false(ty_world_intersect(world, &ray, &hit));
        }
        assert_true(ty_world_bounds(world).high.x > 3.19f && ty_world_bounds(world).low.x < -0.19f);
        ty_world_destroy(world);
    }
    ty_mesh_destroy(ball);
}

// A ball on an arm that turns by a quarter: it stays on the circle, at the angle that the time says.
static void turns(void** state)
{
    (void)state;
    ty_aggregate* arm = ty_aggregate_create(1, 1);
    arm->prototypes[0] = make_sphere(64, 41);
    arm->transforms[0] = ty_affine_from_trs((ty_vec3){1, 0, 0}, ty_quat_identity(), (ty_vec3){0.1f, 0.1f, 0.1f});
    ty_affine steps[2] = {ty_affine_identity(),
                          ty_affine_from_trs((ty_vec3){0, 0, 0}, ty_quat_axis_angle((ty_vec3){0, 0, 1}, 0.5f * TY_PI),
                                             (ty_vec3){1, 1, 1})};
    for (int path = 0; path < 2; path++)
    {
        ty_world* world = new_world((ty_trace_path)path);
        uint32_t object;
        ty_error error;
        assert_int_equal(ty_world_add_aggregate(world, arm, (ty_motion){.steps = steps, .step_count = 2},
                                                (ty_object_flags){.mask = TY_MASK_OPAQUE}, &object, &error),
                         TY_OK);
        commit(world);
        for (int i = 0; i <= 20; i++)
        {
            float time = 0.05f * (float)i, s, c;
            ty_sincos(0.5f * TY_PI * time, &s, &c);
            ty_ray ray = ty_ray_make((ty_vec3){c, s, 2}, down, TY_FLOAT_MAX);
            ray.time = time;
            ty_hit hit;
            assert_true(ty_world_intersect(world, &ray, &hit));
            assert_true(fabsf(hit.t - 1.9f) < 1e-3f);
            ty_affine map = ty_world_to_world(world, 0, 0, time);
            assert_true(ty_length(ty_sub(map.t, (ty_vec3){c, s, 0})) < 1e-3f);
        }
        ty_world_destroy(world);
    }
    ty_aggregate_destroy(arm);
}

static ty_aggregate* make_heap(uint32_t count)
{
    ty_aggregate* heap = ty_aggregate_create(count, 2);
    heap->prototypes[0] = make_sphere(24, 15);
    heap->prototypes[1] = make_torus(24, 12);
    ty_rng rng = ty_rng_make((ty_seed){21}, count, 0);
    for (uint32_t i = 0; i < count; i++)
    {
        heap->prototype_index[i] = i % 2;
        heap->transforms[i] = random_map(&rng, i, 1.0f, 0.06f);
    }
    return heap;
}

// A heap that tumbles and a torus that is flung about through a heap at rest: both paths see the same.
static void paths_agree(void** state)
{
    (void)state;
    ty_aggregate *rest = make_heap(200), *moving = make_heap(150);
    ty_mesh* torus = make_torus(24, 12);
    ty_affine tumble[3], flight[2];
    for (int i = 0; i < 3; i++)
        tumble[i] =
            ty_affine_from_trs((ty_vec3){0.3f * (float)i, 0.1f, 0},
                               ty_quat_axis_angle((ty_vec3){0.6f, 0, 0.8f}, 0.7f * (float)i), (ty_vec3){1, 0.9f, 1});
    for (int i = 0; i < 2; i++)
        flight[i] = ty_affine_from_trs((ty_vec3){-0.5f, 0.8f * (float)i, 0}, ty_quat_identity(),
                                       (ty_vec3){0.3f, 0.3f, -0.3f - 0.2f * (float)i});
    ty_affine identity = ty_affine_identity();
    ty_world* world[2];
    ty_error error;
    uint32_t object;
    for (int path = 0; path < 2; path++)
    {
        world[path] = new_world((ty_trace_path)path);
        ty_object_flags flags = {.mask = TY_MASK_OPAQUE, .one_sided = ~0ull};
        ty_motion motion = {.steps = tumble, .step_count = 3};
        assert_int_equal(
            ty_world_add_aggregate(world[path], rest, ty_motion_at_rest(&identity), flags, &object, &error), TY_OK);
        assert_int_equal(ty_world_add_aggregate(world[path], moving, motion, flags, &object, &error), TY_OK);
        add(world[path], torus, (ty_motion){.steps = flight, .step_count = 2}, TY_MASK_OPAQUE);
        commit(world[path]);
    }
    ty_rng rng = ty_rng_make((ty_seed){22}, 0, 0);
    int hits[3] = {0}, differing = 0;
    for (int i = 0; i < 20000; i++)
    {
        ty_vec3 direction = random_direction(&rng);
        ty_ray ray = ty_ray_make(random_point(&rng, 1.5f), direction, i % 4 ? TY_FLOAT_MAX : ty_rng_float(&rng));
        ray.time = ty_rng_float(&rng);
        ray.flags = i % 3 == 0 ? TY_RAY_FRONT_ONLY : TY_RAY_PLAIN;
        for (int skip = 0; skip < 2; skip++)
        {
            ty_hit a, b;
            bool fast = ty_world_intersect(world[0], &ray, &a), reference = ty_world_intersect(world[1], &ray, &b);
            assert_int_equal(ty_world_occluded(world[0], &ray), fast);
            assert_int_equal(ty_world_occluded(world[1], &ray), reference);
            differing +=
                fast != reference || (fast && (a.object != b.object || a.instance != b.instance ||
                                               a.triangle != b.triangle || fabsf(a.t - b.t) > 1e-5f * (1.0f + b.t)));
            if (!fast)
                break;
            hits[a.object]++;
            ray.skip_object = a.object;
            ray.skip_instance = a.instance;
            ray.skip_distance = i % 2 ? TY_FLOAT_MAX : a.t * 1.001f;
        }
    }
    print_message("  %d at rest, %d moving, %d flung; %d differ\n", hits[0], hits[1], hits[2], differing);
    assert_true(hits[0] > 1000 && hits[1] > 1000 && hits[2] > 300);
    assert_true(differing < 20);
    for (int path = 0; path < 2; path++)
        ty_world_destroy(world[path]);
    ty_aggregate_destroy(rest);
    ty_aggregate_destroy(moving);
    ty_mesh_destroy(torus);
}

static void refuses_bad_motion(void** state)
{
    (void)state;
    ty_mesh* ball = make_sphere(12, 7);
    ty_world* world = new_world(TY_TRACE_FAST);
    uint32_t prototype, object;
    ty_error error;
    ty_affine steps[TY_MOTION_MAX_STEPS + 1];
    for (int i = 0; i <= TY_MOTION_MAX_STEPS; i++)
        steps[i] = ty_affine_identity();
    ty_object_flags flags = {.mask = TY_MASK_OPAQUE};
    assert_int_equal(ty_world_add_prototype(world, ball, &prototype, &error), TY_OK);
    ty_motion motion = {.steps = steps, .step_count = TY_MOTION_MAX_STEPS + 1};
    assert_int_equal(ty_world_add_object(world, prototype, motion, flags, &object, &error), TY_BAD_INPUT);
    steps[1].x.x = -1.0f;
    motion.step_count = 2;
    assert_int_equal(ty_world_add_object(world, prototype, motion, flags, &object, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "inside out"));
    steps[1].x.x = NAN;
    assert_int_equal(ty_world_add_object(world, prototype, motion, flags, &object, &error), TY_BAD_INPUT);
    steps[1].x.x = 1.0f;
    assert_int_equal(ty_world_add_object(world, prototype, motion, flags, &object, &error), TY_OK);
    assert_int_equal(object, 0);
    ty_world_destroy(world);
    ty_mesh_destroy(ball);
}

// Three balls behind one another and a heap's grain, each for other rays.
static void masks_hide(void** state)
{
    (void)state;
    ty_mesh* ball = make_sphere(24, 15);
    ty_aggregate* one = ty_aggregate_create(1, 1);
    one->prototypes[0] = make_sphere(24, 15);
    one->transforms[0] = ty_affine_from_trs((ty_vec3){0, 0, -9}, ty_quat_identity(), (ty_vec3){1, 1, 1});
    static const uint32_t masks[4] = {TY_MASK_CAMERA, TY_MASK_SHADOW_TRANSPARENT | TY_MASK_DIFFUSE, TY_MASK_OPAQUE,
                                      TY_MASK_OPAQUE & ~TY_MASK_CAMERA};
    ty_affine away[2] = {ty_affine_identity(), ty_affine_identity()};
    for (int path = 0; path < 2; path++)
        for (int moving = 0; moving < 2; moving++)
        {
            ty_world* world = new_world((ty_trace_path)path);
            uint32_t object;
            ty_error error;
            for (int i = 0; i < 3; i++)
            {
                away[0].t = away[1].t = (ty_vec3){0, 0, -3.0f * (float)i};
                away[1].t.x = 5.0f;
                add(world, ball, (ty_motion){.steps = away, .step_count = 1 + moving}, masks[i]);
            }
            away[0].t = away[1].t = (ty_vec3){0, 0, 0};
            away[1].t.x = 5.0f;
            assert_int_equal(ty_world_add_aggregate(world, one, (ty_motion){.steps = away, .step_count = 1 + moving},
                                                    (ty_object_flags){.mask = masks[3]}, &object, &error),
                             TY_OK);
            commit(world);
            for (uint32_t bits = 0; bits <= TY_MASK_ALL; bits++)
            {
                uint32_t first = 0;
                while (first < 4 && !(masks[first] & bits))
                    first++;
                ty_ray ray = ty_ray_make((ty_vec3){0.1f, 0, 5}, down, TY_FLOAT_MAX);
                ray.mask = bits;
                ty_hit hit;
                assert_int_equal(ty_world_intersect(world, &ray, &hit), first < 4);
                assert_int_equal(ty_world_occluded(world, &ray), first < 4);
                assert_true(first == 4 || hit.object == first);
            }
            ty_world_destroy(world);
        }
    ty_mesh_destroy(ball);
    ty_aggregate_destroy(one);
}

// A world filled anew is the world built so in the first place; prototypes stay, and their places are used again.
static void filled_again(void** state)
{
    (void)state;
    ty_mesh *ball = make_sphere(24, 15), *torus = make_torus(24, 12), *other = make_torus(12, 8);
    ty_affine identity = ty_affine_identity(), aside = ty_affine_identity();
    aside.t.x = 0.4f;
    for (int path = 0; path < 2; path++)
    {
        ty_world *again = new_world((ty_trace_path)path), *fresh = new_world((ty_trace_path)path);
        add(again, ball, ty_motion_at_rest(&identity), TY_MASK_OPAQUE);
        add(again, torus, ty_motion_at_rest(&identity), TY_MASK_OPAQUE);
        commit(again);
        uint64_t before = ty_world_memory(again);
        ty_world_clear_objects(again);
        ty_world_remove_prototype(again, 1);
        assert_null(ty_world_prototype_count(again) > 1 ? ty_world_prototype_mesh(again, 1) : NULL);
        for (int frame = 0; frame < 20; frame++)
        {
            add(again, ball, ty_motion_at_rest(&aside), TY_MASK_OPAQUE);
            add(again, other, ty_motion_at_rest(&identity), TY_MASK_OPAQUE);
            commit(again);
            if (frame < 19)
                ty_world_clear_objects(again);
        }
        assert_true(ty_world_memory(again) < before);
        assert_int_equal(ty_world_prototype_count(again), 2);
        add(fresh, ball, ty_motion_at_rest(&aside), TY_MASK_OPAQUE);
        add(fresh, other, ty_motion_at_rest(&identity), TY_MASK_OPAQUE);
        commit(fresh);
        ty_rng rng = ty_rng_make((ty_seed){23}, 0, 0);
        int hits = 0;
        for (int i = 0; i < 2000; i++)
        {
            ty_ray ray = ty_ray_make(random_point(&rng, 2.0f), random_direction(&rng), TY_FLOAT_MAX);
            ty_hit a, b;
            memset(&a, 0, sizeof a);
            memset(&b, 0, sizeof b);
            hits += ty_world_intersect(fresh, &ray, &b);
            ty_world_intersect(again, &ray, &a);
            assert_memory_equal(&a, &b, sizeof a);
        }
        assert_true(hits > 200);
        ty_world_destroy(again);
        ty_world_destroy(fresh);
    }
    ty_mesh_destroy(ball);
    ty_mesh_destroy(torus);
    ty_mesh_destroy(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flies),      cmocka_unit_test(turns),        cmocka_unit_test(paths_agree),
        cmocka_unit_test(masks_hide), cmocka_unit_test(filled_again), cmocka_unit_test(refuses_bad_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
