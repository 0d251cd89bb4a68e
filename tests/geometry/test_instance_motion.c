// SPDX-License-Identifier: Apache-2.0
// Velocities and spins of instances: through each file, under the nodes of other programs, on a realised mesh.
#include "base/own_folder.h"
#include "trace_meshes.h"
#include <base/cmocka_all.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/geometry/aggregate_export.h>
#include <unistd.h>

enum
{
    COUNT = 30
};

static const char* const names[] = {"a.glb", "a.ply", "a.usda"};

// Two kinds in turn, so that a file holds them in another order.
static ty_aggregate* make_heap(bool velocities, bool spins)
{
    ty_aggregate* heap = ty_aggregate_create(COUNT, 2);
    heap->prototypes[0] = make_sphere(8, 5);
    heap->prototypes[1] = make_torus(7, 5);
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    for (uint32_t i = 0; i < COUNT; i++)
    {
        heap->prototype_index[i] = i % 2;
        heap->transforms[i] =
            ty_affine_from_trs(random_point(&rng, 0.1f), random_rotation(&rng), (ty_vec3){0.01f, 0.01f, 0.01f});
        if (velocities)
            ty_aggregate_add_velocities(heap)[i] = random_point(&rng, 2.0f);
        if (spins)
            ty_aggregate_add_spins(heap)[i] = random_point(&rng, 50.0f);
    }
    return heap;
}

static void round_trip(void** state)
{
    (void)state;
    ty_error error;
    for (int kind = 0; kind < 8; kind++)
    {
        bool velocities = kind & 1, spins = kind & 2;
        const char* path = in_folder(kind & 4 ? "a.glb" : "a.ply");
        ty_aggregate *heap = make_heap(velocities, spins), *back;
        assert_int_equal(ty_aggregate_export(path, heap, false, &error), TY_OK);
        assert_int_equal(ty_aggregate_read(path, kind & 4 ? NULL : heap->prototypes[0], &back, &error), TY_OK);
        assert_int_equal(back->velocities != NULL, velocities);
        assert_int_equal(back->spins != NULL, spins);
        if (velocities)
            assert_memory_equal(back->velocities, heap->velocities, COUNT * sizeof(ty_vec3));
        if (spins)
            assert_memory_equal(back->spins, heap->spins, COUNT * sizeof(ty_vec3));
        assert_int_equal(back->attribute_count, kind & 4 ? 0 : 1); // of points the prototype
        ty_aggregate_destroy(heap);
        ty_aggregate_destroy(back);
    }
}

static void assert_holds(const char* path, const char* text)
{
    ty_bytes bytes;
    ty_error error;
    assert_int_equal(ty_file_read(path, 1 << 20, &bytes, &error), TY_OK);
    assert_non_null(strstr((const char*)bytes.data, text));
    ty_bytes_term(&bytes);
}

// USD's angular velocities are in degrees.
static void usd(void** state)
{
    (void)state;
    ty_error error;
    ty_aggregate* heap = make_heap(true, true);
    heap->velocities[0] = (ty_vec3){1.5f, -2.0f, 0.25f};
    heap->spins[0] = (ty_vec3){TY_PI, 0.0f, -0.5f * TY_PI};
    assert_int_equal(ty_aggregate_export(in_folder("a.usda"), heap, false, &error), TY_OK);
    assert_holds(in_folder("a.usda"), "vector3f[] velocities = [(1.5, -2, 0.25), ");
    assert_holds(in_folder("a.usda"), "vector3f[] angularVelocities = [(180, 0, -90), ");
    ty_aggregate_destroy(heap);
}

static void write_glb(const char* json, const void* values, uint32_t size)
{
    uint8_t file[4096] = {0};
    uint32_t length = ((uint32_t)strlen(json) + 3) & ~3u;
    const uint32_t head[5] = {0x46546c67, 2, 28 + length + size, length, 0x4e4f534a}, bin[2] = {size, 0x004e4942};
    assert_true(head[2] <= sizeof file);
    memcpy(file, head, sizeof head);
    memset(file + 20, ' ', length);
    memcpy(file + 20, json, strlen(json));
    memcpy(file + 20 + length, bin, sizeof bin);
    memcpy(file + 28 + length, values, size);
    ty_error error;
    assert_int_equal(ty_file_write(in_folder("a.glb"), file, head[2], &error), TY_OK);
}

// One instance with a velocity along x and a spin about x, in a node with the given map.
static ty_aggregate* read_under(const char* map)
{
    const float values[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 3, 0, 0, 7, 0, 0};
    char json[2048];
    snprintf(json, sizeof json,
             "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":72}],\"bufferViews\":[{\"buffer\":0,"
             "\"byteLength\":72}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\""
             "},{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"},"
             "{\"bufferView\":0,\"byteOffset\":48,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"},"
             "{\"bufferView\":0,\"byteOffset\":60,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"}],\"meshes\":"
             "[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0,%s,\"extensions\":"
             "{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":1,\"_VELOCITY\":2,\"_SPIN\":3}}}}]}",
             map);
    write_glb(json, values, sizeof values);
    ty_aggregate* back = NULL;
    ty_error error = {0};
    ty_status status = ty_aggregate_read(in_folder("a.glb"), NULL, &back, &error);
    if (status != TY_OK)
        print_message("%s\n", error.text);
    assert_int_equal(status, TY_OK);
    return back;
}

static void assert_motion(ty_aggregate* a, ty_vec3 velocity, ty_vec3 spin)
{
    assert_true(ty_length(ty_sub(a->velocities[0], velocity)) < 1e-5f);
    assert_true(ty_length(ty_sub(a->spins[0], spin)) < 1e-5f);
    ty_aggregate_destroy(a);
}

// A velocity is turned and sized by the node it stands under; a spin is turned alone, and about by a mirror.
static void under_nodes(void** state)
{
    (void)state;
    assert_motion(read_under("\"scale\":[1,1,1]"), (ty_vec3){3, 0, 0}, (ty_vec3){7, 0, 0});
    assert_motion(read_under("\"rotation\":[0,0,0.70710678,0.70710678],\"scale\":[2,2,2]"), (ty_vec3){0, 6, 0},
                  (ty_vec3){0, 7, 0});
    assert_motion(read_under("\"scale\":[-1,1,1]"), (ty_vec3){-3, 0, 0}, (ty_vec3){7, 0, 0});
    assert_motion(read_under("\"scale\":[1,-1,1]"), (ty_vec3){3, 0, 0}, (ty_vec3){-7, 0, 0});
}

// What moves in a mesh is its vertices: v + w x r.
static void realised(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(true, true);
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_aggregate_realise(heap, &mesh, &error), TY_OK);
    const ty_mesh_attribute* found = ty_mesh_find_attribute(mesh, "velocity");
    assert_non_null(found);
    assert_int_equal(found->components, 3);
    const ty_vec3* velocity = (const ty_vec3*)found->values;
    uint32_t vertex = 0;
    const float h = 1e-3f;
    for (uint32_t i = 0; i < COUNT; i++)
    {
        // Where the vertex is a moment later.
        float angle = h * ty_length(heap->spins[i]);
        ty_quat turn = ty_quat_axis_angle(ty_normalize(heap->spins[i]), angle);
        for (uint32_t k = 0; k < heap->prototypes[i % 2]->vertex_count; k++, vertex++)
        {
            ty_vec3 arm = ty_sub(mesh->positions[vertex], heap->transforms[i].t);
            ty_vec3 moved = ty_sub(ty_mad(ty_quat_rotate(turn, arm), heap->velocities[i], h), arm);
            assert_true(ty_length(ty_sub(ty_mul(moved, 1.0f / h), velocity[vertex])) < 0.04f);
        }
    }
    ty_mesh_destroy(mesh);
    ty_aggregate_destroy(heap);
}

static void refused(void** state)
{
    (void)state;
    ty_error error;
    ty_aggregate* heap = make_heap(true, true);
    heap->spins[9].y = INFINITY;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
    {
        assert_int_equal(ty_aggregate_export(in_folder(names[i]), heap, false, &error), TY_BAD_INPUT);
        assert_non_null(strstr(error.text, "instance 9: its velocity"));
    }
    heap->spins[9].y = 0.0f;
    (void)ty_aggregate_add_attribute(heap, "wx");
    assert_int_equal(ty_aggregate_export(in_folder("a.ply"), heap, false, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "\"wx\""));
    assert_int_equal(ty_aggregate_export(in_folder("a.glb"), heap, false, &error), TY_OK);
    (void)ty_aggregate_add_attribute(heap, "velocity");
    assert_int_equal(ty_aggregate_export(in_folder("a.glb"), heap, false, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "\"velocity\""));
    ty_aggregate_destroy(heap);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip), cmocka_unit_test(usd),     cmocka_unit_test(under_nodes),
        cmocka_unit_test(realised),   cmocka_unit_test(refused),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
