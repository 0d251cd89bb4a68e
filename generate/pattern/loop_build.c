// SPDX-License-Identifier: Apache-2.0
// Builders of volumes: mirror, twist, rotate, union.
#include "loop_volume.h"
#include <string.h>
#include <tsuya/base/memory.h>

// --- one volume looked up from another ---

typedef struct resampling
{
    const ty_loop_volume* from;
    ty_loop_volume* to;
    float twist;    // rad over the depth
    double turn[9]; // rows: from a place of `to`, in voxels from its middle, to one of `from`
    ty_loop_sample_fn* sample;
} resampling;

// Where slice z of `to` lies in `from`. Index y goes down where the volume's y goes up.
static ty_loop_grid grid_of(const resampling* r, int z)
{
    double middle[3], center[3], origin[3];
    for (int k = 0; k < 3; k++)
    {
        middle[k] = 0.5 * (r->to->size[k] - 1);
        center[k] = 0.5 * (r->from->size[k] - 1);
    }
    double t = r->to->size[2] > 1 ? ((double)z - middle[2]) / (r->to->size[2] - 1) : 0.0;
    float s, c;
    ty_sincos(r->twist * (float)t, &s, &c);
    const double across[3] = {(double)c, (double)s, 0.0}, down[3] = {-(double)s, (double)c, 0.0};
    double turned_across[3], turned_down[3];
    for (int k = 0; k < 3; k++)
    {
        const double* row = r->turn + 3 * k;
        turned_across[k] = row[0] * across[0] + row[1] * across[1];
        turned_down[k] = row[0] * down[0] + row[1] * down[1];
        origin[k] =
            center[k] + row[2] * ((double)z - middle[2]) - turned_across[k] * middle[0] - turned_down[k] * middle[1];
    }
    return (ty_loop_grid){
        {(float)origin[0], (float)origin[1], (float)origin[2]},
        {(float)turned_across[0], (float)turned_across[1], (float)turned_across[2]},
        {(float)turned_down[0], (float)turned_down[1], (float)turned_down[2]},
    };
}

static void slices_resample(void* context, int64_t begin, int64_t end, int worker)
{
    const resampling* r = context;
    (void)worker;
    int w = r->to->size[0], h = r->to->size[1];
    float* line = TY_ALLOC(float, w);
    for (int z = (int)begin; z < (int)end; z++)
    {
        const ty_loop_grid grid = grid_of(r, z);
        for (int y = 0; y < h; y++)
        {
            r->sample(r->from, &grid, TY_LOOP_TRILINEAR, y, 0, w, line);
            size_t at = ty_loop_voxel(r->to, 0, y, z);
            for (int x = 0; x < w; x++, at++)
            {
                r->to->values[at] = ty_loop_number_of(line[x]);
                if (r->to->values[at] == 0 || !(r->to->labels || r->to->tints))
                    continue;
                ty_loop_corners corners = ty_loop_corners_of(r->from, &grid, TY_LOOP_TRILINEAR, x, y);
                if (r->to->labels)
                    r->to->labels[at] = (uint8_t)ty_loop_label_of(r->from, &corners);
                else
                    ty_loop_tint_of(r->from, &corners, r->to->tints + 3 * at);
            }
        }
    }
    ty_free(line);
}

// Replaces *volume by itself seen through r, of the given size.
static ty_status resample(resampling* r, const int size[3], ty_workers* workers, ty_loop_volume* volume,
                          ty_error* error)
{
    ty_loop_volume made;
    ty_loop_volume_close(volume);
    ty_status status =
        ty_loop_volume_create(size, volume->labels || volume->tints, volume->tints != NULL, &made, error);
    if (status != TY_OK)
        return status;
    made.palette = volume->palette;
    r->from = volume;
    r->to = &made;
    r->sample = ty_loop_sampler();
    if (!ty_parallel_for(workers, size[2], 1, slices_resample, r))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while the volume was built");
    ty_loop_volume_term(status == TY_OK ? volume : &made);
    if (status == TY_OK)
        *volume = made;
    return status;
}

// --- builders ---

// The half of positive numbers over the other one; y goes up, its index down.
static void mirror(ty_loop_volume* v, int kind)
{
    int k = kind - TY_LOOP_MIRROR_X, n = v->size[k];
    for (int z = 0; z < v->size[2]; z++)
        for (int y = 0; y < v->size[1]; y++)
            for (int x = 0; x < v->size[0]; x++)
            {
                int at[3] = {x, y, z};
                bool positive = kind == TY_LOOP_MIRROR_Y ? 2 * at[k] <= n - 1 : 2 * at[k] >= n - 1;
                if (positive)
                    continue;
                size_t to = ty_loop_voxel(v, x, y, z);
                at[k] = n - 1 - at[k];
                ty_loop_volume_copy(v, to, ty_loop_voxel(v, at[0], at[1], at[2]), 1);
            }
}

static double snapped(float x)
{
    return fabsf(x) < 1e-6f ? 0.0 : fabsf(fabsf(x) - 1.0f) < 1e-6f ? (x > 0.0f ? 1.0 : -1.0) : (double)x;
}

// The inverse of the turn about x, y, z, between indices whose y goes down. Right angles are exact.
static void turn_back(ty_vec3 angles, double out[9])
{
    ty_quat q = ty_quat_euler(angles);
    const ty_vec3 columns[3] = {ty_quat_rotate(q, (ty_vec3){1, 0, 0}), ty_quat_rotate(q, (ty_vec3){0, 1, 0}),
                                ty_quat_rotate(q, (ty_vec3){0, 0, 1})};
    for (int row = 0; row < 3; row++)
    {
        const float of[3] = {columns[row].x, columns[row].y, columns[row].z};
        for (int k = 0; k < 3; k++)
            out[3 * row + k] = snapped(of[k]) * ((row == 1) != (k == 1) ? -1.0 : 1.0);
    }
}

static bool is_turned(const ty_loop_part* part)
{
    return part->rotate.x != 0.0f || part->rotate.y != 0.0f || part->rotate.z != 0.0f;
}

// size: what the part is brought to, NULL = it keeps its own.
static ty_status part_make(const ty_loop_part* part, int index, const int* size, ty_workers* workers,
                           ty_loop_volume* out, ty_error* error)
{
    ty_status status = ty_loop_source_make(part, index, workers, out, error);
    if (status != TY_OK)
        return status;
    if (part->mirror != TY_LOOP_MIRROR_NONE)
        mirror(out, part->mirror);
    resampling twist = {.twist = part->twist, .turn = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    if (part->twist != 0.0f)
        status = resample(&twist, out->size, workers, out, error);
    resampling rotation = {0};
    turn_back(part->rotate, rotation.turn);
    bool other = size && memcmp(size, out->size, sizeof out->size) != 0;
    if (status == TY_OK && (is_turned(part) || other))
        status = resample(&rotation, size ? size : out->size, workers, out, error);
    if (status != TY_OK)
        ty_loop_volume_term(out);
    return status;
}

static ty_status palette_merge(ty_loop_palette* into, const ty_loop_palette* from, int index,
                               uint8_t as[TY_LOOP_COLORS], ty_error* error)
{
    for (int i = 0; i < from->count; i++)
    {
        int k = 0;
        while (k < into->count && memcmp(into->colors[k], from->colors[i], 3) != 0)
            k++;
        if (k == TY_LOOP_COLORS)
            return ty_error_set(error, TY_BAD_INPUT, "volume[%d].colors: with those before more than %d colours", index,
                                TY_LOOP_COLORS);
        if (k == into->count)
            memcpy(into->colors[into->count++], from->colors[i], 3);
        as[i] = (uint8_t)k;
    }
    return TY_OK;
}

static ty_status unite(ty_loop_volume* into, const ty_loop_volume* from, int index, ty_error* error)
{
    uint8_t as[TY_LOOP_COLORS] = {0};
    ty_status status = palette_merge(&into->palette, &from->palette, index, as, error);
    for (size_t i = 0; i < into->count && status == TY_OK; i++)
    {
        if (from->values[i] <= into->values[i])
            continue;
        into->values[i] = from->values[i];
        if (into->labels)
            into->labels[i] = as[from->labels[i]];
        if (into->tints)
            memcpy(into->tints + 3 * i, from->tints + 3 * i, 3);
    }
    for (int k = 0; k < 3; k++)
        into->wrap[k] = into->wrap[k] && from->wrap[k];
    return status;
}

ty_status ty_loop_volume_check(const ty_loop_recipe* recipe, ty_loop_volume* shape, ty_error* error)
{
    const ty_loop_part* parts = recipe->volume.items;
    *shape = (ty_loop_volume){0};
    if (recipe->volume.count < 1)
        return ty_error_set(error, TY_BAD_INPUT, "volume: it has no part; at least 1");
    for (int i = 0; i < recipe->volume.count; i++)
    {
        int size[3];
        ty_status status = ty_loop_source_check(&parts[i], i, size, error);
        if (status != TY_OK)
            return status;
        if (i == 0)
            memcpy(shape->size, size, sizeof size);
        bool colored = ty_loop_part_is_colored(&parts[i]);
        if (colored != ty_loop_part_is_colored(&parts[0]) || (colored && parts[i].mix != parts[0].mix))
            return ty_error_set(error, TY_BAD_INPUT,
                                "volume[%d].colors: all parts have colours of one mix, or none has any", i);
        bool kept = parts[i].twist == 0.0f && !is_turned(&parts[i]) && memcmp(size, shape->size, sizeof size) == 0;
        bool wraps = kept && (parts[i].wraps || parts[i].source == TY_LOOP_REACTION);
        for (int k = 0; k < 2; k++)
            shape->wrap[k] = wraps && (i == 0 || shape->wrap[k]);
    }
    return TY_OK;
}

ty_status ty_loop_volume_make(const ty_loop_recipe* recipe, ty_workers* workers, ty_loop_volume* out, ty_error* error)
{
    const ty_loop_part* parts = recipe->volume.items;
    *out = (ty_loop_volume){0};
    ty_status status = part_make(&parts[0], 0, NULL, workers, out, error);
    for (int i = 1; i < recipe->volume.count && status == TY_OK; i++)
    {
        ty_loop_volume next;
        status = part_make(&parts[i], i, out->size, workers, &next, error);
        if (status != TY_OK)
            break;
        status = unite(out, &next, i, error);
        ty_loop_volume_term(&next);
    }
    if (status == TY_OK)
        ty_loop_volume_close(out);
    else
        ty_loop_volume_term(out);
    return status;
}
