// SPDX-License-Identifier: Apache-2.0
// The sections `film`, `camera`, `render` and `turntable`, with the checks that no table can make.
#include "loader.h"

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

// The turn at this frame; false = none.
static bool turntable_map(const ty_scene* scene, ty_affine* map)
{
    const ty_turntable_def* def = &scene->turntable;
    if (!(fabsf(def->angle) > 0.0f))
        return false;
    ty_vec3 about = def->has_about ? def->about : scene->camera.look_at;
    ty_quat turn = ty_quat_axis_angle(ty_normalize(def->axis), def->angle);
    *map = ty_affine_from_trs(ty_sub(about, ty_quat_rotate(turn, about)), turn, ty_vec3_make(1.0f, 1.0f, 1.0f));
    return true;
}

bool ty_object_turn(const ty_scene* scene, ty_affine* map)
{
    return scene->turntable.turn == TY_TURN_OBJECTS && turntable_map(scene, map);
}

static void turn_camera(ty_scene* scene)
{
    ty_affine map;
    ty_camera_def* camera = &scene->camera;
    if (scene->turntable.turn != TY_TURN_CAMERA || !turntable_map(scene, &map))
        return;
    camera->position = ty_map_point(&map, camera->position);
    camera->look_at = ty_map_point(&map, camera->look_at);
    camera->up = ty_map_vector(&map, camera->up);
}

static void check_camera(ty_loader* loader, const ty_node* node)
{
    const ty_camera_def* camera = &loader->scene->camera;
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

void ty_read_camera(ty_loader* loader)
{
    ty_camera_def* camera = &loader->scene->camera;
    read_section(loader, "camera", ty_camera_params(), camera);
    ty_node* node = ty_section(loader, "camera", TY_NODE_MAP);
    camera->has_focus_point = ty_node_find(node, "focus_point") >= 0;
    if (node)
        check_camera(loader, node);
    turn_camera(loader->scene);
}

void ty_read_turntable(ty_loader* loader)
{
    ty_turntable_def* turntable = &loader->scene->turntable;
    read_section(loader, "turntable", ty_turntable_params(), turntable);
    const ty_node* node = ty_section(loader, "turntable", TY_NODE_MAP);
    turntable->has_about = ty_node_find(node, "about") >= 0;
    if (node && ty_length_sqr(turntable->axis) <= 0.0f)
        ty_report(loader->errors, key_place(node, "axis"), TY_BAD_INPUT, "'axis' has no direction");
}

void ty_read_view(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    read_section(loader, "film", ty_film_params(), &scene->film);
    read_section(loader, "render", ty_render_params(), &scene->render);
    loader->seed = scene->render.seed;
    ty_read_turntable(loader);
    ty_read_camera(loader);
}
