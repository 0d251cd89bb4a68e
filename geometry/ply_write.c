// SPDX-License-Identifier: Apache-2.0
// Binary little-endian PLY.
#include "ply.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/geometry/mesh_file.h>

typedef struct writer
{
    uint8_t* bytes;
    size_t size, capacity;
} writer;

static void put(writer* out, const void* bytes, size_t size)
{
    TY_ASSERT(out->size + size <= out->capacity);
    memcpy(out->bytes + out->size, bytes, size);
    out->size += size;
}

static void put_u32(writer* out, uint32_t value)
{
    uint8_t bytes[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16), (uint8_t)(value >> 24)};
    put(out, bytes, 4);
}

static void put_floats(writer* out, const float* values, int count)
{
    for (int i = 0; i < count; i++)
    {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        put_u32(out, bits);
    }
}

static void put_text(writer* out, const char* text)
{
    put(out, text, strlen(text));
}

static void put_note(writer* out, const char* key, const char* text)
{
    char* begin = (char*)out->bytes + out->size;
    TY_ASSERT(out->size + ply_note_bound(text) <= out->capacity);
    out->size += (size_t)(ply_note_write(key, text, begin) - begin);
}

// Colours as other programs write them: bytes where they are encoded, linear floats else.
static bool is_color(const ty_mesh_attribute* attribute)
{
    return strcmp(attribute->name, "color") == 0 && attribute->components >= 3 &&
           attribute->space != TY_ATTRIBUTE_NUMBERS;
}

static void put_color_property(writer* out, const ty_mesh_attribute* attribute, int component)
{
    static const char* const names[] = {"red", "green", "blue", "alpha"};
    char text[96];
    const char* type = attribute->space == TY_ATTRIBUTE_SRGB ? "uchar" : "float";
    snprintf(text, sizeof text, "property %s %s\n", type, names[component]);
    put_text(out, text);
}

static void put_property(writer* out, const char* name, int component, int components)
{
    static const char* const suffix[] = {"_x", "_y", "_z", "_w"};
    char text[96];
    snprintf(text, sizeof text, "property float %s%s\n", name, components > 1 ? suffix[component] : "");
    put_text(out, text);
}

static void put_header(writer* out, const ty_mesh* mesh)
{
    char text[160];
    put_text(out, "ply\nformat binary_little_endian 1.0\n");
    put_note(out, "hash", mesh->hash);
    put_note(out, "recipe", mesh->recipe);
    snprintf(text, sizeof text, "element vertex %u\n", mesh->vertex_count);
    put_text(out, text);
    put_text(out, "property float x\nproperty float y\nproperty float z\n");
    put_text(out, "property float nx\nproperty float ny\nproperty float nz\n");
    if (mesh->uvs)
    {
        put_text(out, "property float s\nproperty float t\n");
    }
    if (mesh->curvature_1 && mesh->curvature_2)
    {
        put_text(out, "property float curvature_1\nproperty float curvature_2\n");
    }
    for (int i = 0; i < mesh->attribute_count; i++)
    {
        for (int c = 0; c < mesh->attributes[i].components; c++)
        {
            if (is_color(&mesh->attributes[i]))
            {
                put_color_property(out, &mesh->attributes[i], c);
            }
            else
            {
                put_property(out, mesh->attributes[i].name, c, mesh->attributes[i].components);
            }
        }
    }
    snprintf(text, sizeof text, "element face %u\nproperty list uchar uint vertex_indices\nend_header\n",
             mesh->triangle_count);
    put_text(out, text);
}

static void put_vertex(writer* out, const ty_mesh* mesh, uint32_t v)
{
    put_floats(out, &mesh->positions[v].x, 3);
    put_floats(out, &mesh->normals[v].x, 3);
    if (mesh->uvs)
    {
        put_floats(out, &mesh->uvs[v].x, 2);
    }
    if (mesh->curvature_1 && mesh->curvature_2)
    {
        put_floats(out, &mesh->curvature_1[v], 1);
        put_floats(out, &mesh->curvature_2[v], 1);
    }
    for (int i = 0; i < mesh->attribute_count; i++)
    {
        const ty_mesh_attribute* attribute = &mesh->attributes[i];
        const float* values = attribute->values + (size_t)v * (size_t)attribute->components;
        if (!is_color(attribute) || attribute->space != TY_ATTRIBUTE_SRGB)
        {
            put_floats(out, values, attribute->components);
            continue;
        }
        for (int c = 0; c < attribute->components; c++)
        {
            uint8_t byte = (uint8_t)(ty_clamp(values[c], 0.0f, 1.0f) * 255.0f + 0.5f);
            put(out, &byte, 1);
        }
    }
}

static size_t size_bound(const ty_mesh* mesh)
{
    size_t floats = 10, header = 1024 + ply_note_bound(mesh->recipe) + ply_note_bound(mesh->hash);
    for (int i = 0; i < mesh->attribute_count; i++)
    {
        floats += (size_t)mesh->attributes[i].components;
        header += 96 * (size_t)mesh->attributes[i].components;
    }
    return header + (size_t)mesh->vertex_count * floats * 4 + (size_t)mesh->triangle_count * 13;
}

ty_status ty_ply_write(const char* path, const ty_mesh* mesh, ty_error* error)
{
    writer out = {.capacity = size_bound(mesh)};
    out.bytes = TY_TRY_ALLOC(uint8_t, out.capacity);
    if (!out.bytes)
    {
        return ty_error_set_at(error, TY_NO_MEMORY, path, 0, 0, "no memory for a file of %zu bytes", out.capacity);
    }
    put_header(&out, mesh);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        put_vertex(&out, mesh, v);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        static const uint8_t three = 3;
        put(&out, &three, 1);
        for (int k = 0; k < 3; k++)
        {
            put_u32(&out, mesh->triangles[t][k]);
        }
    }
    ty_status status = ty_file_write(path, out.bytes, out.size, error);
    ty_free(out.bytes);
    return status;
}
