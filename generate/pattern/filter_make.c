// SPDX-License-Identifier: Apache-2.0
// A Turing filter from its recipe: the fields begin, frames follow one another in time.
#include "filter_run.h"
#include <math.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>

enum
{
    CHUNK_STEPS = 64,   // between looks at the cancel flag
    MOST_PIXELS = 32768 // of a side: what is read back as an image
};

// A reaction that starts from a picture starts anew with each.
static bool starts_anew(const ty_filter_run* run, int frame)
{
    return frame == 1 || (run->sequence && run->recipe->mode != TY_FILTER_TONE);
}

// The reaction's own beginning is chance, the same in every field so that greys stay grey; a picture's is the picture.
static void field_begin(const ty_filter_run* run, int number)
{
    ty_turing* field = run->fields[number];
    ty_rng rng = ty_rng_make(run->recipe->seed, 0x747572, 0);
    bool starts = run->recipe->mode != TY_FILTER_TONE && run->recipe->image;
    for (int y = 0; y < run->height; y++)
    {
        float *u = ty_turing_u(field, y), *v = ty_turing_v(field, y);
        const float* tone = run->picture.tone[number] + (size_t)y * (size_t)run->width;
        for (int x = 0; x < run->width; x++)
        {
            u[x] = starts ? tone[x] : ty_rng_float(&rng);
            v[x] = starts ? 1.0f : ty_rng_float(&rng);
        }
    }
}

static ty_status advance(ty_filter_run* run, int64_t to, ty_error* error)
{
    while (run->step < to)
    {
        int count = to - run->step < CHUNK_STEPS ? (int)(to - run->step) : CHUNK_STEPS;
        if (ty_cancel_requested())
            return ty_error_set(error, TY_INTERRUPTED, "interrupted at step %lld of %lld of frame %d of %d",
                                (long long)run->step, (long long)to, run->frame, run->frame_count);
        for (int f = 0; f < run->field_count; f++)
            ty_turing_step(run->fields[f], count, run->workers);
        run->step += count;
        run->steps_done += count;
        ty_progress_update(&run->progress, (double)run->steps_done / (double)run->steps_all, NULL);
    }
    return TY_OK;
}

// resumed: the fields are in the middle of it.
static ty_status frame_make(ty_filter_run* run, int frame, bool resumed, const ty_frame_sink* sink, ty_error* error)
{
    ty_status status = TY_OK;
    bool anew = starts_anew(run, frame) && !resumed;
    run->frame = frame;
    run->step = anew ? 0 : run->step;
    bool first = !run->picture.tone[0];
    if (first || run->moves)
    {
        ty_filter_picture_term(&run->picture);
        status = ty_filter_picture_read(run, frame, &run->picture, error);
    }
    if (status == TY_OK && (first || run->sequence))
        status = ty_filter_guide(run, frame, error);
    for (int f = 0; f < run->field_count && status == TY_OK && anew; f++)
        field_begin(run, f);
    run->begun |= status == TY_OK;
    if (status == TY_OK)
        status = advance(run, ty_filter_steps(run, frame), error);
    ty_exr* image = NULL;
    if (status == TY_OK)
        status = ty_filter_frame(run, &image, error);
    if (status == TY_OK)
        status = sink->put(sink->context, frame, image, error);
    ty_exr_destroy(image);
    return status;
}

static ty_status frames_make(ty_filter_run* run, const ty_frame_sink* sink, const ty_bytes* state, ty_error* error)
{
    ty_status status = state ? ty_filter_state_load(run, state, error) : TY_OK, kept = TY_OK;
    int first = state ? run->frame : 1;
    if (status != TY_OK)
        return status;
    for (int frame = first; frame <= run->frame_count; frame++)
        run->steps_all += ty_filter_steps(run, frame) - (starts_anew(run, frame) ? 0 : ty_filter_steps(run, frame - 1));
    for (int frame = first; frame <= run->frame_count && status == TY_OK; frame++)
        status = frame_make(run, frame, state && frame == first, sink, error);
    if (!sink->keep || !run->begun || (status != TY_OK && status != TY_INTERRUPTED))
        return status;
    ty_error keep_error;
    ty_exr* left = ty_filter_state_save(run);
    kept = sink->keep(sink->context, left, &keep_error);
    ty_exr_destroy(left);
    if (kept != TY_OK && error)
        *error = keep_error;
    return kept != TY_OK ? kept : status;
}

// --- before the first step ---

static ty_status size_find(ty_filter_run* run, ty_error* error)
{
    const ty_filter_recipe* r = run->recipe;
    if ((r->cells[0] == 0) != (r->cells[1] == 0))
        return ty_error_set(error, TY_BAD_INPUT, "cells: [%d, %d]; both sides are given, or neither", r->cells[0],
                            r->cells[1]);
    if (r->cells[0] == 0 && !r->image)
        return ty_error_set(error, TY_BAD_INPUT, "cells: without an image the field needs a width and a height");
    run->width = r->cells[0] ? r->cells[0] : run->image.width;
    run->height = r->cells[1] ? r->cells[1] : run->image.height;
    if (run->width < 4 || run->height < 4)
        return ty_error_set(error, TY_BAD_INPUT, "cells: %d x %d; each side has at least 4", run->width, run->height);
    int most = run->width > run->height ? run->width : run->height;
    if ((int64_t)most * r->scale > MOST_PIXELS)
        return ty_error_set(error, TY_BAD_INPUT, "scale: %d; %d cells become more than %d pixels", r->scale, most,
                            MOST_PIXELS);
    return TY_OK;
}

static int frame_count(const void* def)
{
    const ty_filter_recipe* r = def;
    ty_frame_numbers numbers;
    ty_error error;
    if (r->frames > 0 || !r->image || !ty_path_is_sequence(r->image) ||
        ty_frame_numbers_find(r->image, &numbers, &error) != TY_OK)
        return r->frames > 0 ? r->frames : 1;
    int last = numbers.numbers[numbers.count - 1];
    ty_frame_numbers_term(&numbers);
    return last >= r->first_frame ? last - r->first_frame + 1 : 1;
}

static ty_status image_open(ty_filter_run* run, ty_error* error)
{
    const ty_filter_recipe* r = run->recipe;
    run->frame_count = frame_count(r);
    run->sequence = run->moves = r->image && ty_path_is_sequence(r->image);
    for (int i = 0; i < r->regions.count; i++)
        run->sequence |= ty_path_is_sequence(((const ty_filter_region*)r->regions.items)[i].mask);
    if (!r->image)
        return TY_OK;
    int last = r->first_frame + run->frame_count - 1;
    return ty_plane_file_open(r->image, "image", r->first_frame, last, &run->image, error);
}

static ty_status fields_create(ty_filter_run* run, ty_error* error)
{
    ty_turing_def def = ty_filter_turing_def(run->recipe);
    def.width = run->width;
    def.height = run->height;
    run->field_count = run->recipe->color == TY_FILTER_CHANNELS ? 3 : 1;
    ty_status status = TY_OK;
    for (int f = 0; f < run->field_count && status == TY_OK; f++)
        status = ty_turing_create(&def, &run->fields[f], error);
    return status;
}

static ty_status prepare(ty_filter_run* run, ty_error* error)
{
    const char* source;
    ty_status status = ty_color_create(ty_color_choose(NULL, NULL, &source), &run->color, error);
    if (status == TY_OK)
        status = image_open(run, error);
    if (status == TY_OK)
        status = size_find(run, error);
    if (status == TY_OK)
        status = ty_filter_masks_open(run, error);
    return status == TY_OK ? fields_create(run, error) : status;
}

ty_status ty_filter_make(const void* def, ty_workers* workers, const ty_frame_sink* sink, const ty_bytes* state,
                         ty_error* error)
{
    ty_filter_run run = {.recipe = def, .workers = workers};
    ty_status status = prepare(&run, error);
    if (status == TY_OK)
    {
        ty_progress_begin(&run.progress, "filter");
        status = frames_make(&run, sink, state, error);
        ty_progress_end(&run.progress);
    }
    for (int f = 0; f < TY_FILTER_FIELDS; f++)
        ty_turing_destroy(run.fields[f]);
    ty_filter_picture_term(&run.picture);
    ty_free(run.alive);
    ty_free(run.masks);
    ty_color_destroy(run.color);
    return status;
}

// --- the generator ---

static ty_status make(const void* def, ty_workers* workers, ty_made* out, ty_error* error)
{
    return ty_filter_make(def, workers, &out->frames, out->state, error);
}

const ty_generator ty_filter_generator = {
    .kind = "filter",
    .build_id = "filter 2",
    .product = TY_PRODUCT_FRAMES,
    .params = &ty_filter_recipe_table,
    .frame_count = frame_count,
    .make = make,
};
