// SPDX-License-Identifier: Apache-2.0
// Aggregate files: what is written comes back, the same bytes again and again; what is damaged is refused by name.
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
#include <tsuya/geometry/mesh_file.h>
#include <unistd.h>

// Three prototypes (one without instances), interleaved, mirrored and stretched.
static ty_aggregate* make_heap(uint32_t count)
{
    ty_aggregate* heap = ty_aggregate_create(count, 3);
    heap->prototypes[0] = make_sphere(8, 5);
    heap->prototypes[1] = make_sphere(4, 3);
    heap->prototypes[2] = make_torus(6, 5);
    ty_mesh* torus = heap->prototypes[2];
    torus->uvs = TY_ALLOC(ty_vec2, torus->vertex_count);
    torus->curvature_1 = TY_ALLOC(float, torus->vertex_count);
    torus->curvature_2 = TY_ALLOC(float, torus->vertex_count);
    torus->direction_1 = TY_ALLOC(ty_vec3, torus->vertex_count);
    float* pair = ty_mesh_add_attribute(torus, "thickness", 2);
    for (uint32_t i = 0; i < torus->vertex_count; i++)
    {
        torus->uvs[i] = (ty_vec2){0.1f * (float)i, 0.7f};
        torus->curvature_1[i] = 2.5f;
        torus->curvature_2[i] = 0.3f * (float)i;
        torus->direction_1[i] = (ty_vec3){0, 1, 0};
        pair[2 * i] = (float)i;
        pair[2 * i + 1] = -0.1f;
    }
    float* moisture = ty_aggregate_add_attribute(heap, "moisture");
    float* tint = ty_aggregate_add_attribute(heap, "tint");
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    for (uint32_t i = 0; i < count; i++)
    {
        heap->prototype_index[i] = i % 2 ? 2 : 0;
        heap->transforms[i] = random_map(&rng, i, 0.1f, 0.003f);
        heap->ids[i] = 7 * i + 1;
        moisture[i] = ty_rng_float(&rng);
        tint[i] = -1.0f;
    }
    heap->recipe = ty_string_copy("grain: { length: 6 }\nseed: 7 # 艶\n");
    heap->hash = ty_string_copy("00ff");
    heap->metrics = ty_string_copy("{\"z\": 0.1, \"packing\": 0.61}");
    return heap;
}

static ty_aggregate* write_and_read(const ty_aggregate* aggregate, const char* name)
{
    ty_error error = {0};
    ty_aggregate* back = NULL;
    ty_status status = ty_aggregate_write(in_folder(name), aggregate, &error);
    if (status == TY_OK)
        status = ty_aggregate_read(in_folder(name), NULL, &back, &error);
    if (status != TY_OK)
        print_message("%s\n", error.text);
    assert_int_equal(status, TY_OK);
    return back;
}

static void assert_same_map(const ty_affine* a, const ty_affine* b)
{
    const float *p = &a->x.x, *q = &b->x.x;
    float size = 0.0f;
    for (int i = 0; i < 9; i++)
        size = ty_max(size, fabsf(p[i]));
    for (int i = 0; i < 9; i++)
        assert_true(fabsf(p[i] - q[i]) <= 1e-6f * size);
    assert_memory_equal(&a->t, &b->t, sizeof a->t);
}

static void assert_same_mesh(const ty_mesh* a, const ty_mesh* b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_memory_equal(a->positions, b->positions, a->vertex_count * sizeof(ty_vec3));
    assert_memory_equal(a->normals, b->normals, a->vertex_count * sizeof(ty_vec3));
    assert_memory_equal(a->triangles, b->triangles, a->triangle_count * sizeof a->triangles[0]);
    assert_int_equal(a->uvs != NULL, b->uvs != NULL);
    assert_int_equal(a->curvature_1 != NULL, b->curvature_1 != NULL);
    if (a->uvs)
        assert_memory_equal(a->uvs, b->uvs, a->vertex_count * sizeof(ty_vec2));
    if (a->curvature_1)
    {
        assert_memory_equal(a->curvature_1, b->curvature_1, a->vertex_count * sizeof(float));
        assert_memory_equal(a->curvature_2, b->curvature_2, a->vertex_count * sizeof(float));
        assert_memory_equal(a->direction_1, b->direction_1, a->vertex_count * sizeof(ty_vec3));
    }
    assert_int_equal(a->attribute_count, b->attribute_count);
    for (int i = 0; i < a->attribute_count; i++)
    {
        const ty_mesh_attribute* other = ty_mesh_find_attribute(b, a->attributes[i].name);
        assert_non_null(other);
        assert_int_equal(other->components, a->attributes[i].components);
        assert_memory_equal(other->values, a->attributes[i].values,
                            a->vertex_count * (size_t)other->components * sizeof(float));
    }
    assert_non_null(b->welds);
    assert_memory_equal(&a->bounds, &b->bounds, sizeof a->bounds);
}

static void round_trip(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(101);
    ty_aggregate* back = write_and_read(heap, "a.glb");
    assert_int_equal(back->instance_count, 101);
    assert_int_equal(back->prototype_count, 3);
    for (int i = 0; i < 3; i++)
        assert_same_mesh(heap->prototypes[i], back->prototypes[i]);
    assert_memory_equal(heap->prototype_index, back->prototype_index, 101 * sizeof(uint32_t));
    ty_mesh* whole; // by the reader of any glTF file, whose images begin at the top
    ty_error error;
    if (ty_mesh_read(in_folder("a.glb"), &whole, &error) != TY_OK)
        fail_msg("%s", error.text);
    assert_non_null(whole->uvs);
    uint32_t up = 0;
    for (uint32_t i = 0; i < whole->vertex_count; i++)
        up += whole->uvs[i].y == 0.7f;
    assert_int_equal(up, 50 * heap->prototypes[2]->vertex_count);
    ty_mesh_destroy(whole);
    assert_memory_equal(heap->ids, back->ids, 101 * sizeof(uint32_t));
    for (uint32_t i = 0; i < 101; i++)
        assert_same_map(&heap->transforms[i], &back->transforms[i]);
    assert_int_equal(back->attribute_count, 2);
    for (int i = 0; i < 2; i++)
    {
        const ty_instance_attribute* other = ty_aggregate_find_attribute(back, heap->attributes[i].name);
        assert_non_null(other);
        assert_memory_equal(other->values, heap->attributes[i].values, 101 * sizeof(float));
    }
    assert_string_equal(back->recipe, heap->recipe);
    assert_string_equal(back->hash, heap->hash);
    assert_string_equal(back->metrics, "{\"packing\":0.61,\"z\":0.1}");
    ty_aggregate_destroy(heap);
    ty_aggregate_destroy(back);
}

static void assert_same_files(void)
{
    ty_bytes a, b;
    ty_error error;
    assert_int_equal(ty_file_read(in_folder("a.glb"), 1 << 26, &a, &error), TY_OK);
    assert_int_equal(ty_file_read(in_folder("b.glb"), 1 << 26, &b, &error), TY_OK);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.data, b.data, a.size);
    ty_bytes_term(&a);
    ty_bytes_term(&b);
}

// Write, read, write: the same bytes, though rotations and scales are taken apart anew each time.
static void rewriting_is_stable(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(20000);
    ty_aggregate* back = write_and_read(heap, "a.glb");
    ty_aggregate* again = write_and_read(back, "b.glb");
    assert_same_files();
    assert_memory_equal(back->transforms, again->transforms, 20000 * sizeof(ty_affine));
    ty_aggregate_destroy(again);
    // One grain sheared ever so little brings the matrices in; they come back bit for bit.
    heap->transforms[6].x = ty_mad(heap->transforms[6].x, heap->transforms[6].y, 1e-5f);
    heap->transforms[8] = ty_affine_identity();
    heap->transforms[8].z.x = -0.0f;
    ty_aggregate_destroy(back);
    back = write_and_read(heap, "a.glb");
    for (uint32_t i = 0; i < 20000; i += 2)
        assert_memory_equal(&heap->transforms[i], &back->transforms[i], sizeof(ty_affine));
    again = write_and_read(back, "b.glb");
    assert_same_files();
    ty_aggregate_destroy(heap);
    ty_aggregate_destroy(back);
    ty_aggregate_destroy(again);
}

static void large_ids_and_single_prototype(void** state)
{
    (void)state;
    ty_aggregate* heap = ty_aggregate_create(3, 1);
    heap->prototypes[0] = make_sphere(4, 3);
    heap->ids[1] = (1u << 24) + 1;
    ty_aggregate* back = write_and_read(heap, "a.glb");
    assert_memory_equal(back->ids, heap->ids, sizeof(uint32_t[3]));
    ty_aggregate_destroy(back);
    heap->ids[2] = TY_NONE;
    back = write_and_read(heap, "a.glb");
    assert_memory_equal(back->ids, heap->ids, sizeof(uint32_t[3]));
    // Rigid maps stay exactly rigid.
    assert_memory_equal(back->transforms, heap->transforms, sizeof(ty_affine[3]));
    assert_null(back->recipe);
    assert_null(back->metrics);
    ty_aggregate_destroy(heap);
    ty_aggregate_destroy(back);
}

// Grains that are only turned keep a scale of exactly one.
static void rigid_stays_rigid(void** state)
{
    (void)state;
    ty_aggregate* heap = ty_aggregate_create(50, 1);
    heap->prototypes[0] = make_sphere(4, 3);
    ty_rng rng = ty_rng_make((ty_seed){4}, 0, 0);
    for (uint32_t i = 0; i < 50; i++)
        heap->transforms[i] = ty_affine_from_trs(random_point(&rng, 1.0f), random_rotation(&rng), (ty_vec3){1, 1, 1});
    ty_aggregate* back = write_and_read(heap, "a.glb");
    ty_bytes bytes;
    ty_error error;
    assert_int_equal(ty_file_read(in_folder("a.glb"), 1 << 26, &bytes, &error), TY_OK);
    float ones[150];
    for (int i = 0; i < 150; i++)
        ones[i] = 1.0f;
    assert_non_null(memmem(bytes.data, bytes.size, ones, sizeof ones));
    ty_bytes_term(&bytes);
    ty_aggregate_destroy(heap);
    ty_aggregate_destroy(back);
}

static void unwritable(void** state)
{
    (void)state;
    ty_error error;
    ty_aggregate* heap = make_heap(5);
    heap->transforms[3].z = (ty_vec3){0, 0, 0};
    assert_int_equal(ty_aggregate_write(in_folder("b.glb"), heap, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "instance 3"));
    heap->transforms[3] = ty_affine_identity();
    heap->prototypes[1]->positions[2].y = NAN;
    assert_int_equal(ty_aggregate_write(in_folder("b.glb"), heap, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "prototype 1: vertex 2"));
    heap->prototypes[1]->positions[2].y = 0.0f;
    heap->attributes[0].values[4] = INFINITY;
    assert_int_equal(ty_aggregate_write(in_folder("b.glb"), heap, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "instance 4"));
    heap->attributes[0].values[4] = 0.0f;
    strcpy(heap->attributes[0].name, "order");
    assert_int_equal(ty_aggregate_write(in_folder("b.glb"), heap, &error), TY_BAD_INPUT);
    strcpy(heap->attributes[0].name, "moisture");
    ty_free(heap->metrics);
    heap->metrics = ty_string_copy("[1]");
    assert_int_equal(ty_aggregate_write(in_folder("b.glb"), heap, &error), TY_BAD_INPUT);
    ty_free(heap->metrics);
    heap->metrics = NULL;
    assert_int_equal(ty_aggregate_write("/nonexistent/b.glb", heap, &error), TY_BAD_FILE);
    ty_aggregate_destroy(heap);
}

// --- damaged files ---

static ty_bytes good_file(void)
{
    ty_aggregate* heap = make_heap(6);
    ty_error error;
    ty_bytes bytes;
    assert_int_equal(ty_aggregate_write(in_folder("a.glb"), heap, &error), TY_OK);
    assert_int_equal(ty_file_read(in_folder("a.glb"), 1 << 26, &bytes, &error), TY_OK);
    ty_aggregate_destroy(heap);
    return bytes;
}

static void assert_refused(const void* bytes, size_t size, const char* reason)
{
    ty_error error = {0};
    ty_aggregate* none = NULL;
    assert_int_equal(ty_file_write(in_folder("b.glb"), bytes, size, &error), TY_OK);
    ty_status status = ty_aggregate_read(in_folder("b.glb"), NULL, &none, &error);
    if (status != TY_BAD_FILE || !strstr(error.text, reason))
        print_message("status %d, \"%s\" instead of \"%s\"\n", status, error.text, reason);
    assert_int_equal(status, TY_BAD_FILE);
    assert_non_null(strstr(error.text, reason));
    assert_non_null(strstr(error.file, "b.glb"));
    assert_null(none);
}

static void damaged_containers(void** state)
{
    (void)state;
    ty_bytes good = good_file();
    uint8_t* d = good.data;
    assert_refused(d, 0, "empty");
    assert_refused(d, 11, "too few");
    assert_refused(d, good.size - 8, "truncated");
    d[0] = 'x';
    assert_refused(d, good.size, "glTF");
    d[0] = 'g';
    d[4] = 1;
    assert_refused(d, good.size, "version 1");
    d[4] = 2;
    d[11] = 0x7f;
    assert_refused(d, good.size, "the header says 21");
    d[11] = 0;
    d[15] = 0x7f;
    assert_refused(d, good.size, "JSON chunk claims");
    d[15] = 0;
    uint32_t json_size = (uint32_t)(d[12] | d[13] << 8);
    size_t bin = 20 + json_size;
    uint8_t low = d[bin];
    d[bin] = (uint8_t)(low + 4); // 4 bytes more than there are
    assert_refused(d, good.size, "BIN chunk claims");
    d[bin] = low;
    d[16] = 'B';
    assert_refused(d, good.size, "expected a JSON chunk");
    d[16] = 'J';
    d[20] = '[';
    assert_refused(d, good.size, "JSON chunk, line 1");
    memset(d + 20, '[', 200);
    assert_refused(d, good.size, "nested deeper");
    ty_bytes_term(&good);
}

// Replaces the first occurrence in the JSON by a text of the same length.
static void replace(ty_bytes* bytes, const char* from, const char* to)
{
    char* at = memmem(bytes->data, bytes->size, from, strlen(from));
    assert_non_null(at);
    assert_int_equal(strlen(from), strlen(to));
    memcpy(at, to, strlen(to));
}

static void damaged_json(void** state)
{
    (void)state;
    static const struct
    {
        const char *from, *to, *reason;
    } cases[] = {
        {"\"2.0\"", "\"1.0\"", "asset.version"},
        {"\"mesh\":2", "\"mesh\":9", "nodes[1].mesh: the prototype is missing"},
        {"\"mesh\":2", "\"mush\":2", "nodes[1] places instances, but names no mesh"},
        {"\"_ORDER\":", "\"_ORDUR\":", "taken or beyond"},
        {"\"ROTATION\":", "\"_MATRIX0\":", "nodes[0]._MATRIX0: its accessor"},
        {"\"POSITION\":", "\"POSITIAN\":", "meshes[0].primitives[0] has no POSITION"},
        {"\"bufferView\":3,", "\"bufferView\":99", "JSON chunk"},
        {"\"count\":42", "\"count\":-2", "count is not a positive"},
        {"\"count\":42", "\"count\":43", "accessors[0]: 43 elements do not fit"},
        {"\"count\":42", "\"count\":41", "no accessor of 41 elements"},
        {"\"componentType\":5126", "\"componentType\":5127", "componentType"},
        {"\"type\":\"VEC3\"", "\"type\":\"VEC9\"", "accessors[0].type"},
        {"\"mode\":4", "\"mode\":1", "only triangles"},
        {"\"buffer\":0,", "\"buffer\":7,", "bufferViews[0].buffer"},
        {"EXT_mesh_gpu_instancing\"]", "EXT_mesh_gpu_instancinx\"]", "requires the extension"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    {
        ty_bytes bytes = good_file();
        replace(&bytes, cases[i].from, cases[i].to);
        assert_refused(bytes.data, bytes.size, cases[i].reason);
        ty_bytes_term(&bytes);
    }
}

// Finds a run of values in the BIN chunk and replaces its k-th.
static void poke(ty_bytes* bytes, const void* values, size_t size, size_t k, const void* value)
{
    uint8_t* at = memmem(bytes->data, bytes->size, values, size);
    assert_non_null(at);
    memcpy(at + 4 * k, value, 4);
}

static void damaged_values(void** state)
{
    (void)state;
    ty_aggregate* heap = make_heap(6);
    ty_aggregate* back = write_and_read(heap, "a.glb");
    const float nan_value = NAN, zero[3] = {0, 0, 0};
    const uint32_t beyond = 5000;

    ty_bytes bytes = good_file();
    poke(&bytes, heap->prototypes[2]->triangles, 24, 4, &beyond);
    assert_refused(bytes.data, bytes.size, "index 5000 at place 4");
    ty_bytes_term(&bytes);

    bytes = good_file();
    poke(&bytes, &heap->transforms[4].t, 12, 1, &nan_value);
    assert_refused(bytes.data, bytes.size, "instance 4");
    ty_bytes_term(&bytes);

    bytes = good_file();
    float moisture[3] = {heap->attributes[0].values[1], heap->attributes[0].values[3], heap->attributes[0].values[5]};
    poke(&bytes, moisture, 12, 2, &nan_value);
    assert_refused(bytes.data, bytes.size, "instance 5: moisture");
    ty_bytes_term(&bytes);

    bytes = good_file();
    float order[3] = {1.0f, 3.0f, 5.0f};
    poke(&bytes, order, 12, 1, &order[0]);
    assert_refused(bytes.data, bytes.size, "place 1 is taken");
    ty_bytes_term(&bytes);

    bytes = good_file();
    poke(&bytes, &heap->prototypes[0]->positions[5], 12, 0, &nan_value);
    assert_refused(bytes.data, bytes.size, "prototype 0: vertex 5");
    ty_bytes_term(&bytes);

    bytes = good_file();
    const float ids[3] = {8.0f, 22.0f, 36.0f}, half = 22.5f;
    poke(&bytes, ids, 12, 1, &half);
    assert_refused(bytes.data, bytes.size, "nodes[1]._ID holds what is no whole number");
    ty_bytes_term(&bytes);

    // Singular: the sheared heap's matrices are in the file as they are.
    heap->transforms[2].x = ty_add(heap->transforms[2].x, heap->transforms[2].y);
    ty_error error;
    assert_int_equal(ty_aggregate_write(in_folder("a.glb"), heap, &error), TY_OK);
    assert_int_equal(ty_file_read(in_folder("a.glb"), 1 << 26, &bytes, &error), TY_OK);
    uint8_t* at = memmem(bytes.data, bytes.size, &heap->transforms[2].y, 12);
    assert_non_null(at);
    memcpy(at, zero, 12);
    assert_refused(bytes.data, bytes.size, "instance 2: its matrix is singular");
    ty_bytes_term(&bytes);
    ty_aggregate_destroy(heap);
    ty_aggregate_destroy(back);
}

// A GLB of this JSON and a BIN chunk of 64 bytes: a triangle of the unit axes, three byte indices, zeros.
static size_t wrap_json(const char* json, uint8_t* file, size_t capacity)
{
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    size_t length = (strlen(json) + 3) & ~(size_t)3, size = 28 + length + 64;
    assert_true(size <= capacity);
    uint32_t words[5] = {0x46546c67u, 2, (uint32_t)size, (uint32_t)length, 0x4e4f534au}, bin[2] = {64, 0x004e4942u};
    memset(file, 0, size);
    memcpy(file, words, sizeof words);
    memset(file + 20, ' ', length);
    memcpy(file + 20, json, strlen(json));
    memcpy(file + 20 + length, bin, sizeof bin);
    memcpy(file + 28 + length, corners, sizeof corners);
    memcpy(file + 28 + length + 36, (uint8_t[3]){0, 1, 2}, 3);
    return size;
}

static void refuse_json(const char* json, const char* reason)
{
    uint8_t file[2048];
    assert_refused(file, wrap_json(json, file, sizeof file), reason);
}

#define HEAD "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":64}],"
#define VIEW                                                                                                           \
    HEAD "\"bufferViews\":[{\"buffer\":0,\"byteLength\":64},{\"buffer\":0,\"byteLength\":64,\"byteStride\":4}],"
#define TRIANGLE                                                                                                       \
    VIEW "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},{\"bufferView\":0,"   \
         "\"byteOffset\":36,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"},{\"bufferView\":0,"                \
         "\"componentType\":"                                                                                          \
         "5121,\"count\":64,\"type\":\"SCALAR\"},{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":"       \
         "\"VEC3\"}],"

// As other programs write: a tree of nodes, byte indices, no normals, a node that stands for one instance.
static void foreign_file(void** state)
{
    (void)state;
    static const char json[] = TRIANGLE
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1},{\"attributes\":{\"POSITION\":0}}"
        "]}],"
        "\"nodes\":[{\"mesh\":0,\"scale\":[2,2,2],\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{"
        "\"TRANSLATION\":3}}}},{\"children\":[2],\"translation\":[0,0,5]},{\"children\":[0,3],\"rotation\":"
        "[0,0,0.70710678,0.70710678]},{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,7,0,0,1]}]}";
    uint8_t file[2048];
    ty_error error = {0};
    ty_aggregate* back = NULL;
    size_t size = wrap_json(json, file, sizeof file);
    assert_int_equal(ty_file_write(in_folder("a.glb"), file, size, &error), TY_OK);
    ty_status status = ty_aggregate_read(in_folder("a.glb"), NULL, &back, &error);
    print_message("%s", status == TY_OK ? "" : error.text);
    assert_int_equal(status, TY_OK);
    assert_int_equal(back->instance_count, 3);
    assert_int_equal(back->prototypes[0]->vertex_count, 6);
    assert_int_equal(back->prototypes[0]->triangle_count, 2);
    assert_int_equal(back->prototypes[0]->triangles[1][2], 5);
    assert_true(back->prototypes[0]->normals[4].z > 0.999f);
    // The second instance: one along x, doubled, turned to y, five up z.
    assert_true(ty_length(ty_sub(back->transforms[1].t, (ty_vec3){0, 2, 5})) < 1e-5f);
    assert_true(ty_length(ty_sub(back->transforms[1].x, (ty_vec3){0, 2, 0})) < 1e-5f);
    assert_true(ty_length(ty_sub(back->transforms[2].t, (ty_vec3){0, 7, 5})) < 1e-5f);
    ty_aggregate_destroy(back);
}

static void small_files_with_large_claims(void** state)
{
    (void)state;
    refuse_json("{\"asset\":{\"version\":\"2.0\"}}", "no instances");
    refuse_json("{\"asset\":{\"version\":\"2.0\"},\"asset\":{}}", "duplicate");
    refuse_json("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":2147483647}]}", "buffers[0].byteLength");
    refuse_json("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":64,\"uri\":\"/etc/passwd\"}]}",
                "external");
    refuse_json("{\"asset\":{\"version\":\"2.0\"},\"images\":[{\"uri\":\"/etc/passwd\"}]}", "external images");
    refuse_json(HEAD "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":60,\"byteLength\":8}]}", "bufferViews[0]");
    refuse_json(HEAD
                "\"bufferViews\":[{\"buffer\":0,\"byteLength\":64}],\"accessors\":[{\"bufferView\":0,\"componentType\":"
                "5126,\"count\":2000000000,\"type\":\"VEC3\"}]}",
                "accessors[0]: 2000000000 elements do not fit");
    refuse_json(HEAD
                "\"bufferViews\":[{\"buffer\":0,\"byteLength\":64}],\"accessors\":[{\"bufferView\":0,\"componentType\":"
                "5126,\"count\":9223372036854775807,\"type\":\"VEC3\"}]}",
                "accessors[0].count");
    refuse_json(HEAD "\"nodes\":[{\"children\":[1]},{\"children\":[0]}]}", "nodes[0] is its own ancestor");
    refuse_json(HEAD "\"nodes\":[{\"children\":[1,1]},{}]}", "another parent");
    refuse_json(HEAD "\"nodes\":[{\"mesh\":0}]}", "nodes[0].mesh: the prototype is missing");
    refuse_json(VIEW "\"accessors\":[{\"bufferView\":0,\"byteOffset\":60,\"componentType\":5126,\"count\":1,\"type\":"
                     "\"VEC3\"}]}",
                "accessors[0]: 1 elements do not fit");
    refuse_json(VIEW "\"accessors\":[{\"bufferView\":1,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}]}",
                "overlap at a stride of 4");
    refuse_json(
        VIEW "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\",\"sparse\":{}}]}",
        "sparse");
    refuse_json(TRIANGLE "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2}]}]}",
                "64 corners are no whole number of triangles");
    refuse_json(TRIANGLE "\"meshes\":[{\"primitives\":[]}]}", "meshes[0] has no primitives");
    // Sharing must not multiply: 64 bytes cannot hold this many instances, or vertices.
    refuse_json(TRIANGLE "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0,"
                         "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"_A\":2}}}}]}",
                "instances, more than 64 bytes can hold");
#define P "{\"attributes\":{\"POSITION\":0}}"
    refuse_json(TRIANGLE "\"meshes\":[{\"primitives\":[" P "," P "," P "," P "," P "," P "," P "," P "]}]}",
                "24 vertices and 8 triangles, more than 64 bytes can hold");
#undef P
}

static void every_truncation_is_refused(void** state)
{
    (void)state;
    ty_bytes good = good_file();
    ty_error error;
    assert_int_equal(ty_aggregate_check("good", good.data, good.size, &error), TY_OK);
    for (size_t size = 0; size < good.size; size += size < 100 ? 1 : 37)
    {
        assert_int_equal(ty_aggregate_check("cut", good.data, size, &error), TY_BAD_FILE);
        assert_int_equal(ty_glb_check("cut", good.data, size, &error), TY_BAD_FILE);
    }
    ty_bytes_term(&good);
}

// --- points ---

static void points_as_instances(void** state)
{
    (void)state;
    static const char text[] =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "property float orient0\nproperty float orient1\nproperty float orient2\nproperty float orient3\n"
        "property float pscale\nproperty int id\nproperty float Moisture\nend_header\n"
        "1 2 3 0 0 0 1 2 40 0.25\n4 5 6 0 0 0.70710678 0.70710678 1 41 0.5\n";
    ty_error error;
    ty_aggregate* points = NULL;
    ty_mesh* sphere = make_sphere(4, 3);
    assert_int_equal(ty_file_write(in_folder("points.ply"), text, strlen(text), &error), TY_OK);
    assert_int_equal(ty_aggregate_read(in_folder("points.ply"), NULL, &points, &error), TY_BAD_INPUT);
    assert_int_equal(ty_aggregate_read(in_folder("points.ply"), sphere, &points, &error), TY_OK);
    assert_int_equal(points->instance_count, 2);
    assert_same_mesh(sphere, points->prototypes[0]);
    ty_affine first = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 2, 3}};
    assert_same_map(&first, &points->transforms[0]);
    // A quarter turn about z carries x to y.
    ty_vec3 turned = ty_map_vector(&points->transforms[1], (ty_vec3){1, 0, 0});
    assert_true(ty_length(ty_sub(turned, (ty_vec3){0, 1, 0})) < 1e-6f);
    assert_int_equal(points->ids[1], 41);
    assert_int_equal(points->attribute_count, 1);
    const ty_instance_attribute* moisture = ty_aggregate_find_attribute(points, "moisture");
    assert_non_null(moisture);
    assert_true(moisture->values[1] == 0.5f);
    ty_aggregate_destroy(points);
    ty_mesh_destroy(sphere);
}

static void damaged_points(void** state)
{
    (void)state;
    static const struct
    {
        const char *text, *reason;
    } cases[] = {
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
         "0 points"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n",
         "no x, y and z"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty "
         "float "
         "pscale\nend_header\n1 2 3 0\n",
         "instance 0"},
        {"ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nend_header\n1\n", ""},
        {"", ""},
    };
    ty_mesh* sphere = make_sphere(4, 3);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    {
        ty_error error = {0};
        ty_aggregate* none = NULL;
        assert_int_equal(ty_file_write(in_folder("points.ply"), cases[i].text, strlen(cases[i].text), &error), TY_OK);
        assert_int_equal(ty_aggregate_read(in_folder("points.ply"), sphere, &none, &error), TY_BAD_FILE);
        assert_non_null(strstr(error.text, cases[i].reason));
        assert_null(none);
    }
    ty_mesh_destroy(sphere);
}

// Every allocation that a file's size can make fail is refused cleanly.
static void memory_runs_out(void** state)
{
    (void)state;
    ty_bytes good = good_file();
    ty_bytes_term(&good);
    int failures = 0;
    for (long n = 0; n < 60; n++)
    {
        ty_error error = {0};
        ty_aggregate* back = NULL;
        ty_memory_fail_after(n);
        ty_status status = ty_aggregate_read(in_folder("a.glb"), NULL, &back, &error);
        ty_memory_fail_after(-1);
        assert_int_equal(back != NULL, status == TY_OK);
        failures += status != TY_OK;
        ty_aggregate_destroy(back);
    }
    assert_true(failures > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip),
        cmocka_unit_test(rewriting_is_stable),
        cmocka_unit_test(large_ids_and_single_prototype),
        cmocka_unit_test(rigid_stays_rigid),
        cmocka_unit_test(foreign_file),
        cmocka_unit_test(unwritable),
        cmocka_unit_test(damaged_containers),
        cmocka_unit_test(damaged_json),
        cmocka_unit_test(damaged_values),
        cmocka_unit_test(small_files_with_large_claims),
        cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(points_as_instances),
        cmocka_unit_test(damaged_points),
        cmocka_unit_test(memory_runs_out),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
