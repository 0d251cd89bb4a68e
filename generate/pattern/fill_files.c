// SPDX-License-Identifier: Apache-2.0
// The images of a fill: all of them found, with all their frames and of the right sizes, before anything is made.
#include "fill_run.h"
#include <stdio.h>
#include <tsuya/base/memory.h>

static ty_status size_check(const fill_run* run, const ty_plane_file* file, bool cells_too, ty_error* error)
{
    int scale = run->recipe->scale, w = run->width, h = run->height;
    if (file->width == w * scale && file->height == h * scale)
        return TY_OK;
    if (cells_too && file->width == w && file->height == h)
        return TY_OK;
    if (cells_too && scale > 1)
        return ty_error_set(error, TY_BAD_INPUT,
                            "%s: %d x %d pixels; a mask has those of the cells, %d x %d, or of a frame, %d x %d",
                            file->key, file->width, file->height, w, h, w * scale, h * scale);
    return ty_error_set(error, TY_BAD_INPUT, "%s: %d x %d pixels; here it has %d x %d (cells times scale)", file->key,
                        file->width, file->height, w * scale, h * scale);
}

static ty_status file_open(const fill_run* run, const char* path, const char* key, int first, int last, bool cells_too,
                           ty_plane_file* out, ty_error* error)
{
    int shift = run->recipe->run.first - 1;
    if (!path)
        return TY_OK;
    ty_status status = ty_plane_file_open(path, key, first + shift, last + shift, out, error);
    return status == TY_OK ? size_check(run, out, cells_too, error) : status;
}

static ty_status events_open(fill_run* run, int last, ty_error* error)
{
    ty_status status = TY_OK;
    const ty_fill_event* events = run->recipe->events.items;
    for (int i = 0; i < run->recipe->events.count && status == TY_OK; i++)
    {
        const ty_fill_event* e = &events[i];
        int until = fill_event_end(e);
        snprintf(run->keys[i], FILL_KEY, "events[%d].image", i);
        if (e->shape == TY_FILL_IMAGE)
            status = file_open(run, e->image, run->keys[i], e->at, until < last ? until : last, true, &run->events[i],
                               error);
    }
    return status;
}

static ty_status still_read(const fill_run* run, const ty_plane_file* file, ty_planes* out, ty_error* error)
{
    if (!file->path || ty_path_is_sequence(file->path))
        return TY_OK;
    return ty_plane_file_read_color(file, 1, run->color, out, error);
}

ty_status fill_files_open(fill_run* run, ty_error* error)
{
    const ty_fill_recipe* r = run->recipe;
    int last = r->run.frames > 0 ? r->run.frames : 1, count = r->events.count;
    ty_status status = file_open(run, r->region.mask, "region.mask", 1, last, true, &run->region, error);
    if (status == TY_OK)
        status = file_open(run, r->over, "over", 1, last, false, &run->over, error);
    if (status == TY_OK)
        status = events_open(run, last, error);
    for (int i = 0; i < 2 * run->mark_count && status == TY_OK; i++)
    {
        const ty_fill_mark* mark = &run->marks[i / 2];
        char* key = run->keys[count + i];
        snprintf(key, FILL_KEY, "marks[%d].%s", i / 2, i % 2 ? "beneath" : "image");
        status =
            file_open(run, i % 2 ? mark->beneath : mark->image, key, 1, last, false, &run->images[i / 2][i % 2], error);
    }
    bool any = run->over.path != NULL;
    for (int i = 0; i < 2 * run->mark_count; i++)
        any = any || run->images[i / 2][i % 2].path;
    if (status == TY_OK && any)
        status = ty_color_create(NULL, &run->color, error);
    if (status == TY_OK)
        status = still_read(run, &run->over, &run->still_over, error);
    for (int i = 0; i < 2 * run->mark_count && status == TY_OK; i++)
        status = still_read(run, &run->images[i / 2][i % 2], &run->stills[i / 2][i % 2], error);
    return status;
}

ty_status fill_mask_read(const fill_run* run, const ty_plane_file* file, int channel, int frame, float** out,
                         ty_error* error)
{
    float* fine;
    ty_status status =
        ty_plane_file_read_channel(file, frame + run->recipe->run.first - 1, (ty_plane_channel)channel, &fine, error);
    *out = fine;
    if (status != TY_OK || file->width == run->width)
        return status;
    int scale = run->recipe->scale;
    *out = TY_TRY_ALLOC(float, fill_cells(run));
    for (int y = 0; *out && y < run->height; y++)
        for (int x = 0; x < run->width; x++)
        {
            float sum = 0.0f;
            for (int j = 0; j < scale; j++)
                for (int i = 0; i < scale; i++)
                    sum += fine[(size_t)(y * scale + j) * (size_t)file->width + (size_t)(x * scale + i)];
            (*out)[fill_cell(run, x, y)] = sum / (float)(scale * scale);
        }
    ty_free(fine);
    return *out ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "no memory for a mask of %d x %d", run->width, run->height);
}
