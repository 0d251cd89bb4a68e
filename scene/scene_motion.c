// SPDX-License-Identifier: Apache-2.0
// What moves while the shutter is open: camera and objects, posed at even steps over it.
#include "loader.h"
#include <string.h>

_Static_assert(TY_MOTION_MAX_STEPS == 33, "the range of camera.motion_steps");

// In frames, from the frame's own moment.
static double step_offset(const ty_camera_def* camera, int step, int count)
{
    static const double begin[] = {[TY_SHUTTER_CENTER] = -0.5, [TY_SHUTTER_START] = 0.0, [TY_SHUTTER_END] = -1.0};
    return (double)camera->shutter * (begin[camera->shutter_position] + (double)step / (count - 1));
}

static bool is_section(const ty_animated* entry, ty_section_kind section)
{
    return entry->section == section;
}

// Camera and turntable as they are at a moment.
static void pose_view(ty_loader* loader, ty_moment moment)
{
    for (int i = 0; i < loader->timeline.entry_count; ++i)
        if (is_section(&loader->timeline.entries[i], TY_SECTION_CAMERA) ||
            is_section(&loader->timeline.entries[i], TY_SECTION_TURNTABLE))
            ty_timeline_evaluate(&loader->timeline, i, moment, loader->errors);
    ty_read_turntable(loader);
    ty_read_camera(loader);
}

static bool turns_objects(const ty_loader* loader)
{
    return loader->scene->turntable.turn == TY_TURN_OBJECTS;
}

static bool has_view_keys(const ty_loader* loader)
{
    return ty_timeline_find(&loader->timeline, TY_SECTION_CAMERA, 0) >= 0 ||
           ty_timeline_find(&loader->timeline, TY_SECTION_TURNTABLE, 0) >= 0;
}

// Objects that may move: those with keys, or all on a turntable with keys.
static bool may_move(const ty_loader* loader, int object)
{
    return loader->objects[object].keys >= 0 || (turns_objects(loader) && has_view_keys(loader));
}

// The view is at that moment already.
static void pose_objects(ty_loader* loader, ty_moment moment)
{
    for (int i = 0; i < loader->entry_count; ++i)
    {
        ty_object_entry* entry = &loader->objects[i];
        if (!may_move(loader, i))
            continue;
        if (entry->keys >= 0)
            ty_timeline_evaluate(&loader->timeline, entry->keys, moment, loader->errors);
        ty_pose_object(loader, i);
    }
}

static float affine_distance(const ty_affine* a, const ty_affine* b)
{
    return ty_length(ty_sub(a->x, b->x)) + ty_length(ty_sub(a->y, b->y)) + ty_length(ty_sub(a->z, b->z)) +
           ty_length(ty_sub(a->t, b->t));
}

static ty_affine affine_lerp(const ty_affine* a, const ty_affine* b, float s)
{
    return (ty_affine){ty_lerp3(a->x, b->x, s), ty_lerp3(a->y, b->y, s), ty_lerp3(a->z, b->z, s),
                       ty_lerp3(a->t, b->t, s)};
}

// 1 = at rest; 2 = a straight line, to rounding: its ends say it all.
static int needed_steps(const ty_affine* steps, int count)
{
    bool rests = true, straight = true;
    float length = affine_distance(&steps[0], &steps[count - 1]);
    for (int i = 1; i < count; ++i)
    {
        ty_affine line = affine_lerp(&steps[0], &steps[count - 1], (float)i / (float)(count - 1));
        rests &= memcmp(&steps[i], &steps[0], sizeof *steps) == 0;
        straight &= affine_distance(&line, &steps[i]) <= 1e-5f * length;
    }
    return rests ? 1 : straight ? 2 : count;
}

// Objects whose motion is another than the world knows make it be built again.
static void settle_object(ty_loader* loader, ty_object_entry* entry, int count)
{
    int needed = needed_steps(entry->steps, count);
    entry->steps[needed - 1] = entry->steps[needed == 1 ? 0 : count - 1];
    size_t size = (size_t)needed * sizeof *entry->steps;
    if (needed == entry->step_count && memcmp(entry->steps, entry->built_steps, size) == 0)
        return;
    memcpy(entry->built_steps, entry->steps, size);
    entry->step_count = needed;
    loader->world_changed = true;
}

static void allocate_steps(ty_loader* loader, int count)
{
    ty_scene* scene = loader->scene;
    for (int i = 0; i < loader->entry_count; ++i)
        loader->objects[i].keys = -1;
    for (int i = 0; i < loader->timeline.entry_count; ++i)
        if (is_section(&loader->timeline.entries[i], TY_SECTION_OBJECT))
            loader->objects[loader->timeline.entries[i].index].keys = i;
    for (int i = 0; i < loader->entry_count; ++i)
    {
        ty_object_entry* entry = &loader->objects[i];
        if (!may_move(loader, i) || entry->step_capacity >= count)
            continue;
        ty_affine* steps = TY_ARENA_ALLOC(loader->arena, ty_affine, 2 * count);
        if (entry->step_count)
            memcpy(steps + count, entry->built_steps, (size_t)entry->step_count * sizeof *steps);
        entry->steps = steps;
        entry->built_steps = steps + count;
        entry->step_capacity = count;
    }
    if (loader->camera_capacity >= count)
        return;
    scene->camera_steps = TY_ARENA_ALLOC(loader->arena, ty_camera_def, count);
    loader->camera_capacity = count;
}

// By what the table knows: a struct's padding is nobody's.
static bool same_camera(const ty_camera_def* a, const ty_camera_def* b)
{
    const ty_param_table* table = ty_camera_params();
    for (int i = 0; i < table->count; ++i)
    {
        const ty_param* row = &table->params[i];
        size_t size = row->type == TY_PARAM_FLOAT3 ? sizeof(ty_vec3) : row->type == TY_PARAM_FLOAT2 ? 8 : 4;
        if (row->type != TY_PARAM_STRING &&
            memcmp((const char*)a + row->offset, (const char*)b + row->offset, size) != 0)
            return false;
    }
    return true;
}

void ty_settle_moves(ty_loader* loader)
{
    loader->scene->moves = loader->poses_move || loader->instances_move || loader->meshes_move;
}

static void settle(ty_loader* loader, int count)
{
    ty_scene* scene = loader->scene;
    scene->camera_step_count = 1;
    for (int i = 1; i < count; ++i)
        if (!same_camera(&scene->camera_steps[i], &scene->camera_steps[0]))
            scene->camera_step_count = count;
    loader->poses_move = scene->camera_step_count > 1;
    for (int i = 0; i < loader->entry_count; ++i)
    {
        if (!may_move(loader, i))
            continue;
        settle_object(loader, &loader->objects[i], count);
        loader->poses_move |= loader->objects[i].step_count > 1;
    }
    ty_settle_moves(loader);
}

static void pose(ty_loader* loader, ty_moment moment)
{
    pose_view(loader, moment);
    pose_objects(loader, moment);
    ty_focus_camera(loader);
}

static void keep_pose(ty_loader* loader, int step)
{
    loader->scene->camera_steps[step] = loader->scene->camera;
    for (int i = 0; i < loader->entry_count; ++i)
        if (may_move(loader, i))
            loader->objects[i].steps[step] = loader->objects[i].transform;
}

// Instances go by their velocities for as long as it is open: another time makes the world another.
static void settle_shutter(ty_loader* loader, const ty_camera_def* camera)
{
    for (int i = 0; i < 2; ++i)
    {
        float seconds = (float)(step_offset(camera, i, 2) / (double)loader->scene->timeline.fps);
        for (int k = 0; seconds != loader->shutter[i] && k < loader->asset_count; ++k)
            loader->world_changed |= loader->assets[k].aggregate && loader->assets[k].aggregate->velocities;
        loader->shutter[i] = seconds;
    }
}

void ty_pose_scene(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    if (has_view_keys(loader))
        pose_view(loader, (ty_moment){scene->frame, 0.0}); // the shutter may be keyed: not as the last frame left it
    ty_camera_def still = scene->camera;
    settle_shutter(loader, &still);
    int count = still.shutter > 0.0f && loader->timeline.entry_count > 0 ? still.motion_steps : 1;
    allocate_steps(loader, count);
    for (int step = 0; step < count; ++step)
    {
        pose(loader, (ty_moment){scene->frame, count > 1 ? step_offset(&still, step, count) : 0.0});
        keep_pose(loader, step);
    }
    settle(loader, count);
    pose(loader, (ty_moment){scene->frame, 0.0}); // everybody else sees the frame's own moment
    for (int i = 0; i < loader->timeline.entry_count; ++i)
        loader->timeline.entries[i].changed = false;
}
