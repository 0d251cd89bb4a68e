// SPDX-License-Identifier: Apache-2.0
// The JSON of a GLB file, checked against its bytes before an importer sees it.
#include "glb.h"
#include <string.h>
#include <tsuya/base/memory.h>

typedef struct accessor
{
    int component; // TY_GLTF_FLOAT ...
    int width;     // 1..4 for SCALAR..VEC4; 0 for matrices, which nothing here reads
    uint32_t count;
    bool normalized;
} accessor;

typedef struct checker
{
    const char* name;
    ty_error* error;
    const json_t* root;
    uint64_t bin_size;
    uint64_t buffer_size;
    accessor* accessors;
    size_t accessor_count;
    // What the whole file expands to: shared accessors must not multiply it out of proportion to the file.
    uint64_t vertices, triangles, instances;
} checker;

#define FAIL(c, ...) ty_error_set_at((c)->error, TY_BAD_FILE, (c)->name, 0, 0, __VA_ARGS__)

// --- fields ---

// An integer in 0..maximum; absent = fallback, which may be negative (must be given: -2).
static bool read_index(const json_t* object, const char* key, int64_t fallback, uint64_t maximum, int64_t* out)
{
    const json_t* value = json_object_get(object, key);
    if (!value)
    {
        *out = fallback;
        return fallback != -2;
    }
    if (!json_is_integer(value) || json_integer_value(value) < 0 || (uint64_t)json_integer_value(value) > maximum)
        return false;
    *out = json_integer_value(value);
    return true;
}

// The array named key in root: NULL is an empty one.
static ty_status get_list(const checker* c, const char* key, const json_t** out)
{
    *out = json_object_get(c->root, key);
    if (*out && !json_is_array(*out))
        return FAIL(c, "\"%s\" is not an array", key);
    return TY_OK;
}

static ty_status check_numbers(const checker* c, const json_t* object, const char* key, size_t count, size_t index)
{
    const json_t* list = json_object_get(object, key);
    if (!list)
        return TY_OK;
    if (json_array_size(list) != count)
        return FAIL(c, "nodes[%zu].%s: expected %zu numbers", index, key, count);
    for (size_t i = 0; i < count; i++)
        if (!json_is_number(json_array_get(list, i)))
            return FAIL(c, "nodes[%zu].%s[%zu] is not a number", index, key, i);
    return TY_OK;
}

// --- asset, buffers, views ---

static ty_status check_asset(const checker* c)
{
    const char* version = json_string_value(json_object_get(json_object_get(c->root, "asset"), "version"));
    if (!version || strncmp(version, "2.", 2) != 0)
        return FAIL(c, "asset.version is %s; glTF 2 is read", version ? version : "missing");
    const json_t* required;
    ty_status status = get_list(c, "extensionsRequired", &required);
    for (size_t i = 0; i < json_array_size(required) && status == TY_OK; i++)
    {
        const char* extension = json_string_value(json_array_get(required, i));
        if (!extension || strcmp(extension, TY_GLTF_INSTANCING) != 0)
            status = FAIL(c, "requires the extension %s, which is not read", extension ? extension : "?");
    }
    return status;
}

static ty_status check_buffers(checker* c)
{
    const json_t *buffers, *images;
    ty_status status = get_list(c, "buffers", &buffers);
    if (status == TY_OK)
        status = get_list(c, "images", &images);
    if (status != TY_OK)
        return status;
    size_t count = json_array_size(buffers);
    for (size_t i = 0; i < count; i++)
        if (json_object_get(json_array_get(buffers, i), "uri"))
            return FAIL(c, "buffers[%zu]: external buffers are not read from aggregate files", i);
    for (size_t i = 0; i < json_array_size(images); i++)
        if (json_object_get(json_array_get(images, i), "uri"))
            return FAIL(c, "images[%zu]: external images are not read from aggregate files", i);
    if (count > 1)
        return FAIL(c, "%zu buffers; a GLB file holds one", count);
    int64_t length = 0;
    if (count && (!read_index(json_array_get(buffers, 0), "byteLength", -2, c->bin_size, &length) || length == 0))
        return FAIL(c, "buffers[0].byteLength is missing or beyond the %llu bytes of the BIN chunk",
                    (unsigned long long)c->bin_size);
    c->buffer_size = (uint64_t)length;
    return TY_OK;
}

typedef struct view
{
    int64_t offset, length, stride;
} view;

static ty_status check_view(const checker* c, const json_t* object, size_t index, view* out)
{
    int64_t buffer;
    if (!read_index(object, "buffer", -2, 0, &buffer) || c->buffer_size == 0)
        return FAIL(c, "bufferViews[%zu].buffer names no buffer of this file", index);
    if (!read_index(object, "byteOffset", 0, c->buffer_size, &out->offset) ||
        !read_index(object, "byteLength", -2, c->buffer_size - (uint64_t)out->offset, &out->length) || out->length == 0)
        return FAIL(c, "bufferViews[%zu]: byteOffset or byteLength is beyond the buffer's %llu bytes", index,
                    (unsigned long long)c->buffer_size);
    if (!read_index(object, "byteStride", 0, 252, &out->stride) || out->stride % 4)
        return FAIL(c, "bufferViews[%zu].byteStride is none of 4, 8 ... 252", index);
    return TY_OK;
}

static ty_status check_views(const checker* c)
{
    const json_t* views;
    ty_status status = get_list(c, "bufferViews", &views);
    view ignored;
    for (size_t i = 0; i < json_array_size(views) && status == TY_OK; i++)
        status = check_view(c, json_array_get(views, i), i, &ignored);
    return status;
}

// --- accessors ---

static int component_size(int64_t component)
{
    switch (component)
    {
    case TY_GLTF_BYTE:
    case TY_GLTF_UNSIGNED_BYTE:
        return 1;
    case TY_GLTF_SHORT:
    case TY_GLTF_UNSIGNED_SHORT:
        return 2;
    case TY_GLTF_UNSIGNED_INT:
    case TY_GLTF_FLOAT:
        return 4;
    default:
        return 0;
    }
}

// Components of a type, and its width as in struct accessor. Matrices of bytes and shorts pad their columns; the count
// given for them here is the padded one.
static int type_components(const char* type, int* width)
{
    static const struct
    {
        const char* name;
        int components, width;
    } types[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 2},  {"VEC3", 3, 3}, {"VEC4", 4, 4},
                 {"MAT2", 8, 0},   {"MAT3", 12, 0}, {"MAT4", 16, 0}};
    for (size_t i = 0; type && i < sizeof types / sizeof types[0]; i++)
        if (strcmp(type, types[i].name) == 0)
        {
            *width = types[i].width;
            return types[i].components;
        }
    return 0;
}

static ty_status check_accessor(const checker* c, const json_t* object, size_t index, accessor* out)
{
    const json_t* views = json_object_get(c->root, "bufferViews");
    int64_t component, count, offset, v;
    if (json_object_get(object, "sparse"))
        return FAIL(c, "accessors[%zu]: sparse accessors are not read", index);
    if (!read_index(object, "componentType", -2, TY_GLTF_FLOAT, &component) || component_size(component) == 0)
        return FAIL(c, "accessors[%zu].componentType is none of glTF's", index);
    int components = type_components(json_string_value(json_object_get(object, "type")), &out->width);
    if (components == 0)
        return FAIL(c, "accessors[%zu].type is none of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4", index);
    size_t view_count = json_array_size(views);
    if (view_count == 0 || !read_index(object, "bufferView", -2, view_count - 1, &v))
        return FAIL(c, "accessors[%zu].bufferView names none of the %zu views", index, view_count);
    if (!read_index(object, "count", -2, UINT32_MAX - 1, &count) || count == 0)
        return FAIL(c, "accessors[%zu].count is not a positive number", index);
    view on;
    ty_status status = check_view(c, json_array_get(views, (size_t)v), (size_t)v, &on);
    if (status != TY_OK)
        return status;
    int64_t element = (int64_t)component_size(component) * components;
    int64_t stride = on.stride ? on.stride : element;
    if (stride < element)
        return FAIL(c, "accessors[%zu]: elements of %d bytes overlap at a stride of %d", index, (int)element,
                    (int)stride);
    if (!read_index(object, "byteOffset", 0, (uint64_t)on.length, &offset) || offset + element > on.length ||
        (count - 1) > (on.length - offset - element) / stride)
        return FAIL(c, "accessors[%zu]: %lld elements do not fit into the %lld bytes of bufferViews[%lld]", index,
                    (long long)count, (long long)on.length, (long long)v);
    if ((on.offset + offset) % component_size(component))
        return FAIL(c, "accessors[%zu]: its values are not aligned", index);
    out->component = (int)component;
    out->count = (uint32_t)count;
    out->normalized = json_is_true(json_object_get(object, "normalized"));
    return TY_OK;
}

static ty_status check_accessors(checker* c)
{
    const json_t* list;
    ty_status status = get_list(c, "accessors", &list);
    if (status != TY_OK)
        return status;
    c->accessor_count = json_array_size(list);
    c->accessors = TY_TRY_ALLOC(accessor, c->accessor_count);
    if (!c->accessors)
        return ty_error_set(c->error, TY_NO_MEMORY, "no memory for %zu accessors", c->accessor_count);
    for (size_t i = 0; i < c->accessor_count && status == TY_OK; i++)
        status = check_accessor(c, json_array_get(list, i), i, &c->accessors[i]);
    return status;
}

// --- meshes ---

static const accessor* get_accessor(const checker* c, const json_t* index)
{
    if (!json_is_integer(index) || json_integer_value(index) < 0 ||
        (size_t)json_integer_value(index) >= c->accessor_count)
        return NULL;
    return &c->accessors[json_integer_value(index)];
}

// Width that a vertex attribute must have: 0 = any, -1 = it is not read.
static int vertex_width(const char* semantic)
{
    if (strcmp(semantic, "POSITION") == 0 || strcmp(semantic, "NORMAL") == 0)
        return 3;
    if (strcmp(semantic, "TEXCOORD_0") == 0)
        return 2;
    return semantic[0] == '_' ? 0 : -1;
}

static ty_status check_indices(checker* c, const json_t* primitive, size_t mesh, size_t index, uint32_t vertices)
{
    const json_t* indices = json_object_get(primitive, "indices");
    uint32_t count = vertices;
    if (indices)
    {
        const accessor* a = get_accessor(c, indices);
        if (!a || a->width != 1 || a->component == TY_GLTF_FLOAT || a->component == TY_GLTF_BYTE ||
            a->component == TY_GLTF_SHORT)
            return FAIL(c, "meshes[%zu].primitives[%zu].indices is no accessor of unsigned numbers", mesh, index);
        count = a->count;
    }
    if (count % 3)
        return FAIL(c, "meshes[%zu].primitives[%zu]: %u corners are no whole number of triangles", mesh, index, count);
    c->triangles += count / 3;
    return TY_OK;
}

static ty_status check_primitive(checker* c, const json_t* primitive, size_t mesh, size_t index)
{
    int64_t mode;
    if (!read_index(primitive, "mode", 4, 6, &mode) || mode != 4)
        return FAIL(c, "meshes[%zu].primitives[%zu].mode: only triangles (4) are read", mesh, index);
    json_t* attributes = json_object_get(primitive, "attributes");
    const accessor* position = get_accessor(c, json_object_get(attributes, "POSITION"));
    if (!position)
        return FAIL(c, "meshes[%zu].primitives[%zu] has no POSITION", mesh, index);
    const char* semantic;
    json_t* value;
    json_object_foreach(attributes, semantic, value)
    {
        const accessor* a = get_accessor(c, value);
        int width = vertex_width(semantic);
        if (!a || a->count != position->count)
            return FAIL(c, "meshes[%zu].primitives[%zu].%s: no accessor of %u elements", mesh, index, semantic,
                        position->count);
        if (width >= 0 && (a->component != TY_GLTF_FLOAT || a->width == 0 || (width && a->width != width)))
            return FAIL(c, "meshes[%zu].primitives[%zu].%s: its accessor has the wrong type", mesh, index, semantic);
        if (semantic[0] == '_' && strlen(semantic) > 32)
            return FAIL(c, "meshes[%zu].primitives[%zu].%.40s: the name is longer than 32", mesh, index, semantic);
    }
    c->vertices += position->count;
    return check_indices(c, primitive, mesh, index, position->count);
}

static ty_status check_meshes(checker* c)
{
    const json_t* meshes;
    ty_status status = get_list(c, "meshes", &meshes);
    for (size_t m = 0; m < json_array_size(meshes) && status == TY_OK; m++)
    {
        const json_t* primitives = json_object_get(json_array_get(meshes, m), "primitives");
        if (json_array_size(primitives) == 0)
            return FAIL(c, "meshes[%zu] has no primitives", m);
        for (size_t p = 0; p < json_array_size(primitives) && status == TY_OK; p++)
            status = check_primitive(c, json_array_get(primitives, p), m, p);
    }
    if (status == TY_OK && (c->vertices > c->bin_size / 3 || c->triangles > c->bin_size))
        return FAIL(c, "the meshes claim %llu vertices and %llu triangles, more than %llu bytes can hold",
                    (unsigned long long)c->vertices, (unsigned long long)c->triangles, (unsigned long long)c->bin_size);
    return status;
}

// --- nodes ---

static bool instance_type_fits(const char* semantic, const accessor* a)
{
    bool real = a->component == TY_GLTF_FLOAT;
    bool packed = a->normalized && (a->component == TY_GLTF_BYTE || a->component == TY_GLTF_SHORT);
    bool whole = !a->normalized && (a->component == TY_GLTF_UNSIGNED_BYTE || a->component == TY_GLTF_UNSIGNED_SHORT ||
                                    a->component == TY_GLTF_UNSIGNED_INT);
    if (strcmp(semantic, "TRANSLATION") == 0 || strcmp(semantic, "SCALE") == 0 || strncmp(semantic, "_MATRIX", 7) == 0)
        return real && a->width == 3;
    if (strcmp(semantic, "ROTATION") == 0)
        return (real || packed) && a->width == 4;
    // Vectors under other names belong to other programs and are left out by the reader.
    return a->width != 1 || real || whole;
}

static ty_status check_instances(checker* c, const json_t* node, size_t index)
{
    json_t* extension = json_object_get(json_object_get(node, "extensions"), TY_GLTF_INSTANCING);
    if (!extension)
    {
        c->instances += json_object_get(node, "mesh") != NULL;
        return TY_OK;
    }
    if (!json_object_get(node, "mesh"))
        return FAIL(c, "nodes[%zu] places instances, but names no mesh", index);
    json_t* attributes = json_object_get(extension, "attributes");
    const char* semantic;
    json_t* value;
    uint32_t count = 0;
    json_object_foreach(attributes, semantic, value)
    {
        const accessor* a = get_accessor(c, value);
        if (!a || !instance_type_fits(semantic, a))
            return FAIL(c, "nodes[%zu].%s: its accessor is missing or has the wrong type", index, semantic);
        if (count && a->count != count)
            return FAIL(c, "nodes[%zu].%s has %u elements, others have %u", index, semantic, a->count, count);
        if (semantic[0] == '_' && strlen(semantic) > 32)
            return FAIL(c, "nodes[%zu].%.40s: the name is longer than 32", index, semantic);
        count = a->count;
    }
    if (count == 0)
        return FAIL(c, "nodes[%zu] has no instances", index);
    c->instances += count;
    return TY_OK;
}

static ty_status check_node(checker* c, const json_t* node, size_t index, size_t mesh_count)
{
    int64_t mesh;
    if (!json_is_object(node))
        return FAIL(c, "nodes[%zu] is not an object", index);
    if (json_object_get(node, "mesh") && (mesh_count == 0 || !read_index(node, "mesh", -2, mesh_count - 1, &mesh)))
        return FAIL(c, "nodes[%zu].mesh: the prototype is missing (the file has %zu meshes)", index, mesh_count);
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
static ty_status check_trees(const checker* c, const json_t* nodes, size_t count, uint32_t* parent)
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
                return FAIL(c, "nodes[%zu].children[%zu] is no node", i, k);
            if (parent[json_integer_value(child)] != UINT32_MAX)
                return FAIL(c, "nodes[%zu].children[%zu] has another parent", i, k);
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
            return FAIL(c, "nodes[%zu] is its own ancestor", i);
        for (uint32_t walk = (uint32_t)i; walk != at;)
        {
            uint32_t next = parent[walk];
            parent[walk] = UINT32_MAX;
            walk = next;
        }
    }
    return TY_OK;
}

static ty_status check_nodes(checker* c)
{
    const json_t *nodes, *meshes = json_object_get(c->root, "meshes");
    ty_status status = get_list(c, "nodes", &nodes);
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
    if (status == TY_OK && c->instances == 0)
        return FAIL(c, "no instances: no node places a mesh");
    if (status == TY_OK && c->instances > c->bin_size / 4 + count)
        return FAIL(c, "the nodes claim %llu instances, more than %llu bytes can hold",
                    (unsigned long long)c->instances, (unsigned long long)c->bin_size);
    return status;
}

ty_status ty_gltf_check(const char* name, const ty_glb* glb, json_t** root, ty_error* error)
{
    json_error_t where;
    *root = json_loadb(glb->json, glb->json_size, JSON_REJECT_DUPLICATES, &where);
    if (!*root)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "JSON chunk, line %d, column %d: %s", where.line,
                               where.column, where.text);
    checker c = {.name = name, .error = error, .root = *root, .bin_size = glb->bin_size};
    ty_status status = json_is_object(*root) ? check_asset(&c) : FAIL(&c, "the JSON chunk is not an object");
    if (status == TY_OK)
        status = check_buffers(&c);
    if (status == TY_OK)
        status = check_views(&c);
    if (status == TY_OK)
        status = check_accessors(&c);
    if (status == TY_OK)
        status = check_meshes(&c);
    if (status == TY_OK)
        status = check_nodes(&c);
    ty_free(c.accessors);
    if (status != TY_OK)
    {
        json_decref(*root);
        *root = NULL;
    }
    return status;
}
