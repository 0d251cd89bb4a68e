// SPDX-License-Identifier: Apache-2.0
// The section `camera`: what its table cannot check, film back and focal length, the turn, and what it focuses on.
#include "loader.h"
#include "nearest.h"
#include <string.h>

static bool is_parallel(ty_vec3 a, ty_vec3 b)
{
    ty_vec3 c = ty_cross(ty_normalize(a), ty_normalize(b));
    return ty_length_sqr(c) < 1e-12f;
}

static bool has(const ty_node* node, const char* key)
{
    return ty_node_find(node, key) >= 0;
}

static void report(ty_loader* loader, const ty_node* node, const char* key, const char* text)
{
    ty_report(loader->errors, ty_key_place(node, key), TY_BAD_INPUT, "%s", text);
}

// At most one of the keys, which say the same thing in different ways.
static void check_one_of(ty_loader* loader, const ty_node* node, const char* const* keys)
{
    const char* first = NULL;
    for (int i = 0; keys[i]; ++i)
    {
        if (first && has(node, keys[i]))
            ty_report(loader->errors, ty_key_place(node, keys[i]), TY_BAD_INPUT, "either '%s' or '%s', not both", first,
                      keys[i]);
        else if (has(node, keys[i]))
            first = keys[i];
    }
}

static void check_lens(ty_loader* loader, const ty_node* node)
{
    static const char* const focus[] = {"focus_object", "focus_point", "focus_distance", NULL};
    static const char* const view[] = {"focal_length", "vfov", NULL};
    static const char* const film[] = {"film_width", "film_height", NULL};
    static const char* const opening[] = {"aperture", "f_stop", NULL};
    const ty_camera_def* camera = &loader->scene->camera;
    check_one_of(loader, node, view);
    check_one_of(loader, node, film);
    check_one_of(loader, node, opening);
    if (camera->focus_distance > 0.0f || !has(node, "focus_distance"))
        check_one_of(loader, node, focus);
    if (camera->projection == TY_PROJECTION_ORTHOGRAPHIC && camera->f_stop > 0.0f)
        report(loader, node, "f_stop", "'f_stop': an orthographic camera has no focal length; give 'aperture'");
    bool all_round = camera->projection == TY_PROJECTION_EQUIRECTANGULAR;
    if (all_round && (camera->f_stop > 0.0f || camera->aperture > 0.0f))
        report(loader, node, camera->aperture > 0.0f ? "aperture" : "f_stop",
               "an equirectangular camera has no lens: everything is sharp");
    if (all_round && (fabsf(camera->shift[0]) > 0.0f || fabsf(camera->shift[1]) > 0.0f))
        report(loader, node, "shift", "'shift': an equirectangular camera has no film to shift");
    if (camera->far_clip > 0.0f && camera->far_clip <= camera->near_clip)
        report(loader, node, "far_clip", "'far_clip' is not beyond 'near_clip'");
}

static void check_camera(ty_loader* loader, const ty_node* node)
{
    const ty_camera_def* camera = &loader->scene->camera;
    ty_vec3 view = ty_sub(camera->look_at, camera->position);
    if (ty_length_sqr(view) <= 0.0f)
        report(loader, node, "look_at", "'look_at' is the camera's own position");
    else if (is_parallel(view, camera->up))
        report(loader, node, "up", "'up' is zero or along the view: the picture would have no upright");
    check_lens(loader, node);
}

// Index of the object in the file; -1 after a report.
static int find_object(ty_loader* loader, ty_place place, const char* name)
{
    char nearest[TY_NEAREST_SIZE];
    const ty_node* list = ty_node_get(loader->root, "objects");
    int count = list && list->kind == TY_NODE_LIST ? list->count : 0, found = -1;
    const char** names = TY_ALLOC(const char*, count + 1);
    for (int i = 0; i < count; ++i)
    {
        const ty_node* node = ty_node_get(list->items[i], "name");
        names[i] = node && node->kind == TY_NODE_SCALAR && node->text[0] ? node->text : NULL;
        if (names[i] && found < 0 && strcmp(names[i], name) == 0)
            found = i;
    }
    if (found < 0)
        ty_report(loader->errors, place, TY_BAD_INPUT, "'focus_object': no object is named '%.200s'%s", name,
                  ty_nearest(name, names, count, nearest));
    ty_free(names);
    return found;
}

// Film back and focal length become what the renderer knows: height and angle.
static void resolve_film(ty_scene* scene)
{
    ty_camera_def* camera = &scene->camera;
    if (camera->film_width > 0.0f)
        camera->film_height = camera->film_width * (float)scene->film.size[1] / (float)scene->film.size[0];
    if (camera->focal_length > 0.0f)
        camera->vfov = 2.0f * ty_atan2(0.5f * camera->film_height, camera->focal_length);
}

static void turn(ty_scene* scene)
{
    ty_affine map;
    ty_camera_def* camera = &scene->camera;
    if (scene->turntable.turn != TY_TURN_CAMERA || !ty_turntable_map(scene, &map))
        return;
    camera->position = ty_map_point(&map, camera->position);
    camera->look_at = ty_map_point(&map, camera->look_at);
    camera->up = ty_map_vector(&map, camera->up);
}

void ty_read_camera(ty_loader* loader)
{
    ty_camera_def* camera = &loader->scene->camera;
    ty_read_section(loader, "camera", ty_camera_params(), camera);
    const ty_node* node = ty_section(loader, "camera", TY_NODE_MAP);
    camera->has_focus_point = has(node, "focus_point");
    loader->focus_object = -1;
    if (node)
        check_camera(loader, node);
    if (node && camera->focus_object)
        loader->focus_object = find_object(loader, ty_key_place(node, "focus_object"), camera->focus_object);
    resolve_film(loader->scene);
    turn(loader->scene);
}

// Of all parts; empty until the meshes are loaded.
static ty_bounds gltf_bounds(const ty_gltf_scene* gltf)
{
    ty_bounds all = ty_bounds_empty();
    for (int i = 0; i < gltf->object_count; ++i)
    {
        const ty_gltf_object* part = &gltf->objects[i];
        const ty_mesh* mesh = gltf->meshes[part->mesh];
        uint32_t count = part->instances ? part->instances->instance_count : mesh ? 1 : 0;
        for (uint32_t k = 0; k < count; ++k)
        {
            ty_affine map = part->to_file;
            if (part->instances)
                map = ty_affine_multiply(&part->to_file, &part->instances->transforms[k]);
            all = ty_bounds_union(all, ty_bounds_map(&map, mesh->bounds));
        }
    }
    return all;
}

static ty_bounds asset_bounds(const ty_asset* asset)
{
    const ty_aggregate* aggregate = asset->aggregate;
    if (asset->kind == TY_ASSET_GLTF)
        return gltf_bounds(asset->gltf);
    ty_bounds all = ty_bounds_empty();
    if (!aggregate)
        return asset->mesh ? asset->mesh->bounds : all;
    for (uint32_t i = 0; i < aggregate->instance_count; ++i)
        all = ty_bounds_union(all, ty_bounds_map(&aggregate->transforms[i],
                                                 aggregate->prototypes[aggregate->prototype_index[i]]->bounds));
    return all;
}

void ty_focus_camera(ty_loader* loader)
{
    ty_camera_def* camera = &loader->scene->camera;
    if (loader->focus_object < 0)
        return;
    const ty_object_entry* entry = &loader->objects[loader->focus_object];
    if (entry->asset < 0)
        return;
    ty_asset* asset = &loader->assets[entry->asset];
    if (!asset->bounds_known)
        asset->bounds = asset_bounds(asset);
    asset->bounds_known = asset->bounds.low.x <= asset->bounds.high.x;
    if (!asset->bounds_known) // when only checking
        return;
    ty_vec3 middle = ty_mul(ty_add(asset->bounds.low, asset->bounds.high), 0.5f);
    camera->focus_point = ty_map_point(&entry->transform, middle);
    camera->has_focus_point = true;
}
