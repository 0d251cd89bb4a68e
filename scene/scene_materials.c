// SPDX-License-Identifier: Apache-2.0
// The section `materials`: definitions read, their textures and attributes resolved, materials created.
#include "loader.h"
#include "nearest.h"
#include <string.h>

typedef enum model
{
    SURFACE,
    CDRF,
    WALK,
    BARK,
} model;

enum
{
    MOST_SKIPPED = 63 // names of keys
};

// An asset of that name, else a file; a name without a dot or slash can only be meant as an asset.
static int find_texture(void* context, ty_node* name, const ty_node* layer, bool is_data, bool by_uv, const int wrap[2])
{
    ty_loader* loader = context;
    loader->textured[loader->current_material] |= by_uv;
    int index = ty_node_find(loader->asset_map, name->text);
    if (index < 0 && !strpbrk(name->text, "./"))
        return ty_asset_find(loader, name);
    if (index >= 0 && wrap[0] >= 0)
    {
        ty_report(loader->errors, name->place, TY_BAD_INPUT, "'wrap' belongs to the asset '%.200s'", name->text);
        return -1;
    }
    return index >= 0 ? ty_surface_texture_of_asset(loader, index, name, layer, is_data)
                      : ty_surface_texture_of_file(loader, name, layer, is_data, wrap);
}

static int find_attribute(void* context, const ty_node* name)
{
    ty_loader* loader = context;
    ty_scene* scene = loader->scene;
    int index = 0;
    while (index < scene->attribute_count && strcmp(scene->attribute_names[index], name->text) != 0)
        ++index;
    if (index == scene->attribute_count)
    {
        if (index == 256)
        {
            ty_report(loader->errors, name->place, TY_BAD_INPUT, "more than 256 different attributes in a scene");
            return -1;
        }
        if (!scene->attribute_names)
            scene->attribute_names = TY_ARENA_ALLOC(loader->arena, const char*, 256);
        scene->attribute_names[scene->attribute_count++] = ty_arena_string(loader->arena, name->text);
    }
    // What glTF meshes have is theirs to say: where there are no vertex colours, they are white.
    if (loader->current_material >= (loader->material_map ? loader->material_map->count : 0))
        return index;
    for (int i = 0; i < loader->use_count; ++i) // read again for another frame
        if (loader->uses[i].material == loader->current_material && loader->uses[i].attribute == index)
            return index;
    loader->uses = ty_loader_grow(loader->tree.arena, loader->uses, loader->use_count, &loader->use_capacity,
                                  sizeof(*loader->uses));
    loader->uses[loader->use_count++] = (ty_attribute_use){loader->current_material, index, name->place};
    return index;
}

// "kernel: ..." of a material's own check points at its `kernel`, if it is written.
static void report_impossible(ty_loader* loader, const ty_node* node, const char* name, const ty_error* error)
{
    ty_place place = node->place;
    for (int i = 0; i < node->count; ++i)
    {
        size_t length = strlen(node->keys[i].text);
        if (strncmp(error->text, node->keys[i].text, length) == 0 && strchr(": ", error->text[length]))
            place = node->items[i]->place;
    }
    ty_report(loader->errors, place, error->status, "material '%.100s': %.800s", name, error->text);
}

static ty_status create(model kind, const void* def, ty_material** out, ty_error* error)
{
    switch (kind)
    {
    case SURFACE:
        return ty_material_create_surface(def, out, error);
    case CDRF:
        return ty_material_create_cdrf(def, out, error);
    case WALK:
        return ty_material_create_walk(def, out, error);
    case BARK:
        break;
    }
    return ty_material_create_bark(def, out, error);
}

// One of three ways to say it, and one place for the degree of cooking.
static bool read_moisture_source(ty_loader* loader, const ty_node* node, ty_moisture_inputs* moisture)
{
    static const char* const ways[] = {"wet_basis", "uptake", "soak"};
    const ty_node *map = ty_node_get(node, "moisture"), *cooked = ty_node_get(node, "cooked");
    const char* said = NULL;
    bool good = true;
    for (int i = 0; map && map->kind == TY_NODE_MAP && i < TY_PARAM_COUNT(ways); ++i)
    {
        int found = ty_node_find(map, ways[i]);
        if (found >= 0 && said)
        {
            ty_report(loader->errors, map->keys[found].place, TY_BAD_INPUT, "moisture is either '%s' or '%s', not both",
                      said, ways[i]);
            good = false;
        }
        said = found >= 0 ? ways[i] : said;
        moisture->source = found >= 0 ? i : moisture->source;
    }
    if (!cooked || !map || ty_node_find(map, "cooked") < 0)
        return good;
    ty_report(loader->errors, cooked->place, TY_BAD_INPUT, "'cooked' is said in 'moisture' already");
    return false;
}

// `cdrf` and `walk` read over what belongs to the other alone, so that a scene turns into its own reference by
// `model`. Returns how many names were added.
static int skip_names_of(const ty_param_table* table, const char** skip, int count)
{
    const ty_param_table* other = table == ty_cdrf_params()   ? ty_walk_params()
                                  : table == ty_walk_params() ? ty_cdrf_params()
                                                              : NULL;
    for (int i = 0; other && i < other->count && count < MOST_SKIPPED; ++i)
    {
        bool common = false;
        for (int k = 0; k < table->count; ++k)
            common = common || strcmp(table->params[k].name, other->params[i].name) == 0;
        if (!common)
            skip[count++] = other->params[i].name;
    }
    return count;
}

static void read_model(ty_loader* loader, ty_node* node, model kind, int index)
{
    const ty_param_table* const tables[] = {[SURFACE] = ty_surface_params(),
                                            [CDRF] = ty_cdrf_params(),
                                            [WALK] = ty_walk_params(),
                                            [BARK] = ty_bark_params()};
    union
    {
        ty_surface_def surface;
        ty_cdrf_def cdrf;
        ty_walk_def walk;
        ty_bark_def bark;
    } def;
    const char* skip[MOST_SKIPPED + 1] = {"model"};
    skip[skip_names_of(tables[kind], skip, 1)] = NULL;
    ty_error error;
    if (ty_params_read(&loader->reader, node, tables[kind], &def, skip) &&
        (kind == SURFACE || kind == BARK ||
         read_moisture_source(loader, node, kind == CDRF ? &def.cdrf.moisture : &def.walk.common.moisture)) &&
        !loader->checks_keys && create(kind, &def, &loader->scene->materials[index], &error) != TY_OK)
        report_impossible(loader, node, loader->scene->material_names[index], &error);
}

static void read_material(ty_loader* loader, ty_node* node, int index)
{
    static const char* const models[] = {
        [SURFACE] = "surface", [CDRF] = "cdrf", [WALK] = "walk", [BARK] = "bark", NULL};
    const ty_param row = {.name = "model", .type = TY_PARAM_ENUM, .unit = "", .choices = models};
    char described[80];
    const char* name = loader->scene->material_names[index];
    if (node->bad)
        return;
    if (node->kind != TY_NODE_MAP)
    {
        ty_report(loader->errors, node->place, TY_BAD_INPUT,
                  "material '%.100s': expected a mapping with 'model', got %s", name,
                  ty_node_describe(node, described));
        return;
    }
    ty_node* said = ty_node_get(node, "model");
    int chosen = 0;
    if (!said)
        ty_report(loader->errors, node->place, TY_BAD_INPUT,
                  "material '%.100s': missing key 'model', one of: surface, cdrf, walk, bark", name);
    else if (ty_param_read(&loader->reader, said, &row, &chosen))
        read_model(loader, node, (model)chosen, index);
}

void ty_read_material(ty_loader* loader, int index)
{
    loader->current_material = index;
    if (!loader->checks_keys)
    {
        ty_material_destroy(loader->scene->materials[index]);
        loader->scene->materials[index] = NULL;
    }
    int own = loader->material_map ? loader->material_map->count : 0;
    ty_node* node = index < own ? loader->material_map->items[index] : loader->gltf_materials[index - own];
    if (node)
        read_material(loader, node, index);
}

int ty_material_find(const ty_loader* loader, const char* name)
{
    int own = loader->material_map ? loader->material_map->count : 0;
    int found = ty_node_find(loader->material_map, name);
    for (int i = own; i < loader->scene->material_count && found < 0; ++i)
        if (strcmp(loader->scene->material_names[i], name) == 0)
            found = i;
    return found;
}

// Those of glTF scenes stand behind the section's, as "asset/name".
static void name_gltf_materials(ty_loader* loader, int first)
{
    int own = first;
    for (int a = 0; a < loader->asset_count; ++a)
    {
        ty_asset* asset = &loader->assets[a];
        asset->first_material = first;
        for (int i = 0; asset->kind == TY_ASSET_GLTF && i <= asset->gltf->material_count; ++i, ++first)
        {
            const char* name = i < asset->gltf->material_count ? asset->gltf->materials[i].name : TY_GLTF_NO_MATERIAL;
            loader->scene->material_names[first] = ty_arena_format(loader->arena, "%s/%s", asset->name, name);
            loader->gltf_materials[first - own] = ty_gltf_material_node(loader, asset, i);
        }
    }
}

void ty_read_materials(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    ty_node* map = loader->material_map = ty_section(loader, "materials", TY_NODE_MAP);
    int own = map ? map->count : 0, count = own;
    for (int a = 0; a < loader->asset_count; ++a)
        if (loader->assets[a].kind == TY_ASSET_GLTF)
            count += loader->assets[a].gltf->material_count + 1;
    scene->materials = TY_ARENA_ALLOC(loader->arena, ty_material*, count);
    scene->material_names = TY_ARENA_ALLOC(loader->arena, const char*, count);
    scene->material_count = count;
    loader->textured = TY_ARENA_ALLOC(loader->tree.arena, bool, count);
    loader->gltf_materials = TY_ARENA_ALLOC(loader->tree.arena, ty_node*, count - own);
    loader->reader.find_texture = find_texture;
    loader->reader.find_attribute = find_attribute;
    for (int i = 0; i < own; ++i)
        scene->material_names[i] = ty_arena_string(loader->arena, map->keys[i].text);
    name_gltf_materials(loader, own);
    for (int i = 0; i < count; ++i)
        ty_read_material(loader, i);
}
