// SPDX-License-Identifier: Apache-2.0
// The frozen world: attributes of instances, objects and their trees, depth fields, the shading context.
#include "loader.h"
#include "nearest.h"
#include <string.h>
#include <tsuya/base/log.h>

// The meshes of an object: one, or an aggregate's prototypes.
typedef struct meshes
{
    ty_mesh* const* items;
    int count;
} meshes;

static meshes meshes_of(const ty_placed_object* placed)
{
    if (placed->aggregate)
        return (meshes){placed->aggregate->prototypes, placed->aggregate->prototype_count};
    return (meshes){&placed->mesh, placed->mesh ? 1 : 0};
}

void ty_bind_objects(ty_loader* loader)
{
    for (int i = 0; i < loader->scene->object_count; ++i)
    {
        ty_placed_object* placed = &loader->placed[i];
        int index = loader->objects[placed->entry].asset;
        const ty_asset* asset = index >= 0 ? &loader->assets[index] : NULL;
        if (!asset)
            continue;
        placed->mesh = placed->part ? asset->gltf->meshes[placed->part->mesh] : asset->mesh;
        placed->aggregate = placed->part ? placed->part->instances : asset->aggregate;
        if (placed->aggregate)
            placed->mesh = NULL;
    }
}

static bool has_attribute(const ty_placed_object* asset, const char* name)
{
    if (asset->aggregate && ty_aggregate_find_attribute(asset->aggregate, name))
        return true;
    meshes all = meshes_of(asset);
    for (int i = 0; i < all.count; ++i)
        if (!ty_mesh_find_attribute(all.items[i], name))
            return false;
    return all.count > 0;
}

// What an object's material takes from an attribute must be there: of the instances, else of the vertices.
static void check_attribute(ty_loader* loader, const ty_placed_object* asset, const ty_attribute_use* use)
{
    const char* name = loader->scene->attribute_names[use->attribute];
    if (has_attribute(asset, name))
        return;
    meshes all = meshes_of(asset);
    int of_instances = asset->aggregate ? asset->aggregate->attribute_count : 0, count = 0;
    const char** names = TY_ALLOC(const char*, of_instances + all.items[0]->attribute_count + 1);
    if (asset->aggregate)
        names[count++] = "height"; // made where it is asked for
    for (int i = 0; i < of_instances; ++i)
        names[count++] = asset->aggregate->attributes[i].name;
    for (int i = 0; i < all.items[0]->attribute_count; ++i)
        if (has_attribute(asset, all.items[0]->attributes[i].name))
            names[count++] = all.items[0]->attributes[i].name;
    char nearest[TY_NEAREST_SIZE];
    ty_nearest(name, names, count, nearest);
    ty_free(names);
    ty_report(loader->errors, use->place, TY_BAD_INPUT, "%s '%.100s' has no attribute '%.100s'%s",
              asset->aggregate ? "aggregate" : "mesh", asset->name, name, count ? nearest : "; it has none");
}

// Where the file of an aggregate says nothing else, `height` is where its instances stand in it: 0 the lowest, 1 the
// highest.
void ty_compute_height(const ty_aggregate* aggregate, float* height)
{
    float low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < aggregate->instance_count; ++i)
    {
        low = ty_min(low, aggregate->transforms[i].t.y);
        high = ty_max(high, aggregate->transforms[i].t.y);
    }
    for (uint32_t i = 0; i < aggregate->instance_count; ++i)
        height[i] = high > low ? (aggregate->transforms[i].t.y - low) / (high - low) : 1.0f;
}

static void set_attributes(ty_loader* loader, ty_scene_object* object, const ty_aggregate* aggregate)
{
    ty_scene* scene = loader->scene;
    const float** values = TY_ARENA_ALLOC(loader->arena, const float*, scene->attribute_count);
    for (int i = 0; aggregate && i < scene->attribute_count; ++i)
    {
        const ty_instance_attribute* attribute = ty_aggregate_find_attribute(aggregate, scene->attribute_names[i]);
        values[i] = attribute ? attribute->values : NULL;
    }
    object->attributes = values;
    object->ids = aggregate ? aggregate->ids : NULL;
    object->instance_count = aggregate ? aggregate->instance_count : 1;
}

static bool shows_material(const ty_scene_object* object, int material)
{
    for (uint32_t k = 0; k < ty_scene_material_count(object); ++k)
        if (ty_scene_material_at(object, k) == (uint32_t)material)
            return true;
    return false;
}

void ty_build_attributes(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    for (int i = 0; i < scene->object_count; ++i)
    {
        const ty_placed_object* placed = &loader->placed[i];
        for (int a = 0; placed->aggregate && a < scene->attribute_count; ++a)
            if (strcmp(scene->attribute_names[a], "height") == 0 && !has_attribute(placed, "height"))
                ty_compute_height(placed->aggregate, ty_aggregate_add_attribute(placed->aggregate, "height"));
        set_attributes(loader, &scene->objects[i], placed->aggregate);
        for (int u = 0; meshes_of(placed).count > 0 && u < loader->use_count; ++u)
            if (shows_material(&scene->objects[i], loader->uses[u].material))
                check_attribute(loader, placed, &loader->uses[u]);
    }
}

// Whether a mesh encloses matter; says why not.
static bool is_closed(const ty_mesh* mesh, const char* name)
{
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    if (!topology.closed)
        ty_log(TY_LOG_WARNING,
               "'%s' has a translucent material but is not closed (%u boundary edges, %u non-manifold, %u "
               "misoriented): light gets out of it through the gaps (walks with a diffuse boundary then leave where "
               "they entered), and its inner side is seen",
               name, topology.boundary_edges, topology.nonmanifold_edges, topology.misoriented_edges);
    return topology.closed;
}

static void warn_untextured(const ty_loader* loader, const ty_scene_object* object, const ty_mesh* mesh,
                            const char* name)
{
    for (uint32_t k = 0; !mesh->uvs && k < ty_scene_material_count(object); ++k)
        if (loader->textured[ty_scene_material_at(object, k)])
            ty_log(TY_LOG_WARNING, "'%s' has no texture coordinates: textures of material '%s' are constant on it",
                   name, loader->scene->material_names[ty_scene_material_at(object, k)]);
}

// Looked at once: neither meshes nor materials change their kind from frame to frame.
static ty_object_flags object_flags(const ty_loader* loader, const ty_scene_object* object,
                                    const ty_placed_object* asset)
{
    ty_object_flags flags = {0}; // the mask is looked at again for every frame
    bool scatters = false;
    uint64_t both = 0; // slots that are met from either side
    for (uint32_t k = 0; k < ty_scene_material_count(object); ++k)
    {
        const ty_material* material = loader->scene->materials[ty_scene_material_at(object, k)];
        *(ty_material_is_subsurface(material) ? &flags.one_sided : &both) |= ty_slot_bit(k);
        scatters = scatters || (ty_material_traits(material) & TY_TRAIT_SCATTERING);
    }
    flags.one_sided &= ~both; // the last bit stands for many
    bool is_body = flags.one_sided || scatters;
    meshes all = meshes_of(asset);
    for (int i = 0; i < all.count; ++i)
    {
        if (is_body && !is_closed(all.items[i], asset->name))
            flags.one_sided = 0;
        warn_untextured(loader, object, all.items[i], asset->name);
    }
    return flags;
}

// What moves while the shutter is open; steps has room for all of a part's, which its entry carries along.
static ty_motion object_motion(const ty_object_entry* entry, const ty_placed_object* placed,
                               ty_affine steps[TY_MOTION_MAX_STEPS])
{
    ty_motion motion = entry->step_count > 0 ? (ty_motion){.steps = entry->built_steps, .step_count = entry->step_count}
                                             : ty_motion_at_rest(&entry->transform);
    if (!placed->part)
        return motion;
    for (int i = 0; i < motion.step_count; ++i)
        steps[i] = ty_affine_multiply(&motion.steps[i], &placed->part->to_file);
    return (ty_motion){.steps = steps, .step_count = motion.step_count};
}

// Of those that shadow rays stop at; opacity may change from frame to frame.
static uint32_t object_mask(const ty_scene* scene, const ty_scene_object* object)
{
    uint32_t mask = object->mask;
    for (uint32_t k = 0; k < ty_scene_material_count(object); ++k)
        if (ty_material_traits(scene->materials[ty_scene_material_at(object, k)]) & TY_TRAIT_TRANSPARENT)
            return (mask & ~(uint32_t)TY_MASK_SHADOW) | (mask & TY_MASK_SHADOW ? TY_MASK_SHADOW_TRANSPARENT : 0u);
    return mask;
}

static ty_status add_object(ty_loader* loader, int index, ty_error* error)
{
    ty_scene* scene = loader->scene;
    ty_placed_object* placed = &loader->placed[index];
    ty_affine steps[TY_MOTION_MAX_STEPS];
    ty_motion motion = object_motion(&loader->objects[placed->entry], placed, steps);
    int asset = loader->objects[placed->entry].asset;
    float scale = asset >= 0 ? loader->assets[asset].velocity_scale : 0.0f;
    motion.open = scale * loader->shutter[0];
    motion.close = scale * loader->shutter[1];
    if (!placed->flags_known)
        placed->flags = object_flags(loader, &scene->objects[index], placed);
    placed->flags_known = true;
    ty_object_flags flags = placed->flags;
    flags.mask = placed->built_mask = object_mask(scene, &scene->objects[index]);
    uint32_t number = 0, prototype = 0;
    ty_status status = TY_OK;
    if (placed->aggregate)
    {
        status = ty_world_add_aggregate(scene->world, placed->aggregate, motion, flags, &number, error);
    }
    else
    {
        status = ty_world_add_prototype(scene->world, placed->mesh, &prototype, error);
        if (status == TY_OK)
            status = ty_world_add_object(scene->world, prototype, motion, flags, &number, error);
    }
    TY_ASSERT(status != TY_OK || number == (uint32_t)index);
    return status;
}

static bool shows_depth(const ty_scene* scene, const ty_scene_object* object)
{
    for (uint32_t k = 0; k < ty_scene_material_count(object); ++k)
        if (ty_material_needs_depth(scene->materials[ty_scene_material_at(object, k)]))
            return true;
    return false;
}

static void need_depth(ty_loader* loader, int object, bool* needed)
{
    ty_scene* scene = loader->scene;
    if (!shows_depth(scene, &scene->objects[object]))
        return;
    for (uint32_t i = 0; i < scene->objects[object].instance_count; ++i)
        needed[ty_world_prototype(scene->world, (uint32_t)object, i)] = true;
}

typedef struct depth_job
{
    const ty_world* world;
    const bool* needed;
    ty_depth_field** fields;
    ty_status* statuses;
} depth_job;

static void make_some_depth_fields(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const depth_job* job = context;
    for (int64_t i = begin; i < end; ++i)
        if (job->needed[i])
            job->statuses[i] = ty_depth_field_create(job->world, (uint32_t)i, &job->fields[i], NULL);
}

static ty_status make_depth_fields(ty_loader* loader, ty_error* error)
{
    ty_scene* scene = loader->scene;
    uint32_t count = ty_world_prototype_count(scene->world);
    scene->depth_fields = TY_ARENA_ALLOC(loader->arena, ty_depth_field*, count);
    scene->resources->depth_field_count = count;
    bool* needed = TY_ARENA_ALLOC(loader->tree.arena, bool, count);
    for (int i = 0; i < scene->object_count; ++i)
        need_depth(loader, i, needed);
    depth_job job = {scene->world, needed, scene->depth_fields, TY_ARENA_ALLOC(loader->tree.arena, ty_status, count)};
    if (!ty_parallel_for(loader->options->workers, count, 1, make_some_depth_fields, &job))
        return ty_error_set(error, TY_INTERRUPTED, "stopped while loading");
    for (uint32_t i = 0; i < count; ++i)
    {
        const ty_mesh* mesh = ty_world_prototype_mesh(scene->world, i);
        scene->triangle_count += mesh ? mesh->triangle_count : 0;
        if (job.statuses[i] != TY_OK)
            return ty_error_set(error, job.statuses[i], "no memory for the depth field of %u vertices",
                                mesh ? mesh->vertex_count : 0);
    }
    return TY_OK;
}

// By prototype, in the order of attribute names.
static const ty_mesh_attribute* const* const* vertex_attributes(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    uint32_t count = ty_world_prototype_count(scene->world);
    const ty_mesh_attribute* const** all = TY_ARENA_ALLOC(loader->arena, const ty_mesh_attribute* const*, count);
    for (uint32_t i = 0; i < count; ++i)
    {
        const ty_mesh_attribute** found =
            TY_ARENA_ALLOC(loader->arena, const ty_mesh_attribute*, scene->attribute_count);
        for (int k = 0; k < scene->attribute_count; ++k)
            found[k] = ty_mesh_find_attribute(ty_world_prototype_mesh(scene->world, i), scene->attribute_names[k]);
        all[i] = found;
    }
    return all;
}

static void set_shading(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    const float* const** attributes = TY_ARENA_ALLOC(loader->arena, const float* const*, scene->object_count);
    for (int i = 0; i < scene->object_count; ++i)
    {
        attributes[i] = scene->objects[i].attributes;
        scene->instance_count += scene->objects[i].instance_count;
    }
    scene->shading = (ty_shading_context){.world = scene->world,
                                          .textures = (const ty_mip_texture* const*)scene->surface_textures,
                                          .depth_fields = (const ty_depth_field* const*)scene->depth_fields,
                                          .object_attributes = attributes,
                                          .vertex_attributes = vertex_attributes(loader)};
}

// All objects into a world without any, and its tree; false after reports.
static bool fill_world(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    ty_error error = {0};
    for (int i = 0; i < scene->object_count; ++i)
    {
        if (add_object(loader, i, &error) == TY_OK)
            continue;
        ty_report_error(loader->errors, loader->objects[loader->placed[i].entry].place, scene->objects[i].name, &error);
        return false;
    }
    loader->world_changed = false;
    loader->instances_move = false;
    for (int i = 0; i < scene->object_count; ++i)
        loader->instances_move |= loader->placed[i].aggregate != NULL && ty_world_is_moving(scene->world, (uint32_t)i);
    ty_settle_moves(loader);
    if (ty_world_commit(scene->world, &error) == TY_OK)
        return true;
    ty_error_list_add(loader->errors, &error);
    return false;
}

void ty_build_world(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    double start = ty_time_now();
    ty_error error = {0};
    ty_world_def def = ty_world_def_default();
    def.path = loader->options->trace_path;
    def.isa = loader->options->isa;
    def.workers = loader->options->workers;
    ty_status status = ty_world_create(&def, &scene->world, &error);
    if (status == TY_OK)
    {
        if (!fill_world(loader))
            return;
        status = make_depth_fields(loader, &error);
    }
    if (status != TY_OK)
    {
        ty_error_list_add(loader->errors, &error);
        return;
    }
    set_shading(loader);
    scene->build_seconds = ty_time_now() - start;
}

bool ty_world_is_stale(const ty_loader* loader)
{
    for (int i = 0; i < loader->scene->object_count; ++i)
        if (loader->placed[i].built_mask != object_mask(loader->scene, &loader->scene->objects[i]))
            return true;
    return loader->world_changed;
}

// A mesh that changed gets its tree anew, under the same number.
static bool renew_prototypes(ty_loader* loader)
{
    ty_world* world = loader->scene->world;
    ty_error error;
    for (uint32_t i = 0; i < ty_world_prototype_count(world); ++i)
    {
        const ty_mesh* mesh = ty_world_prototype_mesh(world, i);
        uint32_t number = i;
        if (!mesh || !ty_mesh_has_changed(loader, mesh))
            continue;
        ty_world_remove_prototype(world, i);
        if (ty_world_add_prototype(world, mesh, &number, &error) != TY_OK)
        {
            ty_error_list_add(loader->errors, &error);
            return false;
        }
        TY_ASSERT(number == i);
        ++loader->scene->rebuilds.meshes;
    }
    return true;
}

static void renew_depth_fields(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    ty_error error;
    for (uint32_t i = 0; i < scene->resources->depth_field_count; ++i)
    {
        const ty_mesh* mesh = ty_world_prototype_mesh(scene->world, i);
        if (!scene->depth_fields[i] || !mesh || !ty_mesh_has_changed(loader, mesh))
            continue;
        ty_depth_field_destroy(scene->depth_fields[i]);
        scene->depth_fields[i] = NULL;
        if (ty_depth_field_create(scene->world, i, &scene->depth_fields[i], &error) != TY_OK)
            ty_error_list_add(loader->errors, &error);
    }
}

void ty_rebuild_world(ty_loader* loader)
{
    ty_world_clear_objects(loader->scene->world);
    if (renew_prototypes(loader) && fill_world(loader))
        renew_depth_fields(loader);
}
