// SPDX-License-Identifier: Apache-2.0
// Aggregate files in: our checks, the importer in a child process, and our checks of what it sends.
#include "aggregate_gather.h"
#include "glb_build.h"
#include "gltf_json.h"
#include "placement.h"
#include "points_read.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

// --- in the child ---

typedef struct import_job
{
    const char* path;
    const ty_bytes* bytes;
} import_job;

static ty_status import(const void* context, int output_fd, ty_error* error)
{
    const import_job* job = context;
    char message[400] = "";
    bool out_of_memory;
    ty_gltf* gltf = ty_gltf_load(job->bytes->data, job->bytes->size, message, sizeof message, &out_of_memory);
    if (!gltf)
        return ty_error_set_at(error, out_of_memory ? TY_NO_MEMORY : TY_BAD_FILE, job->path, 0, 0, "glTF importer: %s",
                               message);
    ty_aggregate* aggregate = NULL;
    ty_status status = ty_aggregate_gather(job->path, gltf, &aggregate, error);
    if (status == TY_OK)
        status = ty_aggregate_send(output_fd, aggregate, error);
    ty_aggregate_destroy(aggregate);
    ty_gltf_destroy(gltf);
    return status;
}

// --- in the parent ---

ty_status ty_aggregate_validate(const char* path, const ty_aggregate* a, ty_error* error)
{
    if (a->instance_count == 0)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "no instances");
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        if (a->prototype_index[i] >= (uint32_t)a->prototype_count)
            return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "instance %u: prototype %u is missing", i,
                                   a->prototype_index[i]);
        if (!ty_placement_is_regular(&a->transforms[i]))
            return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "instance %u: its matrix is singular or not finite",
                                   i);
        if ((a->velocities && !ty_is_finite3(a->velocities[i])) || (a->spins && !ty_is_finite3(a->spins[i])))
            return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "instance %u: its velocity is not finite", i);
        for (int k = 0; k < a->attribute_count; k++)
            if (!isfinite(a->attributes[k].values[i]))
                return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "instance %u: %s is not finite", i,
                                       a->attributes[k].name);
    }
    return TY_OK;
}

static void read_extras(const json_t* root, ty_aggregate* a)
{
    const json_t* own = json_object_get(json_object_get(json_object_get(root, "asset"), "extras"), "tsuya");
    const char* recipe = json_string_value(json_object_get(own, "recipe"));
    const char* hash = json_string_value(json_object_get(own, "hash"));
    const json_t* metrics = json_object_get(own, "metrics");
    a->recipe = recipe ? ty_string_copy(recipe) : NULL;
    a->hash = hash ? ty_string_copy(hash) : NULL;
    a->metrics = json_is_object(metrics) ? ty_json_text(metrics) : NULL;
}

// A prototype of one material has a slot of that name.
static void read_slots(const json_t* root, ty_aggregate* a)
{
    const json_t *meshes = json_object_get(root, "meshes"), *materials = json_object_get(root, "materials");
    for (int i = 0; i < a->prototype_count; i++)
    {
        const json_t* primitives = json_object_get(json_array_get(meshes, (size_t)i), "primitives");
        const json_t* material = json_object_get(json_array_get(primitives, 0), "material");
        if (json_array_size(primitives) != 1 || !json_is_integer(material) || json_integer_value(material) < 0)
            continue;
        const json_t* found = json_array_get(materials, (size_t)json_integer_value(material));
        const char* name = json_string_value(json_object_get(found, "name"));
        if (name && name[0])
            (void)ty_mesh_add_slot(a->prototypes[i], name); // the first of the mesh
    }
}

static ty_status read_glb(const char* path, const ty_bytes* bytes, ty_aggregate** out, ty_error* error)
{
    ty_glb glb;
    json_t* root = NULL;
    ty_status status = ty_glb_split(path, bytes->data, bytes->size, &glb, error);
    if (status == TY_OK)
        status = ty_gltf_check_aggregate(path, &glb, &root, error);
    if (status != TY_OK)
        return status;
    ty_bytes sent = {0};
    ty_child_def def = {0};
    import_job job = {path, bytes};
    status = ty_child_run(&def, import, &job, &sent, error);
    if (status == TY_OK)
    {
        status = ty_aggregate_receive(path, sent.data, sent.size, out, error);
        ty_bytes_term(&sent);
    }
    if (status == TY_OK)
    {
        read_extras(root, *out);
        read_slots(root, *out);
    }
    json_decref(root);
    return status;
}

// --- what its generator left ---

static ty_status take_state(const char* name, const ty_glb* glb, const json_t* root, ty_bytes* out, ty_error* error)
{
    const json_t* own = ty_gltf_extension(root, TY_GLTF_STATE);
    const json_t* views = json_object_get(root, "bufferViews");
    int64_t index;
    if (!own)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0,
                               "holds no state to go on from: the recipe's settle.state keeps one");
    if (json_array_size(views) == 0 || !ty_gltf_read_index(own, "bufferView", -2, json_array_size(views) - 1, &index))
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "%s.bufferView names none of the %zu views",
                               TY_GLTF_STATE, json_array_size(views));
    const json_t* view = json_array_get(views, (size_t)index); // checked against the bytes already
    size_t offset = (size_t)json_integer_value(json_object_get(view, "byteOffset"));
    size_t size = (size_t)json_integer_value(json_object_get(view, "byteLength"));
    *out = (ty_bytes){TY_TRY_ALLOC(uint8_t, size + 1), size};
    if (!out->data)
        return ty_error_set_at(error, TY_NO_MEMORY, name, 0, 0, "no memory for a state of %zu bytes", size);
    memcpy(out->data, glb->bin + offset, size);
    return TY_OK;
}

ty_status ty_aggregate_find_state(const char* name, const void* bytes, size_t size, ty_bytes* out, ty_error* error)
{
    ty_glb glb;
    json_t* root = NULL;
    *out = (ty_bytes){0};
    ty_status status = ty_glb_split(name, bytes, size, &glb, error);
    if (status == TY_OK)
        status = ty_gltf_check_aggregate(name, &glb, &root, error);
    if (status == TY_OK)
        status = take_state(name, &glb, root, out, error);
    json_decref(root);
    return status;
}

ty_status ty_aggregate_read_state(const char* path, ty_bytes* out, ty_error* error)
{
    ty_bytes file;
    *out = (ty_bytes){0};
    ty_status status = ty_file_read(path, TY_GLB_SIZE_MAX, &file, error);
    if (status != TY_OK)
        return status;
    status = ty_aggregate_find_state(path, file.data, file.size, out, error);
    ty_bytes_term(&file);
    return status;
}

ty_status ty_aggregate_read(const char* path, const ty_mesh* points_prototype, ty_aggregate** out, ty_error* error)
{
    *out = NULL;
    ty_bytes bytes;
    ty_status status = ty_file_read(path, TY_GLB_SIZE_MAX, &bytes, error);
    if (status != TY_OK)
        return status;
    ty_aggregate* aggregate = NULL;
    if (strcasecmp(ty_path_extension(path), "ply") == 0)
        status = ty_points_read_memory(path, bytes.data, bytes.size, points_prototype, &aggregate, error);
    else
        status = read_glb(path, &bytes, &aggregate, error);
    ty_bytes_term(&bytes);
    if (status == TY_OK)
        status = ty_aggregate_validate(path, aggregate, error);
    if (status == TY_OK)
        *out = aggregate;
    else
    {
        ty_aggregate_destroy(aggregate);
        // A crashed importer and a mesh at fault do not know the file.
        if (error && !error->file[0])
            snprintf(error->file, sizeof error->file, "%s", path);
    }
    return status;
}
