// SPDX-License-Identifier: Apache-2.0
// Material slots of objects: the names of a mesh file to the scene's materials.
#include "loader.h"
#include "nearest.h"
#include "text.h"
#include <string.h>

// The mesh that tells the slots of an object: prototypes of an aggregate share one list.
static const ty_mesh* slot_mesh(const ty_placed_object* placed)
{
    return placed->aggregate ? placed->aggregate->prototypes[0] : placed->mesh;
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

// The slots that `materials` names; those that are not the mesh's are reported.
static void take_slots(ty_loader* loader, const ty_object_entry* entry, const ty_placed_object* placed,
                       uint32_t* materials, bool* given)
{
    const ty_mesh* mesh = slot_mesh(placed);
    for (int i = 0; entry->slots && i < entry->slots->count; ++i)
    {
        const char* name = entry->slots->keys[i].text;
        int slot = find_slot(mesh, name);
        if (slot >= 0)
        {
            materials[slot] = (uint32_t)ty_material_find(loader, entry->slots->items[i]->text);
            given[slot] = true;
            continue;
        }
        if (placed->part)
            continue; // it may be another part's
        char nearest[TY_NEAREST_SIZE];
        ty_nearest(name, (const char* const*)mesh->slot_names, mesh->slot_count, nearest);
        ty_report(loader->errors, entry->slots->keys[i].place, TY_BAD_INPUT, "'%.100s' has no material slot '%.100s'%s",
                  placed->name, name, mesh->slot_count ? nearest : "; it names none");
    }
}

static void resolve(ty_loader* loader, const ty_placed_object* placed, ty_scene_object* object)
{
    const ty_object_entry* entry = &loader->objects[placed->entry];
    const ty_mesh* mesh = slot_mesh(placed);
    uint32_t* materials = TY_ARENA_ALLOC(loader->arena, uint32_t, mesh->slot_count + 1);
    bool* given = TY_ARENA_ALLOC(loader->tree.arena, bool, mesh->slot_count + 1);
    for (int i = 0; i <= mesh->slot_count; ++i)
        materials[i] = object->material;
    take_slots(loader, entry, placed, materials, given);
    if (!entry->def.material)
        warn_left(loader, entry, mesh, given);
    object->slot_materials = materials;
    object->slot_count = (uint32_t)(mesh->slot_count ? mesh->slot_count : 1);
}

// --- glTF scenes: their own materials, unless the object says others ---

static int file_material(const ty_asset* asset, const char* name)
{
    for (int i = 0; i < asset->gltf->material_count; ++i)
        if (strcmp(asset->gltf->materials[i].name, name) == 0)
            return i;
    return strcmp(name, TY_GLTF_NO_MATERIAL) == 0 ? asset->gltf->material_count : -1;
}

static void resolve_part(ty_loader* loader, const ty_placed_object* placed, ty_scene_object* object)
{
    const ty_object_entry* entry = &loader->objects[placed->entry];
    const ty_asset* asset = &loader->assets[entry->asset];
    const ty_mesh* mesh = slot_mesh(placed);
    uint32_t* materials = TY_ARENA_ALLOC(loader->arena, uint32_t, mesh->slot_count);
    bool *given = TY_ARENA_ALLOC(loader->tree.arena, bool, mesh->slot_count), all_equal = true;
    for (int i = 0; i < mesh->slot_count; ++i)
        materials[i] = entry->def.material
                           ? (uint32_t)entry->material
                           : (uint32_t)(asset->first_material + file_material(asset, mesh->slot_names[i]));
    take_slots(loader, entry, placed, materials, given);
    for (int i = 1; i < mesh->slot_count; ++i)
        all_equal &= materials[i] == materials[0];
    object->material = materials[0];
    object->slot_materials = all_equal ? NULL : materials;
    object->slot_count = (uint32_t)mesh->slot_count;
}

static void check_names(ty_loader* loader, const ty_object_entry* entry)
{
    const ty_asset* asset = &loader->assets[entry->asset];
    int count = asset->gltf->material_count;
    for (int i = 0; entry->slots && i < entry->slots->count; ++i)
    {
        const char* name = entry->slots->keys[i].text;
        if (file_material(asset, name) >= 0)
            continue;
        char nearest[TY_NEAREST_SIZE];
        const char** names = TY_ALLOC(const char*, count + 1);
        for (int k = 0; k < count; ++k)
            names[k] = asset->gltf->materials[k].name;
        names[count] = TY_GLTF_NO_MATERIAL;
        ty_report(loader->errors, entry->slots->keys[i].place, TY_BAD_INPUT, "'%.100s' has no material '%.100s'%s",
                  asset->name, name, ty_nearest(name, names, count + 1, nearest));
        ty_free(names);
    }
}

void ty_resolve_slots(ty_loader* loader)
{
    for (int i = 0; i < loader->entry_count; ++i)
        if (loader->objects[i].asset >= 0 && loader->assets[loader->objects[i].asset].kind == TY_ASSET_GLTF)
            check_names(loader, &loader->objects[i]);
    for (int i = 0; i < loader->scene->object_count; ++i)
    {
        const ty_placed_object* placed = &loader->placed[i];
        const ty_object_entry* entry = &loader->objects[placed->entry];
        if ((!placed->mesh && !placed->aggregate) || entry->material < 0)
            continue;
        if (placed->part)
            resolve_part(loader, placed, &loader->scene->objects[i]);
        else if (entry->slots)
            resolve(loader, placed, &loader->scene->objects[i]);
    }
}
