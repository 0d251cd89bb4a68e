// SPDX-License-Identifier: Apache-2.0
// Nodes of a glTF file: what they name is there, they form trees, and their instances have room in the file.
#include "gltf_json.h"
#include <float.h>
#include <math.h>
#include <string.h>

static ty_status check_numbers(const ty_gltf_checker* c, const json_t* object, const char* key, size_t count,
                               size_t index)
{
    const json_t* list = json_object_get(object, key);
    if (!list)
        return TY_OK;
    if (json_array_size(list) != count)
        return TY_GLTF_FAIL(c, "nodes[%zu].%s: expected %zu numbers", index, key, count);
    for (size_t i = 0; i < count; i++)
        if (!json_is_number(json_array_get(list, i)) ||
            !(fabs(json_number_value(json_array_get(list, i))) <= (double)FLT_MAX))
            return TY_GLTF_FAIL(c, "nodes[%zu].%s[%zu] is not a finite number", index, key, i);
    return TY_OK;
}

static bool instance_type_fits(const char* semantic, const ty_gltf_accessor* a)
{
    bool real = a->component == TY_GLTF_FLOAT;
    bool packed = a->normalized && (a->component == TY_GLTF_BYTE || a->component == TY_GLTF_SHORT);
    bool whole = !a->normalized && (a->component == TY_GLTF_UNSIGNED_BYTE || a->component == TY_GLTF_UNSIGNED_SHORT ||
                                    a->component == TY_GLTF_UNSIGNED_INT);
    if (strcmp(semantic, "TRANSLATION") == 0 || strcmp(semantic, "SCALE") == 0 || strncmp(semantic, "_MATRIX", 7) == 0)
        return real && a->width == 3;
    if (strcmp(semantic, "ROTATION") == 0)
        return (real || packed) && a->width == 4;
    if (strcmp(semantic, "_VELOCITY") == 0 || strcmp(semantic, "_SPIN") == 0)
        return real || a->width != 3;
    // Vectors under other names belong to other programs and are left out by the reader.
    return a->width != 1 || real || whole;
}

static ty_status check_instances(ty_gltf_checker* c, const json_t* node, size_t index)
{
    json_t* extension = json_object_get(json_object_get(node, "extensions"), TY_GLTF_INSTANCING);
    if (!extension)
    {
        c->instances += json_object_get(node, "mesh") != NULL;
        return TY_OK;
    }
    if (!json_object_get(node, "mesh"))
        return TY_GLTF_FAIL(c, "nodes[%zu] places instances, but names no mesh", index);
    json_t* attributes = json_object_get(extension, "attributes");
    const char* semantic;
    json_t* value;
    uint32_t count = 0;
    json_object_foreach(attributes, semantic, value)
    {
        const ty_gltf_accessor* a = ty_gltf_get_accessor(c, value);
        if (!a || !instance_type_fits(semantic, a))
            return TY_GLTF_FAIL(c, "nodes[%zu].%s: its accessor is missing or has the wrong type", index, semantic);
        if (count && a->count != count)
            return TY_GLTF_FAIL(c, "nodes[%zu].%s has %u elements, others have %u", index, semantic, a->count, count);
        if (semantic[0] == '_' && strlen(semantic) > 32)
            return TY_GLTF_FAIL(c, "nodes[%zu].%.40s: the name is longer than 32", index, semantic);
        count = a->count;
    }
    if (count == 0)
        return TY_GLTF_FAIL(c, "nodes[%zu] has no instances", index);
    c->instances += count;
    return TY_OK;
}

static ty_status check_node(ty_gltf_checker* c, const json_t* node, size_t index, size_t mesh_count)
{
    int64_t mesh;
    if (!json_is_object(node))
        return TY_GLTF_FAIL(c, "nodes[%zu] is not an object", index);
    if (json_object_get(node, "mesh") &&
        (mesh_count == 0 || !ty_gltf_read_index(node, "mesh", -2, mesh_count - 1, &mesh)))
        return TY_GLTF_FAIL(c, "nodes[%zu].mesh: the prototype is missing (the file has %zu meshes)", index,
                            mesh_count);
    ty_status status = check_numbers(c, node, "matrix", 16, index);
    if (status == TY_OK)
        status = check_numbers(c, node, "translation", 3, index);
    if (status == TY_OK)
        status = check_numbers(c, node, "rotation", 4, index);
    if (status == TY_OK)
        status = check_numbers(c, node, "scale", 3, index);
    return status == TY_OK ? check_instances(c, node, index) : status;
}

// Every node has one parent at most, and following parents ends: nodes form trees.
static ty_status check_trees(const ty_gltf_checker* c, const json_t* nodes, size_t count, uint32_t* parent)
{
    for (size_t i = 0; i < count; i++)
        parent[i] = UINT32_MAX;
    for (size_t i = 0; i < count; i++)
    {
        const json_t* children = json_object_get(json_array_get(nodes, i), "children");
        for (size_t k = 0; k < json_array_size(children); k++)
        {
            const json_t* child = json_array_get(children, k);
            if (!json_is_integer(child) || json_integer_value(child) < 0 || (size_t)json_integer_value(child) >= count)
                return TY_GLTF_FAIL(c, "nodes[%zu].children[%zu] is no node", i, k);
            if (parent[json_integer_value(child)] != UINT32_MAX)
                return TY_GLTF_FAIL(c, "nodes[%zu].children[%zu] has another parent", i, k);
            parent[json_integer_value(child)] = (uint32_t)i;
        }
    }
    // A walk over k parents marks its path as done, so all walks together take one pass.
    for (size_t i = 0; i < count; i++)
    {
        size_t steps = 0;
        uint32_t at = (uint32_t)i;
        while (parent[at] != UINT32_MAX && steps++ <= count)
            at = parent[at];
        if (steps > count)
            return TY_GLTF_FAIL(c, "nodes[%zu] is its own ancestor", i);
        for (uint32_t walk = (uint32_t)i; walk != at;)
        {
            uint32_t next = parent[walk];
            parent[walk] = UINT32_MAX;
            walk = next;
        }
    }
    return TY_OK;
}

ty_status ty_gltf_check_nodes(ty_gltf_checker* c)
{
    const json_t *nodes, *meshes = json_object_get(c->root, "meshes");
    ty_status status = ty_gltf_get_list(c, "nodes", &nodes);
    size_t count = json_array_size(nodes);
    for (size_t i = 0; i < count && status == TY_OK; i++)
        status = check_node(c, json_array_get(nodes, i), i, json_array_size(meshes));
    if (status != TY_OK)
        return status;
    uint32_t* parent = TY_TRY_ALLOC(uint32_t, count);
    if (!parent)
        return ty_error_set(c->error, TY_NO_MEMORY, "no memory for %zu nodes", count);
    status = check_trees(c, nodes, count, parent);
    ty_free(parent);
    if (status == TY_OK && c->is_aggregate && c->instances == 0)
        return TY_GLTF_FAIL(c, "no instances: no node places a mesh");
    if (status == TY_OK && c->instances > c->byte_count / 4 + count)
        return TY_GLTF_FAIL(c, "the nodes claim %llu instances, more than %llu bytes can hold",
                            (unsigned long long)c->instances, (unsigned long long)c->byte_count);
    return status;
}
