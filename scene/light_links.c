// SPDX-License-Identifier: Apache-2.0
// Names between lights and objects: light groups, and which lights light an object.
#include "loader.h"
#include "nearest.h"
#include <ctype.h>
#include <string.h>

static bool is_group_name(const char* name)
{
    size_t length = strlen(name);
    for (size_t i = 0; i < length; ++i)
        if (!isalnum((unsigned char)name[i]) && !strchr("_-", name[i]))
            return false;
    return length > 0 && length <= TY_LIGHT_GROUP_NAME;
}

int ty_light_group_index(ty_loader* loader, const ty_node* name)
{
    ty_scene* scene = loader->scene;
    if (!scene->light_groups)
    {
        scene->light_groups = TY_ARENA_ALLOC(loader->arena, const char*, TY_LIGHT_GROUPS);
        scene->light_groups[scene->light_group_count++] = "default";
    }
    if (!name || name->kind != TY_NODE_SCALAR)
        return 0;
    for (int i = 0; i < scene->light_group_count; ++i)
        if (strcmp(scene->light_groups[i], name->text) == 0)
            return i;
    if (!is_group_name(name->text))
        ty_report(loader->errors, name->place, TY_BAD_INPUT,
                  "light group '%.100s': expected 1 to %d letters, digits, _ or -, as it names channels", name->text,
                  TY_LIGHT_GROUP_NAME);
    else if (scene->light_group_count == TY_LIGHT_GROUPS)
        ty_report(loader->errors, name->place, TY_BAD_INPUT,
                  "light group '%.100s': a scene has at most %d, default included", name->text, TY_LIGHT_GROUPS);
    else
    {
        scene->light_groups[scene->light_group_count] = ty_arena_string(loader->arena, name->text);
        return scene->light_group_count++;
    }
    return 0;
}

// --- linking ---

// Or may at another frame: links are the same at all.
static bool material_emits(const ty_loader* loader, int material)
{
    const ty_material* m = material >= 0 ? loader->scene->materials[material] : NULL;
    return m && (ty_material_is_emissive(m) || ty_timeline_find(&loader->timeline, TY_SECTION_MATERIAL, material) >= 0);
}

// Of what a glTF scene brings, any may.
static bool file_emits(const ty_loader* loader, const ty_asset* asset)
{
    for (int i = 0; i <= asset->gltf->material_count; ++i)
        if (material_emits(loader, asset->first_material + i))
            return true;
    return false;
}

static bool object_emits(const ty_loader* loader, const ty_object_entry* entry)
{
    const ty_asset* asset = entry->asset >= 0 ? &loader->assets[entry->asset] : NULL;
    bool has_own = asset && asset->kind == TY_ASSET_GLTF && !entry->def.material;
    bool emits = has_own ? file_emits(loader, asset) : material_emits(loader, entry->material);
    for (int i = 0; entry->slots && i < entry->slots->count && !emits; ++i)
        if (entry->slots->items[i]->kind == TY_NODE_SCALAR)
            emits = material_emits(loader, ty_material_find(loader, entry->slots->items[i]->text));
    return emits;
}

// Everything that gives light: lights, then objects by what their materials emit; a name may mean several.
static const char* emitter_name(const ty_loader* loader, int index, bool group)
{
    const ty_scene* scene = loader->scene;
    if (index < scene->light_count)
        return group ? scene->light_groups[scene->lights[index].group_index] : scene->lights[index].name;
    int object = index - scene->light_count;
    if (!object_emits(loader, &loader->objects[loader->placed[object].entry]))
        return NULL;
    return group ? scene->light_groups[scene->objects[object].light_group] : scene->objects[object].name;
}

// Marks what a name means: lights of that name, else of that group. False = nothing.
static bool mark(const ty_loader* loader, const char* name, bool value, bool* marks)
{
    bool found = false;
    int count = loader->scene->light_count + loader->scene->object_count;
    for (int group = 0; group < 2 && !found; ++group)
        for (int i = 0; i < count; ++i)
        {
            const char* known = emitter_name(loader, i, group);
            if (!known || strcmp(known, name) != 0)
                continue;
            marks[i] = value;
            found = true;
        }
    return found;
}

static void report_unknown(ty_loader* loader, const ty_node* name)
{
    const ty_scene* scene = loader->scene;
    char nearest[TY_NEAREST_SIZE];
    int count = scene->light_count + scene->object_count;
    const char** names = TY_ALLOC(const char*, count + TY_LIGHT_GROUPS);
    for (int i = 0; i < count; ++i)
        names[i] = emitter_name(loader, i, false);
    for (int i = 0; i < scene->light_group_count; ++i)
        names[count + i] = scene->light_groups[i];
    ty_report(loader->errors, name->place, TY_BAD_INPUT, "no light, glowing object or light group '%.100s'%s",
              name->text, ty_nearest(name->text, names, count + TY_LIGHT_GROUPS, nearest));
    ty_free(names);
}

static void mark_all(ty_loader* loader, const ty_node* list, bool value, bool* marks)
{
    bool single = list->kind == TY_NODE_SCALAR;
    if (!single && list->kind != TY_NODE_LIST)
        return; // reported by the table
    for (int i = 0; i < (single ? 1 : list->count); ++i)
    {
        const ty_node* name = single ? list : list->items[i];
        if (name->kind == TY_NODE_SCALAR && !mark(loader, name->text, value, marks))
            report_unknown(loader, name);
    }
}

// The same marks share one link.
static int link_index(ty_scene* scene, const bool* marks, size_t count)
{
    for (int i = 1; i < scene->light_link_count; ++i)
        if (memcmp(scene->light_links[i], marks, count) == 0)
            return i;
    scene->light_links[scene->light_link_count] = marks;
    return scene->light_link_count++;
}

void ty_read_links(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    (void)ty_light_group_index(loader, NULL); // there is always a default group
    ty_node* list = ty_section(loader, "objects", TY_NODE_LIST);
    size_t count = (size_t)scene->light_count + (size_t)scene->object_count;
    scene->light_links = TY_ARENA_ALLOC(loader->arena, const bool*, scene->object_count + 1);
    scene->light_link_count = 1;
    for (int i = 0; list && i < loader->entry_count; ++i)
    {
        const ty_node *only = ty_node_get(list->items[i], "lights"),
                      *without = ty_node_get(list->items[i], "exclude_lights");
        if (!only && !without)
            continue;
        if (only && without)
        {
            ty_report(loader->errors, without->place, TY_BAD_INPUT, "either 'lights' or 'exclude_lights', not both");
            continue;
        }
        bool* marks = TY_ARENA_ALLOC(loader->arena, bool, count);
        memset(marks, without != NULL, count);
        mark_all(loader, only ? only : without, only != NULL, marks);
        int link = link_index(scene, marks, count);
        for (int k = 0; k < loader->objects[i].count; ++k)
            scene->objects[loader->objects[i].first + k].light_link = link;
    }
}
