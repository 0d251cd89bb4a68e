// SPDX-License-Identifier: Apache-2.0
// A glTF file's text and buffers: containers, data URIs, files beside it.
#include "gltf_source.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define WARNINGS_MAX 64

// --- URIs ---

static int sextet(char c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    if (c == '+' || c == '-')
        return 62;
    return c == '/' || c == '_' ? 63 : -1;
}

static ty_status decode_base64(const ty_gltf_source* source, const char* what, const char* text, ty_bytes* out,
                               ty_error* error)
{
    size_t length = strlen(text);
    while (length > 0 && text[length - 1] == '=')
        length--;
    size_t size = length / 4 * 3 + (length % 4 ? length % 4 - 1 : 0);
    if (size > TY_GLTF_DATA_URI_MAX)
        return ty_error_set_at(error, TY_BAD_FILE, source->path, 0, 0,
                               "%s: a data URI of %zu bytes; at most %zu are read: put them into a file", what, size,
                               TY_GLTF_DATA_URI_MAX);
    out->data = TY_TRY_ALLOC(uint8_t, size + 1);
    if (!out->data)
        return ty_error_set_at(error, TY_NO_MEMORY, source->path, 0, 0, "%s: no memory for %zu bytes", what, size);
    uint32_t bits = 0;
    for (size_t i = 0; i < length; i++)
    {
        int value = sextet(text[i]);
        if (value < 0 || length % 4 == 1)
            return ty_error_set_at(error, TY_BAD_FILE, source->path, 0, 0, "%s: its data URI is no base64", what);
        bits = bits << 6 | (uint32_t)value;
        if (i % 4)
            out->data[out->size++] = (uint8_t)(bits >> (6 - 2 * (i % 4)));
    }
    return TY_OK;
}

static int hex(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// %20 and the like; false for a name that is none.
static bool decode_percent(const char* uri, char out[1024])
{
    size_t size = 0;
    for (const char* c = uri; *c; c++)
    {
        int value = (unsigned char)*c;
        if (*c == '%' && hex(c[1]) >= 0 && hex(c[2]) >= 0)
        {
            value = hex(c[1]) * 16 + hex(c[2]);
            c += 2;
        }
        if (value < 0x20 || size == 1023)
            return false;
        out[size++] = (char)value;
    }
    out[size] = 0;
    return size > 0;
}

static bool goes_up(const char* name)
{
    for (const char* c = name; (c = strstr(c, "..")) != NULL; c += 2)
        if ((c == name || c[-1] == '/') && (c[2] == '/' || c[2] == 0))
            return true;
    return false;
}

static bool find_beside(const ty_gltf_source* source, const char* name, char path[TY_PATH_MAX], ty_error* error)
{
    char folder[TY_PATH_MAX];
    ty_path_folder(source->path, folder);
    ty_path_join(folder, name, path);
    if (name[0] == '/' || goes_up(name))
        (void)ty_error_set(error, TY_BAD_FILE, "'%.200s' is not below the file's folder", name);
    else if (!ty_file_exists(path))
        (void)ty_error_set(error, TY_BAD_FILE, "no file '%.400s'", path);
    else
        return true;
    return false;
}

ty_status ty_gltf_resolve_uri(const ty_gltf_source* source, const char* what, const char* uri, ty_bytes* out,
                              char path[TY_PATH_MAX], ty_error* error)
{
    char name[1024];
    const char* data = strncmp(uri, "data:", 5) == 0 ? strstr(uri, ";base64,") : NULL;
    path[0] = 0;
    if (data)
        return decode_base64(source, what, data + 8, out, error);
    const char* colon = strchr(uri, ':');
    if ((colon && strcspn(uri, "/") > (size_t)(colon - uri)) || !decode_percent(uri, name))
        return ty_error_set_at(error, TY_BAD_FILE, source->path, 0, 0, "%s: '%.60s' is no file and no data", what, uri);
    ty_error reason = {0};
    bool found =
        source->find ? source->find(source->context, name, path, &reason) : find_beside(source, name, path, &reason);
    if (!found)
        return ty_error_set_at(error, TY_BAD_FILE, source->path, 0, 0, "%s: %.600s", what,
                               reason.text[0] ? reason.text : "it cannot be found");
    return TY_OK;
}

// --- buffers ---

static ty_status open_buffer(ty_gltf_source* source, int index, const ty_glb* glb, ty_error* error)
{
    char what[40], path[TY_PATH_MAX];
    ty_gltf_buffer* buffer = &source->buffers[index];
    const json_t* object = json_array_get(json_object_get(source->root, "buffers"), (size_t)index);
    const char* uri = json_string_value(json_object_get(object, "uri"));
    snprintf(what, sizeof what, "buffers[%d]", index);
    if (!uri)
    {
        if (index > 0 || !glb->bin)
            return ty_error_set_at(error, TY_BAD_FILE, source->path, 0, 0, "%s is missing: it has no uri%s", what,
                                   index ? "" : " and there is no BIN chunk");
        *buffer = (ty_gltf_buffer){.data = glb->bin, .size = glb->bin_size};
        return TY_OK;
    }
    ty_status status = ty_gltf_resolve_uri(source, what, uri, &buffer->owned, path, error);
    if (status == TY_OK && path[0])
    {
        ty_error reason = {0};
        status = ty_file_read(path, TY_GLB_SIZE_MAX, &buffer->owned, &reason);
        if (status != TY_OK)
            (void)ty_error_set_at(error, status, source->path, 0, 0, "%s: %.600s", what, reason.text);
    }
    buffer->data = buffer->owned.data;
    buffer->size = buffer->owned.size;
    return status;
}

static ty_status open_buffers(ty_gltf_source* source, const ty_glb* glb, ty_error* error)
{
    const json_t* buffers = json_object_get(source->root, "buffers");
    uint64_t total = 0;
    int count = (int)json_array_size(buffers);
    source->buffers = TY_ARENA_ALLOC(source->arena, ty_gltf_buffer, count);
    ty_status status = TY_OK;
    for (int i = 0; i < count && status == TY_OK; i++)
    {
        source->buffer_count = i + 1;
        status = open_buffer(source, i, glb, error);
        total += source->buffers[i].size;
        if (status == TY_OK && total > TY_GLB_SIZE_MAX)
            status =
                ty_error_set_at(error, TY_BAD_FILE, source->path, 0, 0, "buffers of %llu bytes; at most %zu are read",
                                (unsigned long long)total, TY_GLB_SIZE_MAX);
    }
    return status;
}

ty_status ty_gltf_source_open(ty_gltf_source* source, const void* bytes, size_t size, ty_error* error)
{
    static const char magic[4] = {'g', 'l', 'T', 'F'};
    ty_glb glb = {.json = bytes, .json_size = size};
    ty_status status = TY_OK;
    if (size >= 4 && memcmp(bytes, magic, 4) == 0)
        status = ty_glb_split(source->path, bytes, size, &glb, error);
    else if (size == 0)
        status = ty_error_set_at(error, TY_BAD_FILE, source->path, 0, 0, "the file is empty");
    else if (size > TY_GLTF_TEXT_MAX)
        status = ty_error_set_at(error, TY_BAD_FILE, source->path, 0, 0, "%zu bytes of text; at most %zu are read",
                                 size, TY_GLTF_TEXT_MAX);
    else
        status = ty_gltf_check_depth(source->path, bytes, size, error);
    if (status == TY_OK)
        status = ty_gltf_parse(source->path, glb.json, glb.json_size, &source->root, error);
    return status == TY_OK ? open_buffers(source, &glb, error) : status;
}

void ty_gltf_source_term(ty_gltf_source* source)
{
    for (int i = 0; i < source->buffer_count; i++)
        ty_bytes_term(&source->buffers[i].owned);
    for (int i = 0; i < source->image_count; i++)
        ty_bytes_term(&source->images[i]);
    json_decref(source->root);
    ty_bytes_term(&source->file);
}

void ty_gltf_warn(ty_gltf_scene* scene, const char* format, ...)
{
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    for (int i = 0; i < scene->warning_count; i++)
        if (strcmp(scene->warnings[i], text) == 0)
            return;
    if (!scene->warnings)
        scene->warnings = TY_ARENA_ALLOC(scene->source->arena, const char*, WARNINGS_MAX);
    if (scene->warning_count + 1 == WARNINGS_MAX)
        snprintf(text, sizeof text, "and more that is left out");
    if (scene->warning_count < WARNINGS_MAX)
        scene->warnings[scene->warning_count++] = ty_arena_string(scene->source->arena, text);
}
