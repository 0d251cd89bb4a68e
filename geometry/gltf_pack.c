// SPDX-License-Identifier: Apache-2.0
// What the importer gets to see: one GLB of the checked buffers with the meshes and instances alone. No name, image or
// path of the file reaches it.
#include "gltf_pack.h"
#include "glb_build.h"
#include <string.h>

// Members of object named in keys.
static json_t* pick(const json_t* object, const char* const* keys)
{
    json_t* out = json_object();
    for (int i = 0; keys[i]; i++)
    {
        json_t* value = json_object_get(object, keys[i]);
        if (value)
            json_object_set(out, keys[i], value);
    }
    return out;
}

static json_t* pack_views(const ty_gltf_source* source, const size_t* begins)
{
    json_t* out = json_array();
    const json_t* views = json_object_get(source->root, "bufferViews");
    static const char* const keys[] = {"byteLength", "byteStride", NULL};
    for (size_t i = 0; i < json_array_size(views); i++)
    {
        const json_t* view = json_array_get(views, i);
        json_t* packed = pick(view, keys);
        size_t begin = begins[json_integer_value(json_object_get(view, "buffer"))];
        size_t offset = begin + (size_t)json_integer_value(json_object_get(view, "byteOffset"));
        json_object_set_new(packed, "buffer", json_integer(0));
        json_object_set_new(packed, "byteOffset", json_integer((json_int_t)offset));
        json_array_append_new(out, packed);
    }
    return out;
}

static json_t* pack_accessors(const json_t* root)
{
    static const char* const keys[] = {"bufferView", "byteOffset", "componentType", "count",
                                       "type",       "normalized", "sparse",        NULL};
    json_t* out = json_array();
    const json_t* list = json_object_get(root, "accessors");
    for (size_t i = 0; i < json_array_size(list); i++)
        json_array_append_new(out, pick(json_array_get(list, i), keys));
    return out;
}

static json_t* pack_meshes(const json_t* root)
{
    static const char* const keys[] = {"attributes", "indices", "material", "mode", NULL};
    json_t* out = json_array();
    const json_t* list = json_object_get(root, "meshes");
    for (size_t i = 0; i < json_array_size(list); i++)
    {
        const json_t* primitives = json_object_get(json_array_get(list, i), "primitives");
        json_t* packed = json_array();
        for (size_t k = 0; k < json_array_size(primitives); k++)
            json_array_append_new(packed, pick(json_array_get(primitives, k), keys));
        json_array_append_new(out, json_pack("{s:o}", "primitives", packed));
    }
    return out;
}

static json_t* pack_nodes(const json_t* root)
{
    json_t* out = json_array();
    const json_t* list = json_object_get(root, "nodes");
    for (size_t i = 0; i < json_array_size(list); i++)
    {
        const json_t* node = json_array_get(list, i);
        json_t *packed = json_object(), *mesh = json_object_get(node, "mesh");
        const json_t* instancing = ty_gltf_extension(node, TY_GLTF_INSTANCING);
        if (mesh && instancing)
        {
            json_object_set(packed, "mesh", mesh);
            json_object_set_new(
                packed, "extensions",
                json_pack("{s:{s:O}}", TY_GLTF_INSTANCING, "attributes", json_object_get(instancing, "attributes")));
        }
        json_array_append_new(out, packed);
    }
    return out;
}

static void put_u32(uint8_t* at, size_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> (8 * i));
}

// Around text, with room for size bytes behind it.
static ty_status frame(const ty_gltf_source* source, const char* text, const size_t* begins, size_t size, ty_bytes* out,
                       ty_error* error)
{
    size_t length = strlen(text), padded = (length + 3) & ~(size_t)3, total = 28 + padded + size;
    if (padded > TY_GLTF_TEXT_MAX || total > UINT32_MAX)
        return ty_error_set_at(error, TY_BAD_FILE, source->path, 0, 0, "too large for the importer");
    out->data = TY_TRY_ALLOC(uint8_t, total + 1);
    if (!out->data)
        return ty_error_set_at(error, TY_NO_MEMORY, source->path, 0, 0, "no memory for %zu bytes", total);
    out->size = total;
    uint8_t* at = out->data;
    put_u32(at, TY_GLB_MAGIC);
    put_u32(at + 4, 2);
    put_u32(at + 8, total);
    put_u32(at + 12, padded);
    put_u32(at + 16, TY_GLB_JSON);
    memset(at + 20, ' ', padded);
    memcpy(at + 20, text, length);
    put_u32(at + 20 + padded, size);
    put_u32(at + 24 + padded, TY_GLB_BIN);
    for (int i = 0; i < source->buffer_count; i++)
        memcpy(at + 28 + padded + begins[i], source->buffers[i].data, source->buffers[i].size);
    return TY_OK;
}

ty_status ty_gltf_pack(const ty_gltf_source* source, ty_bytes* out, ty_error* error)
{
    *out = (ty_bytes){0};
    size_t size = 0, *begins = TY_ALLOC(size_t, source->buffer_count + 1);
    for (int i = 0; i < source->buffer_count; i++)
    {
        begins[i] = size;
        size = (size + source->buffers[i].size + 7) & ~(size_t)7; // alignment of every element is kept
    }
    json_t* root =
        json_pack("{s:{s:s}, s:[{s:I}], s:o, s:o, s:o, s:o}", "asset", "version", "2.0", "buffers", "byteLength",
                  (json_int_t)size, "bufferViews", pack_views(source, begins), "accessors",
                  pack_accessors(source->root), "meshes", pack_meshes(source->root), "nodes", pack_nodes(source->root));
    char* text = ty_json_text(root);
    ty_status status = frame(source, text, begins, size, out, error);
    ty_free(text);
    json_decref(root);
    ty_free(begins);
    return status;
}
