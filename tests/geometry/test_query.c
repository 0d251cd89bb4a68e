// SPDX-License-Identifier: Apache-2.0
// Closest point, inside, one instance alone, the surface at a hit: against formulas.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "trace_meshes.h"

typedef struct stage
{
    ty_mesh *sphere, *torus;
    ty_world* world;
    uint32_t sphere_prototype, torus_prototype;
    ty_vec3 axes; // of the stretched sphere, object 0; object 1 is the torus, object 2 the sphere mirrored
} stage;

static void add(ty_world* world, const ty_mesh* mesh, ty_affine map, uint32_t* prototype)
{
    ty_error error;
    uint32_t object;
    ty_object_flags flags = {.mask = TY_MASK_OPAQUE};
    assert_int_equal(ty_world_add_prototype(world, mesh, prototype, &error), TY_OK);
    assert_int_equal(ty_world_add_object(world, *prototype, ty_motion_at_rest(&map), flags, &object, &error), TY_OK);
}

static int set_up(void** state)
{
    stage* s = ty_alloc(1, sizeof *s);
    ty_error error;
    s->sphere = make_sphere(256, 127);
    s->torus = make_torus(96, 48);
    s->axes = (ty_vec3){3.0f, 1.0f, 0.5f};
    ty_world_def def = ty_world_def_default();
    assert_int_equal(ty_world_create(&def, &s->world, &error), TY_OK);
    ty_affine stretched = ty_affine_from_trs((ty_vec3){0, 0, 0}, ty_quat_identity(), s->axes);
    ty_affine aside = ty_affine_from_trs((ty_vec3){10, 0, 0}, ty_quat_identity(), (ty_vec3){1, 1, 1});
    ty_affine mirrored = ty_affine_from_trs((ty_vec3){0, 10, 0}, ty_quat_identity(), (ty_vec3){-1, 2, 1});
    add(s->world, s->sphere, stretched, &s->sphere_prototype);
    add(s->world, s->torus, aside, &s->torus_prototype);
    add(s->world, s->sphere, mirrored, &s->sphere_prototype);
    assert_int_equal(ty_world_commit(s->world, &error), TY_OK);
    *state = s;
    return 0;
}

static int tear_down(void** state)
{
    stage* s = *state;
    ty_world_destroy(s->world);
    ty_mesh_destroy(s->sphere);
    ty_mesh_destroy(s->torus);
    ty_free(s);
    return 0;
}

static void closest_on_a_sphere(void** state)
{
    const stage* s = *state;
    ty_rng rng = ty_rng_make((ty_seed){1}, 0, 0);
    for (int i = 0; i < 2000; i++)
    {
        ty_vec3 p = random_point(&rng, 2.0f);
        float r = ty_length(p);
        ty_closest c;
        assert_true(ty_world_closest(s->world, s->sphere_prototype, p, 10.0f, &c));
        // The chords of 127 rings stay within 1 - cos(pi/128) of the sphere.
        assert_true(fabsf(c.distance - fabsf(r - 1.0f)) < 5e-4f);
        assert_true(fabsf(ty_length(ty_sub(c.position, p)) - c.distance) < 1e-5f);
        const uint32_t* t = s->sphere->triangles[c.triangle];
        ty_vec3 back = ty_mul(s->sphere->positions[t[0]], 1.0f - c.u - c.v);
        back = ty_mad(ty_mad(back, s->sphere->positions[t[1]], c.u), s->sphere->positions[t[2]], c.v);
        assert_true(ty_length(ty_sub(back, c.position)) < 1e-5f);
        assert_true(c.u >= 0.0f && c.v >= 0.0f && c.u + c.v <= 1.00001f);
        bool within = ty_world_closest(s->world, s->sphere_prototype, p, 0.25f, &c);
        if (fabsf(fabsf(r - 1.0f) - 0.25f) > 1e-3f)
            assert_int_equal(within, fabsf(r - 1.0f) < 0.25f);
    }
}

static void closest_on_a_torus(void** state)
{
    const stage* s = *state;
    ty_rng rng = ty_rng_make((ty_seed){2}, 0, 0);
    for (int i = 0; i < 500; i++)
    {
        ty_vec3 p = random_point(&rng, 1.6f);
        ty_closest c;
        assert_true(ty_world_closest(s->world, s->torus_prototype, p, 10.0f, &c));
        float ring = sqrtf(p.x * p.x + p.z * p.z) - 1.0f;
        float exact = fabsf(sqrtf(ring * ring + p.y * p.y) - 0.4f);
        assert_true(fabsf(c.distance - exact) < 3e-3f);
    }
}

// One triangle alone: most points are closest to an edge or a corner. No point of it, sampled finely, is closer.
static void closest_is_the_least(void** state)
{
    (void)state;
    stage s;
    ty_error error;
    ty_world_def def = ty_world_def_default();
    ty_mesh* mesh = ty_mesh_create(3, 1);
    for (uint32_t i = 0; i < 3; i++)
    {
        mesh->positions[i] = (ty_vec3){i == 1 ? 1.2f : -0.3f, i == 2 ? 1.0f : -0.4f, 0.3f * (float)i};
        mesh->normals[i] = (ty_vec3){0, 0, 1};
    }
    set_triangle(mesh, 0, 0, 1, 2);
    assert_int_equal(ty_world_create(&def, &s.world, &error), TY_OK);
    add(s.world, mesh, ty_affine_identity(), &s.sphere_prototype);
    assert_int_equal(ty_world_commit(s.world, &error), TY_OK);
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    for (int i = 0; i < 2000; i++)
    {
        ty_vec3 p = random_point(&rng, 2.0f);
        ty_closest c;
        assert_true(ty_world_closest(s.world, s.sphere_prototype, p, 10.0f, &c));
        float least = 10.0f;
        for (uint32_t t = 0; t < mesh->triangle_count; t++)
            for (int k = 0; k < 33 * 33; k++)
            {
                float u = (float)(k % 33) / 32.0f, v = (float)(k / 33) / 32.0f;
                const uint32_t* n = mesh->triangles[t];
                ty_vec3 at = ty_mul(mesh->positions[n[0]], 1.0f - u - v);
                at = ty_mad(ty_mad(at, mesh->positions[n[1]], u), mesh->positions[n[2]], v);
                if (u + v <= 1.0f)
                    least = ty_min(least, ty_length(ty_sub(at, p)));
            }
        assert_true(c.distance <= least + 1e-6f);
        assert_true(c.distance >= least - 0.045f);
    }
    ty_world_destroy(s.world);
    ty_mesh_destroy(mesh);
}

// Shading normals that point the wrong way are turned to the side of the faces.
static void inward_normals_are_turned(void** state)
{
    (void)state;
    stage s;
    ty_error error;
    ty_world_def def = ty_world_def_default();
    ty_mesh* mesh = make_sphere(32, 15);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->normals[i] = ty_neg(mesh->normals[i]);
    assert_int_equal(ty_world_create(&def, &s.world, &error), TY_OK);
    add(s.world, mesh, ty_affine_identity(), &s.sphere_prototype);
    assert_int_equal(ty_world_commit(s.world, &error), TY_OK);
    ty_hit hit;
    ty_surface_point q;
    assert_true(
        ty_world_intersect_instance(s.world, 0, 0, 0.0f, (ty_vec3){0, 0, 0}, (ty_vec3){0.6f, 0, 0.8f}, 10.0f, &hit));
    ty_world_surface(s.world, &hit, &q);
    assert_true(ty_dot(q.ns, (ty_vec3){0.6f, 0, 0.8f}) > 0.99f);
    ty_world_destroy(s.world);
    ty_mesh_destroy(mesh);
}

static void inside_by_formula(void** state)
{
    const stage* s = *state;
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    int inside = 0;
    for (int i = 0; i < 3000; i++)
    {
        ty_vec3 p = random_point(&rng, 1.4f);
        float ring = sqrtf(p.x * p.x + p.z * p.z) - 1.0f, tube = sqrtf(ring * ring + p.y * p.y), r = ty_length(p);
        if (fabsf(r - 1.0f) > 1e-3f)
            assert_int_equal(ty_world_inside(s->world, s->sphere_prototype, p), r < 1.0f);
        if (fabsf(tube - 0.4f) > 3e-3f)
            assert_int_equal(ty_world_inside(s->world, s->torus_prototype, p), tube < 0.4f);
        inside += r < 1.0f;
    }
    assert_true(inside > 300);
}

static ty_ray ray_at(ty_vec3 origin, ty_vec3 target)
{
    return ty_ray_make(origin, ty_normalize(ty_sub(target, origin)), TY_FLOAT_MAX);
}

static void surface_of_a_stretched_sphere(void** state)
{
    const stage* s = *state;
    ty_rng rng = ty_rng_make((ty_seed){4}, 0, 0);
    for (int i = 0; i < 2000; i++)
    {
        ty_ray ray = ray_at(ty_mul(random_direction(&rng), 5.0f), random_point(&rng, 0.2f));
        ty_hit hit;
        ty_surface_point q;
        assert_true(ty_world_intersect(s->world, &ray, &hit));
        ty_world_surface(s->world, &hit, &q);
        ty_vec3 p = ty_mad(ray.origin, ray.direction, hit.t);
        assert_true(ty_length(ty_sub(p, q.position)) < 1e-5f);
        ty_vec3 exact =
            ty_normalize((ty_vec3){p.x / ty_sqr(s->axes.x), p.y / ty_sqr(s->axes.y), p.z / ty_sqr(s->axes.z)});
        assert_true(ty_dot(exact, q.ns) > 0.99995f);
        assert_true(ty_dot(exact, q.ng) > 0.99f);
        assert_true(ty_dot(q.ng, ray.direction) < 0.0f);
        assert_true(ty_dot(q.ng, q.ns) > 0.0f);
        assert_true(fabsf(ty_length(q.ns) - 1.0f) < 1e-5f);
    }
}

// A mirror turns the winding over, but the outside stays outside.
static void mirrored_stays_outward(void** state)
{
    const stage* s = *state;
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    ty_vec3 center = {0.0f, 10.0f, 0.0f};
    for (int i = 0; i < 500; i++)
    {
        ty_ray ray = ray_at(ty_mad(center, random_direction(&rng), 5.0f), center);
        ty_hit hit;
        ty_surface_point q;
        assert_true(ty_world_intersect(s->world, &ray, &hit));
        assert_int_equal(hit.object, 2);
        ty_world_surface(s->world, &hit, &q);
        assert_true(ty_dot(q.ng, ray.direction) < 0.0f);
        assert_true(ty_dot(q.ng, q.ns) > 0.0f);
    }
}

static void one_instance_alone(void** state)
{
    const stage* s = *state;
    ty_hit hit;
    // From the centre of the stretched sphere along z: its half axis; the torus is never seen.
    assert_true(ty_world_intersect_instance(s->world, 0, 0, 0.0f, (ty_vec3){0, 0, 0}, (ty_vec3){0, 0, 1}, 10.0f, &hit));
    assert_true(fabsf(hit.t - 0.5f) < 1e-4f);
    assert_int_equal(hit.object, 0);
    assert_int_equal(hit.instance, 0);
    assert_false(ty_world_intersect_instance(s->world, 0, 0, 0.0f, (ty_vec3){0, 0, 0}, (ty_vec3){0, 0, 1}, 0.4f, &hit));
    assert_false(
        ty_world_intersect_instance(s->world, 0, 0, 0.0f, (ty_vec3){5, 0, 0}, (ty_vec3){1, 0, 0}, 100.0f, &hit));
    bool behind = false;
    assert_true(ty_world_intersect_prototype(s->world, s->sphere_prototype, (ty_vec3){0, 0, 0}, (ty_vec3){0, 2, 0},
                                             10.0f, &hit, &behind));
    assert_true(behind && fabsf(hit.t - 0.5f) < 1e-4f);
    assert_true(ty_world_intersect_prototype(s->world, s->sphere_prototype, (ty_vec3){0, -3, 0}, (ty_vec3){0, 2, 0},
                                             10.0f, &hit, &behind));
    assert_false(behind);
}

static void uv_and_fields_are_linear(void** state)
{
    (void)state;
    ty_mesh* quad = ty_mesh_create(4, 2);
    quad->uvs = ty_alloc(4, sizeof(ty_vec2));
    for (uint32_t i = 0; i < 4; i++)
    {
        float x = (float)(i & 1), z = (float)(i >> 1);
        quad->positions[i] = (ty_vec3){x, 0.0f, z};
        quad->normals[i] = (ty_vec3){0.0f, 1.0f, 0.0f};
        quad->uvs[i] = (ty_vec2){1.0f - z, x}; // u runs along -z
    }
    set_triangle(quad, 0, 0, 1, 2);
    set_triangle(quad, 1, 1, 3, 2);
    ty_mesh_compute_bounds(quad);
    stage s;
    ty_error error;
    ty_world_def def = ty_world_def_default();
    assert_int_equal(ty_world_create(&def, &s.world, &error), TY_OK);
    ty_affine map =
        ty_affine_from_trs((ty_vec3){0, 0, 0}, ty_quat_axis_angle((ty_vec3){1, 0, 0}, 0.5f), (ty_vec3){1, 1, 3});
    add(s.world, quad, map, &s.sphere_prototype);
    assert_int_equal(ty_world_commit(s.world, &error), TY_OK);
    ty_ray ray = ray_at((ty_vec3){0.3f, 5.0f, 1.2f}, ty_map_point(&map, (ty_vec3){0.3f, 0.0f, 0.4f}));
    ty_hit hit;
    ty_surface_point q;
    assert_true(ty_world_intersect(s.world, &ray, &hit));
    ty_world_surface(s.world, &hit, &q);
    assert_true(fabsf(q.uv.x - 0.6f) < 1e-4f && fabsf(q.uv.y - 0.3f) < 1e-4f);
    float field[4] = {0.0f, 1.0f, 2.0f, 3.0f};
    assert_true(fabsf(ty_world_interpolate(s.world, &q, field) - (0.3f + 2.0f * 0.4f)) < 1e-4f);
    ty_world_destroy(s.world);
    ty_mesh_destroy(quad);
}

// Rays that leave grains of 3 mm at 2 cm to 200 m from the origin do not meet the grain they stand on, and begin nearer
// to it than its neighbours are.
static void offset_clears_the_surface(void** state)
{
    const stage* s = *state;
    ty_rng rng = ty_rng_make((ty_seed){6}, 0, 0);
    for (int far = 0; far < 5; far++)
    {
        float distance = 0.02f * ty_pow(10.0f, (float)far);
        ty_world* world = NULL;
        ty_error error;
        ty_world_def def = ty_world_def_default();
        assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
        uint32_t prototype;
        ty_vec3 at = ty_mul(random_direction(&rng), distance);
        add(world, s->sphere, ty_affine_from_trs(at, random_rotation(&rng), (ty_vec3){3e-3f, 1e-3f, 1e-3f}),
            &prototype);
        assert_int_equal(ty_world_commit(world, &error), TY_OK);
        int again = 0, hits = 0;
        for (int i = 0; i < 20000; i++)
        {
            ty_ray ray = ray_at(ty_mad(at, random_direction(&rng), 0.1f), ty_mad(at, random_direction(&rng), 5e-4f));
            ty_hit hit;
            ty_surface_point q;
            if (!ty_world_intersect(world, &ray, &hit))
                continue;
            ty_world_surface(world, &hit, &q);
            ray.origin = ty_offset_origin(&q, q.ng);
            assert_true(ty_length(ty_sub(ray.origin, q.position)) < ty_max(1e-6f, 1e-5f * distance));
            ray.direction = random_direction(&rng);
            if (ty_dot(ray.direction, q.ng) < 0.0f)
                ray.direction = ty_neg(ray.direction);
            hits++;
            again += ty_world_occluded(world, &ray);
        }
        assert_true(hits > 15000);
        assert_int_equal(again, 0);
        ty_world_destroy(world);
    }
}

// Where a tilted triangle of 100 m passes the origin, the coordinates of a hit are small and their errors are not.
static void offset_clears_a_large_triangle(void** state)
{
    (void)state;
    ty_mesh* mesh = ty_mesh_create(3, 1);
    ty_vec3 n = ty_normalize((ty_vec3){0.3f, 1.0f, -0.2f});
    ty_frame frame = ty_frame_from_normal(n);
    const float corners[3][2] = {{-47.0f, -31.0f}, {59.0f, -23.0f}, {-13.0f, 61.0f}};
    for (int i = 0; i < 3; i++)
    {
        mesh->positions[i] = ty_to_world(frame, (ty_vec3){corners[i][0], corners[i][1], 0.0f});
        mesh->normals[i] = n;
    }
    set_triangle(mesh, 0, 0, 1, 2);
    ty_mesh_compute_bounds(mesh);
    ty_world* world = NULL;
    ty_error error;
    ty_world_def def = ty_world_def_default();
    uint32_t prototype;
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    add(world, mesh, ty_affine_identity(), &prototype);
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
    ty_rng rng = ty_rng_make((ty_seed){7}, 0, 0);
    int again = 0;
    for (int i = 0; i < 20000; i++)
    {
        ty_ray ray = ray_at(n, ty_mul(random_direction(&rng), 0.05f));
        ty_hit hit;
        ty_surface_point q;
        assert_true(ty_world_intersect(world, &ray, &hit));
        ty_world_surface(world, &hit, &q);
        ty_vec3 side = ty_dot(q.ng, ray.direction) < 0.0f ? q.ng : ty_neg(q.ng);
        ray.origin = ty_offset_origin(&q, side);
        ray.direction = random_direction(&rng);
        if (ty_dot(ray.direction, side) < 0.0f)
            ray.direction = ty_neg(ray.direction);
        again += ty_world_occluded(world, &ray);
    }
    assert_int_equal(again, 0);
    ty_world_destroy(world);
    ty_mesh_destroy(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closest_on_a_sphere),
        cmocka_unit_test(closest_on_a_torus),
        cmocka_unit_test(closest_is_the_least),
        cmocka_unit_test(inward_normals_are_turned),
        cmocka_unit_test(inside_by_formula),
        cmocka_unit_test(surface_of_a_stretched_sphere),
        cmocka_unit_test(mirrored_stays_outward),
        cmocka_unit_test(one_instance_alone),
        cmocka_unit_test(uv_and_fields_are_linear),
        cmocka_unit_test(offset_clears_the_surface),
        cmocka_unit_test(offset_clears_a_large_triangle),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
