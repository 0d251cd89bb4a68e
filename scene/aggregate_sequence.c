// SPDX-License-Identifier: Apache-2.0
// Aggregates that change with time: a file a frame of the same instances, of which the transforms and attributes
// change in place.
#include "loader.h"
#include <string.h>

typedef struct ty_aggregate_sequence
{
    const char* pattern;
    ty_mip_texture_def timing; // path and what is of images unused
    int first, count;          // numbers of the files
    int shown;                 // which of them the asset's aggregate is, from 0; -1 = none yet
    int attribute_count;       // of the files: what the scene makes itself comes after these
} ty_aggregate_sequence;

void ty_aggregate_sequence_read(ty_loader* loader, ty_asset* asset, const ty_aggregate_asset_def* def, ty_node* pattern)
{
    ty_sequence_check(loader, &def->sequence, asset->place);
    const char* path = ty_files_use_frames(&loader->files, pattern, "aggregate");
    if (!path)
        return;
    ty_aggregate_sequence* s = TY_ARENA_ALLOC(loader->arena, ty_aggregate_sequence, 1);
    *s = (ty_aggregate_sequence){.pattern = path, .timing = ty_sequence_timing(&def->sequence), .shown = -1};
    asset->path = path;
    if (!ty_sequence_find_files(loader, path, &def->sequence, "aggregate", asset->place, &s->first, &s->count))
        return;
    ty_check_sequence_covers(loader, &s->timing, s->count, asset->place);
    asset->aggregate_sequence = s;
}

// --- files ---

static bool same_mesh(const ty_mesh* a, const ty_mesh* b)
{
    return a->vertex_count == b->vertex_count && a->triangle_count == b->triangle_count &&
           memcmp(a->positions, b->positions, a->vertex_count * sizeof(*a->positions)) == 0 &&
           memcmp(a->triangles, b->triangles, a->triangle_count * sizeof(*a->triangles)) == 0;
}

// The index of the first prototype that differs; -1 = none.
static int other_prototype(const ty_aggregate* a, const ty_aggregate* b)
{
    for (int i = 0; i < a->prototype_count; ++i)
        if (!same_mesh(a->prototypes[i], b->prototypes[i]))
            return i;
    return -1;
}

// The first instance that is another one; the count = none.
static uint32_t other_instance(const ty_aggregate* a, const ty_aggregate* b)
{
    uint32_t i = 0;
    while (i < a->instance_count && a->ids[i] == b->ids[i] && a->prototype_index[i] == b->prototype_index[i])
        ++i;
    return i;
}

// The first attribute of the files that b lacks, else one that b has besides them, else NULL.
static const char* other_attribute(const ty_aggregate* a, int count, const ty_aggregate* b)
{
    for (int i = 0; i < count; ++i)
        if (!ty_aggregate_find_attribute(b, a->attributes[i].name))
            return a->attributes[i].name;
    for (int k = 0; k < b->attribute_count; ++k)
    {
        int i = 0;
        while (i < count && strcmp(a->attributes[i].name, b->attributes[k].name) != 0)
            ++i;
        if (i == count)
            return b->attributes[k].name;
    }
    return NULL;
}

// What makes b no other moment of a, in words; false = nothing does.
static bool describe_difference(const ty_aggregate* a, int attribute_count, const ty_aggregate* b, ty_error* why)
{
    if (a->instance_count != b->instance_count)
        (void)ty_error_set(why, TY_BAD_FILE, "has %u instances, the others %u", b->instance_count, a->instance_count);
    else if (a->prototype_count != b->prototype_count)
        (void)ty_error_set(why, TY_BAD_FILE, "has %d prototypes, the others %d", b->prototype_count,
                           a->prototype_count);
    else if (other_prototype(a, b) >= 0)
        (void)ty_error_set(why, TY_BAD_FILE, "prototype %d is another mesh than in the others", other_prototype(a, b));
    else if (other_instance(a, b) < a->instance_count)
        (void)ty_error_set(why, TY_BAD_FILE, "instance %u has another id or prototype (%u, %u) than in the others",
                           other_instance(a, b), b->ids[other_instance(a, b)],
                           b->prototype_index[other_instance(a, b)]);
    else if (other_attribute(a, attribute_count, b))
        (void)ty_error_set(why, TY_BAD_FILE, "'%s' is an attribute of some of the files only",
                           other_attribute(a, attribute_count, b));
    else if (!a->velocities != !b->velocities || !a->spins != !b->spins)
        (void)ty_error_set(why, TY_BAD_FILE, "velocities or spins stand in some of the files only");
    else
        return false;
    return true;
}

// The file of index i (from 0), compared with what was read first, if anything. NULL after a report.
static ty_aggregate* read_file(ty_loader* loader, const ty_asset* asset, int i)
{
    const ty_aggregate_sequence* s = asset->aggregate_sequence;
    const ty_mesh* prototype = asset->prototype >= 0 ? loader->assets[asset->prototype].mesh : NULL;
    char path[TY_PATH_MAX];
    ty_error error;
    ty_aggregate* aggregate = NULL;
    ty_path_frame(s->pattern, s->first + i, path);
    if (ty_aggregate_read(path, prototype, &aggregate, &error) != TY_OK)
    {
        ty_report_error(loader->errors, asset->place, "aggregate", &error);
        return NULL;
    }
    if (!asset->aggregate || !describe_difference(asset->aggregate, s->attribute_count, aggregate, &error))
        return aggregate;
    ty_report(loader->errors, asset->place, TY_BAD_FILE,
              "aggregate: frame %d, '%s': %s: a sequence has the same instances in every file", s->first + i, path,
              error.text);
    ty_aggregate_destroy(aggregate);
    return NULL;
}

// --- showing ---

// The arrays stay where they are: world and shading point into them.
static void move_instances(ty_aggregate* out, int attribute_count, const ty_aggregate* from)
{
    memcpy(out->transforms, from->transforms, out->instance_count * sizeof(*out->transforms));
    for (int i = 0; i < attribute_count; ++i)
        memcpy(out->attributes[i].values, ty_aggregate_find_attribute(from, out->attributes[i].name)->values,
               out->instance_count * sizeof(float));
    if (out->velocities)
        memcpy(out->velocities, from->velocities, out->instance_count * sizeof(*out->velocities));
    if (out->spins)
        memcpy(out->spins, from->spins, out->instance_count * sizeof(*out->spins));
    for (int i = attribute_count; i < out->attribute_count; ++i)
        ty_compute_height(out, out->attributes[i].values); // the one that the scene makes
}

// The asset's aggregate at the scene's seconds; whether it changed. What is wrong is in the list of errors.
static bool show(ty_loader* loader, ty_asset* asset)
{
    ty_aggregate_sequence* s = asset->aggregate_sequence;
    int wanted[2];
    float weight;
    if (!ty_sequence_at(&s->timing, s->count, loader->scene->seconds, wanted, &weight))
    {
        ty_report(loader->errors, asset->place, TY_BAD_INPUT, "aggregate: %g s is outside of the sequence",
                  loader->scene->seconds);
        return false;
    }
    if (wanted[0] == s->shown)
        return false;
    ty_aggregate* aggregate = read_file(loader, asset, wanted[0]);
    if (!aggregate)
        return false;
    s->shown = wanted[0];
    if (!asset->aggregate)
    {
        asset->aggregate = aggregate;
        s->attribute_count = aggregate->attribute_count;
        return true;
    }
    move_instances(asset->aggregate, s->attribute_count, aggregate);
    ty_aggregate_destroy(aggregate);
    return true;
}

void ty_aggregate_sequence_load(ty_loader* loader, ty_asset* asset)
{
    (void)show(loader, asset);
    if (!loader->options->check_only) // which looks at every file
        return;
    for (int i = 0; asset->aggregate && i < asset->aggregate_sequence->count; ++i)
        ty_aggregate_destroy(read_file(loader, asset, i));
}

void ty_set_aggregate_times(ty_loader* loader)
{
    for (int i = 0; i < loader->asset_count; ++i)
    {
        ty_asset* asset = &loader->assets[i];
        if (!asset->aggregate_sequence || !asset->aggregate || !show(loader, asset))
            continue;
        asset->bounds_known = false;
        loader->world_changed = true;
    }
}
