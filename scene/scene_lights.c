// SPDX-License-Identifier: Apache-2.0
// The sections `film`, `camera`, `render` and `lights`, with the checks that no table can make.
#include "loader.h"
#include "text.h"
#include <string.h>

static void read_section(ty_loader* loader, const char* name, const ty_param_table* table, void* def)
{
    ty_node* node = ty_section(loader, name, TY_NODE_MAP);
    table->set_default(def);
    if (node)
        (void)ty_params_read(&loader->reader, node, table, def, NULL); // what is wrong is in the list of errors
}

static ty_place key_place(const ty_node* map, const char* key)
{
    const ty_node* value = ty_node_get(map, key);
    return value ? value->place : map->place;
}

static bool is_parallel(ty_vec3 a, ty_vec3 b)
{
    ty_vec3 c = ty_cross(ty_normalize(a), ty_normalize(b));
    return ty_length_sqr(c) < 1e-12f;
}

void ty_read_view(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    read_section(loader, "film", ty_film_params(), &scene->film);
    read_section(loader, "camera", ty_camera_params(), &scene->camera);
    read_section(loader, "render", ty_render_params(), &scene->render);
    ty_node* node = ty_section(loader, "camera", TY_NODE_MAP);
    if (!node)
        return;
    ty_camera_def* camera = &scene->camera;
    camera->has_focus_point = ty_node_find(node, "focus_point") >= 0;
    ty_vec3 view = ty_sub(camera->look_at, camera->position);
    if (ty_length_sqr(view) <= 0.0f)
        ty_report(loader->errors, key_place(node, "look_at"), TY_BAD_INPUT, "'look_at' is the camera's own position");
    else if (is_parallel(view, camera->up))
        ty_report(loader->errors, key_place(node, "up"), TY_BAD_INPUT,
                  "'up' is zero or along the view: the picture would have no upright");
    if (camera->has_focus_point && camera->focus_distance > 0.0f)
        ty_report(loader->errors, key_place(node, "focus_distance"), TY_BAD_INPUT,
                  "either 'focus_distance' or 'focus_point', not both");
}

static void check_keys(ty_loader* loader, const ty_node* node, ty_light_kind kind)
{
    const ty_param_table* table = ty_light_params();
    for (int i = 0; i < node->count; ++i)
    {
        if (ty_light_has_key(kind, node->keys[i].text))
            continue;
        ty_text keys = {0};
        for (int row = 0; row < table->count; ++row)
            if (ty_light_has_key(kind, table->params[row].name))
                ty_text_format(&keys, "%s%s", keys.size ? ", " : "", table->params[row].name);
        ty_report(loader->errors, node->keys[i].place, TY_BAD_INPUT,
                  "'%.100s' means nothing for %s %s light, which has: %s", node->keys[i].text,
                  kind == TY_LIGHT_ENVIRONMENT ? "an" : "a", ty_light_kind_name(kind), keys.data);
        ty_text_term(&keys);
    }
}

static void check_light(ty_loader* loader, const ty_node* node, const ty_light_def* light)
{
    check_keys(loader, node, (ty_light_kind)light->kind);
    bool aims = light->kind == TY_LIGHT_RECTANGLE || light->kind == TY_LIGHT_DIRECTIONAL;
    if (aims && ty_length_sqr(ty_sub(light->target, light->center)) <= 0.0f)
        ty_report(loader->errors, key_place(node, "target"), TY_BAD_INPUT, "'target' is the light's own center");
    if (light->kind == TY_LIGHT_ENVIRONMENT && light->color_space && !light->image)
        ty_report(loader->errors, key_place(node, "color_space"), TY_BAD_INPUT, "'color_space' without an 'image'");
}

void ty_read_lights(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    ty_node* list = ty_section(loader, "lights", TY_NODE_LIST);
    scene->light_count = list ? list->count : 0;
    scene->lights = TY_ARENA_ALLOC(loader->arena, ty_light_def, scene->light_count);
    loader->light_textures = TY_ARENA_ALLOC(loader->tree.arena, int, scene->light_count);
    for (int i = 0; i < scene->light_count; ++i)
    {
        ty_light_def* light = &scene->lights[i];
        loader->light_textures[i] = -1;
        if (!ty_params_read(&loader->reader, list->items[i], ty_light_params(), light, NULL))
            continue;
        check_light(loader, list->items[i], light);
        ty_texture_def def = ty_texture_def_default();
        def.path = light->image;
        def.color_space = light->color_space;
        if (light->image)
            loader->light_textures[i] = ty_texture_index(loader, &def, key_place(list->items[i], "image"));
    }
}
