// SPDX-License-Identifier: Apache-2.0
// Small glTF files as text: numbers go into one buffer, a data URI, and get their accessors.
#pragma once
#include <base/cmocka_all.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>

typedef struct gltf_text
{
    char buffer[65536]; // bytes
    size_t size;
    char views[16384], accessors[16384];
    int count;
} gltf_text;

// Appends bytes as a view and an accessor of count elements; returns its number. further: ",\"normalized\":true" or "".
static inline int gltf_add(gltf_text* g, const void* bytes, size_t size, int count, int component, const char* type,
                           const char* further)
{
    g->size = (g->size + 3) & ~(size_t)3;
    assert_true(g->size + size <= sizeof g->buffer);
    memcpy(g->buffer + g->size, bytes, size);
    size_t views = strlen(g->views), accessors = strlen(g->accessors);
    snprintf(g->views + views, sizeof g->views - views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}",
             g->count ? "," : "", g->size, size);
    snprintf(g->accessors + accessors, sizeof g->accessors - accessors,
             "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"%s\"%s}", g->count ? "," : "", g->count,
             component, count, type, further);
    g->size += size;
    return g->count++;
}

static inline int gltf_floats(gltf_text* g, const float* values, int count, int width)
{
    static const char* const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    return gltf_add(g, values, sizeof(float) * (size_t)(count * width), count, 5126, types[width], "");
}

static inline int gltf_shorts(gltf_text* g, const uint16_t* values, int count)
{
    return gltf_add(g, values, 2 * (size_t)count, count, 5123, "SCALAR", "");
}

static inline char* gltf_base64(const void* bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t* b = bytes;
    char* out = ty_alloc(size / 3 * 4 + 8, 1);
    size_t n = 0;
    for (size_t i = 0; i < size; i += 3)
    {
        uint32_t bits =
            (uint32_t)b[i] << 16 | (i + 1 < size ? (uint32_t)b[i + 1] << 8 : 0u) | (i + 2 < size ? b[i + 2] : 0u);
        out[n++] = digits[bits >> 18];
        out[n++] = digits[bits >> 12 & 63];
        out[n++] = i + 1 < size ? digits[bits >> 6 & 63] : '=';
        out[n++] = i + 2 < size ? digits[bits & 63] : '=';
    }
    return out;
}

// The whole text: rest is what follows accessors, "\"meshes\":[...],\"nodes\":[...]". Freed with ty_free.
static inline char* gltf_compose(const gltf_text* g, const char* rest)
{
    char* data = gltf_base64(g->buffer, g->size);
    char* text = ty_string_format("{\"asset\":{\"version\":\"2.0\"},\n\"buffers\":[{\"byteLength\":%zu,\"uri\":"
                                  "\"data:application/octet-stream;base64,%s\"}],\n\"bufferViews\":[%s],\n"
                                  "\"accessors\":[%s],\n%s}",
                                  g->size, data, g->views, g->accessors, rest);
    ty_free(data);
    return text;
}

static inline void gltf_write(const gltf_text* g, const char* path, const char* rest)
{
    ty_error error;
    char* text = gltf_compose(g, rest);
    assert_int_equal(ty_file_write(path, text, strlen(text), &error), TY_OK);
    ty_free(text);
}
