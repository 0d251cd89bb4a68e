// SPDX-License-Identifier: Apache-2.0
// Meshes of sequences while the shutter is open: their vertices at even steps over it.
#include "mesh_sequence.h"
#include <string.h>
#include <tsuya/base/log.h>

// Times of files and steps may differ by rounding; in frames of the sequence.
#define SAME_TIME 1e-3

// Vertices go straight from one file to the next, so every file that is shown within the shutter has to be a step:
// as few even ones as that takes, or many where no number of them fits.
static int steps_between(double open, double close)
{
    int first = (int)floor(open + SAME_TIME) + 1, last = (int)ceil(close - SAME_TIME) - 1;
    int most = 4 * (last - first + 1) + 1;
    most = most < 2 ? 2 : most > TY_MESH_MAX_STEPS ? TY_MESH_MAX_STEPS : most;
    for (int count = 2; count < most; ++count)
    {
        bool fits = true;
        for (int k = first; k <= last; ++k)
        {
            double at = ((double)k - open) / (close - open) * (double)(count - 1);
            fits &= fabs(at - floor(at + 0.5)) <= SAME_TIME;
        }
        if (fits)
            return count;
    }
    return most;
}

// What stops outside of its time stands still there.
static double within(const ty_mesh_sequence* s, double seconds)
{
    double start = (double)s->timing.start, end = start + (double)(s->count - 1) / (double)s->timing.fps;
    return s->timing.end != TY_SEQUENCE_STOP ? seconds : seconds < start ? start : seconds > end ? end : seconds;
}

static bool load_step(ty_loader* loader, ty_asset* asset, double seconds, int step)
{
    ty_mesh_sequence* s = asset->sequence;
    ty_mesh* mesh = asset->mesh;
    int wanted[2];
    float weight;
    if (!ty_sequence_at(&s->timing, s->count, within(s, seconds), wanted, &weight))
        return false;
    if (!ty_mesh_sequence_files(loader, s, wanted, mesh, asset->place))
        return false;
    const ty_mesh *a = s->frames[0], *b = s->frames[wanted[0] == wanted[1] ? 0 : 1];
    size_t n = mesh->vertex_count, at = (size_t)step * n;
    ty_mesh_blend_floats(&mesh->step_positions[at].x, &a->positions[0].x, &b->positions[0].x, 3 * n, weight);
    ty_mesh_blend_normals(mesh->step_normals + at, a, b, weight);
    return true;
}

static bool rests(const ty_mesh* mesh)
{
    size_t size = mesh->vertex_count * sizeof(ty_vec3);
    bool same = true;
    for (int i = 1; i < mesh->step_count && same; ++i)
        same = memcmp(mesh->step_positions, mesh->step_positions + (size_t)i * mesh->vertex_count, size) == 0;
    return same;
}

// False after a report.
static bool make_steps(ty_loader* loader, ty_asset* asset)
{
    ty_mesh_sequence* s = asset->sequence;
    double open = s->shutter[0], close = s->shutter[1];
    double start = (double)s->timing.start, fps = (double)s->timing.fps;
    int count = steps_between((open - start) * fps, (close - start) * fps);
    if (!ty_mesh_make_steps(asset->mesh, count))
    {
        ty_report(loader->errors, asset->place, TY_NO_MEMORY, "mesh: no memory for %u vertices at %d moments",
                  asset->mesh->vertex_count, count);
        return false;
    }
    for (int i = 0; i < count; ++i)
        if (!load_step(loader, asset, open + (close - open) * (double)i / (double)(count - 1), i))
            return false;
    if (rests(asset->mesh))
        ty_mesh_forget_steps(asset->mesh);
    return true;
}

// Light is drawn from the triangles of what emits, where they stand at the frame's moment.
static bool emits(const ty_loader* loader, const ty_mesh* mesh)
{
    const ty_scene* scene = loader->scene;
    for (int i = 0; i < scene->object_count; ++i)
        for (uint32_t k = 0; loader->placed[i].mesh == mesh && k < ty_scene_material_count(&scene->objects[i]); ++k)
            if (ty_material_is_emissive(scene->materials[ty_scene_material_at(&scene->objects[i], k)]))
                return true;
    return false;
}

static bool may_blur(const ty_loader* loader, const ty_asset* asset)
{
    ty_mesh_sequence* s = asset->sequence;
    if (!(loader->shutter[1] > loader->shutter[0]) || s->count < 2)
        return false;
    bool shines = emits(loader, asset->mesh);
    if (!s->timing.blend && !s->told)
        ty_log(TY_LOG_INFO, "mesh '%s' shows one file at a time ('interpolate: none'): it does not blur", asset->name);
    else if (shines && !s->told)
        ty_log(TY_LOG_INFO, "mesh '%s' emits light: its vertices do not blur", asset->name);
    s->told = true;
    return s->timing.blend && !shines;
}

// Marks the mesh where its steps are others now. False after a report.
static bool set_motion(ty_loader* loader, ty_asset* asset)
{
    ty_mesh_sequence* s = asset->sequence;
    double shutter[2] = {loader->scene->seconds + (double)loader->shutter[0],
                         loader->scene->seconds + (double)loader->shutter[1]};
    bool had = asset->mesh->step_count > 0, blurs = may_blur(loader, asset);
    if (had && blurs && memcmp(shutter, s->shutter, sizeof shutter) == 0)
        return true;
    memcpy(s->shutter, shutter, sizeof shutter);
    if (!blurs)
        ty_mesh_forget_steps(asset->mesh);
    else if (!make_steps(loader, asset))
        return false;
    if (had || asset->mesh->step_count > 0)
        loader->world_changed = s->changed = true;
    return true;
}

void ty_set_mesh_motion(ty_loader* loader)
{
    loader->meshes_move = false;
    for (int i = 0; i < loader->asset_count; ++i)
    {
        ty_asset* asset = &loader->assets[i];
        if (!asset->sequence || !asset->mesh)
            continue;
        if (!set_motion(loader, asset))
            return;
        loader->meshes_move |= asset->mesh->step_count > 0;
    }
    ty_settle_moves(loader);
}
