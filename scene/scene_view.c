// SPDX-License-Identifier: Apache-2.0
// The sections `film`, `render` and `turntable`, with the checks that no table can make.
#include "loader.h"

void ty_read_section(ty_loader* loader, const char* name, const ty_param_table* table, void* def)
{
    ty_node* node = ty_section(loader, name, TY_NODE_MAP);
    table->set_default(def);
    if (node)
        (void)ty_params_read(&loader->reader, node, table, def, NULL); // what is wrong is in the list of errors
}

ty_place ty_key_place(const ty_node* map, const char* key)
{
    const ty_node* value = ty_node_get(map, key);
    return value ? value->place : map->place;
}

bool ty_turntable_map(const ty_scene* scene, ty_affine* map)
{
    const ty_turntable_def* def = &scene->turntable;
    if (!(fabsf(def->angle) > 0.0f))
        return false;
    ty_vec3 about = def->has_about ? def->about : scene->camera.look_at;
    ty_quat turn = ty_quat_axis_angle(ty_normalize(def->axis), def->angle);
    *map = ty_affine_from_trs(ty_sub(about, ty_quat_rotate(turn, about)), turn, ty_vec3_make(1.0f, 1.0f, 1.0f));
    return true;
}

void ty_read_turntable(ty_loader* loader)
{
    ty_turntable_def* turntable = &loader->scene->turntable;
    ty_read_section(loader, "turntable", ty_turntable_params(), turntable);
    const ty_node* node = ty_section(loader, "turntable", TY_NODE_MAP);
    turntable->has_about = ty_node_find(node, "about") >= 0;
    if (node && ty_length_sqr(turntable->axis) <= 0.0f)
        ty_report(loader->errors, ty_key_place(node, "axis"), TY_BAD_INPUT, "'axis' has no direction");
}

void ty_read_view(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    ty_read_section(loader, "film", ty_film_params(), &scene->film);
    ty_read_section(loader, "render", ty_render_params(), &scene->render);
    loader->seed = scene->render.seed;
    ty_read_turntable(loader);
    ty_read_camera(loader);
}
