// SPDX-License-Identifier: Apache-2.0
// glTF scenes: opened and checked here, meshes through the importer in a child process.
#include "gltf_mesh.h"
#include "gltf_pack.h"
#include "pipe.h"
#include <stdio.h>
#include <string.h>

// --- opening ---

static void warn_ignored(ty_gltf_scene* scene)
{
    static const char* const unread[][2] = {{"skins", "skins are not applied"},
                                            {"animations", "animations are not played"}};
    const json_t* root = scene->source->root;
    const json_t* used = json_object_get(root, "extensionsUsed");
    for (size_t i = 0; i < json_array_size(used); i++)
    {
        const char* name = json_string_value(json_array_get(used, i));
        if (name && !ty_gltf_knows_extension(name))
            ty_gltf_warn(scene, "the extension %.80s is ignored", name);
    }
    for (size_t i = 0; i < sizeof unread / sizeof unread[0]; i++)
        if (json_array_size(json_object_get(root, unread[i][0])) > 0)
            ty_gltf_warn(scene, "%s", unread[i][1]);
    const json_t* meshes = json_object_get(root, "meshes");
    for (size_t i = 0; i < json_array_size(meshes); i++)
    {
        const json_t* first = json_array_get(json_object_get(json_array_get(meshes, i), "primitives"), 0);
        if (json_object_get(first, "targets"))
            ty_gltf_warn(scene, "morph targets are not applied");
    }
}

static ty_status check(const ty_gltf_source* source, ty_error* error)
{
    uint64_t* sizes = TY_ALLOC(uint64_t, source->buffer_count + 1);
    for (int i = 0; i < source->buffer_count; i++)
        sizes[i] = source->buffers[i].size;
    ty_gltf_checker c = {.name = source->path,
                         .error = error,
                         .root = source->root,
                         .buffer_sizes = sizes,
                         .buffer_count = (size_t)source->buffer_count};
    ty_status status = ty_gltf_check(&c);
    ty_free(sizes);
    return status;
}

static ty_gltf_scene* create(const char* path, ty_gltf_find_fn* find, void* context)
{
    ty_arena* arena = ty_arena_create(0);
    ty_gltf_scene* scene = TY_ARENA_ALLOC(arena, ty_gltf_scene, 1);
    scene->source = TY_ARENA_ALLOC(arena, ty_gltf_source, 1);
    scene->path = ty_arena_string(arena, path);
    *scene->source = (ty_gltf_source){.arena = arena, .find = find, .context = context, .path = scene->path};
    return scene;
}

static ty_status read_all(ty_gltf_scene* scene, const void* bytes, size_t size, ty_error* error)
{
    ty_status status = ty_gltf_source_open(scene->source, bytes, size, error);
    if (status == TY_OK)
        status = check(scene->source, error);
    if (status != TY_OK)
        return status;
    warn_ignored(scene);
    const json_t* extras = json_object_get(json_object_get(scene->source->root, "asset"), "extras");
    // A realised one has extras, but is a mesh.
    bool instanced = json_array_size(json_object_get(scene->source->root, "extensionsUsed")) > 0;
    scene->is_aggregate = instanced && json_object_get(extras, "tsuya") != NULL;
    status = ty_gltf_read_look(scene, error);
    return status == TY_OK ? ty_gltf_read_nodes(scene, error) : status;
}

ty_status ty_gltf_scene_open_memory(const char* path, const void* bytes, size_t size, ty_gltf_find_fn* find,
                                    void* context, ty_gltf_scene** out, ty_error* error)
{
    ty_gltf_scene* scene = create(path, find, context);
    ty_status status = read_all(scene, bytes, size, error);
    if (status != TY_OK)
        ty_gltf_scene_destroy(scene);
    *out = status == TY_OK ? scene : NULL;
    return status;
}

ty_status ty_gltf_scene_open(const char* path, ty_gltf_find_fn* find, void* context, ty_gltf_scene** out,
                             ty_error* error)
{
    ty_bytes bytes;
    *out = NULL;
    ty_status status = ty_file_read(path, TY_GLB_SIZE_MAX, &bytes, error);
    if (status != TY_OK)
        return status;
    status = ty_gltf_scene_open_memory(path, bytes.data, bytes.size, find, context, out, error);
    if (status == TY_OK)
        (*out)->source->file = bytes;
    else
        ty_bytes_term(&bytes);
    return status;
}

void ty_gltf_scene_destroy(ty_gltf_scene* scene)
{
    if (!scene)
        return;
    for (int i = 0; scene->objects && i < scene->object_count; i++)
        ty_aggregate_destroy(scene->objects[i].instances);
    for (int i = 0; scene->meshes && i < scene->mesh_count; i++)
        ty_mesh_destroy(scene->meshes[i]);
    ty_gltf_source_term(scene->source);
    ty_arena_destroy(scene->source->arena);
}

// --- in the child ---

// Every mesh that an object shows, then the instances of every instanced object, in order.
typedef struct import_job
{
    const ty_gltf_scene* scene;
    const bool* wanted; // [mesh_count]
    const char** slots; // [material_count + 1]
} import_job;

static ty_status send_meshes(const import_job* job, const ty_gltf* gltf, int fd, ty_error* error)
{
    const ty_gltf_scene* scene = job->scene;
    const ty_gltf_mesh_job meshes = {.name = scene->path,
                                     .gltf = gltf,
                                     .slot_names = job->slots,
                                     .uv_sets = scene->source->uv_sets,
                                     .material_count = scene->material_count,
                                     .error = error};
    ty_status status = TY_OK;
    for (int i = 0; i < scene->mesh_count && status == TY_OK; i++)
    {
        ty_mesh* mesh = NULL;
        if (!job->wanted[i])
            continue;
        status = ty_gltf_gather_mesh(&meshes, i, &mesh);
        if (status == TY_OK)
            status = ty_mesh_send(fd, mesh, error);
        ty_mesh_destroy(mesh);
    }
    return status;
}

static ty_status send_instances(const import_job* job, const ty_gltf* gltf, int fd, ty_error* error)
{
    ty_status status = TY_OK;
    for (int i = 0; i < job->scene->object_count && status == TY_OK; i++)
    {
        ty_aggregate* instances = NULL;
        if (!job->scene->objects[i].is_instanced)
            continue;
        status = ty_aggregate_gather_node(job->scene->path, gltf, job->scene->objects[i].node, &instances, error);
        if (status == TY_OK)
            status = ty_aggregate_send(fd, instances, error);
        ty_aggregate_destroy(instances);
    }
    return status;
}

static ty_status import(const void* context, int output_fd, ty_error* error)
{
    const import_job* job = context;
    char message[400] = "";
    bool out_of_memory;
    ty_bytes packed;
    ty_status status = ty_gltf_pack(job->scene->source, &packed, error);
    if (status != TY_OK)
        return status;
    ty_gltf* gltf = ty_gltf_load(packed.data, packed.size, message, sizeof message, &out_of_memory);
    ty_bytes_term(&packed);
    if (!gltf)
        return ty_error_set_at(error, out_of_memory ? TY_NO_MEMORY : TY_BAD_FILE, job->scene->path, 0, 0,
                               "glTF importer: %s", message);
    status = send_meshes(job, gltf, output_fd, error);
    if (status == TY_OK)
        status = send_instances(job, gltf, output_fd, error);
    ty_gltf_destroy(gltf);
    return status;
}

// --- in the parent ---

// One slot is no choice between slots.
static void drop_single_slot(ty_mesh* mesh)
{
    if (mesh->slot_count > 1)
        return;
    ty_free(mesh->slots);
    mesh->slots = NULL;
}

static ty_status take_instances(ty_gltf_scene* scene, ty_gltf_object* object, ty_receiver* r)
{
    ty_status status = ty_aggregate_take(r, &object->instances);
    if (status != TY_OK)
        return status;
    ty_aggregate* a = object->instances;
    ty_free(a->prototypes);
    a->prototypes = TY_ALLOC(ty_mesh*, 1);
    a->prototypes[0] = scene->meshes[object->mesh];
    a->prototype_count = 1;
    a->borrows_prototypes = true;
    return ty_aggregate_validate(scene->path, a, r->error);
}

static ty_status receive(ty_gltf_scene* scene, const bool* wanted, const ty_bytes* bytes, ty_error* error)
{
    ty_receiver r = {scene->path, bytes->data, bytes->size, error};
    ty_status status = TY_OK;
    for (int i = 0; i < scene->mesh_count && status == TY_OK; i++)
    {
        if (!wanted[i])
            continue;
        status = ty_mesh_take(&r, i, &scene->meshes[i]);
        if (status == TY_OK)
            drop_single_slot(scene->meshes[i]);
    }
    for (int i = 0; i < scene->object_count && status == TY_OK; i++)
        if (scene->objects[i].is_instanced)
            status = take_instances(scene, &scene->objects[i], &r);
    return status == TY_OK ? ty_receive_end(&r) : status;
}

ty_status ty_gltf_scene_read_meshes(ty_gltf_scene* scene, ty_error* error)
{
    if (scene->source->meshes_read)
        return TY_OK;
    bool* wanted = TY_ALLOC(bool, scene->mesh_count + 1);
    const char** slots = TY_ALLOC(const char*, scene->material_count + 1);
    for (int i = 0; i < scene->object_count; i++)
        wanted[scene->objects[i].mesh] = true;
    for (int i = 0; i < scene->material_count; i++)
        slots[i] = scene->materials[i].name;
    slots[scene->material_count] = TY_GLTF_NO_MATERIAL;
    ty_bytes sent = {0};
    ty_child_def def = {0};
    import_job job = {scene, wanted, slots};
    ty_status status = scene->object_count ? ty_child_run(&def, import, &job, &sent, error) : TY_OK;
    if (status == TY_OK && scene->object_count)
        status = receive(scene, wanted, &sent, error);
    ty_bytes_term(&sent);
    ty_free(slots);
    ty_free(wanted);
    scene->source->meshes_read = status == TY_OK;
    if (status != TY_OK && error && !error->file[0])
        snprintf(error->file, sizeof error->file, "%s", scene->path); // a crashed importer does not know the file
    return status;
}
