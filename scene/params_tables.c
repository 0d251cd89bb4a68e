// SPDX-License-Identifier: Apache-2.0
// Every parameter table of scenes and recipes, with the tables inside them, in a fixed order.
#include "scene_params.h"
#include <tsuya/generate/asset.h>
#include <tsuya/geometry/shape.h>
#include <tsuya/scene/calibration.h>
#include <tsuya/scene/regression.h>

#define MOST 128

typedef struct ty_table_list
{
    const ty_param_table* items[MOST];
    int count;
} ty_table_list;

static void add(ty_table_list* list, const ty_param_table* table)
{
    for (int i = 0; i < list->count; ++i)
        if (list->items[i] == table)
            return;
    TY_ASSERT(list->count < MOST);
    list->items[list->count++] = table;
    for (int i = 0; i < table->count; ++i)
        if (table->params[i].group)
            add(list, table->params[i].group);
}

const ty_param_table* const* ty_scene_tables(int* count)
{
    static ty_table_list tables; // filled with the same values at each call
    ty_table_list list = {.count = 0};
    add(&list, ty_film_params());
    add(&list, ty_camera_params());
    add(&list, ty_render_params());
    add(&list, ty_timeline_params());
    add(&list, ty_turntable_params());
    add(&list, ty_light_params());
    add(&list, ty_object_params());
    add(&list, ty_mesh_asset_params());
    add(&list, ty_shape_params());
    add(&list, ty_texture_asset_params());
    add(&list, ty_frames_asset_params("frames"));
    add(&list, ty_frames_asset_params("fill"));
    add(&list, ty_frames_asset_params("loop"));
    add(&list, ty_frames_asset_params("filter"));
    add(&list, ty_aggregate_asset_params());
    add(&list, ty_gltf_asset_params());
    add(&list, ty_surface_params());
    add(&list, ty_cdrf_params());
    add(&list, ty_walk_params());
    add(&list, ty_bark_params());
    int generators = 0;
    const ty_generator* const* all = ty_generator_list(&generators);
    for (int i = 0; i < generators; ++i)
        add(&list, all[i]->params);
    add(&list, ty_optical_states_params());
    add(&list, ty_regression_params());
    tables = list;
    *count = tables.count;
    return tables.items;
}
