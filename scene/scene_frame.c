// SPDX-License-Identifier: Apache-2.0
// A scene at a frame: keys evaluated, what they changed read again, the world rebuilt if objects moved.
#include "loader.h"
#include "number.h"
#include <stdio.h>
#include <string.h>

#define MOST_FRAME 1e7

void ty_frame_read_timeline(ty_loader* loader)
{
    ty_timeline_def* def = &loader->scene->timeline;
    ty_node* node = ty_section(loader, "timeline", TY_NODE_MAP);
    *def = ty_timeline_def_default();
    if (!node || !ty_params_read(&loader->reader, node, ty_timeline_params(), def, NULL))
        return;
    const ty_node *start = ty_node_get(node, "start"), *end = ty_node_get(node, "end");
    if (!end && def->end < def->start)
        def->end = def->start;
    if (def->end < def->start)
        ty_report(loader->errors, (end ? end : start)->place, TY_BAD_INPUT, "'end' is %d, ahead of 'start', %d",
                  def->end, def->start);
}

static void parse_frame(ty_loader* loader, const ty_node* node)
{
    char described[80];
    bool good = node->kind == TY_NODE_SCALAR && ty_number_parse(node->text, &loader->scene->frame);
    if (!good || fabs(loader->scene->frame) > MOST_FRAME)
        ty_report(loader->errors, node->place, TY_BAD_INPUT, "'frame': expected a number -1e7..1e7, got %s",
                  ty_node_describe(node, described));
}

static void read_frame(ty_loader* loader)
{
    const ty_node* node = loader->frame_node;
    loader->scene->frame = loader->scene->timeline.start;
    if (node && !node->bad)
        parse_frame(loader, node);
    if (loader->options->frame)
        loader->scene->frame = *loader->options->frame;
}

// The recipe of a picture tells its frame wherever frames may differ.
static void tell_frame(ty_loader* loader)
{
    if (!loader->frame_node)
    {
        loader->frame_node = ty_node_create(&loader->tree, TY_NODE_SCALAR, loader->root->place);
        if (!loader->frame_node)
            return;
        ty_node_add(&loader->tree, loader->root, (ty_key){"frame", loader->root->place}, loader->frame_node);
    }
    if (loader->frame_node->path != loader->frame_node->text) // the first time: a text of its own
        loader->frame_node->path = loader->frame_node->text = TY_ARENA_ALLOC(loader->tree.arena, char, TY_TRACK_TEXT);
    snprintf((char*)loader->frame_node->text, TY_TRACK_TEXT, "%.17g", loader->scene->frame);
}

static void set_time(ty_loader* loader, double frame)
{
    ty_scene* scene = loader->scene;
    scene->frame = frame;
    scene->seconds = (frame - scene->timeline.start) / (double)scene->timeline.fps;
    uint64_t bits;
    memcpy(&bits, &frame, sizeof bits);
    scene->render.seed = loader->seed;
    if (scene->render.animate_seed)
        scene->render.seed.value = ty_rng_make(loader->seed, bits, 0).key;
    for (int i = 0; i < loader->timeline.entry_count; ++i)
        ty_timeline_evaluate(&loader->timeline, i, (ty_moment){frame, 0.0},
                             loader->options->frame_count > 0 ? NULL : loader->errors); // else told for all at once
}

void ty_frame_begin(ty_loader* loader)
{
    ty_frame_read_timeline(loader);
    loader->frame_node = ty_node_get(loader->root, "frame");
    read_frame(loader);
    ty_timeline_collect(&loader->timeline, &loader->tree, &loader->reader, loader->root);
    if (loader->frame_node || loader->timeline.track_count || ty_node_get(loader->root, "timeline"))
        tell_frame(loader);
    ty_check_keys_cover(loader);
    set_time(loader, loader->scene->frame);
}

// --- reading again ---

static void read_entry(ty_loader* loader, const ty_animated* entry)
{
    switch (entry->section)
    {
    case TY_SECTION_CAMERA:
        ty_read_camera(loader);
        break;
    case TY_SECTION_TURNTABLE:
        ty_read_turntable(loader);
        break;
    case TY_SECTION_MATERIAL:
        ty_read_material(loader, entry->index);
        break;
    case TY_SECTION_LIGHT:
        ty_read_light(loader, entry->index);
        break;
    case TY_SECTION_OBJECT:
        ty_read_object(loader, entry->index);
        break;
    }
}

static bool same_error(const ty_error* a, const ty_error* b)
{
    return a->line == b->line && a->column == b->column && strcmp(a->file, b->file) == 0 &&
           strcmp(a->text, b->text) == 0;
}

// What an entry says at one key it says at the next one too, and at every pose.
void ty_forget_repeated(ty_error_list* errors, int from)
{
    int kept = from;
    for (int i = from; i < errors->count; ++i)
    {
        int j = 0;
        while (j < kept && !same_error(&errors->items[i], &errors->items[j]))
            ++j;
        if (j == kept)
            errors->items[kept++] = errors->items[i];
    }
    errors->count = kept;
}

static bool has_key(const ty_track* track, double time)
{
    int low = 0, high = track->key_count;
    while (low < high)
    {
        int middle = (low + high) / 2;
        if (track->times[middle] < time)
            low = middle + 1;
        else
            high = middle;
    }
    return low < track->key_count && track->times[low] <= time;
}

static void check_at(ty_loader* loader, int entry, double frame)
{
    int before = loader->errors->count;
    ty_timeline_evaluate(&loader->timeline, entry, (ty_moment){frame, 0.0}, NULL);
    read_entry(loader, &loader->timeline.entries[entry]);
    ty_forget_repeated(loader->errors, before);
}

static void check_entry(ty_loader* loader, int entry)
{
    const ty_timeline* timeline = &loader->timeline;
    const ty_animated* animated = &timeline->entries[entry];
    const ty_track* tracks = timeline->tracks + animated->first_track;
    for (int i = 0; i < animated->track_count; ++i)
        for (int k = 0; k < tracks[i].key_count; ++k)
        {
            bool seen = false;
            for (int other = 0; other < i && !seen; ++other)
                seen = has_key(&tracks[other], tracks[i].times[k]);
            if (!seen)
                check_at(loader, entry, tracks[i].times[k]);
        }
    check_at(loader, entry, loader->scene->frame);
}

void ty_frame_check_keys(ty_loader* loader)
{
    ty_timeline* timeline = &loader->timeline;
    loader->checks_keys = true;
    for (int i = 0; i < timeline->entry_count && !loader->tree.stopped; ++i)
        check_entry(loader, i);
    loader->checks_keys = false;
    for (int i = 0; i < timeline->entry_count; ++i)
        timeline->entries[i].changed = false;
}

// --- another frame ---

static void count_entry(ty_scene_rebuilds* rebuilds, ty_section_kind section)
{
    switch (section)
    {
    case TY_SECTION_CAMERA:
    case TY_SECTION_TURNTABLE:
        break; // counted where they are read
    case TY_SECTION_MATERIAL:
        ++rebuilds->materials;
        break;
    case TY_SECTION_LIGHT:
        ++rebuilds->lights;
        break;
    case TY_SECTION_OBJECT:
        ++rebuilds->objects;
        break;
    }
}

static bool section_changed(const ty_timeline* timeline, ty_section_kind section)
{
    for (int i = 0; i < timeline->entry_count; ++i)
        if (timeline->entries[i].section == section && timeline->entries[i].changed)
            return true;
    return false;
}

// What is not posed: materials and lights are as they are at the frame's moment.
static void read_changed(ty_loader* loader)
{
    ty_timeline* timeline = &loader->timeline;
    for (int i = 0; i < timeline->entry_count; ++i)
    {
        const ty_animated* entry = &timeline->entries[i];
        if (!entry->changed)
            continue;
        if (entry->section == TY_SECTION_MATERIAL || entry->section == TY_SECTION_LIGHT)
            read_entry(loader, entry);
        count_entry(&loader->scene->rebuilds, entry->section);
    }
}

static void go_to(ty_loader* loader, double frame)
{
    set_time(loader, frame);
    ty_scene_rebuilds* rebuilds = &loader->scene->rebuilds;
    bool view = section_changed(&loader->timeline, TY_SECTION_CAMERA) ||
                section_changed(&loader->timeline, TY_SECTION_TURNTABLE);
    rebuilds->cameras += view;
    read_changed(loader);
    ty_set_aggregate_times(loader);
    ty_set_mesh_times(loader); // ahead of the poses: a camera may focus on what it shows
    ty_pose_scene(loader);
    ty_set_mesh_motion(loader);
}

ty_status ty_scene_set_frame(ty_scene* scene, double frame, ty_error_list* errors)
{
    ty_loader* loader = scene->resources->loader;
    int first = errors->count;
    TY_ASSERT(fabs(frame) <= MOST_FRAME);
    ty_loader_report_to(loader, errors);
    go_to(loader, frame);
    ty_set_texture_times(loader);
    if (errors->count == first && scene->world && ty_world_is_stale(loader))
    {
        ty_rebuild_world(loader);
        ++scene->rebuilds.worlds;
    }
    tell_frame(loader);
    ty_frame_write_recipe(loader);
    ++scene->rebuilds.frames;
    ty_forget_repeated(errors, first);
    ty_loader_report_to(loader, NULL);
    return errors->count == first ? TY_OK : ty_loader_status(errors, first);
}
