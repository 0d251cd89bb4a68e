// SPDX-License-Identifier: Apache-2.0
// The fast path against the reference path, hit for hit; skips, one-sided objects, determinism.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../../geometry/trace_world.h"
#include "trace_meshes.h"
#include <string.h>

#define INSTANCES 500u
#define RAYS 20000

static const ty_object_flags opaque = {.mask = TY_MASK_OPAQUE};
static const ty_object_flags subsurface = {.one_sided = ~0ull, .mask = TY_MASK_OPAQUE};

// Spheres and non-convex tori, stretched and mirrored, overlapping in a cube of 2 x 2 x 2.
static ty_aggregate* make_heap(uint64_t key)
{
    ty_aggregate* heap = ty_aggregate_create(INSTANCES, 2);
    heap->prototypes[0] = make_sphere(24, 15);
    heap->prototypes[1] = make_torus(24, 12);
    ty_rng rng = ty_rng_make((ty_seed){11}, key, 0);
    for (uint32_t i = 0; i < INSTANCES; i++)
    {
        heap->prototype_index[i] = i % 2;
        heap->transforms[i] = random_map(&rng, i, 1.0f, 0.06f);
    }
    return heap;
}

// A plain torus (object 0), a heap (1), a turned, shrunk and subsurface heap (2), a subsurface sphere (3).
typedef struct stage
{
    ty_aggregate *first, *second;
    ty_mesh* sphere;
    ty_world* world[2]; // by ty_trace_path
} stage;

static ty_world* build_world(stage* s, ty_trace_path path)
{
    ty_world_def def = ty_world_def_default();
    def.path = path;
    ty_world* world = NULL;
    ty_error error;
    uint32_t object, prototype;
    ty_affine identity = ty_affine_identity();
    ty_affine plain = ty_affine_from_trs((ty_vec3){0.2f, 0.9f, 0.0f}, ty_quat_identity(), (ty_vec3){0.4f, 0.4f, -0.6f});
    ty_affine turned =
        ty_affine_from_trs((ty_vec3){0.5f, -0.3f, 0.4f}, ty_quat_axis_angle((ty_vec3){0.6f, 0.0f, 0.8f}, 1.1f),
                           (ty_vec3){0.9f, 0.8f, 1.0f});
    ty_affine small = ty_affine_from_trs((ty_vec3){-0.7f, 0.0f, 0.1f}, ty_quat_identity(), (ty_vec3){0.5f, 0.3f, 0.5f});
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    assert_int_equal(ty_world_add_prototype(world, s->first->prototypes[1], &prototype, &error), TY_OK);
    assert_int_equal(ty_world_add_object(world, prototype, ty_motion_at_rest(&plain), opaque, &object, &error), TY_OK);
    assert_int_equal(ty_world_add_aggregate(world, s->first, ty_motion_at_rest(&identity), opaque, &object, &error),
                     TY_OK);
    assert_int_equal(ty_world_add_aggregate(world, s->second, ty_motion_at_rest(&turned), subsurface, &object, &error),
                     TY_OK);
    assert_int_equal(ty_world_add_prototype(world, s->sphere, &prototype, &error), TY_OK);
    assert_int_equal(ty_world_add_object(world, prototype, ty_motion_at_rest(&small), subsurface, &object, &error),
                     TY_OK);
    assert_int_equal(object, 3);
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
    return world;
}

static int set_up(void** state)
{
    stage* s = ty_alloc(1, sizeof *s);
    s->first = make_heap(1);
    s->second = make_heap(2);
    s->sphere = make_sphere(40, 25);
    s->world[TY_TRACE_FAST] = build_world(s, TY_TRACE_FAST);
    s->world[TY_TRACE_REFERENCE] = build_world(s, TY_TRACE_REFERENCE);
    *state = s;
    return 0;
}

static int tear_down(void** state)
{
    stage* s = *state;
    ty_world_destroy(s->world[0]);
    ty_world_destroy(s->world[1]);
    ty_aggregate_destroy(s->first);
    ty_aggregate_destroy(s->second);
    ty_mesh_destroy(s->sphere);
    ty_free(s);
    return 0;
}

// Half from outside, half from within the heap; every fifth short.
static ty_ray random_ray(ty_rng* rng, int i)
{
    ty_vec3 origin = random_point(rng, 1.0f);
    ty_vec3 direction = random_direction(rng);
    if (i & 1)
    {
        origin = ty_mul(direction, 6.0f);
        direction = ty_normalize(ty_sub(random_point(rng, 1.0f), origin));
    }
    float reach = ty_rng_range(rng, 0.0f, 0.5f);
    return ty_ray_make(origin, direction, i % 5 == 0 ? reach : TY_FLOAT_MAX);
}

typedef struct tally
{
    int hits, misses;
    int differing; // one path hits what the other passes by, or another triangle
} tally;

// The maps of the two paths round differently, so a ray through an edge or along a silhouette may fall on either side.
static void compare_paths(const stage* s, const ty_ray* ray, tally* sum)
{
    ty_hit fast, reference;
    bool a = ty_world_intersect(s->world[TY_TRACE_FAST], ray, &fast);
    bool b = ty_world_intersect(s->world[TY_TRACE_REFERENCE], ray, &reference);
    sum->hits += b;
    sum->misses += !b;
    if (a != b)
        sum->differing++;
    else if (a)
    {
        bool same = fast.object == reference.object && fast.instance == reference.instance;
        // The error is one of coordinates, so it is relative to them and not only to a short ray's length.
        bool near = fabsf(fast.t - reference.t) <= 1e-5f * (reference.t + ty_length(ray->origin));
        sum->differing += !same || !near || fast.triangle != reference.triangle;
    }
    assert_int_equal(ty_world_occluded(s->world[TY_TRACE_FAST], ray), a);
    assert_int_equal(ty_world_occluded(s->world[TY_TRACE_REFERENCE], ray), b);
}

static void check_tally(const tally* sum)
{
    print_message("  %d hits, %d misses, %d differ\n", sum->hits, sum->misses, sum->differing);
    assert_true(sum->hits > RAYS / 20);
    assert_true(sum->misses > RAYS / 50);
    assert_true(sum->differing <= (sum->hits + sum->misses) / 5000);
}

static void fast_equals_reference(void** state)
{
    tally sum = {0};
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    for (int i = 0; i < RAYS; i++)
    {
        ty_ray ray = random_ray(&rng, i);
        compare_paths(*state, &ray, &sum);
    }
    check_tally(&sum);
}

static void fast_equals_reference_front_only(void** state)
{
    tally sum = {0};
    ty_rng rng = ty_rng_make((ty_seed){6}, 0, 0);
    for (int i = 0; i < RAYS; i++)
    {
        ty_ray ray = random_ray(&rng, i);
        ray.flags = TY_RAY_FRONT_ONLY;
        compare_paths(*state, &ray, &sum);
    }
    check_tally(&sum);
}

static void fast_equals_reference_with_skips(void** state)
{
    const stage* s = *state;
    tally sum = {0};
    ty_rng rng = ty_rng_make((ty_seed){7}, 0, 0);
    for (int i = 0; i < RAYS; i++)
    {
        ty_ray ray = random_ray(&rng, i);
        ty_hit hit;
        if (!ty_world_intersect(s->world[TY_TRACE_REFERENCE], &ray, &hit))
            continue;
        ray.skip_object = hit.object;
        ray.skip_instance = hit.instance;
        ray.skip_distance = i % 3 == 0 ? TY_FLOAT_MAX : hit.t * 1.01f;
        ray.flags = i % 2 ? TY_RAY_FRONT_ONLY : TY_RAY_PLAIN;
        compare_paths(s, &ray, &sum);
    }
    check_tally(&sum);
}

// A skipped instance is passed up to the distance given, and only the nearer hits of it.
static void skip_passes_the_instance(void** state)
{
    const stage* s = *state;
    ty_rng rng = ty_rng_make((ty_seed){8}, 0, 0);
    int through = 0;
    for (int path = 0; path < 2; path++)
        for (int i = 0; i < 4000; i++)
        {
            ty_ray ray = random_ray(&rng, i);
            ty_hit hit, beyond;
            if (!ty_world_intersect(s->world[path], &ray, &hit))
                continue;
            ray.skip_object = hit.object;
            ray.skip_instance = hit.instance;
            ray.skip_distance = TY_FLOAT_MAX;
            if (ty_world_intersect(s->world[path], &ray, &beyond))
            {
                assert_true(beyond.object != hit.object || beyond.instance != hit.instance);
                assert_true(beyond.t >= hit.t);
            }
            ray.skip_distance = nextafterf(hit.t, TY_FLOAT_MAX);
            if (ty_world_intersect(s->world[path], &ray, &beyond))
            {
                bool own = beyond.object == hit.object && beyond.instance == hit.instance;
                assert_true(!own || beyond.t > hit.t);
                through += own;
            }
            // At the very distance the hit is kept: only nearer ones are passed.
            ray.skip_distance = hit.t;
            assert_true(ty_world_intersect(s->world[path], &ray, &beyond));
            assert_true(beyond.t == hit.t);
        }
    assert_true(through > 100);
}

// From inside a mirrored one-sided sphere: its wall is passed with FRONT_ONLY, seen without.
static void one_sided_objects(void** state)
{
    const stage* s = *state;
    for (int path = 0; path < 2; path++)
    {
        ty_rng rng = ty_rng_make((ty_seed){9}, 0, 0);
        for (int i = 0; i < 2000; i++)
        {
            ty_ray ray = random_ray(&rng, i & ~1);
            ray.t_max = TY_FLOAT_MAX;
            ray.flags = TY_RAY_FRONT_ONLY;
            ty_hit hit;
            if (!ty_world_intersect(s->world[path], &ray, &hit) || hit.object < 2)
                continue;
            ty_surface_point point;
            ty_world_surface(s->world[path], &hit, &point);
            assert_true(ty_dot(point.ng, ray.direction) < 0.0f);
        }
        ty_affine map = ty_world_to_world(s->world[path], 3, 0, 0.0f);
        ty_ray ray = ty_ray_make(map.t, (ty_vec3){0, 1, 0}, 0.35f);
        ty_hit hit;
        int walls[2] = {0, 0};
        for (uint32_t flags = 0; flags < 2; flags++)
        {
            ray.flags = flags;
            for (int i = 0; i < 50; i++)
            {
                ray.direction = random_direction(&rng);
                walls[flags] += ty_world_intersect(s->world[path], &ray, &hit) && hit.object == 3;
            }
        }
        assert_true(walls[0] > 0);
        assert_int_equal(walls[1], 0);
    }
}

static void two_builds_are_one(void** state)
{
    stage* s = *state;
    for (int path = 0; path < 2; path++)
    {
        ty_world* again = build_world(s, (ty_trace_path)path);
        ty_rng rng = ty_rng_make((ty_seed){10}, 0, 0);
        for (int i = 0; i < 5000; i++)
        {
            ty_ray ray = random_ray(&rng, i);
            ty_hit a, b;
            memset(&a, 0, sizeof a);
            memset(&b, 0, sizeof b);
            bool hit = ty_world_intersect(s->world[path], &ray, &a);
            assert_int_equal(hit, ty_world_intersect(again, &ray, &b));
            assert_memory_equal(&a, &b, sizeof a);
        }
        // At least the positions and indices of the prototypes, and two maps an instance.
        assert_true(ty_world_memory(again) > 2 * INSTANCES * 2 * sizeof(ty_affine));
        assert_true(ty_world_memory(again) == ty_world_memory(s->world[path]));
        ty_world_destroy(again);
    }
}

// Far from the world's origin the ellipsoid test must still not cut what the prototype's tree would find.
static void far_from_the_origin(void** state)
{
    stage* s = *state;
    ty_affine away = ty_affine_identity();
    away.t = (ty_vec3){200.0f, -50.0f, 120.0f};
    ty_world* world[2];
    ty_error error;
    uint32_t object;
    for (int path = 0; path < 2; path++)
    {
        ty_world_def def = {.path = (ty_trace_path)path};
        assert_int_equal(ty_world_create(&def, &world[path], &error), TY_OK);
        assert_int_equal(
            ty_world_add_aggregate(world[path], s->first, ty_motion_at_rest(&away), opaque, &object, &error), TY_OK);
        assert_int_equal(ty_world_commit(world[path], &error), TY_OK);
    }
    ty_rng rng = ty_rng_make((ty_seed){12}, 0, 0);
    int hits = 0, differing = 0;
    for (int i = 0; i < RAYS; i++)
    {
        ty_ray ray = random_ray(&rng, i);
        ray.origin = ty_add(ray.origin, away.t);
        ty_hit a, b;
        bool fast = ty_world_intersect(world[0], &ray, &a), reference = ty_world_intersect(world[1], &ray, &b);
        hits += reference;
        differing += fast != reference || (fast && a.instance != b.instance);
    }
    print_message("  %d hits, %d differ\n", hits, differing);
    assert_true(hits > RAYS / 4);
    assert_true(differing <= hits / 500);
    ty_world_destroy(world[0]);
    ty_world_destroy(world[1]);
}

// The fast path gives the very bits of the nearest of all instances tried one by one: nothing is cut off. Prototypes
// are stretched askew, and half of the rays come from far away, where the maps round most.
static void fast_path_cuts_nothing(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(3);
    ty_affine askew = {{1.0f, 0.4f, 0.2f}, {0.5f, 0.7f, -0.6f}, {-0.1f, 0.5f, 1.1f}, {0.3f, -0.2f, 0.1f}};
    ty_mesh_transform(heap->prototypes[0], &askew);
    ty_world* world = NULL;
    ty_error error;
    ty_world_def def = ty_world_def_default();
    ty_affine identity = ty_affine_identity();
    uint32_t object;
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    assert_int_equal(ty_world_add_aggregate(world, heap, ty_motion_at_rest(&identity), opaque, &object, &error), TY_OK);
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
    ty_rng rng = ty_rng_make((ty_seed){13}, 0, 0);
    int hits = 0;
    for (int i = 0; i < 3000; i++)
    {
        ty_ray ray = random_ray(&rng, i);
        if (i & 1)
            ray.origin = ty_mad(ray.origin, ray.direction, -60.0f);
        ray.t_max = TY_FLOAT_MAX;
        ty_hit fast, nearest, one;
        nearest.t = TY_FLOAT_MAX;
        bool any = false;
        for (uint32_t k = 0; k < INSTANCES; k++)
            if (ty_world_intersect_instance(world, 0, k, 0.0f, ray.origin, ray.direction, nearest.t, &one) &&
                one.t < nearest.t)
            {
                nearest = one;
                any = true;
            }
        assert_int_equal(ty_world_intersect(world, &ray, &fast), any);
        if (any)
            assert_memory_equal(&fast, &nearest, sizeof fast);
        hits += any;
    }
    assert_true(hits > 1000);
    ty_world_destroy(world);
    ty_aggregate_destroy(heap);
}

// A ray that one of two heaps does not see meets the other as if that were alone.
static void masks_hide_instances(void** state)
{
    (void)state;
    ty_aggregate* heap[2] = {make_heap(4), make_heap(5)};
    ty_affine identity = ty_affine_identity();
    const ty_object_flags unlit = {.mask = TY_MASK_OPAQUE & ~TY_MASK_SHADOW};
    ty_world* world[2]; // of both, and of the second
    for (int alone = 0; alone < 2; alone++)
    {
        ty_world_def def = ty_world_def_default();
        ty_error error;
        uint32_t object;
        assert_int_equal(ty_world_create(&def, &world[alone], &error), TY_OK);
        for (int k = alone; k < 2; k++)
            assert_int_equal(ty_world_add_aggregate(world[alone], heap[k], ty_motion_at_rest(&identity),
                                                    k ? opaque : unlit, &object, &error),
                             TY_OK);
        assert_int_equal(ty_world_commit(world[alone], &error), TY_OK);
    }
    ty_rng rng = ty_rng_make((ty_seed){17}, 0, 0);
    int hits = 0, seen[2] = {0};
    for (int i = 0; i < RAYS; i++)
    {
        ty_ray ray = random_ray(&rng, i);
        ty_hit both, one;
        ray.mask = TY_MASK_SHADOW;
        bool found = ty_world_intersect(world[1], &ray, &one), dark = ty_world_occluded(world[1], &ray);
        assert_int_equal(ty_world_intersect(world[0], &ray, &both), found);
        assert_int_equal(ty_world_occluded(world[0], &ray), dark);
        if (found)
        {
            one.object = 1;
            assert_memory_equal(&both, &one, sizeof both);
            hits++;
        }
        ray.mask = TY_MASK_DIFFUSE;
        if (ty_world_intersect(world[0], &ray, &both))
            seen[both.object]++;
    }
    assert_true(hits > RAYS / 4 && seen[0] > RAYS / 10 && seen[1] > RAYS / 10);
    for (int k = 0; k < 2; k++)
    {
        ty_world_destroy(world[k]);
        ty_aggregate_destroy(heap[k]);
    }
}

// Of an aggregate of two materials only the bodies of the one-sided one let a ray out unseen.
static void one_sided_slots(void** state)
{
    (void)state;
    const uint32_t slot_of[2] = {70, 2}; // the first is among those that share a bit
    ty_aggregate* heap = ty_aggregate_create(2, 2);
    for (uint32_t k = 0; k < 2; k++)
    {
        ty_mesh* mesh = heap->prototypes[k] = make_sphere(24, 15);
        mesh->slots = TY_ALLOC(uint16_t, mesh->triangle_count);
        for (uint32_t i = 0; i < mesh->triangle_count; i++)
            mesh->slots[i] = (uint16_t)slot_of[k];
        heap->prototype_index[k] = k;
        heap->transforms[k] = ty_affine_identity();
        heap->transforms[k].t.x = 3.0f * (float)k;
    }
    ty_affine identity = ty_affine_identity();
    for (int path = 0; path < 2; path++)
        for (uint32_t one = 0; one < 2; one++)
        {
            ty_world_def def = {.path = (ty_trace_path)path};
            ty_object_flags flags = {.one_sided = ty_slot_bit(slot_of[one]), .mask = TY_MASK_OPAQUE};
            ty_error error;
            ty_world* world;
            uint32_t object;
            assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
            assert_int_equal(ty_world_add_aggregate(world, heap, ty_motion_at_rest(&identity), flags, &object, &error),
                             TY_OK);
            assert_int_equal(ty_world_commit(world, &error), TY_OK);
            for (uint32_t k = 0; k < 2; k++)
            {
                ty_ray ray = ty_ray_make(heap->transforms[k].t, (ty_vec3){0, 1, 0}, TY_FLOAT_MAX);
                ray.flags = TY_RAY_FRONT_ONLY;
                ty_hit hit;
                assert_int_equal(ty_world_intersect(world, &ray, &hit), k != one);
            }
            ty_world_destroy(world);
        }
    ty_aggregate_destroy(heap);
}

// Meshes that stand where they are and are no instances: found, skipped, masked and seen from outside only like those.
static void meshes_are_like_instances(void** state)
{
    (void)state;
    ty_mesh *torus = make_torus(24, 12), *sphere = make_sphere(24, 15);
    ty_affine small = ty_affine_from_trs((ty_vec3){0.5f, 0.2f, 0.1f}, ty_quat_identity(), (ty_vec3){0.7f, 0.6f, 0.5f});
    ty_mesh_transform(sphere, &small);
    ty_affine identity = ty_affine_identity();
    ty_object_flags unlit = {.one_sided = ~0ull, .mask = TY_MASK_OPAQUE & ~TY_MASK_SHADOW};
    ty_world* world[2];
    for (int path = 0; path < 2; path++)
    {
        ty_world_def def = {.path = (ty_trace_path)path};
        ty_error error;
        uint32_t object, prototype;
        assert_int_equal(ty_world_create(&def, &world[path], &error), TY_OK);
        assert_int_equal(ty_world_add_prototype(world[path], torus, &prototype, &error), TY_OK);
        assert_int_equal(
            ty_world_add_object(world[path], prototype, ty_motion_at_rest(&identity), opaque, &object, &error), TY_OK);
        assert_int_equal(ty_world_add_prototype(world[path], sphere, &prototype, &error), TY_OK);
        assert_int_equal(
            ty_world_add_object(world[path], prototype, ty_motion_at_rest(&identity), unlit, &object, &error), TY_OK);
        assert_int_equal(ty_world_commit(world[path], &error), TY_OK);
    }
    ty_rng rng = ty_rng_make((ty_seed){16}, 0, 0);
    int hits[2] = {0}, occluded = 0;
    for (int i = 0; i < RAYS; i++)
    {
        ty_ray ray = random_ray(&rng, i);
        ray.t_max = i % 3 ? TY_FLOAT_MAX : 0.5f;
        ray.flags = i % 5 < 2 ? TY_RAY_FRONT_ONLY : TY_RAY_PLAIN;
        ray.mask = i % 7 < 2 ? TY_MASK_SHADOW : TY_MASK_DIFFUSE;
        if (i % 4 == 0)
        {
            ray.skip_object = i / 4 % 2;
            ray.skip_instance = 0;
            ray.skip_distance = i % 8 ? 0.4f : TY_FLOAT_MAX;
        }
        ty_hit hit[2];
        memset(hit, 0, sizeof hit);
        bool found = ty_world_intersect(world[0], &ray, &hit[0]);
        assert_int_equal(found, ty_world_intersect(world[1], &ray, &hit[1]));
        assert_memory_equal(&hit[0], &hit[1], sizeof hit[0]);
        bool dark = ty_world_occluded(world[0], &ray);
        assert_int_equal(dark, ty_world_occluded(world[1], &ray));
        occluded += dark;
        if (!found)
            continue;
        hits[hit[0].object]++;
        assert_true(hit[0].object == 0 || ray.mask != TY_MASK_SHADOW);
    }
    assert_true(hits[0] > RAYS / 20 && hits[1] > RAYS / 20 && occluded > RAYS / 10);
    ty_world_destroy(world[0]);
    ty_world_destroy(world[1]);
    ty_mesh_destroy(torus);
    ty_mesh_destroy(sphere);
}

// The kernels of every width give the same bits.
static void widths_are_one(void** state)
{
    stage* s = *state;
    ty_world* world = s->world[TY_TRACE_FAST];
    if (strcmp(ty_world_isa(world), "avx512") != 0)
        skip();
    ty_rng rng = ty_rng_make((ty_seed){14}, 0, 0);
    for (int i = 0; i < RAYS; i++)
    {
        ty_ray ray = random_ray(&rng, i);
        ty_hit hit[2];
        bool found[2], occluded[2];
        memset(hit, 0, sizeof hit);
        for (int wide = 0; wide < 2; wide++)
        {
            world->use_avx512 = wide;
            found[wide] = ty_world_intersect(world, &ray, &hit[wide]);
            occluded[wide] = ty_world_occluded(world, &ray);
        }
        assert_int_equal(found[0], found[1]);
        assert_int_equal(occluded[0], occluded[1]);
        assert_memory_equal(&hit[0], &hit[1], sizeof hit[0]);
    }
    world->use_avx512 = false;
}

// A ball with shallow furrows from pole to pole.
static ty_mesh* make_furrowed(void)
{
    ty_mesh* mesh = make_sphere(48, 31);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 p = mesh->positions[i];
        float c = ty_cos(5.0f * ty_atan2(p.z, p.x)), waist = 1.0f - p.y * p.y;
        mesh->positions[i] = ty_mul(p, 1.0f + 0.04f * waist * c);
    }
    ty_mesh_compute_normals(mesh, TY_PI);
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_welds(mesh);
    return mesh;
}

typedef struct horizon_tally
{
    int above, met_above, below, met_below, zero, between, none;
} horizon_tally;

// A direction over the point's plane by the given sine.
static ty_vec3 raised(ty_rng* rng, const ty_surface_point* p, float sine)
{
    ty_vec3 w = random_direction(rng), flat = ty_normalize(ty_mad(w, p->ng, -ty_dot(w, p->ng)));
    return ty_add(ty_mul(flat, sqrtf(1.0f - sine * sine)), ty_mul(p->ng, sine));
}

static void look_around(const ty_world* world, const ty_hit* hit, ty_rng* rng, horizon_tally* sum)
{
    ty_surface_point p;
    ty_hit again;
    ty_world_surface(world, hit, &p);
    sum->zero += p.horizon == 0.0f;
    sum->between += p.horizon > 0.0f && p.horizon < 1.0f;
    sum->none += p.horizon >= 1.0f;
    ty_vec3 start = ty_offset_origin(&p, p.ng);
    for (int k = 0; k < 10 && p.horizon < 0.9f; k++)
    {
        // Just above the horizon is where it would show.
        ty_vec3 w = raised(rng, &p, p.horizon + 1e-4f + (k % 2 ? 0.02f : 0.1f) * ty_rng_float(rng));
        sum->above++;
        sum->met_above += ty_world_intersect_instance(world, 0, hit->instance, 0.0f, start, w, TY_FLOAT_MAX, &again);
        w = raised(rng, &p, p.horizon * (0.1f + 0.4f * ty_rng_float(rng)));
        sum->below += p.horizon > 0.0f;
        sum->met_below += ty_world_intersect_instance(world, 0, hit->instance, 0.0f, start, w, TY_FLOAT_MAX, &again);
    }
}

// What leaves above the horizon of its triangle never meets its instance again, whatever the map; much of what leaves
// well below does. Convex bodies have none, and where a torus looks at itself nothing is said.
static void horizons_hold(void** state)
{
    (void)state;
    static const char* const names[] = {"ball", "furrowed ball", "torus"};
    horizon_tally sum[3] = {0};
    for (int kind = 0; kind < 3; kind++)
    {
        ty_aggregate* heap = ty_aggregate_create(64, 1);
        ty_rng rng = ty_rng_make((ty_seed){15}, (uint64_t)kind, 0);
        heap->prototypes[0] = kind == 0 ? make_sphere(24, 15) : kind == 1 ? make_furrowed() : make_torus(24, 12);
        for (uint32_t i = 0; i < 64; i++)
            heap->transforms[i] = random_map(&rng, i, 1.0f, i % 2 ? 0.1f : 0.3f);
        ty_world* world = NULL;
        ty_error error;
        uint32_t object;
        ty_world_def def = ty_world_def_default();
        ty_affine identity = ty_affine_identity();
        assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
        assert_int_equal(ty_world_add_aggregate(world, heap, ty_motion_at_rest(&identity), opaque, &object, &error),
                         TY_OK);
        assert_int_equal(ty_world_commit(world, &error), TY_OK);
        for (int i = 0; i < RAYS / 4; i++)
        {
            ty_ray ray = random_ray(&rng, i | 1);
            ty_hit hit;
            if (ty_world_intersect(world, &ray, &hit))
                look_around(world, &hit, &rng, &sum[kind]);
        }
        const horizon_tally* t = &sum[kind];
        print_message("  %s: %d horizons of zero, %d above, %d none; %d rays below, %d of them meet\n", names[kind],
                      t->zero, t->between, t->none, t->below, t->met_below);
        assert_true(t->above > 1000);
        assert_int_equal(t->met_above, 0);
        ty_world_destroy(world);
        ty_aggregate_destroy(heap);
    }
    assert_true(sum[0].none == 0 && sum[0].between == 0);
    assert_true(sum[1].between > sum[1].none && sum[1].met_below > sum[1].below / 50);
    assert_true(sum[2].none > 100 && sum[2].zero > 100);
}

static void numbering(void** state)
{
    stage* s = *state;
    const ty_world* world = s->world[TY_TRACE_FAST];
    assert_int_equal(ty_world_prototype_count(world), 5);
    assert_ptr_equal(ty_world_mesh(world, 1, 3), s->first->prototypes[1]);
    assert_ptr_equal(ty_world_mesh(world, 1, 2), s->first->prototypes[0]);
    assert_ptr_equal(ty_world_mesh(world, 3, 0), s->sphere);
    assert_ptr_equal(ty_world_mesh(world, 0, 0), s->first->prototypes[1]);
    assert_int_equal(ty_world_prototype(world, 0, 0), ty_world_prototype(world, 1, 1));
    ty_affine map = ty_world_to_world(world, 1, 7, 0.0f);
    assert_memory_equal(&map, &s->first->transforms[7], sizeof map);
    assert_true(ty_world_topology(world, 0)->closed);
    assert_false(ty_world_topology(world, 0)->convex);
    assert_true(ty_world_topology(world, ty_world_prototype(world, 3, 0))->convex);
}

static void bad_input(void** state)
{
    stage* s = *state;
    ty_world* world = NULL;
    ty_error error = {0};
    ty_world_def def = {.path = TY_TRACE_FAST, .isa = "avx9"};
    assert_int_equal(ty_world_create(&def, &world, &error), TY_BAD_INPUT);
    assert_null(world);
    def.isa = "avx2,verbose=3";
    assert_int_equal(ty_world_create(&def, &world, &error), TY_BAD_INPUT);
    def.isa = "sse4.2";
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    uint32_t prototype, object;
    ty_affine flat = ty_affine_identity();
    flat.z.z = 0.0f;
    assert_int_equal(ty_world_add_prototype(world, s->sphere, &prototype, &error), TY_OK);
    assert_int_equal(ty_world_add_object(world, prototype, ty_motion_at_rest(&flat), opaque, &object, &error),
                     TY_BAD_INPUT);
    s->first->transforms[41].t.x = NAN;
    ty_affine identity = ty_affine_identity();
    assert_int_equal(ty_world_add_aggregate(world, s->first, ty_motion_at_rest(&identity), opaque, &object, &error),
                     TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "instance 41"));
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
    ty_ray ray = ty_ray_make((ty_vec3){0}, (ty_vec3){0, 0, 1}, TY_FLOAT_MAX);
    ty_hit hit;
    assert_false(ty_world_intersect(world, &ray, &hit));
    assert_false(ty_world_occluded(world, &ray));
    ty_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fast_equals_reference),
        cmocka_unit_test(fast_equals_reference_front_only),
        cmocka_unit_test(fast_equals_reference_with_skips),
        cmocka_unit_test(skip_passes_the_instance),
        cmocka_unit_test(one_sided_objects),
        cmocka_unit_test(one_sided_slots),
        cmocka_unit_test(two_builds_are_one),
        cmocka_unit_test(far_from_the_origin),
        cmocka_unit_test(fast_path_cuts_nothing),
        cmocka_unit_test(widths_are_one),
        cmocka_unit_test(masks_hide_instances),
        cmocka_unit_test(meshes_are_like_instances),
        cmocka_unit_test(horizons_hold),
        cmocka_unit_test(numbering),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
