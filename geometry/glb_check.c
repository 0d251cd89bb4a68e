// SPDX-License-Identifier: Apache-2.0
// The container of a GLB file: header, chunks, lengths, and how deep its JSON goes.
#include "gltf_json.h"
#include <string.h>
#include <tsuya/geometry/aggregate.h>

#define DEPTH_MAX 32

static uint32_t read_u32(const uint8_t* bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static ty_status check_header(const char* name, const uint8_t* bytes, size_t size, ty_error* error)
{
    if (size == 0)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "the file is empty");
    if (size < 20)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "%zu bytes are too few for a GLB file", size);
    if (read_u32(bytes) != TY_GLB_MAGIC)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "not a GLB file: it does not begin with \"glTF\"");
    if (read_u32(bytes + 4) != 2)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "GLB version %u; only version 2 is read",
                               read_u32(bytes + 4));
    uint32_t length = read_u32(bytes + 8);
    if (length != size)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "the header says %u bytes, the file has %zu%s", length,
                               size, length > size ? " (truncated?)" : "");
    return TY_OK;
}

// Quotes and brackets only: whether it is JSON the parser says. Bounds the recursion of every parser behind.
ty_status ty_gltf_check_depth(const char* name, const char* json, size_t size, ty_error* error)
{
    int depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < size; i++)
    {
        char c = json[i];
        if (quoted && c == '\\')
            i++;
        else if (c == '"')
            quoted = !quoted;
        else if (!quoted && (c == '{' || c == '['))
        {
            if (++depth > DEPTH_MAX)
                return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "JSON chunk: byte %zu: nested deeper than %d", i,
                                       DEPTH_MAX);
        }
        else if (!quoted && (c == '}' || c == ']'))
            depth--;
    }
    return TY_OK;
}

// Takes the chunk at *offset, whose type must be as expected.
static ty_status take_chunk(const char* name, const uint8_t* bytes, size_t size, size_t* offset, uint32_t type,
                            const uint8_t** content, size_t* content_size, ty_error* error)
{
    const char* label = type == TY_GLB_JSON ? "JSON" : "BIN";
    if (size - *offset < 8)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "byte %zu: the header of the %s chunk is cut off",
                               *offset, label);
    uint32_t length = read_u32(bytes + *offset);
    if (read_u32(bytes + *offset + 4) != type)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "byte %zu: expected a %s chunk", *offset + 4, label);
    if (length % 4 || length > size - *offset - 8)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "byte %zu: the %s chunk claims %u bytes, %zu are left",
                               *offset, label, length, size - *offset - 8);
    *content = bytes + *offset + 8;
    *content_size = length;
    *offset += 8 + (size_t)length;
    return TY_OK;
}

ty_status ty_glb_split(const char* name, const void* bytes, size_t size, ty_glb* out, ty_error* error)
{
    memset(out, 0, sizeof *out);
    ty_status status = check_header(name, bytes, size, error);
    if (status != TY_OK)
        return status;
    size_t offset = 12;
    const uint8_t* json = NULL;
    status = take_chunk(name, bytes, size, &offset, TY_GLB_JSON, &json, &out->json_size, error);
    out->json = (const char*)json;
    if (status == TY_OK && out->json_size > TY_GLB_JSON_MAX)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "the JSON chunk has %zu bytes; at most %zu are read",
                               out->json_size, TY_GLB_JSON_MAX);
    if (status == TY_OK)
        status = ty_gltf_check_depth(name, out->json, out->json_size, error);
    if (status == TY_OK && offset < size)
        status = take_chunk(name, bytes, size, &offset, TY_GLB_BIN, &out->bin, &out->bin_size, error);
    if (status == TY_OK && offset < size)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "byte %zu: more than a JSON and a BIN chunk", offset);
    return status;
}

ty_status ty_glb_check(const char* name, const void* bytes, size_t size, ty_error* error)
{
    ty_glb glb;
    return ty_glb_split(name, bytes, size, &glb, error);
}

ty_status ty_gltf_check_aggregate(const char* name, const ty_glb* glb, json_t** root, ty_error* error)
{
    ty_status status = ty_gltf_parse(name, glb->json, glb->json_size, root, error);
    if (status != TY_OK)
        return status;
    const uint64_t size = glb->bin_size;
    ty_gltf_checker c = {
        .name = name, .error = error, .root = *root, .is_aggregate = true, .buffer_sizes = &size, .buffer_count = 1};
    status = ty_gltf_check(&c);
    if (status != TY_OK)
    {
        json_decref(*root);
        *root = NULL;
    }
    return status;
}

ty_status ty_aggregate_check(const char* name, const void* bytes, size_t size, ty_error* error)
{
    ty_glb glb;
    json_t* root = NULL;
    ty_status status = ty_glb_split(name, bytes, size, &glb, error);
    if (status == TY_OK)
        status = ty_gltf_check_aggregate(name, &glb, &root, error);
    json_decref(root);
    return status;
}
