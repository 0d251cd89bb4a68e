// SPDX-License-Identifier: Apache-2.0
// Aggregates for other programs: what is written is what stands in memory, whichever file holds it.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/own_folder.h"
#include "trace_meshes.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/geometry/aggregate_export.h>
#include <tsuya/geometry/mesh_file.h>
#include <unistd.h>

static const char* const names[] = {"a.glb", "b.glb", "a.usda", "b.usda", "a.ply", "b.ply", "a.obj", "b.obj"};

// Spheres and tori with a material each, some of them mirrored and stretched.
static ty_aggregate* make_heap(bool rigid)
{
    ty_aggregate* heap = ty_aggregate_create(40, 2);
    heap->prototypes[0] = make_sphere(8, 5);
    heap->prototypes[1] = make_torus(7, 5);
    assert_int_equal(ty_mesh_add_slot(heap->prototypes[0], "white"), 0);
    assert_int_equal(ty_mesh_add_slot(heap->prototypes[1], "yolk"), 0);
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    float* moisture = ty_aggregate_add_attribute(heap, "moisture");
    for (uint32_t i = 0; i < 40; i++)
    {
        heap->prototype_index[i] = i % 2;
        heap->transforms[i] = random_map(&rng, i, 0.1f, 0.003f);
        if (rigid)
        {
            float size = 0.001f * (1.0f + ty_rng_float(&rng));
            heap->transforms[i] =
                ty_affine_from_trs(random_point(&rng, 0.1f), random_rotation(&rng), (ty_vec3){size, size, size});
        }
        heap->ids[i] = 3 * i + 2;
        moisture[i] = ty_rng_float(&rng);
    }
    heap->recipe = ty_string_copy("kind: aggregate\nname: \"a\\b\"\n");
    return heap;
}

static double heap_volume(const ty_aggregate* heap)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < heap->instance_count; i++)
    {
        ty_mesh_topology topology;
        ty_mesh_analyse(heap->prototypes[heap->prototype_index[i]], &topology);
        sum += topology.volume * fabs((double)ty_affine_determinant(&heap->transforms[i]));
    }
    return sum;
}

// Every vertex where its instance has it, outside still outside, the instance's values on it, its material kept.
static void realised(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(false);
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_aggregate_realise(heap, &mesh, &error), TY_OK);
    uint32_t vertex = 0, triangle = 0;
    const float* moisture = ty_mesh_find_attribute(mesh, "moisture")->values;
    const float* id = ty_mesh_find_attribute(mesh, "id")->values;
    for (uint32_t i = 0; i < 40; i++)
    {
        const ty_mesh* part = heap->prototypes[i % 2];
        for (uint32_t v = 0; v < part->vertex_count; v++, vertex++)
        {
            ty_vec3 p = ty_map_point(&heap->transforms[i], part->positions[v]);
            assert_memory_equal(&mesh->positions[vertex], &p, sizeof p);
            assert_true(moisture[vertex] == heap->attributes[0].values[i]);
            assert_true(id[vertex] == (float)heap->ids[i]);
        }
        for (uint32_t t = 0; t < part->triangle_count; t++, triangle++)
            assert_string_equal(mesh->slot_names[mesh->slots[triangle]], part->slot_names[0]);
    }
    assert_int_equal(vertex, mesh->vertex_count);
    assert_int_equal(triangle, mesh->triangle_count);
    ty_mesh_compute_welds(mesh);
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    assert_true(topology.closed);
    assert_int_equal(topology.components, 40);
    assert_true(fabs(topology.volume - heap_volume(heap)) < 1e-4 * topology.volume);
    ty_mesh_destroy(mesh);
    ty_aggregate_destroy(heap);
}

// The realised mesh through each of its files.
static void mesh_files(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(false);
    double volume = heap_volume(heap);
    ty_error error;
    for (size_t k = 0; k < 3; k++)
    {
        const char* path = in_folder((const char*[]){"a.glb", "a.ply", "a.obj"}[k]);
        assert_int_equal(ty_aggregate_export(path, heap, true, &error), TY_OK);
        ty_mesh* mesh;
        assert_int_equal(ty_mesh_read(path, &mesh, &error), TY_OK);
        ty_mesh_topology topology;
        ty_mesh_analyse(mesh, &topology);
        assert_int_equal(mesh->triangle_count, 20 * (heap->prototypes[0]->triangle_count + 70));
        assert_true(topology.closed);
        assert_int_equal(topology.components, 40);
        assert_true(fabs(topology.volume - volume) < 1e-4 * volume);
        if (k != 1) // our PLY files name no materials
        {
            assert_int_equal(mesh->slot_count, 2);
            assert_string_equal(mesh->slot_names[0], "white");
            assert_string_equal(mesh->slot_names[1], "yolk");
        }
        ty_mesh_destroy(mesh);
    }
    ty_aggregate_destroy(heap);
}

// Points bring back place, turn, size, id and attributes of those that are neither mirrored nor sheared.
static void points(void** state)
{
    (void)state;
    ty_aggregate *heap = make_heap(true), *back;
    ty_error error;
    assert_int_equal(ty_aggregate_export(in_folder("a.ply"), heap, false, &error), TY_OK);
    assert_int_equal(ty_aggregate_read(in_folder("a.ply"), heap->prototypes[0], &back, &error), TY_OK);
    assert_int_equal(back->instance_count, 40);
    const ty_instance_attribute* prototype = ty_aggregate_find_attribute(back, "prototype");
    assert_non_null(prototype);
    for (uint32_t i = 0; i < 40; i++)
    {
        const float *p = &heap->transforms[i].x.x, *q = &back->transforms[i].x.x;
        for (int k = 0; k < 9; k++)
            assert_true(fabsf(p[k] - q[k]) < 4e-9f);
        assert_memory_equal(&heap->transforms[i].t, &back->transforms[i].t, sizeof(ty_vec3));
        assert_true(prototype->values[i] == (float)heap->prototype_index[i]);
    }
    assert_memory_equal(heap->ids, back->ids, 40 * sizeof(uint32_t));
    const ty_instance_attribute* moisture = ty_aggregate_find_attribute(back, "moisture");
    assert_memory_equal(heap->attributes[0].values, moisture->values, 40 * sizeof(float));
    // One stretched grain brings scale_x .. scale_z in for all.
    ty_aggregate_destroy(back);
    heap->transforms[3] = ty_affine_from_trs((ty_vec3){0, 0, 0}, (ty_quat){0, 0, 0, 1}, (ty_vec3){1, 2, 3});
    assert_int_equal(ty_aggregate_export(in_folder("a.ply"), heap, false, &error), TY_OK);
    assert_int_equal(ty_aggregate_read(in_folder("a.ply"), heap->prototypes[0], &back, &error), TY_OK);
    assert_memory_equal(&heap->transforms[3], &back->transforms[3], sizeof(ty_affine));
    assert_true(fabsf(heap->transforms[9].x.x - back->transforms[9].x.x) < 4e-9f);
    ty_aggregate_destroy(heap);
    ty_aggregate_destroy(back);
}

static void same_bytes(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(false);
    ty_error error;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        assert_int_equal(ty_aggregate_export(in_folder(names[i]), heap, false, &error), TY_OK);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i += 2)
    {
        ty_bytes a, b;
        assert_int_equal(ty_file_read(in_folder(names[i]), 1 << 26, &a, &error), TY_OK);
        assert_int_equal(ty_file_read(in_folder(names[i + 1]), 1 << 26, &b, &error), TY_OK);
        assert_int_equal(a.size, b.size);
        assert_memory_equal(a.data, b.data, a.size);
        ty_bytes_term(&a);
        ty_bytes_term(&b);
    }
    ty_aggregate_destroy(heap);
}

static void refused(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(false);
    ty_error error;
    assert_int_equal(ty_aggregate_export(in_folder("a.fbx"), heap, false, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, ".usda"));
    assert_int_equal(ty_aggregate_export(in_folder("a.usda"), heap, true, &error), TY_BAD_INPUT);
    assert_int_equal(ty_aggregate_export("/nonexistent/a.usda", heap, false, &error), TY_BAD_FILE);
    heap->transforms[7].t.x = NAN;
    for (size_t i = 0; i < 6; i += 2)
    {
        unlink(in_folder(names[i]));
        assert_int_equal(ty_aggregate_export(in_folder(names[i]), heap, false, &error), TY_BAD_INPUT);
        assert_non_null(strstr(error.text, "instance 7"));
        assert_false(ty_file_exists(in_folder(names[i])));
    }
    heap->prototype_index[7] = 9;
    assert_int_equal(ty_aggregate_export(in_folder("a.obj"), heap, false, &error), TY_BAD_INPUT);
    ty_aggregate_destroy(heap);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(realised),   cmocka_unit_test(mesh_files), cmocka_unit_test(points),
        cmocka_unit_test(same_bytes), cmocka_unit_test(refused),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
