// SPDX-License-Identifier: Apache-2.0
// Tangents against differences of positions; the footprint of a cone against its rim traced to the plane.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "trace_meshes.h"

// One triangle under a sheared and mirrored map.
typedef struct stage
{
    ty_mesh* mesh;
    ty_world* world;
    ty_affine map;
} stage;

static stage make_stage(const ty_vec2 uvs[3])
{
    stage s = {.mesh = ty_mesh_create(3, 1),
               .map = {{0.5f, 0.2f, 0.0f}, {-0.1f, 2.0f, 0.3f}, {0.0f, 0.1f, -1.5f}, {0.3f, 0.1f, 5.0f}}};
    const ty_vec3 corners[3] = {{0.1f, 0.2f, 0.0f}, {1.3f, 0.1f, 0.4f}, {0.2f, 0.9f, -0.5f}};
    for (uint32_t i = 0; i < 3; i++)
    {
        s.mesh->positions[i] = corners[i];
        s.mesh->normals[i] = ty_vec3_make(0.0f, 0.0f, 1.0f);
        s.mesh->triangles[0][i] = i;
    }
    if (uvs)
    {
        s.mesh->uvs = TY_ALLOC(ty_vec2, 3);
        for (int i = 0; i < 3; i++)
            s.mesh->uvs[i] = uvs[i];
    }
    ty_mesh_compute_bounds(s.mesh);
    ty_mesh_compute_welds(s.mesh);
    ty_world_def def = ty_world_def_default();
    ty_error error;
    uint32_t prototype, object;
    assert_int_equal(ty_world_create(&def, &s.world, &error), TY_OK);
    assert_int_equal(ty_world_add_prototype(s.world, s.mesh, &prototype, &error), TY_OK);
    assert_int_equal(
        ty_world_add_object(s.world, prototype, ty_motion_at_rest(&s.map), (ty_object_flags){0}, &object, &error),
        TY_OK);
    assert_int_equal(ty_world_commit(s.world, &error), TY_OK);
    return s;
}

static void destroy_stage(stage* s)
{
    ty_world_destroy(s->world);
    ty_mesh_destroy(s->mesh);
}

static ty_surface_point point_at(const stage* s, float u, float v)
{
    ty_hit hit = {.t = 1.0f, .u = u, .v = v};
    ty_surface_point point;
    ty_world_surface(s->world, &hit, &point);
    return point;
}

static void tangents_are_differences(void** state)
{
    (void)state;
    const ty_vec2 uvs[3] = {{0.3f, 0.1f}, {0.7f, 0.3f}, {0.2f, 1.4f}};
    stage s = make_stage(uvs);
    ty_surface_point a = point_at(&s, 0.2f, 0.3f);
    ty_vec3 dpdu, dpdv;
    assert_true(ty_world_tangents(s.world, &a, &dpdu, &dpdv));
    for (int i = 0; i < 2; i++)
    {
        ty_surface_point b = point_at(&s, i == 0 ? 0.6f : 0.1f, i == 0 ? 0.1f : 0.8f);
        ty_vec3 moved = ty_mad(ty_mul(dpdu, b.uv.x - a.uv.x), dpdv, b.uv.y - a.uv.y);
        assert_true(ty_length(ty_sub(moved, ty_sub(b.position, a.position))) < 2e-6f);
    }
    assert_true(fabsf(ty_dot(ty_normalize(dpdu), a.ng)) < 1e-6f);
    destroy_stage(&s);
}

static void no_tangents_without_uv(void** state)
{
    (void)state;
    const ty_vec2 line[3] = {{0.1f, 0.1f}, {0.2f, 0.2f}, {0.4f, 0.4f}};
    const ty_vec2* cases[2] = {NULL, line};
    for (int i = 0; i < 2; i++)
    {
        stage s = make_stage(cases[i]);
        ty_surface_point point = point_at(&s, 0.2f, 0.3f);
        ty_vec3 dpdu, dpdv;
        assert_false(ty_world_tangents(s.world, &point, &dpdu, &dpdv));
        assert_true(ty_length(dpdu) == 0.0f && ty_length(dpdv) == 0.0f);
        assert_true(ty_length(point.footprint[0]) == 0.0f && ty_length(point.footprint[1]) == 0.0f);
        destroy_stage(&s);
    }
}

// Rim of a narrow cone that began far away: parallel lines at the radius, cut by the plane.
static void footprint_is_the_cone_on_the_plane(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    const float radius = 0.01f;
    for (int i = 0; i < 1000; i++)
    {
        ty_surface_point point = {.ng = random_direction(&rng)};
        ty_vec3 d = i == 0 ? ty_neg(point.ng) : random_direction(&rng);
        if (fabsf(ty_dot(d, point.ng)) < 0.02f)
            continue;
        ty_surface_set_footprint(&point, d, 2.0f * radius);
        float angle = 2.0f * TY_PI * ty_rng_float(&rng);
        ty_vec3 on_rim = ty_mad(ty_mul(point.footprint[0], ty_cos(angle)), point.footprint[1], ty_sin(angle));
        assert_true(fabsf(ty_dot(on_rim, point.ng)) < 1e-5f * ty_length(on_rim));
        ty_vec3 across = ty_mad(on_rim, d, -ty_dot(on_rim, d));
        assert_true(fabsf(ty_length(across) - radius) < 1e-4f * radius);
        assert_true(fabsf(ty_dot(point.footprint[0], point.footprint[1])) < 1e-4f * radius * ty_length(on_rim));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tangents_are_differences),
        cmocka_unit_test(no_tangents_without_uv),
        cmocka_unit_test(footprint_is_the_cone_on_the_plane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
