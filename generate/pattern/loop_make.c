// SPDX-License-Identifier: Apache-2.0
// A looping texture: the volume, then frame after frame what the rectangle cuts.
#include "loop_frame.h"
#include "loop_report.h"
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

enum
{
    MOST_PIXELS = 1 << 28 // of a frame
};

static ty_status volume_check(const ty_loop_recipe* recipe, const ty_loop_volume* volume, ty_error* error)
{
    uint16_t most = 0, iso = ty_loop_number_of(recipe->iso);
    for (size_t i = 0; i < volume->count; i++)
        most = volume->values[i] > most ? volume->values[i] : most;
    if (most == 0 || (!recipe->show_values && most < iso))
        return ty_error_set(error, TY_BAD_INPUT,
                            "volume: it is empty; its largest number is %.4f of its range, and the inside begins at "
                            "iso %g",
                            (double)((float)most / TY_LOOP_ONE), (double)recipe->iso);
    return TY_OK;
}

// The frame of the path that is the loop's first.
static ty_status start_find(const ty_loop_recipe* recipe, const ty_loop_volume* volume, ty_loop_painter* painter,
                            int* out, ty_error* error)
{
    ty_loop_report* changes;
    *out = (int)(recipe->start * (float)recipe->frames + 0.5f) % recipe->frames;
    if (!recipe->quiet_start)
        return TY_OK;
    ty_status status = ty_loop_report_create(recipe, volume, &changes, error);
    for (int i = 0; i < recipe->frames && status == TY_OK; i++)
    {
        status = ty_loop_painter_cover(painter, i, error);
        if (status == TY_OK)
            ty_loop_report_add(changes, ty_loop_painter_coverage(painter));
    }
    if (status == TY_OK)
        *out = ty_loop_report_quietest(changes);
    ty_loop_report_destroy(changes);
    return status;
}

static ty_status frames_make(const ty_loop_recipe* recipe, const ty_loop_volume* volume, ty_workers* workers,
                             const ty_frame_sink* sink, char** report, ty_error* error)
{
    ty_loop_painter* painter = NULL;
    ty_loop_report* counts = NULL;
    ty_status status = ty_loop_report_create(recipe, volume, &counts, error);
    if (status == TY_OK)
        status = ty_loop_painter_create(recipe, volume, workers, &painter, error);
    int first = 0;
    if (status == TY_OK)
        status = start_find(recipe, volume, painter, &first, error);
    ty_progress progress;
    ty_progress_begin(&progress, "loop");
    for (int i = 0; i < recipe->frames && status == TY_OK; i++)
    {
        ty_exr* image = NULL;
        status = ty_loop_painter_paint(painter, (first + i) % recipe->frames, &image, error);
        if (status == TY_OK)
        {
            ty_loop_report_add(counts, ty_loop_painter_coverage(painter));
            status = sink->put(sink->context, i + 1, image, error);
        }
        ty_exr_destroy(image);
        ty_progress_update(&progress, (double)(i + 1) / recipe->frames, NULL);
    }
    ty_progress_end(&progress);
    if (status == TY_OK)
    {
        char* text = ty_loop_report_end(counts, first);
        if (report)
            *report = text;
        else
            ty_free(text);
    }
    ty_loop_report_destroy(counts);
    ty_loop_painter_destroy(painter);
    return status;
}

ty_status ty_loop_make(const void* def, ty_workers* workers, const ty_frame_sink* sink, char** report, ty_error* error)
{
    const ty_loop_recipe* recipe = def;
    ty_loop_volume volume;
    if ((int64_t)recipe->size[0] * recipe->size[1] > MOST_PIXELS)
        return ty_error_set(error, TY_BAD_INPUT, "size: %d x %d pixels; at most %d in all", recipe->size[0],
                            recipe->size[1], MOST_PIXELS);
    ty_status status = ty_loop_volume_check(recipe, &volume, error);
    if (status == TY_OK)
        status = ty_loop_motion_check(recipe, &volume, error);
    if (status == TY_OK)
        status = ty_loop_volume_make(recipe, workers, &volume, error);
    if (status != TY_OK)
        return status;
    status = volume_check(recipe, &volume, error);
    if (status == TY_OK)
        status = frames_make(recipe, &volume, workers, sink, report, error);
    ty_loop_volume_term(&volume);
    return status;
}
