// SPDX-License-Identifier: Apache-2.0
// Contact facets of a realised mesh: flat, in the middle, nothing within another any more, closed, volume kept, for any
// number of threads.
#include "trace_meshes.h"
#include <base/cmocka_all.h>
#include <string.h>
#include <tsuya/base/workers.h>
#include <tsuya/geometry/aggregate_export.h>
#include <tsuya/geometry/trace.h>

#define WIDTH 2e-3f // m

static ty_aggregate* aggregate_make(uint32_t count)
{
    ty_aggregate* a = ty_aggregate_create(count, 1);
    a->prototypes[0] = make_sphere(64, 48);
    return a;
}

static ty_mesh* facets(const ty_aggregate* a, float close, int threads, ty_facet_report* report)
{
    ty_facet_def def = ty_facet_def_default();
    def.close = close;
    ty_mesh* mesh;
    ty_workers* workers;
    ty_error error;
    assert_int_equal(ty_workers_create(threads, &workers, &error), TY_OK);
    ty_status status = ty_aggregate_realise_facets(a, &def, workers, &mesh, report, &error);
    if (status != TY_OK)
        print_message("%s\n", error.text);
    assert_int_equal(status, TY_OK);
    ty_workers_destroy(workers);
    return mesh;
}

// One instance of the mesh by itself.
static ty_mesh* part_of(const ty_mesh* mesh, const ty_aggregate* a, uint32_t instance)
{
    const ty_mesh* p = a->prototypes[0];
    ty_mesh* part = ty_mesh_copy(p);
    memcpy(part->positions, mesh->positions + (size_t)instance * p->vertex_count, p->vertex_count * sizeof(ty_vec3));
    memcpy(part->normals, mesh->normals + (size_t)instance * p->vertex_count, p->vertex_count * sizeof(ty_vec3));
    for (uint32_t t = 0; t < p->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            part->triangles[t][k] =
                mesh->triangles[(size_t)instance * p->triangle_count + t][k] - instance * p->vertex_count;
    ty_mesh_compute_welds(part);
    ty_mesh_compute_bounds(part);
    return part;
}

// Deepest vertex of one within another, m; and every part is closed.
static float deepest_within(const ty_mesh* mesh, const ty_aggregate* a)
{
    ty_world_def def = ty_world_def_default();
    ty_world* world;
    ty_error error;
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    ty_mesh** parts = ty_alloc(a->instance_count, sizeof *parts);
    uint32_t* numbers = ty_alloc(a->instance_count, sizeof *numbers);
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        parts[i] = part_of(mesh, a, i);
        ty_mesh_topology topology;
        ty_mesh_analyse(parts[i], &topology);
        assert_true(topology.closed);
        assert_int_equal(ty_world_add_prototype(world, parts[i], &numbers[i], &error), TY_OK);
    }
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
    float deepest = 0.0f;
    for (uint32_t i = 0; i < a->instance_count; i++)
        for (uint32_t j = 0; j < a->instance_count; j++)
            for (uint32_t v = 0; v < parts[i]->vertex_count && i != j; v++)
            {
                ty_vec3 p = parts[i]->positions[v];
                const ty_bounds* b = &parts[j]->bounds;
                ty_closest closest;
                if (p.x < b->low.x || p.x > b->high.x || p.y < b->low.y || p.y > b->high.y || p.z < b->low.z ||
                    p.z > b->high.z || !ty_world_inside(world, numbers[j], p))
                    continue;
                assert_true(ty_world_closest(world, numbers[j], p, 1.0f, &closest));
                deepest = ty_max(deepest, closest.distance);
            }
    ty_world_destroy(world);
    for (uint32_t i = 0; i < a->instance_count; i++)
        ty_mesh_destroy(parts[i]);
    ty_free(parts);
    ty_free(numbers);
    return deepest;
}

// Two balls: the facet is the plane between them, its volume the two caps.
static void two_balls(void** state)
{
    (void)state;
    ty_aggregate* a = aggregate_make(2);
    const float r = 0.5f * WIDTH, d = 0.92f * WIDTH;
    ty_vec3 n = ty_normalize((ty_vec3){1, 2, -0.5f});
    for (uint32_t i = 0; i < 2; i++)
        a->transforms[i] = ty_affine_from_trs(ty_mul(n, i ? d : 0.0f), ty_quat_identity(), (ty_vec3){r, r, r});
    ty_facet_report report;
    ty_mesh* mesh = facets(a, 0.0f, 1, &report);
    assert_int_equal(report.contacts, 1);
    assert_true(fabsf(report.deepest / (2.0f * r - d) - 1.0f) < 0.1f);
    uint32_t of_one = a->prototypes[0]->vertex_count, on_plane = 0;
    for (uint32_t v = 0; v < 2 * of_one; v++)
    {
        ty_vec3 center = v < of_one ? (ty_vec3){0, 0, 0} : ty_mul(n, d);
        float off = ty_dot(mesh->positions[v], n) - 0.5f * d;
        float radius = ty_length(ty_sub(mesh->positions[v], center));
        if (radius > 0.999f * r)
            continue;
        on_plane++;
        assert_true(fabsf(off) < 1e-3f * WIDTH);
        // Well within the facet it is the plane's normal.
        if (radius < 0.94f * r)
            assert_true(ty_dot(mesh->normals[v], n) * (v < of_one ? 1.0f : -1.0f) > 0.99f);
    }
    assert_true(on_plane > 20 && report.vertices >= on_plane);
    double h = (double)(r - 0.5f * d), cap = 3.14159265358979 * h * h * ((double)r - h / 3.0);
    assert_true(fabs((report.volume_before - report.volume_after) / (2.0 * cap) - 1.0) < 0.25); // of a coarse facet
    assert_true(deepest_within(mesh, a) < 1e-3f * WIDTH);
    ty_mesh_destroy(mesh);
    ty_aggregate_destroy(a);
}

// A heap of ellipsoids, some sheared and mirrored, each within several others.
static ty_aggregate* heap_make(void)
{
    enum
    {
        SIDE = 4
    };
    ty_aggregate* a = aggregate_make(SIDE * SIDE * SIDE);
    ty_rng rng = ty_rng_make((ty_seed){4}, 0, 0);
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        float pitch = 0.945f * WIDTH;
        ty_vec3 at = {pitch * (float)(i % SIDE), pitch * (float)(i / SIDE % SIDE), pitch * (float)(i / SIDE / SIDE)};
        at = ty_add(at, random_point(&rng, 0.03f * WIDTH));
        float x = 0.5f * WIDTH * ty_rng_range(&rng, 0.98f, 1.04f);
        ty_affine m = ty_affine_from_trs(at, random_rotation(&rng), (ty_vec3){i % 5 ? x : -x, 0.5f * WIDTH, x});
        if (i % 3 == 0)
        {
            ty_affine shear = {{1, 0.04f, 0}, {0.02f, 1, 0}, {0, 0.03f, 0.98f}, {0, 0, 0}};
            m = ty_affine_multiply(&m, &shear);
        }
        a->transforms[i] = m;
    }
    return a;
}

static void heap(void** state)
{
    (void)state;
    ty_aggregate* a = heap_make();
    ty_facet_report report;
    ty_mesh* mesh = facets(a, 0.0f, 1, &report);
    assert_true(report.contacts > 100);
    assert_true(report.deepest > 0.05f * WIDTH);
    float deepest = deepest_within(mesh, a);
    print_message("%u contacts, %g of the width within, then %g; volume %g\n", report.contacts,
                  (double)(report.deepest / WIDTH), (double)(deepest / WIDTH),
                  report.volume_after / report.volume_before);
    assert_true(deepest < 1e-3f * WIDTH);
    assert_true(report.volume_after < report.volume_before && report.volume_after > 0.98 * report.volume_before);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        assert_true(fabsf(ty_length(mesh->normals[v]) - 1.0f) < 1e-4f);
    for (int threads = 2; threads <= 3; threads++)
    {
        ty_mesh* other = facets(a, 0.0f, threads, &report);
        assert_memory_equal(other->positions, mesh->positions, mesh->vertex_count * sizeof(ty_vec3));
        assert_memory_equal(other->normals, mesh->normals, mesh->vertex_count * sizeof(ty_vec3));
        ty_mesh_destroy(other);
    }
    ty_mesh_destroy(mesh);
    ty_aggregate_destroy(a);
}

// A gap that is closed in its middle.
static void gaps_close(void** state)
{
    (void)state;
    ty_aggregate* a = aggregate_make(2);
    const float r = 0.5f * WIDTH, gap = 0.01f * WIDTH;
    for (uint32_t i = 0; i < 2; i++)
        a->transforms[i] =
            ty_affine_from_trs((ty_vec3){0, (2.0f * r + gap) * (float)i, 0}, ty_quat_identity(), (ty_vec3){r, r, r});
    ty_facet_report report;
    ty_mesh* open = facets(a, 0.0f, 1, &report);
    assert_int_equal(report.vertices, 0);
    ty_mesh* closed = facets(a, 4.0f * gap, 1, &report);
    assert_int_equal(report.contacts, 1);
    assert_true(report.volume_after > report.volume_before);
    float highest = -1.0f;
    for (uint32_t v = 0; v < a->prototypes[0]->vertex_count; v++)
        highest = ty_max(highest, closed->positions[v].y);
    assert_true(fabsf(highest - (r + 0.5f * gap)) < 0.2f * gap);
    assert_true(deepest_within(closed, a) < 1e-3f * WIDTH);
    ty_mesh_destroy(open);
    ty_mesh_destroy(closed);
    ty_aggregate_destroy(a);
}

// What lies in another altogether stays, and what is open is refused.
static void others(void** state)
{
    (void)state;
    ty_aggregate* a = aggregate_make(2);
    for (uint32_t i = 0; i < 2; i++)
    {
        float r = i ? 0.3f * WIDTH : 0.5f * WIDTH;
        a->transforms[i] =
            ty_affine_from_trs((ty_vec3){0, 0.1f * WIDTH * (float)i, 0}, ty_quat_identity(), (ty_vec3){r, r, r});
    }
    ty_facet_report report;
    ty_mesh* mesh = facets(a, 0.0f, 1, &report);
    assert_int_equal(report.vertices, 0);
    ty_mesh_destroy(mesh);
    a->prototypes[0]->triangle_count--;
    ty_facet_def def = ty_facet_def_default();
    ty_error error;
    assert_int_equal(ty_aggregate_realise_facets(a, &def, NULL, &mesh, NULL, &error), TY_BAD_INPUT);
    assert_null(mesh);
    assert_non_null(strstr(error.text, "closed"));
    ty_aggregate_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(two_balls), cmocka_unit_test(heap),
                                       cmocka_unit_test(gaps_close), cmocka_unit_test(others)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
