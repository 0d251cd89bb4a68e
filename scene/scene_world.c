// SPDX-License-Identifier: Apache-2.0
// The frozen world: attributes of instances, objects and their trees, depth fields, the shading context.
#include "loader.h"
#include "nearest.h"
#include <string.h>
#include <tsuya/base/log.h>

// An object's aggregate must have every attribute that its material uses.
static void check_attribute(ty_loader* loader, const ty_object_entry* entry, const ty_attribute_use* use)
{
    const ty_asset* asset = &loader->assets[entry->asset];
    const char* name = loader->scene->attribute_names[use->attribute];
    if (ty_aggregate_find_attribute(asset->aggregate, name))
        return;
    int count = asset->aggregate->attribute_count;
    const char** names = TY_ALLOC(const char*, count);
    for (int i = 0; i < count; ++i)
        names[i] = asset->aggregate->attributes[i].name;
    char nearest[TY_NEAREST_SIZE];
    ty_nearest(name, names, count, nearest);
    ty_free(names);
    ty_report(loader->errors, use->place, TY_BAD_INPUT, "aggregate '%.100s' has no attribute '%.100s'%s", asset->name,
              name, count ? nearest : "; it has none");
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

void ty_build_attributes(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    for (int i = 0; i < scene->object_count; ++i)
    {
        const ty_object_entry* entry = &loader->objects[i];
        const ty_aggregate* aggregate = entry->asset >= 0 ? loader->assets[entry->asset].aggregate : NULL;
        set_attributes(loader, &scene->objects[i], aggregate);
        for (int u = 0; aggregate && u < loader->use_count; ++u)
            if (loader->uses[u].material == entry->material)
                check_attribute(loader, entry, &loader->uses[u]);
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
               "misoriented): light "
               "is not kept inside",
               name, topology.boundary_edges, topology.nonmanifold_edges, topology.misoriented_edges);
    return topology.closed;
}

static void warn_untextured(ty_loader* loader, const ty_object_entry* entry, const ty_mesh* mesh, const char* name)
{
    if (loader->textured[entry->material] && !mesh->uvs)
        ty_log(TY_LOG_WARNING, "'%s' has no texture coordinates: textures of material '%s' are constant on it", name,
               loader->scene->material_names[entry->material]);
}

static ty_status add_object(ty_loader* loader, int index, ty_error* error)
{
    ty_scene* scene = loader->scene;
    const ty_object_entry* entry = &loader->objects[index];
    const ty_asset* asset = &loader->assets[entry->asset];
    const ty_material* material = scene->materials[entry->material];
    ty_object_flags flags = {.closed_subsurface = ty_material_is_subsurface(material), .camera_visible = true};
    uint32_t number = 0, prototype = 0;
    ty_status status = TY_OK;
    if (asset->aggregate)
    {
        for (int i = 0; i < asset->aggregate->prototype_count; ++i)
        {
            const ty_mesh* mesh = asset->aggregate->prototypes[i];
            flags.closed_subsurface = flags.closed_subsurface && is_closed(mesh, asset->name);
            warn_untextured(loader, entry, mesh, asset->name);
        }
        status = ty_world_add_aggregate(scene->world, asset->aggregate, &entry->transform, flags, &number, error);
    }
    else
    {
        flags.closed_subsurface = flags.closed_subsurface && is_closed(asset->mesh, asset->name);
        warn_untextured(loader, entry, asset->mesh, asset->name);
        status = ty_world_add_prototype(scene->world, asset->mesh, &prototype, error);
        if (status == TY_OK)
            status = ty_world_add_object(scene->world, prototype, &entry->transform, flags, &number, error);
    }
    TY_ASSERT(status != TY_OK || number == (uint32_t)index);
    return status;
}

static void need_depth(ty_loader* loader, int object, bool* needed)
{
    ty_scene* scene = loader->scene;
    if (!ty_material_needs_depth(scene->materials[scene->objects[object].material]))
        return;
    for (uint32_t i = 0; i < scene->objects[object].instance_count; ++i)
        needed[ty_world_prototype(scene->world, (uint32_t)object, i)] = true;
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
    ty_status status = TY_OK;
    for (uint32_t i = 0; i < count && status == TY_OK; ++i)
    {
        scene->triangle_count += ty_world_prototype_mesh(scene->world, i)->triangle_count;
        if (needed[i])
            status = ty_depth_field_create(scene->world, i, &scene->depth_fields[i], error);
    }
    return status;
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
                                          .textures = (const ty_texture* const*)scene->textures,
                                          .depth_fields = (const ty_depth_field* const*)scene->depth_fields,
                                          .object_attributes = attributes};
}

// The world has its own copies of where instances stand.
static void release_transforms(struct ty_scene_resources* resources)
{
    for (int i = 0; i < resources->aggregate_count; ++i)
    {
        ty_free(resources->aggregates[i]->transforms);
        ty_free(resources->aggregates[i]->prototype_index);
        resources->aggregates[i]->transforms = NULL;
        resources->aggregates[i]->prototype_index = NULL;
    }
}

void ty_build_world(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    double start = ty_time_now();
    ty_error error = {0};
    ty_world_def def = ty_world_def_default();
    def.path = loader->options->trace_path;
    def.isa = loader->options->isa;
    ty_status status = ty_world_create(&def, &scene->world, &error);
    for (int i = 0; i < scene->object_count && status == TY_OK; ++i)
    {
        status = add_object(loader, i, &error);
        if (status != TY_OK)
            ty_report_error(loader->errors, loader->objects[i].place, scene->objects[i].name, &error);
    }
    if (status != TY_OK && scene->world)
        return;
    if (status == TY_OK)
        status = ty_world_commit(scene->world, &error);
    if (status == TY_OK)
        status = make_depth_fields(loader, &error);
    if (status != TY_OK)
    {
        ty_error_list_add(loader->errors, &error);
        return;
    }
    set_shading(loader);
    release_transforms(scene->resources);
    scene->build_seconds = ty_time_now() - start;
}
