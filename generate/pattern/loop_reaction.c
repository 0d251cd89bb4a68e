// SPDX-License-Identifier: Apache-2.0
// A volume of Gray–Scott in time, from drops or from a logo both ways.
#include "loop_volume.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/image.h>

enum
{
    GAP = 5,    // cells
    CHUNK = 256 // steps between looks at the cancel flag
};

#define RANGE_HIGH 0.4f // of v, where the recipe says nothing: then iso .5 is v = .2

typedef struct reaction
{
    const ty_loop_part* part;
    ty_gray_scott* field;
    ty_workers* workers;
    int width, height, color_count;
    float *front, *back; // [color_count][height][width], or NULL
    ty_loop_labels logo;
    ty_loop_volume* volume;
    float low, scale; // of v to 0..1
    int slices[2];    // that the present state is written to
    ty_progress progress;
} reaction;

static size_t plane(const reaction* r)
{
    return (size_t)r->width * (size_t)r->height;
}

static bool advance(reaction* r, int steps)
{
    for (int done = 0; !r->front && done < steps && !ty_cancel_requested(); done += CHUNK)
        ty_gray_scott_step(r->field, steps - done < CHUNK ? steps - done : CHUNK, r->workers);
    for (int i = 0; r->front && i < steps; i++)
    {
        if (!ty_loop_colors_step(r->field, &r->part->reaction, (const int[2]){r->width, r->height}, r->color_count,
                                 r->front, r->back, r->workers))
            return false;
        ty_gray_scott_step(r->field, 1, r->workers);
        float* done = r->back;
        r->back = r->front;
        r->front = done;
    }
    return !ty_cancel_requested();
}

// --- slices ---

static int largest_color(const reaction* r, size_t at)
{
    int best = 0;
    for (int c = 1; c < r->color_count; c++)
        if (r->front[(size_t)c * plane(r) + at] > r->front[(size_t)best * plane(r) + at])
            best = c;
    return best;
}

static void tint_of(const reaction* r, size_t at, uint8_t out[3])
{
    float total = 0.0f, sum[3] = {0.0f, 0.0f, 0.0f};
    for (int c = 0; c < r->color_count; c++)
    {
        float amount = ty_max(r->front[(size_t)c * plane(r) + at], 0.0f);
        total += amount;
        for (int k = 0; k < 3; k++)
            sum[k] += amount * (float)r->volume->palette.colors[c][k];
    }
    for (int k = 0; k < 3 && total > 0.0f; k++)
        out[k] = (uint8_t)ty_min(sum[k] / total + 0.5f, 255.0f);
}

static void rows_put(void* context, int64_t begin, int64_t end, int worker)
{
    const reaction* r = context;
    ty_loop_volume* volume = r->volume;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
    {
        const float* v = ty_gray_scott_v(r->field, y);
        size_t at = ty_loop_voxel(volume, 0, y, r->slices[0]), other = ty_loop_voxel(volume, 0, y, r->slices[1]);
        size_t first = (size_t)y * (size_t)r->width, w = (size_t)r->width;
        for (size_t x = 0; x < w; x++)
        {
            volume->values[at + x] = ty_loop_number_of((v[x] - r->low) * r->scale);
            if (volume->labels && r->front)
                volume->labels[at + x] = (uint8_t)largest_color(r, first + x);
            if (volume->tints)
                tint_of(r, first + x, volume->tints + 3 * (at + x));
        }
        if (other != at)
            ty_loop_volume_copy(volume, other, at, w);
    }
}

static bool slices_put(reaction* r, int first, int second)
{
    r->slices[0] = first;
    r->slices[1] = second;
    return ty_parallel_for(r->workers, r->height, 32, rows_put, r);
}

// --- the run ---

static ty_status stopped(ty_error* error)
{
    return ty_error_set(error, TY_INTERRUPTED, "interrupted while the reaction ran");
}

static bool is_gap(const ty_loop_reaction* def, int x, int y)
{
    ty_rng rng = ty_rng_make(def->seed, 0x67617073, (uint64_t)(y / GAP) << 32 | (uint64_t)(x / GAP));
    return ty_rng_float(&rng) < def->gaps;
}

// Both ways from the logo in the middle.
static ty_status run_logo(reaction* r, ty_error* error)
{
    int middle = r->volume->size[2] / 2;
    for (int y = 0; y < r->height; y++)
        for (int x = 0; x < r->width; x++)
        {
            size_t at = (size_t)y * (size_t)r->width + (size_t)x;
            uint8_t label = r->logo.labels[at];
            if (label == TY_LOOP_BACKGROUND || is_gap(&r->part->reaction, x, y))
                continue;
            ty_gray_scott_u(r->field, y)[x] = 0.5f;
            ty_gray_scott_v(r->field, y)[x] = 0.25f;
            if (r->front)
                r->front[(size_t)label * plane(r) + at] = 0.25f;
        }
    ty_loop_labels_put(&r->logo, middle, r->volume);
    for (int n = 1; n <= middle; n++)
    {
        if (!advance(r, r->part->reaction.every) || !slices_put(r, middle - n, middle + n))
            return stopped(error);
        ty_progress_update(&r->progress, (double)n / middle, NULL);
    }
    return TY_OK;
}

static ty_status run_drops(reaction* r, ty_error* error)
{
    const ty_loop_reaction* def = &r->part->reaction;
    ty_rng place = ty_rng_make(def->seed, 0x64726f70, 0);
    for (int i = 0; i < def->drops.count; i++)
    {
        ty_rng rng = ty_rng_make(def->seed, 0x64726f70, 1 + (uint64_t)i);
        float x = ty_rng_range(&place, 0.0f, (float)r->width);
        float up = ty_lerp(def->drops.area[0], def->drops.area[1], ty_rng_float(&place));
        ty_gray_scott_drop(r->field, x, (1.0f - up) * (float)(r->height - 1), def->drops.radius, &rng);
    }
    double steps = (double)def->start + (double)def->every * (r->volume->size[2] - 1);
    for (int z = 0; z < r->volume->size[2]; z++)
    {
        if (!advance(r, z == 0 ? def->start : def->every) || !slices_put(r, z, z))
            return stopped(error);
        ty_progress_update(&r->progress, steps > 0.0 ? (def->start + (double)def->every * z) / steps : 1.0, NULL);
    }
    return TY_OK;
}

static ty_status field_create(const ty_loop_reaction* def, int width, int height, ty_gray_scott** out, ty_error* error)
{
    ty_gray_scott_def field = ty_gray_scott_def_default();
    field.width = width;
    field.height = height;
    field.diffusion_u = def->diffusion_u;
    field.diffusion_v = def->diffusion_v;
    field.time_step = def->time_step;
    field.wrap_x = field.wrap_y = true;
    field.rates[0] = (ty_gray_scott_rates){def->feed, def->kill};
    return ty_gray_scott_create(&field, out, error);
}

static ty_status field_make(reaction* r, ty_error* error)
{
    const ty_loop_reaction* def = &r->part->reaction;
    ty_status status = field_create(def, r->width, r->height, &r->field, error);
    r->color_count = r->volume->palette.count;
    if (status != TY_OK || !def->logo || (r->color_count < 2 && !r->volume->tints))
        return status;
    r->front = TY_TRY_ALLOC(float, (size_t)r->color_count* plane(r));
    r->back = TY_TRY_ALLOC(float, (size_t)r->color_count* plane(r));
    if (r->front && r->back)
        return TY_OK;
    return ty_error_set(error, TY_NO_MEMORY, "no memory for %d colours", r->color_count);
}

static ty_status logo_read(reaction* r, int index, ty_error* error)
{
    const ty_loop_reaction* def = &r->part->reaction;
    char key[64];
    snprintf(key, sizeof key, "volume[%d].reaction.logo", index);
    ty_status status = ty_loop_labels_read(def->logo, key, r->part->colors, def->cells, NULL, &r->logo, error);
    r->width = r->logo.width;
    r->height = r->logo.height;
    return status;
}

ty_status ty_loop_reaction_check(const ty_loop_part* part, int index, int size[3], ty_error* error)
{
    const ty_loop_reaction* def = &part->reaction;
    ty_status status = TY_OK;
    ty_gray_scott* field = NULL;
    size[0] = size[1] = 256;
    size[2] = def->depth;
    if (def->logo && def->depth % 2 == 0)
        return ty_error_set(error, TY_BAD_INPUT,
                            "volume[%d].reaction.depth: %d; with a logo an odd number, so that it lies in the middle: "
                            "%d or %d",
                            index, def->depth, def->depth - 1, def->depth + 1);
    if (def->logo)
        status = ty_image_read_size(def->logo, &size[0], &size[1], error);
    for (int k = 0; k < 2; k++)
        size[k] = def->cells[k] ? def->cells[k] : size[k];
    if (status == TY_OK)
        status = ty_loop_size_check(size, error);
    if (status == TY_OK)
        status = ty_loop_part_error(field_create(def, size[0], size[1], &field, error), index, "reaction", error);
    ty_gray_scott_destroy(field);
    return status;
}

ty_status ty_loop_reaction_make(const ty_loop_part* part, int index, ty_workers* workers, ty_loop_volume* out,
                                ty_error* error)
{
    const ty_loop_reaction* def = &part->reaction;
    reaction r = {.part = part, .workers = workers, .volume = out};
    r.width = def->cells[0] ? def->cells[0] : 256;
    r.height = def->cells[1] ? def->cells[1] : 256;
    ty_status status = ty_loop_range(part, index, RANGE_HIGH, &r.low, &r.scale, error);
    if (status == TY_OK && def->logo)
        status = logo_read(&r, index, error);
    bool colored = ty_loop_part_is_colored(part);
    if (status == TY_OK)
        status = ty_loop_volume_create((const int[3]){r.width, r.height, def->depth}, colored,
                                       part->mix == TY_LOOP_MIX_BLEND, out, error);
    if (status == TY_OK && colored)
        out->palette = r.logo.palette;
    if (status == TY_OK)
        status = field_make(&r, error);
    if (status == TY_OK)
    {
        ty_progress_begin(&r.progress, "reaction");
        status = def->logo ? run_logo(&r, error) : run_drops(&r, error);
        ty_progress_end(&r.progress);
    }
    out->wrap[0] = out->wrap[1] = true;
    if (status != TY_OK)
        ty_loop_volume_term(out);
    ty_free(r.front);
    ty_free(r.back);
    ty_loop_labels_term(&r.logo);
    ty_gray_scott_destroy(r.field);
    return status;
}
