// SPDX-License-Identifier: Apache-2.0
// The field of distance about a mesh, kept from one run to the next by what went into it.
#include "roots_host.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/hash.h>
#include <tsuya/base/log.h>
#include <unistd.h>

#define FORMAT "tsuya field 1" // in the file: what another version wrote is something else
#define EXTENSION "field"
#define MOST_KEPT ((uint64_t)4 << 30) // bytes of all fields in the folder together

enum
{
    MARGIN = 8, // steps of the field about the mesh
};

// The file begins with it; the values follow, then the nearest triangles where they were wanted.
typedef struct header
{
    char format[16], key[40];
    int32_t size[3];
    float origin[3], step;
    int32_t has_nearest;
    ty_hash values, nearest;
    ty_hash own; // of all that stands before it
} header;

static header header_seal(header h)
{
    h.own = ty_hash_bytes(&h, offsetof(header, own));
    return h;
}

static size_t nodes_of(const int32_t size[3])
{
    return (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
}

// Positions and triangles alone: what is painted on them changes no distance.
static void key_make(const ty_mesh* mesh, float step, float margin, char key[33])
{
    const float numbers[2] = {step, margin};
    const uint32_t counts[2] = {mesh->vertex_count, mesh->triangle_count};
    ty_hasher* hasher = ty_hasher_create();
    ty_hasher_add_string(hasher, TY_VOXELS_AROUND_MESH_BUILD);
    ty_hasher_add(hasher, numbers, sizeof numbers);
    ty_hasher_add(hasher, counts, sizeof counts);
    ty_hasher_add(hasher, mesh->positions, mesh->vertex_count * sizeof *mesh->positions);
    ty_hasher_add(hasher, mesh->triangles, mesh->triangle_count * sizeof *mesh->triangles);
    ty_hash_hex(ty_hasher_end(hasher), key);
}

// --- reading ---

// An array of four bytes a node that the file goes on with; NULL: there is no memory, or it is not what was written.
static void* array_read(FILE* file, size_t count, ty_hash hash)
{
    void* array = ty_try_alloc(count, 4);
    if (!array)
        return NULL;
    ty_hash found = {0};
    if (fread(array, 4, count, file) == count)
        found = ty_hash_bytes(array, 4 * count);
    if (found.low == hash.low && found.high == hash.high)
        return array;
    ty_free(array);
    return NULL;
}

static bool header_read(FILE* file, const char* key, header* out)
{
    if (fread(out, sizeof *out, 1, file) != 1)
        return false;
    const header sealed = header_seal(*out);
    return memcmp(&sealed.own, &out->own, sizeof(ty_hash)) == 0 && strcmp(out->format, FORMAT) == 0 &&
           strcmp(out->key, key) == 0;
}

// What an earlier run has kept. What is there but is not what it should be is made anew.
static bool field_read(const char* path, const char* key, ty_voxels* out, int32_t** nearest)
{
    header h;
    FILE* file = fopen(path, "rb");
    if (!file)
        return false;
    bool good = header_read(file, key, &h), lacks = good && nearest && !h.has_nearest;
    if (good && !lacks)
    {
        *out = (ty_voxels){{h.size[0], h.size[1], h.size[2]}, {h.origin[0], h.origin[1], h.origin[2]}, h.step, NULL};
        out->values = array_read(file, nodes_of(h.size), h.values);
        good = out->values != NULL;
        if (good && nearest)
            good = (*nearest = array_read(file, nodes_of(h.size), h.nearest)) != NULL;
    }
    fclose(file);
    if (!good)
    {
        ty_voxels_term(out);
        ty_log(TY_LOG_WARNING, "%s: the host's field is damaged and is made again: it is cut off or changed", path);
    }
    else if (!lacks)
        ty_file_touch(path);
    return good && !lacks;
}

// --- writing ---

static ty_status field_write(const char* path, const char* key, const ty_voxels* field, const int32_t* nearest,
                             ty_error* error)
{
    ty_atomic_file file;
    size_t bytes = 4 * nodes_of(field->size);
    header h = {.format = FORMAT,
                .size = {field->size[0], field->size[1], field->size[2]},
                .origin = {field->origin.x, field->origin.y, field->origin.z},
                .step = field->step,
                .has_nearest = nearest != NULL,
                .values = ty_hash_bytes(field->values, bytes)};
    snprintf(h.key, sizeof h.key, "%s", key);
    if (nearest)
        h.nearest = ty_hash_bytes(nearest, bytes);
    h = header_seal(h);
    ty_status status = ty_atomic_begin(&file, path, error);
    if (status != TY_OK)
        return status;
    int fd = open(file.temporary, O_WRONLY | O_CLOEXEC);
    bool good = fd >= 0 && ty_descriptor_write(fd, &h, sizeof h) && ty_descriptor_write(fd, field->values, bytes) &&
                (!nearest || ty_descriptor_write(fd, nearest, bytes));
    int failed = errno;
    if (fd >= 0 && close(fd) != 0 && good)
    {
        good = false;
        failed = errno;
    }
    if (good)
        return ty_atomic_commit(&file, error);
    ty_atomic_abort(&file);
    return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot write: %s", strerror(failed));
}

static void field_keep(const char* cache, const char* path, const char* key, const ty_voxels* field,
                       const int32_t* nearest)
{
    ty_error error = {0};
    if (field_write(path, key, field, nearest, &error) == TY_OK)
        ty_folder_trim(cache, EXTENSION, MOST_KEPT);
    else
        ty_log(TY_LOG_WARNING, "the host's field cannot be kept: %s", error.text);
}

ty_status host_field_make(const ty_mesh* mesh, int resolution, const char* cache, ty_workers* workers, ty_voxels* out,
                          int32_t** nearest, ty_error* error)
{
    char key[33], name[64], path[TY_PATH_MAX];
    double start = ty_time_now();
    float step = host_longest(mesh) / (float)resolution, margin = MARGIN * step;
    bool known = false;
    if (cache)
    {
        key_make(mesh, step, margin, key);
        snprintf(name, sizeof name, "%s." EXTENSION, key);
        ty_path_join(cache, name, path);
        known = field_read(path, key, out, nearest);
    }
    if (!known)
    {
        ty_status status = ty_voxels_around_mesh(mesh, step, margin, workers, out, nearest, error);
        if (status != TY_OK)
            return status;
    }
    ty_log(TY_LOG_INFO, "roots: field of %d x %d x %d %s in %.2f s", out->size[0], out->size[1], out->size[2],
           known ? "from the cache" : "made", ty_time_now() - start);
    if (cache && !known)
        field_keep(cache, path, key, out, nearest ? *nearest : NULL);
    return TY_OK;
}
