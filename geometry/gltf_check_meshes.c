// SPDX-License-Identifier: Apache-2.0
// Meshes of a glTF file: every accessor has the type and length that its use asks for.
#include "gltf_json.h"
#include <string.h>

// What a vertex attribute is made of.
typedef struct semantic_rule
{
    const char* name;
    int width_low, width_high;
    bool quantized; // normalised integers, or any of KHR_mesh_quantization
} semantic_rule;

static const semantic_rule rules[] = {
    {"POSITION", 3, 3, true},   {"NORMAL", 3, 3, true},  {"TEXCOORD_0", 2, 2, true},
    {"TEXCOORD_1", 2, 2, true}, {"COLOR_0", 3, 4, true},
};

static bool semantic_fits(const ty_gltf_checker* c, const char* semantic, const ty_gltf_accessor* a)
{
    if (semantic[0] == '_')
        return a->width != 0 && (a->component == TY_GLTF_FLOAT || !c->is_aggregate);
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++)
        if (strcmp(semantic, rules[i].name) == 0)
            return a->width >= rules[i].width_low && a->width <= rules[i].width_high &&
                   (a->component == TY_GLTF_FLOAT || (rules[i].quantized && !c->is_aggregate));
    return true; // not read
}

// The number of triangles of a primitive from its corners.
static bool count_triangles(int64_t mode, uint32_t corners, uint64_t* triangles)
{
    if (mode == TY_GLTF_TRIANGLES && corners % 3 == 0)
        *triangles = corners / 3;
    else if (mode > TY_GLTF_TRIANGLES && corners >= 3)
        *triangles = corners - 2;
    else
        return false;
    return true;
}

static ty_status check_indices(ty_gltf_checker* c, const json_t* primitive, size_t mesh, size_t index, int64_t mode,
                               uint32_t vertices)
{
    const json_t* indices = json_object_get(primitive, "indices");
    uint32_t count = vertices;
    uint64_t triangles;
    if (indices)
    {
        const ty_gltf_accessor* a = ty_gltf_get_accessor(c, indices);
        if (!a || a->width != 1 || a->component == TY_GLTF_FLOAT || a->component == TY_GLTF_BYTE ||
            a->component == TY_GLTF_SHORT || a->normalized)
            return TY_GLTF_FAIL(c, "meshes[%zu].primitives[%zu].indices is no accessor of unsigned numbers", mesh,
                                index);
        count = a->count;
    }
    if (!count_triangles(mode, count, &triangles))
        return TY_GLTF_FAIL(c, "meshes[%zu].primitives[%zu]: %u corners are no whole number of triangles", mesh, index,
                            count);
    c->triangles += triangles;
    return TY_OK;
}

static ty_status check_attributes(const ty_gltf_checker* c, json_t* attributes, size_t mesh, size_t index,
                                  uint32_t count)
{
    const char* semantic;
    json_t* value;
    json_object_foreach(attributes, semantic, value)
    {
        const ty_gltf_accessor* a = ty_gltf_get_accessor(c, value);
        if (!a || a->count != count)
            return TY_GLTF_FAIL(c, "meshes[%zu].primitives[%zu].%.40s: no accessor of %u elements", mesh, index,
                                semantic, count);
        if (!semantic_fits(c, semantic, a))
            return TY_GLTF_FAIL(c, "meshes[%zu].primitives[%zu].%.40s: its accessor has the wrong type", mesh, index,
                                semantic);
        if (semantic[0] == '_' && strlen(semantic) > 32)
            return TY_GLTF_FAIL(c, "meshes[%zu].primitives[%zu].%.40s: the name is longer than 32", mesh, index,
                                semantic);
    }
    return TY_OK;
}

static ty_status check_primitive(ty_gltf_checker* c, const json_t* primitive, size_t mesh, size_t index)
{
    int64_t mode, material;
    size_t materials = json_array_size(json_object_get(c->root, "materials"));
    if (!ty_gltf_read_index(primitive, "mode", TY_GLTF_TRIANGLES, TY_GLTF_FAN, &mode))
        return TY_GLTF_FAIL(c, "meshes[%zu].primitives[%zu].mode is not within 0..6", mesh, index);
    if (c->is_aggregate && mode != TY_GLTF_TRIANGLES)
        return TY_GLTF_FAIL(c, "meshes[%zu].primitives[%zu].mode: only triangles (4) are read", mesh, index);
    if (mode < TY_GLTF_TRIANGLES)
        return TY_OK; // points and lines are left out
    if (!c->is_aggregate && (!ty_gltf_read_index(primitive, "material", -1, INT32_MAX, &material) ||
                             (material >= 0 && (uint64_t)material >= materials)))
        return TY_GLTF_FAIL(c, "meshes[%zu].primitives[%zu].material is none of the %zu materials", mesh, index,
                            materials);
    json_t* attributes = json_object_get(primitive, "attributes");
    const ty_gltf_accessor* position = ty_gltf_get_accessor(c, json_object_get(attributes, "POSITION"));
    if (!position)
        return TY_GLTF_FAIL(c, "meshes[%zu].primitives[%zu] has no POSITION", mesh, index);
    ty_status status = check_attributes(c, attributes, mesh, index, position->count);
    c->vertices += position->count;
    return status == TY_OK ? check_indices(c, primitive, mesh, index, mode, position->count) : status;
}

// Triangles that share vertices are what files are made of; primitives read only the vertices that they use. Whole
// meshes are shared too, by primitives of other materials. Those of an aggregate are all kept.
static bool is_in_proportion(const ty_gltf_checker* c)
{
    if (c->is_aggregate)
        return c->triangles <= c->byte_count && c->vertices <= c->byte_count / 3;
    return c->triangles / 8 <= c->byte_count;
}

ty_status ty_gltf_check_meshes(ty_gltf_checker* c)
{
    const json_t* meshes;
    ty_status status = ty_gltf_get_list(c, "meshes", &meshes);
    for (size_t m = 0; m < json_array_size(meshes) && status == TY_OK; m++)
    {
        const json_t* primitives = json_object_get(json_array_get(meshes, m), "primitives");
        if (json_array_size(primitives) == 0)
            return TY_GLTF_FAIL(c, "meshes[%zu] has no primitives", m);
        for (size_t p = 0; p < json_array_size(primitives) && status == TY_OK; p++)
            status = check_primitive(c, json_array_get(primitives, p), m, p);
    }
    if (status == TY_OK && !is_in_proportion(c))
        return TY_GLTF_FAIL(c, "the meshes claim %llu vertices and %llu triangles, more than %llu bytes can hold",
                            (unsigned long long)c->vertices, (unsigned long long)c->triangles,
                            (unsigned long long)c->byte_count);
    return status;
}
