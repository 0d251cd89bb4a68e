// SPDX-License-Identifier: Apache-2.0
// Puts a GLB file together.
#include "glb_build.h"
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>

void ty_glb_builder_init(ty_glb_builder* builder)
{
    *builder = (ty_glb_builder){.views = json_array(), .accessors = json_array()};
}

void ty_glb_builder_term(ty_glb_builder* builder)
{
    ty_free(builder->bytes);
    json_decref(builder->views);
    json_decref(builder->accessors);
}

int ty_glb_add_bytes(ty_glb_builder* builder, const void* bytes, size_t size)
{
    size_t padded = (size + 3) & ~(size_t)3, wanted = builder->size + padded;
    if (wanted > builder->capacity)
    {
        size_t capacity = wanted > 2 * builder->capacity ? wanted : 2 * builder->capacity;
        builder->bytes = ty_grow(builder->bytes, builder->size, capacity, 1);
        builder->capacity = capacity;
    }
    memcpy(builder->bytes + builder->size, bytes, size);
    memset(builder->bytes + builder->size + size, 0, padded - size);
    json_array_append_new(builder->views, json_pack("{s:i, s:I, s:I}", "buffer", 0, "byteOffset",
                                                    (json_int_t)builder->size, "byteLength", (json_int_t)size));
    builder->size = wanted;
    return (int)json_array_size(builder->views) - 1;
}

int ty_glb_add(ty_glb_builder* builder, const void* values, size_t count, int component, int width, int target)
{
    static const char* const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    int view = ty_glb_add_bytes(builder, values, count * (size_t)width * 4);
    if (target)
        json_object_set_new(json_array_get(builder->views, (size_t)view), "target", json_integer(target));
    json_array_append_new(builder->accessors, json_pack("{s:i, s:i, s:I, s:s}", "bufferView", view, "componentType",
                                                        component, "count", (json_int_t)count, "type", types[width]));
    return (int)json_array_size(builder->accessors) - 1;
}

int ty_glb_add_integers(ty_glb_builder* builder, const uint32_t* values, size_t count)
{
    float* exact = TY_ALLOC(float, count);
    bool all = true;
    for (size_t i = 0; i < count; i++)
    {
        exact[i] = (float)values[i];
        all = all && values[i] <= 1u << 24;
    }
    int accessor = all ? ty_glb_add(builder, exact, count, TY_GLTF_FLOAT, 1, 0)
                       : ty_glb_add(builder, values, count, TY_GLTF_UNSIGNED_INT, 1, 0);
    ty_free(exact);
    return accessor;
}

char* ty_json_text(const json_t* value)
{
    const size_t flags = JSON_SORT_KEYS | JSON_COMPACT | JSON_REAL_PRECISION(9);
    size_t size = json_dumpb(value, NULL, 0, flags);
    char* text = TY_ALLOC(char, size + 1);
    json_dumpb(value, text, size, flags);
    return text;
}

static void put_u32(uint8_t* at, size_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> (8 * i));
}

ty_status ty_glb_write(ty_glb_builder* builder, json_t* root, const char* path, ty_error* error)
{
    json_object_set_new(root, "buffers", json_pack("[{s:I}]", "byteLength", (json_int_t)builder->size));
    json_object_set(root, "bufferViews", builder->views);
    json_object_set(root, "accessors", builder->accessors);
    char* text = ty_json_text(root);
    size_t text_size = strlen(text), json_size = (text_size + 3) & ~(size_t)3, size = 28 + json_size + builder->size;
    ty_status status = TY_OK;
    if (size > TY_GLB_SIZE_MAX || json_size > TY_GLB_JSON_MAX)
        status = ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "the aggregate needs %zu bytes; GLB files end at %zu",
                                 size, TY_GLB_SIZE_MAX);
    else
    {
        // Every array has a multiple of four bytes, so the BIN chunk needs no padding.
        uint8_t* file = TY_ALLOC(uint8_t, size);
        put_u32(file, TY_GLB_MAGIC);
        put_u32(file + 4, 2);
        put_u32(file + 8, size);
        put_u32(file + 12, json_size);
        put_u32(file + 16, TY_GLB_JSON);
        memset(file + 20, ' ', json_size);
        memcpy(file + 20, text, text_size);
        put_u32(file + 20 + json_size, builder->size);
        put_u32(file + 24 + json_size, TY_GLB_BIN);
        memcpy(file + 28 + json_size, builder->bytes, builder->size);
        status = ty_file_write(path, file, size, error);
        ty_free(file);
    }
    ty_free(text);
    return status;
}
