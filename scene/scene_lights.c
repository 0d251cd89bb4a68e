// SPDX-License-Identifier: Apache-2.0
// The section `lights`, with the checks that no table can make.
#include "loader.h"
#include "text.h"
#include <string.h>

static ty_place key_place(const ty_node* map, const char* key)
{
    const ty_node* value = ty_node_get(map, key);
    return value ? value->place : map->place;
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

static bool has_key(const ty_node* node, const char* key)
{
    return ty_node_find(node, key) >= 0;
}

static void check_light(ty_loader* loader, const ty_node* node, const ty_light_def* light)
{
    check_keys(loader, node, (ty_light_kind)light->kind);
    bool aims = light->kind == TY_LIGHT_RECTANGLE || light->kind == TY_LIGHT_DISK || light->kind == TY_LIGHT_SPOT ||
                light->kind == TY_LIGHT_DIRECTIONAL;
    if (aims && ty_length_sqr(ty_sub(light->target, light->center)) <= 0.0f)
        ty_report(loader->errors, key_place(node, "target"), TY_BAD_INPUT, "'target' is the light's own center");
    if (light->kind == TY_LIGHT_CYLINDER && ty_length_sqr(light->axis) <= 0.0f)
        ty_report(loader->errors, key_place(node, "axis"), TY_BAD_INPUT, "'axis' has no length");
    if (light->color_space && !light->image)
        ty_report(loader->errors, key_place(node, "color_space"), TY_BAD_INPUT, "'color_space' without an 'image'");
    if (has_key(node, "power") && (has_key(node, "radiance") || has_key(node, "intensity")))
        ty_report(loader->errors, key_place(node, "power"), TY_BAD_INPUT, "either 'power' or '%s', not both",
                  has_key(node, "radiance") ? "radiance" : "intensity");
}

// What a power of one watt is in radiance (Lambert's law over the area), or in intensity.
static float per_watt(const ty_light_def* light)
{
    float inner = 0.5f * light->cone * (1.0f - light->penumbra);
    switch ((ty_light_kind)light->kind)
    {
    case TY_LIGHT_RECTANGLE:
        return TY_INV_PI / (light->size[0] * light->size[1]);
    case TY_LIGHT_DISK:
        return TY_INV_PI / (TY_PI * ty_sqr(light->radius));
    case TY_LIGHT_SPHERE:
        return TY_INV_PI / (4.0f * TY_PI * ty_sqr(light->radius));
    case TY_LIGHT_CYLINDER:
        return TY_INV_PI / (2.0f * TY_PI * light->radius * light->length);
    case TY_LIGHT_POINT:
        return 0.25f * TY_INV_PI;
    case TY_LIGHT_SPOT: // the fade is symmetric in the cosine
        return 0.5f * TY_INV_PI / (1.0f - 0.5f * (ty_cos(inner) + ty_cos(0.5f * light->cone)));
    case TY_LIGHT_ENVIRONMENT:
    case TY_LIGHT_SKY:
    case TY_LIGHT_DIRECTIONAL:
        break;
    }
    return 0.0f;
}

// Power, colour and exposure become what the renderer knows.
static void resolve_units(ty_light_def* light, bool by_power)
{
    ty_rgb factor = ty_rgb_scale(light->color, ty_exp(light->exposure * 0.693147181f));
    if (by_power)
        light->radiance = light->intensity = ty_rgb_grey(light->power * per_watt(light));
    ty_rgb* const values[] = {&light->radiance, &light->intensity, &light->irradiance,    &light->zenith,
                              &light->horizon,  &light->ground,    &light->sun_irradiance};
    for (int i = 0; i < TY_PARAM_COUNT(values); ++i)
        *values[i] = ty_rgb_mul(*values[i], factor);
}

void ty_read_light(ty_loader* loader, int index)
{
    ty_node* node = ty_section(loader, "lights", TY_NODE_LIST)->items[index];
    ty_light_def* light = &loader->scene->lights[index];
    loader->light_textures[index] = -1;
    if (!ty_params_read(&loader->reader, node, ty_light_params(), light, NULL))
        return;
    check_light(loader, node, light);
    resolve_units(light, has_key(node, "power"));
    light->group_index = ty_light_group_index(loader, ty_node_get(node, "group"));
    ty_texture_def def = ty_texture_def_default();
    def.path = light->image;
    def.color_space = light->color_space;
    if (light->kind == TY_LIGHT_SPOT)
        def.wrap = TY_WRAP_CLAMP;
    if (light->image)
        loader->light_textures[index] = ty_texture_index(loader, &def, key_place(node, "image"));
}

void ty_read_lights(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    ty_node* list = ty_section(loader, "lights", TY_NODE_LIST);
    scene->light_count = list ? list->count : 0;
    scene->lights = TY_ARENA_ALLOC(loader->arena, ty_light_def, scene->light_count);
    loader->light_textures = TY_ARENA_ALLOC(loader->tree.arena, int, scene->light_count);
    for (int i = 0; i < scene->light_count; ++i)
        ty_read_light(loader, i);
}
