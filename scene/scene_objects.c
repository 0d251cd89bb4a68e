// SPDX-License-Identifier: Apache-2.0
// The section `objects`: references to assets and materials, and where each object stands.
#include "loader.h"
#include "nearest.h"
#include "number.h"
#include <string.h>

// One number for all three axes, written out, so that the table sees three.
static void spread_scale(ty_loader* loader, ty_node* node)
{
    int index = ty_node_find(node, "scale");
    ty_node* one = index < 0 ? NULL : node->items[index];
    double value = 0.0;
    if (!one || one->kind != TY_NODE_SCALAR || !ty_number_parse(one->text, &value))
        return; // what it is instead is reported by the table
    ty_node* list = ty_node_create(&loader->tree, TY_NODE_LIST, one->place);
    for (int i = 0; list && i < 3; ++i)
        ty_node_append(&loader->tree, list, one);
    if (list)
        node->items[index] = list;
}

// Whether it is what the key `mesh`, `aggregate` or `gltf` (0, 1, 2) means.
static bool is_geometry(const ty_asset* asset, int kind)
{
    static const ty_product products[] = {TY_PRODUCT_MESH, TY_PRODUCT_AGGREGATE};
    if (asset->kind == TY_ASSET_NONE)
        return true; // reported where it is defined
    if (asset->kind == TY_ASSET_RECIPE)
        return kind < 2 && asset->recipe.generator->product == products[kind];
    if (kind == 2)
        return asset->kind == TY_ASSET_GLTF;
    return kind == 1 ? asset->kind == TY_ASSET_AGGREGATE
                     : asset->kind == TY_ASSET_MESH || asset->kind == TY_ASSET_SHAPE;
}

static void find_asset(ty_loader* loader, const ty_node* node, ty_object_entry* entry)
{
    static const char* const keys[] = {"mesh", "aggregate", "gltf"};
    static const char* const what[] = {"mesh or shape", "aggregate", "glTF scene"};
    const ty_node* name = NULL;
    int kind = 0;
    for (int i = 0; i < 3; ++i)
    {
        const ty_node* value = ty_node_get(node, keys[i]);
        if (value && name)
        {
            ty_report(loader->errors, value->place, TY_BAD_INPUT, "either '%s' or '%s', not both", keys[kind], keys[i]);
            return;
        }
        kind = value ? i : kind;
        name = value ? value : name;
    }
    if (!name)
    {
        ty_report(loader->errors, node->place, TY_BAD_INPUT, "missing key 'mesh', 'aggregate' or 'gltf' of an object");
        return;
    }
    entry->asset = ty_asset_find(loader, name);
    if (entry->asset < 0)
        return;
    ty_asset* asset = &loader->assets[entry->asset];
    asset->used = true;
    if (asset->prototype >= 0)
        loader->assets[asset->prototype].used = true;
    if (!is_geometry(asset, kind))
        ty_report(loader->errors, name->place, TY_BAD_INPUT, "asset '%.200s' is no %s", asset->name, what[kind]);
}

static int find_material(ty_loader* loader, const ty_node* name)
{
    char nearest[TY_NEAREST_SIZE];
    if (name->kind != TY_NODE_SCALAR || !name->text[0])
        return -1;
    int found = ty_material_find(loader, name->text);
    if (found < 0)
        ty_report(loader->errors, name->place, TY_BAD_INPUT, "no material '%.200s'%s", name->text,
                  ty_nearest_key(name->text, loader->material_map, nearest));
    return found;
}

// What the slots mean is known when the mesh is; that every material exists, here. The first of the slots takes what
// nobody names.
static void find_materials(ty_loader* loader, const ty_node* node, ty_object_entry* entry)
{
    const ty_node *name = ty_node_get(node, "material"), *slots = ty_node_get(node, "materials");
    bool has_slots = slots && slots->kind == TY_NODE_MAP && slots->count > 0;
    bool has_own = entry->asset >= 0 && loader->assets[entry->asset].kind == TY_ASSET_GLTF;
    if (has_own)
        entry->material = loader->assets[entry->asset].first_material;
    if (!has_own && !name && (!slots || ty_node_is_empty(slots)) && !(slots && slots->bad))
        ty_report(loader->errors, node->place, TY_BAD_INPUT, "missing key 'material' (or 'materials') of an object");
    if (name)
        entry->material = find_material(loader, name);
    for (int i = 0; has_slots && i < slots->count; ++i)
    {
        int found = find_material(loader, slots->items[i]);
        if (!name && !has_own && i == 0)
            entry->material = found;
    }
    entry->slots = has_slots ? slots : NULL;
}

static void place_object(ty_loader* loader, const ty_node* node, ty_object_entry* entry)
{
    const ty_object_def* def = &entry->def;
    ty_affine turn, inverse;
    entry->transform = ty_affine_from_trs(def->translate, ty_quat_euler(def->rotate), def->scale);
    if (loader->scene->turntable.turn == TY_TURN_OBJECTS && ty_turntable_map(loader->scene, &turn))
        entry->transform = ty_affine_multiply(&turn, &entry->transform);
    const ty_node* scale = ty_node_get(node, "scale");
    if (!ty_affine_invert(&entry->transform, &inverse))
        ty_report(loader->errors, scale ? scale->place : node->place, TY_BAD_INPUT,
                  "'scale': zero along an axis would make the object flat");
}

static uint32_t mask_of(const ty_visible_def* v)
{
    return (v->camera ? TY_MASK_CAMERA : 0u) | (v->diffuse ? TY_MASK_DIFFUSE : 0u) | (v->glossy ? TY_MASK_GLOSSY : 0u) |
           (v->transmission ? TY_MASK_TRANSMISSION : 0u) | (v->shadow ? TY_MASK_SHADOW : 0u);
}

void ty_pose_object(ty_loader* loader, int index)
{
    static const char* const keys[] = {"translate", "rotate", "scale", "visible"};
    const ty_param_table* table = ty_object_params();
    const ty_node* node = ty_section(loader, "objects", TY_NODE_LIST)->items[index];
    ty_object_entry* entry = &loader->objects[index];
    for (int k = 0; k < TY_PARAM_COUNT(keys); ++k)
        for (int i = 0; i < table->count; ++i)
        {
            ty_node* value = strcmp(table->params[i].name, keys[k]) == 0 ? ty_node_get(node, keys[k]) : NULL;
            if (value) // what is wrong with it is in the list of errors
                (void)ty_param_read(&loader->reader, value, &table->params[i],
                                    (char*)&entry->def + table->params[i].offset);
        }
    place_object(loader, node, entry);
    for (int i = entry->first; i < entry->first + entry->count; ++i)
        loader->scene->objects[i].mask = mask_of(&entry->def.visible);
}

// What belongs to one kind of object alone.
static void check_keys(ty_loader* loader, const ty_node* node)
{
    static const char* const keys[] = {"file_lights", "file_camera"};
    for (int i = 0; i < 2; ++i)
        if (ty_node_get(node, keys[i]) && !ty_node_get(node, "gltf"))
            ty_report(loader->errors, ty_node_get(node, keys[i])->place, TY_BAD_INPUT, "'%s' belongs to 'gltf'",
                      keys[i]);
}

// The definition to what it places, once that is known.
static void set_placed(ty_loader* loader, const ty_object_entry* entry, const ty_node* node)
{
    int group = ty_light_group_index(loader, ty_node_get(node, "light_group"));
    for (int i = entry->first; i < entry->first + entry->count; ++i)
    {
        if (!loader->placed[i].part) // that one's are resolved by name
            loader->scene->objects[i].material = (uint32_t)entry->material;
        loader->scene->objects[i].light_group = group;
        loader->scene->objects[i].mask = mask_of(&entry->def.visible);
    }
}

void ty_read_object(ty_loader* loader, int index)
{
    ty_object_entry* entry = &loader->objects[index];
    ty_node* node = ty_section(loader, "objects", TY_NODE_LIST)->items[index];
    entry->place = node->place;
    entry->asset = entry->material = -1;
    spread_scale(loader, node);
    bool good = ty_params_read(&loader->reader, node, ty_object_params(), &entry->def, NULL);
    if (node->kind != TY_NODE_MAP || node->bad)
        return;
    find_asset(loader, node, entry);
    find_materials(loader, node, entry);
    check_keys(loader, node);
    if (good)
        place_object(loader, node, entry);
    set_placed(loader, entry, node);
}

static int count_parts(const ty_loader* loader, const ty_object_entry* entry)
{
    const ty_asset* asset = entry->asset >= 0 ? &loader->assets[entry->asset] : NULL;
    return asset && asset->kind == TY_ASSET_GLTF ? asset->gltf->object_count : 1;
}

static void place_parts(ty_loader* loader, int index)
{
    ty_object_entry* entry = &loader->objects[index];
    const ty_asset* asset = entry->asset >= 0 ? &loader->assets[entry->asset] : NULL;
    const char* name = entry->def.name ? entry->def.name : ty_arena_format(loader->arena, "object%d", index);
    for (int i = 0; i < entry->count; ++i)
    {
        ty_placed_object* placed = &loader->placed[entry->first + i];
        ty_scene_object* object = &loader->scene->objects[entry->first + i];
        placed->entry = index;
        placed->name = asset ? asset->name : name;
        object->name = name;
        if (!asset || asset->kind != TY_ASSET_GLTF)
            continue;
        placed->part = &asset->gltf->objects[i];
        placed->name = ty_arena_format(loader->arena, "%s/%s", asset->name, placed->part->name);
        object->name =
            ty_arena_format(loader->arena, "%s/%s", entry->def.name ? name : asset->name, placed->part->name);
    }
}

void ty_read_objects(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    ty_node* list = ty_section(loader, "objects", TY_NODE_LIST);
    loader->entry_count = list ? list->count : 0;
    loader->objects = TY_ARENA_ALLOC(loader->tree.arena, ty_object_entry, loader->entry_count);
    for (int i = 0; i < loader->entry_count; ++i)
    {
        ty_object_entry* entry = &loader->objects[i];
        ty_read_object(loader, i);
        entry->first = scene->object_count;
        entry->count = count_parts(loader, entry);
        scene->object_count += entry->count;
    }
    scene->objects = TY_ARENA_ALLOC(loader->arena, ty_scene_object, scene->object_count);
    loader->placed = TY_ARENA_ALLOC(loader->tree.arena, ty_placed_object, scene->object_count);
    for (int i = 0; i < loader->entry_count; ++i)
    {
        place_parts(loader, i);
        set_placed(loader, &loader->objects[i], list->items[i]);
    }
}
