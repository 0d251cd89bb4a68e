// SPDX-License-Identifier: Apache-2.0
// Where files are looked for, what a sandbox allows, and hashing of their contents.
#include "scene_files.h"
#include "text.h"
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Whether path, with links followed, lies below the scene's folder.
static bool is_inside(const ty_files* files, const char* path)
{
    char folder[PATH_MAX], real[PATH_MAX];
    if (!realpath(files->folder, folder) || !realpath(path, real))
        return false;
    size_t length = strlen(folder);
    return strncmp(real, folder, length) == 0 && (real[length] == '/' || (length == 1 && folder[0] == '/'));
}

// name seen from base, in scene terms: absolute names and an empty base leave it as it is.
static const char* join(const ty_files* files, const char* base, const char* name)
{
    while (strncmp(name, "./", 2) == 0 && name[2])
        name += 2;
    if (name[0] == '/' || base[0] == 0)
        return ty_arena_string(files->arena, name);
    size_t length = strlen(base);
    return ty_arena_format(files->arena, base[length - 1] == '/' ? "%s%s" : "%s/%s", base, name);
}

const char* ty_files_find(ty_files* files, ty_node* node, const char* what)
{
    char path[TY_PATH_MAX], described[80];
    if (node->bad || node->path)
        return node->path;
    if (node->kind != TY_NODE_SCALAR || node->text[0] == 0)
    {
        ty_report(files->errors, node->place, TY_BAD_INPUT, "%s: expected the name of a file, got %s", what,
                  ty_node_describe(node, described));
        return NULL;
    }
    if (strlen(node->text) > 1024)
    {
        ty_report(files->errors, node->place, TY_BAD_INPUT, "%s: a file name of more than 1024 bytes", what);
        return NULL;
    }
    ty_text tried = {0};
    const char* found = NULL;
    for (int i = -1; i < files->search_count && !found; ++i)
    {
        const char* name = join(files, i < 0 ? node->place.source->base : files->search[i], node->text);
        ty_path_join(files->folder, name, path);
        ty_text_format(&tried, "%s%s", i < 0 ? "" : ", ", path);
        if (ty_file_exists(path))
            found = name;
    }
    if (!found)
        ty_report(files->errors, node->place, TY_BAD_INPUT, "%s: no file '%s' (tried: %s)", what, node->text,
                  tried.data);
    ty_text_term(&tried);
    if (found && files->sandbox && !is_inside(files, path))
    {
        ty_report(files->errors, node->place, TY_BAD_INPUT, "%s: '%s' is outside the scene's folder (sandbox)", what,
                  node->text);
        found = NULL;
    }
    if (!found)
        return NULL;
    node->text = found;
    return node->path = ty_arena_string(files->arena, path);
}

const char* ty_files_use(ty_files* files, ty_node* node, const char* what)
{
    bool known = node->path != NULL;
    const char* path = ty_files_find(files, node, what);
    if (!path || known)
        return path;
    if (files->count == files->capacity)
    {
        int capacity = files->capacity ? 2 * files->capacity : 16;
        ty_file_entry* entries = TY_ARENA_ALLOC(files->arena, ty_file_entry, capacity);
        if (files->count)
            memcpy(entries, files->entries, (size_t)files->count * sizeof(*entries));
        files->entries = entries;
        files->capacity = capacity;
    }
    files->entries[files->count++] = (ty_file_entry){.text = ty_arena_string(files->arena, node->text), .path = path};
    return path;
}

static ty_status hash_file(const char* path, ty_hash* out, ty_error* error)
{
    FILE* file = fopen(path, "rb");
    if (!file)
        return ty_error_set(error, TY_BAD_FILE, "cannot read '%s': %s", path, strerror(errno));
    ty_hasher* content = ty_hasher_create();
    uint8_t* buffer = TY_ALLOC(uint8_t, 1 << 16);
    size_t size = 0;
    while ((size = fread(buffer, 1, 1 << 16, file)) > 0)
        ty_hasher_add(content, buffer, size);
    int failed = ferror(file) ? (errno ? errno : EIO) : 0;
    ty_free(buffer);
    fclose(file);
    *out = ty_hasher_end(content);
    return failed ? ty_error_set(error, TY_BAD_FILE, "cannot read '%s': %s", path, strerror(failed)) : TY_OK;
}

ty_status ty_files_add_to_hash(ty_files* files, int begin, int end, ty_hasher* hasher, ty_error* error)
{
    for (int i = begin; i < end; ++i)
    {
        ty_file_entry* entry = &files->entries[i];
        ty_status status = entry->hashed ? TY_OK : hash_file(entry->path, &entry->content, error);
        if (status != TY_OK)
            return status;
        entry->hashed = true;
        ty_hasher_add_string(hasher, entry->text);
        ty_hasher_add(hasher, &entry->content, sizeof(entry->content));
    }
    return TY_OK;
}
