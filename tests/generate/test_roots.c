// SPDX-License-Identifier: Apache-2.0
// Roots: one closed surface that holds on to its host, tapers, branches, and is the same whatever the workers.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/hash.h>
#include <tsuya/generate/roots_recipe.h>
#include <tsuya/geometry/mesh_file.h>

#define RADIUS 0.04f // m, of the host

static ty_mesh* make(const ty_roots_recipe* recipe, ty_workers* workers)
{
    ty_mesh* mesh;
    ty_error error = {0};
    ty_status status = ty_roots_make(recipe, workers, &mesh, &error);
    if (status != TY_OK)
        print_message("%s\n", error.text);
    assert_int_equal(status, TY_OK);
    return mesh;
}

static ty_roots_recipe coarse(void)
{
    ty_roots_recipe recipe = ty_roots_recipe_default();
    recipe.tip = recipe.detail = 1.2e-3f;
    recipe.host.resolution = 96;
    return recipe;
}

static const float* attribute(const ty_mesh* mesh, const char* name)
{
    const ty_mesh_attribute* found = ty_mesh_find_attribute(mesh, name);
    assert_non_null(found);
    return found->values;
}

static void the_surface_is_closed(void** state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++)
    {
        ty_roots_recipe recipe = coarse();
        recipe.seed.value = seed;
        ty_mesh* mesh = make(&recipe, NULL);
        ty_mesh_topology topology;
        ty_error error;
        ty_mesh_analyse(mesh, &topology);
        assert_int_equal(topology.boundary_edges, 0);
        assert_int_equal(topology.nonmanifold_edges, 0);
        assert_int_equal(topology.misoriented_edges, 0);
        assert_int_equal(topology.components, 1);
        assert_true(topology.closed && topology.volume > 0.0);
        assert_int_equal(ty_mesh_validate(mesh, "roots", &error), TY_OK);
        double against = 0.0; // normals go with the triangles
        for (uint32_t t = 0; t < mesh->triangle_count; t++)
        {
            const uint32_t* c = mesh->triangles[t];
            ty_vec3 p = mesh->positions[c[0]];
            ty_vec3 n = ty_cross(ty_sub(mesh->positions[c[1]], p), ty_sub(mesh->positions[c[2]], p));
            ty_vec3 sum = ty_add(ty_add(mesh->normals[c[0]], mesh->normals[c[1]]), mesh->normals[c[2]]);
            against += ty_dot(n, sum) < 0.0f ? (double)ty_length(n) : 0.0;
        }
        assert_true(against < 0.01 * topology.area); // slivers at creases
        ty_mesh_destroy(mesh);
    }
}

// A root that falls beside a host it does not touch is a cone with round ends: r = r0 e^(-s / taper).
static void a_free_root_has_its_volume(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    recipe.host.shape.radius = 1e-3f;
    recipe.host.floor = false;
    recipe.trunk = (ty_roots_trunk_def){0.0f, 0.02f, {0.0f, 0.0f, 0.0f}};
    recipe.count = 1;
    recipe.variation = 0.0f;
    recipe.growth.wander = 0.0f;
    recipe.growth.gravity = 1.0f;
    recipe.growth.flatten = 1.0f;
    recipe.growth.sink = 0.0f;
    recipe.first.spacing = 0.0f;
    recipe.radius = 2e-3f;
    recipe.tip = 0.6e-3f;
    recipe.taper = 0.025f;
    recipe.bark = 0.0f;
    recipe.detail = 0.2e-3f;
    ty_mesh* mesh = make(&recipe, NULL);
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    // half a ball closes the cone at either end
    double r0 = 2e-3, r1 = 0.6e-3, cone = 0.5 * M_PI * 0.025 * (r0 * r0 - r1 * r1);
    double ends = 2.0 / 3.0 * M_PI * (r0 * r0 * r0 + r1 * r1 * r1);
    assert_float_equal((float)(topology.volume / (cone + ends)), 1.0f, 0.04f);
    float length = 0.025f * ty_ln(2.0f / 0.6f), lowest = -mesh->bounds.low.y;
    assert_float_equal(lowest, length, 0.05f * length + 1e-3f); // it set out aslant
    ty_mesh_destroy(mesh);
}

static void roots_hold_on_to_the_host(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    recipe.bark = 0.0f;
    ty_mesh* mesh = make(&recipe, NULL);
    const float* radius = attribute(mesh, "radius");
    int under = 0, beside = 0, floor = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        ty_vec3 p = mesh->positions[v];
        float height = ty_length(p) - RADIUS;
        bool trunk = p.x * p.x + p.z * p.z < ty_sqr(recipe.trunk.radius + recipe.radius) && p.y > 0.0f;
        if (trunk)
            continue;
        under += height < 0.0f;
        beside += height < 3.0f * radius[v];
        floor += p.y < -RADIUS + 2.0f * radius[v];
        float depth = (recipe.growth.sink + 0.5f) * radius[v]; // where they run together they bulge downwards too
        assert_true(height > -depth);
        assert_true(p.y > -RADIUS - 1.5f * radius[v]); // on the table they end by going under
    }
    assert_true(under > (int)mesh->vertex_count / 20); // they are sunk into it,
    assert_true(beside > (int)mesh->vertex_count / 3); // most of them keep near,
    assert_true(floor > (int)mesh->vertex_count / 50); // and some have reached the table
    ty_mesh_destroy(mesh);
}

static void roots_taper_and_branch(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    ty_mesh* mesh = make(&recipe, NULL);
    const float *radius = attribute(mesh, "radius"), *level = attribute(mesh, "level"), *join = attribute(mesh, "join");
    double sum[3] = {0}, count[3] = {0};
    float most = 0.0f, run_together = 0.0f;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        float along = mesh->uvs[v].y; // m from the trunk's top
        int part = along < 0.03f ? 0 : along < 0.08f ? 1 : 2;
        sum[part] += (double)radius[v];
        count[part] += 1.0;
        most = level[v] > most ? level[v] : most;
        run_together += join[v] > 0.5f ? 1.0f : 0.0f;
        assert_in_range((int)(mesh->uvs[v].x * 1000.0f), 0, 2000); // turns, on beyond 1 at the seam
        assert_true(join[v] >= 0.0f && join[v] <= 1.0f);
    }
    assert_true(count[2] > 0.0 && sum[0] / count[0] > sum[1] / count[1] && sum[1] / count[1] > sum[2] / count[2]);
    assert_true(most >= 2.0f);
    assert_true(run_together > 0.02f * (float)mesh->vertex_count);
    uint32_t back = 0; // triangles that run back over the turn: none but at tips hardly wider than a cell
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++)
        {
            const uint32_t* c = mesh->triangles[t];
            back += fabsf(mesh->uvs[c[k]].x - mesh->uvs[c[(k + 1) % 3]].x) > 0.5f + 1e-6f;
        }
    assert_true(back < mesh->triangle_count / 100);
    ty_mesh_destroy(mesh);
}

// Any mesh will do: the ball from a file gives what the shape gives.
static void hosts_come_from_files_too(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    ty_shape_def def = recipe.host.shape;
    ty_mesh *ball, *by_shape, *by_file;
    ty_error error;
    def.kind = TY_SHAPE_SPHERE;
    assert_int_equal(ty_shape_create(&def, &ball, &error), TY_OK);
    assert_int_equal(ty_ply_write("roots_host.ply", ball, &error), TY_OK);
    by_shape = make(&recipe, NULL);
    recipe.host.kind = TY_ROOTS_HOST_MESH;
    recipe.host.mesh = "roots_host.ply";
    by_file = make(&recipe, NULL);
    assert_int_equal(by_shape->vertex_count, by_file->vertex_count);
    assert_memory_equal(by_shape->positions, by_file->positions, by_shape->vertex_count * sizeof(ty_vec3));
    ty_mesh_destroy(by_shape);
    ty_mesh_destroy(by_file);
    ty_mesh_destroy(ball);
    recipe.host.mesh = "no_such.ply";
    assert_int_equal(ty_roots_make(&recipe, NULL, &by_file, &error), TY_BAD_FILE);
    recipe.host.mesh = NULL;
    assert_int_equal(ty_roots_make(&recipe, NULL, &by_file, &error), TY_BAD_INPUT);
}

// Where thick roots overlap far from the host their surface has no step: no two triangles meet at more than 60 degrees
// but at the cut of the top.
static void thick_roots_run_together_smoothly(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    recipe.count = 6;
    recipe.radius = 12e-3f;
    recipe.trunk.height = 0.12f;
    recipe.join = 2.0f;
    recipe.bark = 0.0f;
    recipe.tip = recipe.detail = 1.5e-3f;
    recipe.first.spacing = 0.0f;
    ty_mesh* mesh = make(&recipe, NULL);
    ty_vec3* normals = TY_ALLOC(ty_vec3, mesh->vertex_count);
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t t = 0; t < mesh->triangle_count; t++)
        {
            const uint32_t* c = mesh->triangles[t];
            ty_vec3 p = mesh->positions[c[0]];
            ty_vec3 n = ty_cross(ty_sub(mesh->positions[c[1]], p), ty_sub(mesh->positions[c[2]], p));
            bool trunk = p.y > RADIUS + 0.03f && p.y < mesh->bounds.high.y - 4e-3f;
            for (int k = 0; k < 3; k++)
                if (pass == 0)
                    normals[mesh->welds[c[k]]] = ty_add(normals[mesh->welds[c[k]]], n);
                else if (trunk)
                    assert_true(ty_dot(ty_normalize(n), ty_normalize(normals[mesh->welds[c[k]]])) > 0.8f);
        }
    ty_free(normals);
    ty_mesh_destroy(mesh);
}

static void workers_change_no_bit(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    ty_hash first = {0};
    for (int threads = 1; threads <= 3; threads++)
    {
        ty_workers* workers;
        ty_error error;
        assert_int_equal(ty_workers_create(threads, &workers, &error), TY_OK);
        ty_mesh* mesh = make(&recipe, workers);
        ty_hasher* hasher = ty_hasher_create();
        ty_hasher_add(hasher, mesh->positions, mesh->vertex_count * sizeof(ty_vec3));
        ty_hasher_add(hasher, mesh->normals, mesh->vertex_count * sizeof(ty_vec3));
        ty_hasher_add(hasher, mesh->uvs, mesh->vertex_count * sizeof(ty_vec2));
        ty_hasher_add(hasher, mesh->triangles, mesh->triangle_count * sizeof(*mesh->triangles));
        ty_hash hash = ty_hasher_end(hasher);
        first = threads == 1 ? hash : first;
        assert_memory_equal(&hash, &first, sizeof hash);
        ty_mesh_destroy(mesh);
        ty_workers_destroy(workers);
    }
}

static void impossible_ones_are_refused(void** state)
{
    (void)state;
    ty_error error;
    ty_mesh* mesh;
    ty_roots_recipe recipe = coarse();
    recipe.tip = 1.0f;
    assert_int_equal(ty_roots_make(&recipe, NULL, &mesh, &error), TY_BAD_INPUT);
    recipe = coarse();
    recipe.detail = 1.3e-3f;
    assert_int_equal(ty_roots_make(&recipe, NULL, &mesh, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "detail: 1.3 mm"));
    recipe = coarse();
    recipe.detail = 2e-6f;
    assert_int_equal(ty_roots_make(&recipe, NULL, &mesh, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "at least"));
    recipe = coarse();
    recipe.first.share[0] = 0.9f;
    assert_int_equal(ty_roots_make(&recipe, NULL, &mesh, &error), TY_BAD_INPUT);
    recipe = coarse();
    recipe.host.shape.radius = 0.0f;
    assert_int_equal(ty_roots_make(&recipe, NULL, &mesh, &error), TY_BAD_INPUT);
    recipe = coarse();
    ty_cancel_request(0);
    ty_status status = ty_roots_make(&recipe, NULL, &mesh, &error);
    ty_cancel_clear();
    assert_int_equal(status, TY_INTERRUPTED);
    assert_null(mesh);
}

static void memory_may_end_anywhere(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    recipe.count = 2;
    recipe.first.spacing = 0.0f;
    ty_status status = TY_NO_MEMORY;
    for (long i = 0; status != TY_OK && i < 200; i++)
    {
        ty_mesh* mesh;
        ty_error error;
        ty_memory_fail_after(i);
        status = ty_roots_make(&recipe, NULL, &mesh, &error);
        ty_memory_fail_after(-1);
        assert_true(status == TY_OK ? mesh != NULL : status == TY_NO_MEMORY && mesh == NULL);
        ty_mesh_destroy(mesh);
    }
    assert_int_equal(status, TY_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_surface_is_closed),     cmocka_unit_test(a_free_root_has_its_volume),
        cmocka_unit_test(roots_hold_on_to_the_host), cmocka_unit_test(roots_taper_and_branch),
        cmocka_unit_test(hosts_come_from_files_too), cmocka_unit_test(thick_roots_run_together_smoothly),
        cmocka_unit_test(workers_change_no_bit),     cmocka_unit_test(impossible_ones_are_refused),
        cmocka_unit_test(memory_may_end_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
