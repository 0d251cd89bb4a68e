// SPDX-License-Identifier: Apache-2.0
// glTF files that assets name, opened before the tables are read, and what objects bring from them besides meshes:
// lights and a camera, written into the tree as if the scene's file had them. So a recipe tells them too.
#include "loader.h"
#include "nearest.h"
#include "number.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>

#define DEGREES (180.0f / TY_PI) // of a radian

// --- nodes that this program makes ---

void ty_text_quote(ty_text* text, const char* word)
{
    ty_text_add(text, "\"");
    for (const char* c = word; *c; ++c)
        if (*c == '"' || *c == '\\')
            ty_text_format(text, "\\%c", *c);
        else
            ty_text_add_bytes(text, c, 1);
    ty_text_add(text, "\"");
}

static void move_to(ty_node* node, ty_place place)
{
    node->place = place;
    for (int i = 0; i < node->count; ++i)
    {
        if (node->kind == TY_NODE_MAP)
            node->keys[i].place = place;
        move_to(node->items[i], place);
    }
}

ty_node* ty_made_node(ty_loader* loader, ty_place place, const char* text)
{
    ty_node* node = ty_tree_parse(&loader->tree, place.source, text, strlen(text));
    if (node)
        move_to(node, place);
    return node;
}

// --- opening ---

typedef struct finder
{
    ty_loader* loader;
    ty_place place;
    const char* base; // folder of the glTF file, as scenes name files
} finder;

// Files of a glTF are files of the scene: in its search folders and its hash, and kept in by a sandbox.
static bool find_file(void* context, const char* uri, char path[4096], ty_error* error)
{
    finder* f = context;
    ty_source* source = TY_ARENA_ALLOC(f->loader->tree.arena, ty_source, 1);
    *source = *f->place.source;
    source->base = f->base;
    ty_place place = f->place;
    place.source = source;
    ty_node* node = ty_node_create(&f->loader->tree, TY_NODE_SCALAR, place);
    (void)ty_error_set(error, TY_BAD_FILE, "'%.400s' cannot be used", uri);
    if (!node)
        return false;
    node->text = ty_arena_string(f->loader->tree.arena, uri);
    const char* found = ty_files_use(&f->loader->files, node, "gltf");
    if (found)
        snprintf(path, 4096, "%s", found);
    return found != NULL;
}

static void open_file(ty_loader* loader, ty_node* name, ty_asset* asset)
{
    char folder[TY_PATH_MAX];
    ty_error error;
    int before = loader->errors->count;
    const char* path = ty_files_use(&loader->files, name, "gltf");
    if (!path)
        return;
    ty_path_folder(name->text, folder);
    finder f = {loader, name->place, strcmp(folder, ".") == 0 ? "" : ty_arena_string(loader->tree.arena, folder)};
    if (ty_gltf_scene_open(path, find_file, &f, &asset->gltf, &error) == TY_OK)
    {
        struct ty_scene_resources* resources = loader->scene->resources;
        resources->gltfs[resources->gltf_count++] = asset->gltf;
        for (int i = 0; i < asset->gltf->warning_count; ++i)
            ty_report_warning(name->place, "%s: %s", path, asset->gltf->warnings[i]);
    }
    else if (loader->errors->count == before)
        ty_report_error(loader->errors, name->place, "gltf", &error);
}

static void open_all(ty_loader* loader)
{
    ty_node* map = ty_section(loader, "assets", TY_NODE_MAP);
    loader->asset_count = map ? map->count : 0;
    loader->assets = TY_ARENA_ALLOC(loader->tree.arena, ty_asset, loader->asset_count);
    loader->scene->resources->sequences = TY_ARENA_ALLOC(loader->arena, struct ty_mesh_sequence*, loader->asset_count);
    loader->scene->resources->gltfs = TY_ARENA_ALLOC(loader->arena, ty_gltf_scene*, loader->asset_count);
    for (int i = 0; i < loader->asset_count; ++i)
    {
        ty_node *gltf = ty_node_get(map->items[i], "gltf"), *mesh = ty_node_get(map->items[i], "mesh");
        loader->assets[i].name = ty_arena_string(loader->arena, map->keys[i].text);
        if (gltf && gltf->kind == TY_NODE_SCALAR)
            open_file(loader, gltf, &loader->assets[i]);
        else if (mesh && mesh->kind == TY_NODE_SCALAR && ty_gltf_is_file(mesh->text))
            open_file(loader, mesh, &loader->assets[i]);
    }
}

// --- lights and cameras ---

static void add_vector(ty_text* text, const char* key, ty_vec3 v)
{
    ty_text_format(text, ", \"%s\": [%.9g, %.9g, %.9g]", key, (double)v.x, (double)v.y, (double)v.z);
}

static void add_color(ty_text* text, const char* key, const float c[3], float scale)
{
    ty_text_format(text, ", \"%s\": {\"color\": [%.9g, %.9g, %.9g], \"space\": \"lin_rec709\"}", key,
                   (double)(c[0] * scale), (double)(c[1] * scale), (double)(c[2] * scale));
}

static ty_vec3 forward(const ty_affine* map)
{
    return ty_normalize(ty_map_vector(map, ty_vec3_make(0.0f, 0.0f, -1.0f)));
}

static char* light_text(const ty_asset* asset, const ty_gltf_light* light, const ty_affine* object, float scale)
{
    static const char* const kinds[] = {"point", "spot", "directional"};
    ty_affine map = ty_affine_multiply(object, &light->to_file);
    ty_text name = {0}, text = {0};
    ty_text_format(&name, "%s/%s", asset->name, light->name);
    ty_text_add(&text, "{\"name\": ");
    ty_text_quote(&text, name.data);
    ty_text_format(&text, ", \"type\": \"%s\"", kinds[light->kind]);
    add_vector(&text, "center", map.t);
    if (light->kind != TY_GLTF_POINT)
        add_vector(&text, "target", ty_add(map.t, forward(&map)));
    add_color(&text, light->kind == TY_GLTF_DIRECTIONAL ? "irradiance" : "intensity", light->color,
              light->intensity * scale);
    if (light->kind == TY_GLTF_SPOT)
    {
        float cone = ty_clamp(2.0f * light->outer * DEGREES, 0.01f, 179.9f);
        float penumbra = 1.0f - ty_min(light->inner / ty_max(light->outer, 1e-6f), 1.0f);
        ty_text_format(&text, ", \"cone\": %.9g, \"penumbra\": %.9g", (double)cone, (double)penumbra);
    }
    ty_text_add(&text, "}");
    ty_text_term(&name);
    return ty_text_take(&text);
}

static char* camera_text(const ty_gltf_scene* gltf, const ty_gltf_camera* camera, const ty_affine* object)
{
    ty_affine map = ty_affine_multiply(object, &camera->to_file);
    ty_vec3 view = forward(&map), up = ty_normalize(ty_map_vector(&map, ty_vec3_make(0.0f, 1.0f, 0.0f)));
    // What is sharp if an aperture is asked for: the middle of what there is.
    float distance = 1.0f;
    if (gltf->bounds.low.x <= gltf->bounds.high.x)
    {
        ty_vec3 middle = ty_mul(ty_add(gltf->bounds.low, gltf->bounds.high), 0.5f);
        distance = ty_dot(ty_sub(ty_map_point(object, middle), map.t), view);
    }
    ty_text text = {0};
    if (camera->is_orthographic)
        ty_text_format(&text, "{\"projection\": \"orthographic\", \"ortho_height\": %.9g", (double)camera->height);
    else
        ty_text_format(&text, "{\"vfov\": %.9g", (double)ty_clamp(camera->yfov * DEGREES, 0.01f, 179.0f));
    add_vector(&text, "position", map.t);
    add_vector(&text, "look_at", ty_mad(map.t, view, distance > 1e-3f ? distance : 1.0f));
    add_vector(&text, "up", up);
    ty_text_add(&text, "}");
    return ty_text_take(&text);
}

// The section's list, made where there is none.
static ty_node* section_for(ty_loader* loader, const char* name, ty_node_kind kind, ty_place place)
{
    ty_node* node = ty_node_get(loader->root, name);
    if (node && node->kind == kind)
        return node;
    if (node && !ty_node_is_empty(node))
        return NULL; // reported by who reads it
    ty_node_remove(&loader->tree, loader->root, name);
    node = ty_node_create(&loader->tree, kind, place);
    if (node)
        ty_node_add(&loader->tree, loader->root, (ty_key){name, place}, node);
    return node;
}

static void bring_lights(ty_loader* loader, ty_node* object, const ty_asset* asset, const ty_affine* map)
{
    ty_node* wish = ty_node_get(object, "file_lights");
    const ty_node* scale =
        ty_node_get(ty_section(loader, "assets", TY_NODE_MAP)->items[asset - loader->assets], "light_scale");
    double factor = 1.0;
    if (!wish || wish->kind != TY_NODE_SCALAR || strcmp(wish->text, "true") != 0)
        return;
    if (scale && (scale->kind != TY_NODE_SCALAR || !ty_number_parse(scale->text, &factor)))
        return; // reported with the asset
    ty_node* list = section_for(loader, "lights", TY_NODE_LIST, wish->place);
    for (int i = 0; list && i < asset->gltf->light_count; ++i)
    {
        char* text = light_text(asset, &asset->gltf->lights[i], map, (float)factor);
        ty_node* light = ty_made_node(loader, wish->place, text);
        ty_free(text);
        if (light)
            ty_node_append(&loader->tree, list, light);
    }
    if (asset->gltf->light_count == 0)
        ty_report_warning(wish->place, "'%s' has no lights", asset->name);
    wish->text = "false"; // they are the scene's now
}

static const ty_gltf_camera* find_camera(ty_loader* loader, const ty_node* name, const ty_asset* asset)
{
    const ty_gltf_scene* gltf = asset->gltf;
    double number;
    for (int i = 0; i < gltf->camera_count; ++i)
        if (strcmp(gltf->cameras[i].name, name->text) == 0)
            return &gltf->cameras[i];
    if (ty_number_parse(name->text, &number) && number >= 0.0 && number < (double)gltf->camera_count)
        return &gltf->cameras[(int)number];
    char nearest[TY_NEAREST_SIZE];
    const char** names = TY_ALLOC(const char*, gltf->camera_count);
    for (int i = 0; i < gltf->camera_count; ++i)
        names[i] = gltf->cameras[i].name;
    ty_report(loader->errors, name->place, TY_BAD_INPUT, "'%.100s' has no camera '%.100s'%s", asset->name, name->text,
              gltf->camera_count ? ty_nearest(name->text, names, gltf->camera_count, nearest) : "; it has none");
    ty_free(names);
    return NULL;
}

static void bring_camera(ty_loader* loader, const ty_node* object, const ty_asset* asset, const ty_affine* map)
{
    const ty_node* wish = ty_node_get(object, "file_camera");
    if (!wish || wish->kind != TY_NODE_SCALAR || !wish->text[0])
        return;
    const ty_gltf_camera* camera = find_camera(loader, wish, asset);
    const ty_node* own = ty_node_get(loader->root, "camera");
    if (!camera || (own && !ty_node_is_empty(own)))
        return;
    char* text = camera_text(asset->gltf, camera, map);
    ty_node *made = ty_made_node(loader, wish->place, text), *section = NULL;
    ty_free(text);
    if (made)
        section = section_for(loader, "camera", TY_NODE_MAP, wish->place);
    for (int i = 0; section && i < made->count; ++i)
        ty_node_add(&loader->tree, section, made->keys[i], made->items[i]);
}

// Where an object stands; what is wrong with it is reported when it is read.
static ty_affine object_map(const ty_node* node)
{
    static const char* const keys[] = {"translate", "rotate", "scale"};
    ty_vec3 v[3] = {{0, 0, 0}, {0, 0, 0}, {1, 1, 1}};
    for (int i = 0; i < 3; ++i)
    {
        const ty_node* value = ty_node_get(node, keys[i]);
        double n[3] = {0.0};
        bool single = value && value->kind == TY_NODE_SCALAR && i == 2;
        bool good = value && (single || (value->kind == TY_NODE_LIST && value->count == 3));
        for (int k = 0; k < 3 && good; ++k)
            good = ty_number_parse(single ? value->text : value->items[k]->text ? value->items[k]->text : "", &n[k]);
        if (good)
            v[i] = ty_vec3_make((float)n[0], (float)n[1], (float)n[2]);
    }
    ty_vec3 angles = {ty_radians(v[1].x), ty_radians(v[1].y), ty_radians(v[1].z)};
    return ty_affine_from_trs(v[0], ty_quat_euler(angles), v[2]);
}

// Lights and cameras stay where the object stands at the timeline's start: at the present frame they would stand
// elsewhere in every picture of a list.
static ty_affine placed_at_start(ty_loader* loader, int object, const ty_node* node)
{
    const ty_scene* scene = loader->scene;
    int entry = ty_timeline_find(&loader->timeline, TY_SECTION_OBJECT, object);
    if (entry < 0)
        return object_map(node);
    ty_timeline_evaluate(&loader->timeline, entry, (ty_moment){scene->timeline.start, 0.0}, NULL);
    ty_affine map = object_map(node);
    ty_timeline_evaluate(&loader->timeline, entry, (ty_moment){scene->frame, 0.0}, NULL);
    return map;
}

void ty_gltf_expand(ty_loader* loader)
{
    open_all(loader);
    ty_node* map = ty_section(loader, "assets", TY_NODE_MAP);
    ty_node* list = ty_section(loader, "objects", TY_NODE_LIST);
    for (int i = 0; list && i < list->count; ++i)
    {
        const ty_node* name = ty_node_get(list->items[i], "gltf");
        int asset = name && name->kind == TY_NODE_SCALAR ? ty_node_find(map, name->text) : -1;
        if (asset < 0 || !loader->assets[asset].gltf)
            continue;
        ty_affine placed = placed_at_start(loader, i, list->items[i]);
        bring_lights(loader, list->items[i], &loader->assets[asset], &placed);
        bring_camera(loader, list->items[i], &loader->assets[asset], &placed);
    }
}
