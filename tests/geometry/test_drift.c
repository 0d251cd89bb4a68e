// SPDX-License-Identifier: Apache-2.0
// Instances that go by velocities and spins of their own while the shutter is open.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "trace_meshes.h"
#include <string.h>
#include <tsuya/base/memory.h>

static const ty_vec3 down = {0, 0, -1};

static void set_motion(ty_aggregate* a, uint32_t i, ty_vec3 velocity, ty_vec3 spin)
{
    ty_aggregate_add_velocities(a)[i] = velocity;
    ty_aggregate_add_spins(a)[i] = spin;
}

static ty_world* world_of(ty_trace_path path, const ty_aggregate* a, ty_motion motion, ty_object_flags flags)
{
    ty_world_def def = {.path = path};
    ty_world* world = NULL;
    uint32_t object;
    ty_error error;
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    assert_int_equal(ty_world_add_aggregate(world, a, motion, flags, &object, &error), TY_OK);
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
    return world;
}

static const ty_affine unmoved = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
static const ty_object_flags plain = {.mask = TY_MASK_OPAQUE};

static ty_motion over(float open, float close)
{
    return (ty_motion){.steps = &unmoved, .step_count = 1, .open = open, .close = close};
}

static bool meets(const ty_world* world, float x, float time, ty_hit* hit)
{
    ty_ray ray = ty_ray_make((ty_vec3){x, 0, 2}, down, TY_FLOAT_MAX);
    ray.time = time;
    bool met = ty_world_intersect(world, &ray, hit);
    assert_int_equal(ty_world_occluded(world, &ray), met);
    return met;
}

// A ball of radius .1 at 3 m/s, shutter from -.02 to .03 s: it smears from -.06 - .1 to .09 + .1, is at each moment
// where it should be, and covers a point as long as its chord takes to pass.
static void smears_over_its_path(void** state)
{
    (void)state;
    ty_aggregate* a = ty_aggregate_create(1, 1);
    a->prototypes[0] = make_sphere(128, 81);
    a->transforms[0] = ty_affine_from_trs((ty_vec3){0, 0, 0}, ty_quat_identity(), (ty_vec3){0.1f, 0.1f, 0.1f});
    set_motion(a, 0, (ty_vec3){3, 0, 0}, (ty_vec3){0, 0, 0});
    for (int path = 0; path < 2; path++)
    {
        ty_world* world = world_of((ty_trace_path)path, a, over(-0.02f, 0.03f), plain);
        assert_true(ty_world_is_moving(world, 0));
        ty_hit hit, same;
        int covered = 0;
        for (int i = 0; i <= 1000; i++)
        {
            float time = 0.001f * (float)i, x = 3.0f * (-0.02f + 0.05f * time);
            assert_true(meets(world, x, time, &hit));
            assert_true(fabsf(hit.t - 1.9f) < 1e-4f && hit.time == time);
            assert_false(meets(world, x + 0.101f, time, &hit) || meets(world, x - 0.101f, time, &hit));
            covered += meets(world, 0.15f, time, &hit); // from .05 on, which it passes at time .733
        }
        assert_true(fabsf((float)covered - 267.0f) <= 2.0f);
        float edge = 0.1f + 3.0f * 0.03f;
        assert_true(meets(world, edge - 0.0005f, 1.0f, &hit) && !meets(world, edge + 0.0005f, 1.0f, &hit));
        ty_surface_point point;
        assert_true(meets(world, 0.0f, 0.4f, &hit));
        ty_world_surface(world, &hit, &point);
        assert_true(fabsf(point.position.x) < 1e-5f && fabsf(point.position.z - 0.1f) < 1e-4f);
        assert_true(ty_world_intersect_instance(world, 0, 0, 0.4f, (ty_vec3){0, 0, 2}, down, 10.0f, &same));
        assert_true(fabsf(same.t - hit.t) < 1e-6f);
        ty_bounds box = ty_world_bounds(world);
        assert_true(fabsf(box.low.x + 0.16f) < 2e-4f && fabsf(box.high.x - 0.19f) < 2e-4f);
        ty_world_destroy(world);
    }
    ty_aggregate_destroy(a);
}

// A rod that turns by 2.4 radians about its middle: it lies where the angle of the moment says, all the way to its tip.
static void turns_about_its_origin(void** state)
{
    (void)state;
    ty_aggregate* a = ty_aggregate_create(2, 1);
    a->prototypes[0] = make_sphere(128, 81);
    a->transforms[0] = ty_affine_from_trs((ty_vec3){5, 1, 0}, ty_quat_identity(), (ty_vec3){1, 0.004f, 0.004f});
    a->transforms[1].t.x = -5.0f; // alone it would be traced without a box
    set_motion(a, 0, (ty_vec3){0, 2, 0}, (ty_vec3){0, 0, 60});
    set_motion(a, 1, (ty_vec3){0, 2, 0}, (ty_vec3){0, 0, 0});
    for (int path = 0; path < 2; path++)
    {
        ty_world* world = world_of((ty_trace_path)path, a, over(0.0f, 0.04f), plain);
        for (int i = 0; i <= 200; i++)
        {
            float time = 0.005f * (float)i, s, c;
            ty_sincos(2.4f * time, &s, &c);
            ty_ray ray = ty_ray_make((ty_vec3){5 + 0.998f * c, 1 + 0.08f * time + 0.998f * s, 2}, down, TY_FLOAT_MAX);
            ray.time = time;
            ty_hit hit;
            assert_true(ty_world_intersect(world, &ray, &hit));
            assert_true(fabsf(hit.t - (2.0f - 0.004f * sqrtf(1.0f - 0.998f * 0.998f))) < 2e-4f);
            ray.origin = (ty_vec3){5 + 0.998f * c - 0.01f * s, 1 + 0.08f * time + 0.998f * s + 0.01f * c, 2};
            assert_false(ty_world_intersect(world, &ray, &hit));
        }
        ty_world_destroy(world);
    }
    ty_aggregate_destroy(a);
}

static ty_aggregate* make_heap(uint32_t count, float fast)
{
    ty_aggregate* heap = ty_aggregate_create(count, 2);
    heap->prototypes[0] = make_sphere(24, 15);
    heap->prototypes[1] = make_torus(24, 12);
    ty_rng rng = ty_rng_make((ty_seed){31}, count, 0);
    for (uint32_t i = 0; i < count; i++)
    {
        heap->prototype_index[i] = i % 2;
        heap->transforms[i] = random_map(&rng, i, 1.0f, 0.06f);
        float own = i % 3 == 0 ? 0.0f : fast;
        ty_vec3 v = ty_mul(random_direction(&rng), 2.0f * own), w = ty_mul(random_direction(&rng), 40.0f * own);
        set_motion(heap, i, v, w);
    }
    return heap;
}

static ty_ray random_ray(ty_rng* rng, int i)
{
    ty_ray ray = ty_ray_make(random_point(rng, 1.5f), random_direction(rng), i % 4 ? TY_FLOAT_MAX : ty_rng_float(rng));
    ray.time = ty_rng_float(rng);
    ray.flags = i % 3 == 0 ? TY_RAY_FRONT_ONLY : TY_RAY_PLAIN;
    return ray;
}

// A heap of which two thirds move, at rest and moving as a whole: both paths see the same, whatever is skipped. Embree
// blends its maps, 4 degrees apart, linearly, which shrinks by up to .06 %: 4e-5 here.
static void paths_agree(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(300, 1.0f);
    ty_affine tumble[3];
    for (int i = 0; i < 3; i++)
        tumble[i] =
            ty_affine_from_trs((ty_vec3){0.3f * (float)i, 0.1f, 0},
                               ty_quat_axis_angle((ty_vec3){0.6f, 0, 0.8f}, 0.7f * (float)i), (ty_vec3){1, 0.9f, 1});
    for (int tumbles = 0; tumbles < 2; tumbles++)
    {
        ty_motion motion = over(-0.03f, 0.04f);
        if (tumbles)
            motion = (ty_motion){.steps = tumble, .step_count = 3, .open = -0.03f, .close = 0.04f};
        ty_world* world[2];
        for (int path = 0; path < 2; path++)
            world[path] =
                world_of((ty_trace_path)path, heap, motion, (ty_object_flags){.mask = TY_MASK_OPAQUE, .one_sided = 1});
        ty_rng rng = ty_rng_make((ty_seed){32}, 0, 0);
        int hits = 0, differing = 0;
        for (int i = 0; i < 20000; i++)
        {
            ty_ray ray = random_ray(&rng, i);
            for (int skip = 0; skip < 2; skip++)
            {
                ty_hit a, b;
                bool fast = ty_world_intersect(world[0], &ray, &a), reference = ty_world_intersect(world[1], &ray, &b);
                assert_int_equal(ty_world_occluded(world[0], &ray), fast);
                differing += fast != reference || (fast && (a.instance != b.instance || fabsf(a.t - b.t) > 1e-3f));
                if (!fast)
                    break;
                hits++;
                ray.skip_object = a.object;
                ray.skip_instance = a.instance;
                ray.skip_distance = i % 2 ? TY_FLOAT_MAX : a.t + 2e-4f;
            }
        }
        print_message("  %d hits, %d differ\n", hits, differing);
        assert_true(hits > 3000 && differing < 40);
        for (int path = 0; path < 2; path++)
            ty_world_destroy(world[path]);
    }
    ty_aggregate_destroy(heap);
}

// Without speed, without time, or too slow to be seen: the same hits to the bit as without velocities, from the wide
// level.
static void rests_to_the_bit(void** state)
{
    (void)state;
    ty_aggregate *none = make_heap(200, 0.0f), *slow = make_heap(200, 1e-5f), *fast = make_heap(200, 1.0f);
    ty_free(none->velocities);
    ty_free(none->spins);
    none->velocities = none->spins = NULL;
    ty_aggregate* still = make_heap(200, 0.0f);
    ty_world* worlds[4] = {world_of(TY_TRACE_FAST, none, over(-0.01f, 0.01f), plain),
                           world_of(TY_TRACE_FAST, still, over(-0.01f, 0.01f), plain),
                           world_of(TY_TRACE_FAST, slow, over(-0.01f, 0.01f), plain),
                           world_of(TY_TRACE_FAST, fast, over(0.0f, 0.0f), plain)};
    ty_rng rng = ty_rng_make((ty_seed){33}, 0, 0);
    int hits = 0;
    for (int i = 0; i < 4; i++)
    {
        assert_false(ty_world_is_moving(worlds[i], 0));
        assert_true(ty_world_memory(worlds[i]) == ty_world_memory(worlds[0]));
    }
    for (int i = 0; i < 8000; i++)
    {
        ty_ray ray = random_ray(&rng, i);
        ty_hit first = {0}, hit;
        bool met = ty_world_intersect(worlds[0], &ray, &first);
        hits += met;
        for (int k = 1; k < 4; k++)
        {
            hit = (ty_hit){0};
            assert_int_equal(ty_world_intersect(worlds[k], &ray, &hit), met);
            assert_memory_equal(&hit, &first, sizeof hit);
        }
    }
    assert_true(hits > 1000);
    for (int i = 0; i < 4; i++)
        ty_world_destroy(worlds[i]);
    ty_aggregate_destroy(none);
    ty_aggregate_destroy(still);
    ty_aggregate_destroy(slow);
    ty_aggregate_destroy(fast);
}

static void refuses_what_leaves_the_finite(void** state)
{
    (void)state;
    ty_aggregate* a = make_heap(4, 1.0f);
    a->spins[2].y = INFINITY;
    ty_world_def def = {.path = TY_TRACE_FAST};
    ty_world* world = NULL;
    uint32_t object;
    ty_error error;
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    assert_int_equal(ty_world_add_aggregate(world, a, over(0.0f, 0.1f), plain, &object, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "instance 2"));
    ty_world_destroy(world);
    ty_aggregate_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smears_over_its_path),
        cmocka_unit_test(turns_about_its_origin),
        cmocka_unit_test(paths_agree),
        cmocka_unit_test(rests_to_the_bit),
        cmocka_unit_test(refuses_what_leaves_the_finite),
    };
    return cmocka_run_group_tests_name("drift", tests, NULL, NULL);
}
