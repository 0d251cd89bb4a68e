// SPDX-License-Identifier: Apache-2.0
// Material slots of objects: the names of a mesh file to the scene's materials.
#include "loader.h"
#include "nearest.h"
#include "text.h"
#include <string.h>

// The mesh that tells the slots of an asset: prototypes of an aggregate share one list.
static const ty_mesh* slot_mesh(const ty_asset* asset)
{
    return asset->aggregate ? asset->aggregate->prototypes[0] : asset->mesh;
}

static int find_slot(const ty_mesh* mesh, const char* name)
{
    for (int i = 0; i < mesh->slot_count; ++i)
        if (strcmp(mesh->slot_names[i], name) == 0)
            return i;
    return -1;
}

static void warn_left(const ty_loader* loader, const ty_object_entry* entry, const ty_mesh* mesh, const bool* given)
{
    ty_text left = {0};
    for (int i = 0; i < mesh->slot_count; ++i)
        if (!given[i])
            ty_text_format(&left, "%s'%.100s'", left.size ? ", " : "", mesh->slot_names[i]);
    if (left.size)
        ty_report_warning(entry->slots->place, "no material for slot%s %.600s of '%.100s': '%.100s' is used",
                          strchr(left.data, ',') ? "s" : "", left.data, loader->assets[entry->asset].name,
                          loader->scene->material_names[entry->material]);
    ty_text_term(&left);
}

static void resolve(ty_loader* loader, const ty_object_entry* entry, ty_scene_object* object)
{
    const ty_asset* asset = &loader->assets[entry->asset];
    const ty_mesh* mesh = slot_mesh(asset);
    uint32_t* materials = TY_ARENA_ALLOC(loader->arena, uint32_t, mesh->slot_count + 1);
    bool* given = TY_ARENA_ALLOC(loader->tree.arena, bool, mesh->slot_count + 1);
    for (int i = 0; i <= mesh->slot_count; ++i)
        materials[i] = object->material;
    for (int i = 0; i < entry->slots->count; ++i)
    {
        const char* name = entry->slots->keys[i].text;
        int slot = find_slot(mesh, name);
        if (slot >= 0)
        {
            materials[slot] = (uint32_t)ty_node_find(loader->material_map, entry->slots->items[i]->text);
            given[slot] = true;
            continue;
        }
        char nearest[TY_NEAREST_SIZE];
        ty_nearest(name, (const char* const*)mesh->slot_names, mesh->slot_count, nearest);
        ty_report(loader->errors, entry->slots->keys[i].place, TY_BAD_INPUT, "'%.100s' has no material slot '%.100s'%s",
                  asset->name, name, mesh->slot_count ? nearest : "; it names none");
    }
    if (!entry->def.material)
        warn_left(loader, entry, mesh, given);
    object->slot_materials = materials;
    object->slot_count = (uint32_t)(mesh->slot_count ? mesh->slot_count : 1);
}

void ty_resolve_slots(ty_loader* loader)
{
    for (int i = 0; i < loader->scene->object_count; ++i)
    {
        const ty_object_entry* entry = &loader->objects[i];
        if (!entry->slots || entry->asset < 0 || entry->material < 0)
            continue;
        if (loader->assets[entry->asset].mesh || loader->assets[entry->asset].aggregate)
            resolve(loader, entry, &loader->scene->objects[i]);
    }
}
