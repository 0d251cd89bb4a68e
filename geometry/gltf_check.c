// SPDX-License-Identifier: Apache-2.0
// A glTF file's JSON, checked against its bytes before an importer sees it: extensions, buffers, views, accessors.
#include "gltf_json.h"
#include <string.h>

// --- extensions ---

static const char* const known_extensions[] = {
    TY_GLTF_INSTANCING,           "KHR_lights_punctual",    "KHR_materials_emissive_strength",
    "KHR_materials_transmission", "KHR_materials_ior",      "KHR_materials_volume",
    "KHR_materials_clearcoat",    "KHR_materials_specular", "KHR_materials_anisotropy",
    "KHR_texture_transform",      "KHR_mesh_quantization",
};

bool ty_gltf_knows_extension(const char* name)
{
    for (size_t i = 0; i < sizeof known_extensions / sizeof known_extensions[0]; i++)
        if (strcmp(name, known_extensions[i]) == 0)
            return true;
    return false;
}

static ty_status check_asset(const ty_gltf_checker* c)
{
    const char* version = json_string_value(json_object_get(json_object_get(c->root, "asset"), "version"));
    if (!version || strncmp(version, "2.", 2) != 0)
        return TY_GLTF_FAIL(c, "asset.version is %.20s; glTF 2 is read", version ? version : "missing");
    const json_t *required, *used;
    ty_status status = ty_gltf_get_list(c, "extensionsRequired", &required);
    for (size_t i = 0; i < json_array_size(required) && status == TY_OK; i++)
    {
        const char* extension = json_string_value(json_array_get(required, i));
        if (!extension || !ty_gltf_knows_extension(extension))
            status = TY_GLTF_FAIL(c, "requires the extension %.80s, which is not read", extension ? extension : "?");
    }
    return status == TY_OK ? ty_gltf_get_list(c, "extensionsUsed", &used) : status;
}

// --- buffers and views ---

// An aggregate file is one file.
static ty_status check_aggregate_files(const ty_gltf_checker* c)
{
    const json_t *buffers = json_object_get(c->root, "buffers"), *images;
    ty_status status = ty_gltf_get_list(c, "images", &images);
    if (status != TY_OK)
        return status;
    for (size_t i = 0; i < json_array_size(buffers); i++)
        if (json_object_get(json_array_get(buffers, i), "uri"))
            return TY_GLTF_FAIL(c, "buffers[%zu]: external buffers are not read from aggregate files", i);
    for (size_t i = 0; i < json_array_size(images); i++)
        if (json_object_get(json_array_get(images, i), "uri"))
            return TY_GLTF_FAIL(c, "images[%zu]: external images are not read from aggregate files", i);
    return TY_OK;
}

static ty_status check_buffers(ty_gltf_checker* c)
{
    const json_t* buffers;
    ty_status status = ty_gltf_get_list(c, "buffers", &buffers);
    if (status == TY_OK && c->is_aggregate)
        status = check_aggregate_files(c);
    size_t count = json_array_size(buffers);
    for (size_t i = 0; i < count && status == TY_OK; i++)
    {
        int64_t length = 0;
        uint64_t size = i < c->buffer_count ? c->buffer_sizes[i] : 0;
        if (!ty_gltf_read_index(json_array_get(buffers, i), "byteLength", -2, size, &length) || length == 0)
            status = TY_GLTF_FAIL(c, "buffers[%zu].byteLength is missing or beyond the %llu bytes %s", i,
                                  (unsigned long long)size, i ? "that are there" : "of the BIN chunk or file");
        c->byte_count += (uint64_t)length;
    }
    return status;
}

typedef struct view
{
    int64_t offset, length, stride;
} view;

static ty_status check_view(const ty_gltf_checker* c, const json_t* object, size_t index, view* out)
{
    int64_t buffer;
    const json_t* buffers = json_object_get(c->root, "buffers");
    size_t count = json_array_size(buffers);
    if (count == 0 || !ty_gltf_read_index(object, "buffer", -2, count - 1, &buffer))
        return TY_GLTF_FAIL(c, "bufferViews[%zu].buffer names no buffer of this file", index);
    uint64_t size =
        (uint64_t)json_integer_value(json_object_get(json_array_get(buffers, (size_t)buffer), "byteLength"));
    if (!ty_gltf_read_index(object, "byteOffset", 0, size, &out->offset) ||
        !ty_gltf_read_index(object, "byteLength", -2, size - (uint64_t)out->offset, &out->length) || out->length == 0)
        return TY_GLTF_FAIL(c, "bufferViews[%zu]: byteOffset or byteLength is beyond the buffer's %llu bytes", index,
                            (unsigned long long)size);
    if (!ty_gltf_read_index(object, "byteStride", 0, 252, &out->stride) || out->stride % 4)
        return TY_GLTF_FAIL(c, "bufferViews[%zu].byteStride is none of 4, 8 ... 252", index);
    return TY_OK;
}

static ty_status check_views(const ty_gltf_checker* c)
{
    const json_t* views;
    ty_status status = ty_gltf_get_list(c, "bufferViews", &views);
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

// Elements of element bytes at byteOffset of object's bufferView, aligned to size and within it.
static ty_status check_elements(const ty_gltf_checker* c, const json_t* object, size_t index, int64_t size,
                                int64_t element, int64_t count, bool packed)
{
    const json_t* views = json_object_get(c->root, "bufferViews");
    int64_t offset, v;
    size_t view_count = json_array_size(views);
    if (view_count == 0 || !ty_gltf_read_index(object, "bufferView", -2, view_count - 1, &v))
        return TY_GLTF_FAIL(c, "accessors[%zu].bufferView names none of the %zu views", index, view_count);
    view on;
    ty_status status = check_view(c, json_array_get(views, (size_t)v), (size_t)v, &on);
    if (status != TY_OK)
        return status;
    int64_t stride = on.stride && !packed ? on.stride : element;
    if (stride < element)
        return TY_GLTF_FAIL(c, "accessors[%zu]: elements of %d bytes overlap at a stride of %d", index, (int)element,
                            (int)stride);
    if (!ty_gltf_read_index(object, "byteOffset", 0, (uint64_t)on.length, &offset) || offset + element > on.length ||
        (count - 1) > (on.length - offset - element) / stride)
        return TY_GLTF_FAIL(c, "accessors[%zu]: %lld elements do not fit into the %lld bytes of bufferViews[%lld]",
                            index, (long long)count, (long long)on.length, (long long)v);
    if ((on.offset + offset) % size)
        return TY_GLTF_FAIL(c, "accessors[%zu]: its values are not aligned", index);
    return TY_OK;
}

static ty_status check_sparse(const ty_gltf_checker* c, const json_t* sparse, size_t index, int64_t size,
                              int64_t element, int64_t of)
{
    int64_t count, component;
    const json_t *indices = json_object_get(sparse, "indices"), *values = json_object_get(sparse, "values");
    if (c->is_aggregate)
        return TY_GLTF_FAIL(c, "accessors[%zu]: sparse accessors are not read from aggregate files", index);
    if (!ty_gltf_read_index(sparse, "count", -2, (uint64_t)of, &count) || count == 0)
        return TY_GLTF_FAIL(c, "accessors[%zu].sparse.count is not within 1..%lld", index, (long long)of);
    if (!ty_gltf_read_index(indices, "componentType", -2, TY_GLTF_UNSIGNED_INT, &component) ||
        (component != TY_GLTF_UNSIGNED_BYTE && component != TY_GLTF_UNSIGNED_SHORT &&
         component != TY_GLTF_UNSIGNED_INT))
        return TY_GLTF_FAIL(c, "accessors[%zu].sparse.indices.componentType is no unsigned type", index);
    int64_t width = component_size(component);
    ty_status status = check_elements(c, indices, index, width, width, count, true);
    return status == TY_OK ? check_elements(c, values, index, size, element, count, true) : status;
}

static ty_status check_accessor(const ty_gltf_checker* c, const json_t* object, size_t index, ty_gltf_accessor* out)
{
    int64_t component, count;
    const json_t* sparse = json_object_get(object, "sparse");
    if (!ty_gltf_read_index(object, "componentType", -2, TY_GLTF_FLOAT, &component) || component_size(component) == 0)
        return TY_GLTF_FAIL(c, "accessors[%zu].componentType is none of glTF's", index);
    int components = type_components(json_string_value(json_object_get(object, "type")), &out->width);
    if (components == 0)
        return TY_GLTF_FAIL(c, "accessors[%zu].type is none of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4", index);
    if (!ty_gltf_read_index(object, "count", -2, UINT32_MAX - 1, &count) || count == 0)
        return TY_GLTF_FAIL(c, "accessors[%zu].count is not a positive number", index);
    int64_t size = component_size(component), element = size * components;
    ty_status status = TY_OK;
    if (sparse)
        status = check_sparse(c, sparse, index, size, element, count);
    // Without a view all is zero but for what is sparse: the sums of what meshes use bound that.
    if (status == TY_OK && (!sparse || json_object_get(object, "bufferView")))
        status = check_elements(c, object, index, size, element, count, false);
    out->component = (int)component;
    out->count = (uint32_t)count;
    out->normalized = json_is_true(json_object_get(object, "normalized"));
    return status;
}

static ty_status check_accessors(ty_gltf_checker* c)
{
    const json_t* list;
    ty_status status = ty_gltf_get_list(c, "accessors", &list);
    if (status != TY_OK)
        return status;
    c->accessor_count = json_array_size(list);
    c->accessors = TY_TRY_ALLOC(ty_gltf_accessor, c->accessor_count);
    if (!c->accessors)
        return ty_error_set(c->error, TY_NO_MEMORY, "no memory for %zu accessors", c->accessor_count);
    for (size_t i = 0; i < c->accessor_count && status == TY_OK; i++)
        status = check_accessor(c, json_array_get(list, i), i, &c->accessors[i]);
    return status;
}

ty_status ty_gltf_parse(const char* name, const char* json, size_t size, json_t** root, ty_error* error)
{
    json_error_t where;
    *root = json_loadb(json, size, JSON_REJECT_DUPLICATES, &where);
    if (!*root)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "JSON chunk, line %d, column %d: %s", where.line,
                               where.column, where.text);
    if (json_is_object(*root))
        return TY_OK;
    json_decref(*root);
    *root = NULL;
    return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "the JSON chunk is not an object");
}

ty_status ty_gltf_check(ty_gltf_checker* c)
{
    ty_status status = check_asset(c);
    if (status == TY_OK)
        status = check_buffers(c);
    if (status == TY_OK)
        status = check_views(c);
    if (status == TY_OK)
        status = check_accessors(c);
    if (status == TY_OK)
        status = ty_gltf_check_meshes(c);
    if (status == TY_OK)
        status = ty_gltf_check_nodes(c);
    ty_free(c->accessors);
    c->accessors = NULL;
    return status;
}
