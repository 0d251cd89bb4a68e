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

static bool is_there(const char* path, bool frames)
{
    ty_frame_numbers numbers;
    ty_error error;
    if (!frames)
        return ty_file_exists(path);
    if (ty_frame_numbers_find(path, &numbers, &error) != TY_OK)
        return false;
    ty_frame_numbers_term(&numbers);
    return true;
}

// Each frame may be a link of its own.
static bool all_inside(const ty_files* files, const char* path, bool frames)
{
    char frame[TY_PATH_MAX];
    ty_frame_numbers numbers;
    ty_error error;
    if (!frames)
        return is_inside(files, path);
    if (ty_frame_numbers_find(path, &numbers, &error) != TY_OK)
        return false;
    bool inside = true;
    for (int i = 0; i < numbers.count && inside; ++i)
    {
        ty_path_frame(path, numbers.numbers[i], frame);
        inside = is_inside(files, frame);
    }
    ty_frame_numbers_term(&numbers);
    return inside;
}

static bool is_file_name(const ty_files* files, const ty_node* node, const char* what)
{
    char described[80];
    if (node->kind != TY_NODE_SCALAR || node->text[0] == 0)
    {
        ty_report(files->errors, node->place, TY_BAD_INPUT, "%s: expected the name of a file, got %s", what,
                  ty_node_describe(node, described));
        return false;
    }
    if (strlen(node->text) > 1024)
    {
        ty_report(files->errors, node->place, TY_BAD_INPUT, "%s: a file name of more than 1024 bytes", what);
        return false;
    }
    return true;
}

static const char* find(ty_files* files, ty_node* node, const char* what, bool frames)
{
    char path[TY_PATH_MAX];
    if (node->bad || node->path)
        return node->path;
    if (!is_file_name(files, node, what))
        return NULL;
    ty_text tried = {0};
    const char* found = NULL;
    for (int i = -1; i < files->search_count && !found; ++i)
    {
        const char* name = join(files, i < 0 ? node->place.source->base : files->search[i], node->text);
        ty_path_join(files->folder, name, path);
        ty_text_format(&tried, "%s%s", i < 0 ? "" : ", ", path);
        if (is_there(path, frames))
            found = name;
    }
    if (!found)
        ty_report(files->errors, node->place, TY_BAD_INPUT, "%s: no %s '%s' (tried: %s)", what,
                  frames ? "frame of" : "file", node->text, tried.data);
    ty_text_term(&tried);
    if (found && files->sandbox && !all_inside(files, path, frames))
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

const char* ty_files_find(ty_files* files, ty_node* node, const char* what)
{
    return find(files, node, what, false);
}

static const char* use(ty_files* files, ty_node* node, const char* what, bool frames)
{
    bool known = node->path != NULL;
    const char* path = find(files, node, what, frames);
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
    files->entries[files->count++] =
        (ty_file_entry){.text = ty_arena_string(files->arena, node->text), .path = path, .frames = frames};
    return path;
}

const char* ty_files_use(ty_files* files, ty_node* node, const char* what)
{
    return use(files, node, what, false);
}

const char* ty_files_use_frames(ty_files* files, ty_node* node, const char* what)
{
    if (!node->bad && node->kind == TY_NODE_SCALAR && node->text[0] && !ty_path_is_sequence(node->text))
    {
        ty_report(files->errors, node->place, TY_BAD_INPUT,
                  "%s: expected a name with #### for the number of the frame, got '%.200s'", what, node->text);
        return NULL;
    }
    return use(files, node, what, true);
}

const char* ty_files_use_either(ty_files* files, ty_node* node, const char* what)
{
    return use(files, node, what, node->kind == TY_NODE_SCALAR && ty_path_is_sequence(node->text));
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

enum
{
    SAMPLE = 1 << 16, // bytes
};

// A long sequence is gigabytes: of each frame its size, and its bytes at the beginning, in the middle and at the end.
// What a picture really looks up is known by its whole content, in the cache of textures.
static ty_status hash_samples(const char* path, ty_hasher* hasher, uint8_t* buffer, ty_error* error)
{
    FILE* file = fopen(path, "rb");
    if (!file)
        return ty_error_set(error, TY_BAD_FILE, "cannot read '%s': %s", path, strerror(errno));
    bool failed = fseeko(file, 0, SEEK_END) != 0;
    off_t size = ftello(file);
    const off_t starts[3] = {0, size / 2, size > SAMPLE ? size - SAMPLE : 0};
    ty_hasher_add(hasher, &size, sizeof size);
    for (int i = 0; i < 3 && !failed; ++i)
    {
        failed = fseeko(file, starts[i], SEEK_SET) != 0;
        size_t count = failed ? 0 : fread(buffer, 1, SAMPLE, file);
        ty_hasher_add(hasher, buffer, count);
        failed |= ferror(file) != 0;
    }
    fclose(file);
    return failed ? ty_error_set(error, TY_BAD_FILE, "cannot read '%s'", path) : TY_OK;
}

static ty_status hash_frames(const char* pattern, ty_hash* out, ty_error* error)
{
    char path[TY_PATH_MAX];
    ty_frame_numbers numbers;
    ty_status status = ty_frame_numbers_find(pattern, &numbers, error);
    if (status != TY_OK)
        return status;
    ty_hasher* content = ty_hasher_create();
    uint8_t* buffer = TY_ALLOC(uint8_t, SAMPLE);
    for (int i = 0; i < numbers.count && status == TY_OK; ++i)
    {
        ty_path_frame(pattern, numbers.numbers[i], path);
        ty_hasher_add(content, &numbers.numbers[i], sizeof(int));
        status = hash_samples(path, content, buffer, error);
    }
    *out = ty_hasher_end(content);
    ty_free(buffer);
    ty_frame_numbers_term(&numbers);
    return status;
}

static ty_status hash_entry(ty_file_entry* entry, ty_error* error)
{
    if (entry->hashed)
        return TY_OK;
    return entry->frames ? hash_frames(entry->path, &entry->content, error)
                         : hash_file(entry->path, &entry->content, error);
}

ty_status ty_files_add_to_hash(ty_files* files, int begin, int end, ty_hasher* hasher, ty_error* error)
{
    for (int i = begin; i < end; ++i)
    {
        ty_file_entry* entry = &files->entries[i];
        ty_status status = hash_entry(entry, error);
        if (status != TY_OK)
            return status;
        entry->hashed = true;
        ty_hasher_add_string(hasher, entry->text);
        ty_hasher_add(hasher, &entry->content, sizeof(entry->content));
    }
    return TY_OK;
}
