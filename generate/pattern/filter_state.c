// SPDX-License-Identifier: Apache-2.0
// What a Turing filter goes on from, as an EXR file: U and V of every field, the frame and how far its reaction is.
#include "filter_run.h"
#include "pattern_state.h"
#include <string.h>

// What only shows, and how far the reaction goes; the size is told by itself.
static const char* const free_rows[] = {"cells", "scale", "tone.calibrated", "time",     "time_per_frame", "frames",
                                        "low",   "high",  "threshold",       "softness", "fields",         NULL};

static pattern_state_kind kind_of(const ty_filter_run* run)
{
    // A sequence steers by frames: what came before a state depends on when they were.
    static const char* const by_frame[] = {"cells", "scale",     "tone.calibrated", "frames", "low",
                                           "high",  "threshold", "softness",        "fields", NULL};
    return (pattern_state_kind){"tsuya filter state 2", "a filter", &ty_filter_recipe_table,
                                run->sequence ? by_frame : free_rows};
}

static void channel_name(int k, char name[3])
{
    memcpy(name, (const char[3]){k % 2 ? 'v' : 'u', (char)('0' + k / 2), 0}, 3);
}

static float* row_of(const ty_filter_run* run, int k, int y)
{
    return k % 2 ? ty_turing_v(run->fields[k / 2], y) : ty_turing_u(run->fields[k / 2], y);
}

ty_exr* ty_filter_state_save(const ty_filter_run* run)
{
    pattern_state_kind kind = kind_of(run);
    ty_exr* state = pattern_state_create(&kind, run->recipe, run->width, run->height);
    for (int k = 0; k < 2 * run->field_count; k++)
    {
        char name[3];
        channel_name(k, name);
        float* plane = ty_exr_add_channel(state, name, TY_EXR_FLOAT);
        for (int y = 0; y < run->height; y++)
            memcpy(plane + (size_t)y * (size_t)run->width, row_of(run, k, y), (size_t)run->width * sizeof(float));
    }
    ty_exr_add_int(state, "tsuya/frame", run->frame);
    ty_exr_add_int(state, "tsuya/step", (int)run->step);
    return state;
}

static const float* plane_find(const ty_exr* state, int k)
{
    char name[3];
    channel_name(k, name);
    return pattern_state_plane(state, name, TY_EXR_FLOAT);
}

static ty_status state_check(const ty_filter_run* run, const ty_exr* state, int* frame, int* step, ty_error* error)
{
    pattern_state_kind kind = kind_of(run);
    if (!pattern_state_number(state, "tsuya/frame", frame) || !pattern_state_number(state, "tsuya/step", step) ||
        *step < 0)
        return ty_error_set(error, TY_BAD_FILE, "the state to go on from is not whole: it lacks a step");
    for (int k = 0; k < 2 * TY_FILTER_FIELDS; k++)
        if ((plane_find(state, k) != NULL) != (k < 2 * run->field_count))
            return ty_error_set(error, TY_BAD_INPUT, "color: the state to go on from has %d fields for %d",
                                plane_find(state, 2) ? 3 : 1, run->field_count);
    ty_status status = pattern_state_check(&kind, state, run->recipe, run->width, run->height, error);
    if (status != TY_OK)
        return status;
    if (*frame < 1 || *frame > run->frame_count)
        return ty_error_set(error, TY_BAD_INPUT, "frames: %d; the state is in frame %d", run->frame_count, *frame);
    if (*step > ty_filter_steps(run, *frame))
        return ty_error_set(error, TY_BAD_INPUT, "time: %g; frame %d ends at step %lld and the state is at step %d",
                            (double)run->recipe->time, *frame, (long long)ty_filter_steps(run, *frame), *step);
    return TY_OK;
}

static ty_status open_state(const ty_filter_run* run, const ty_bytes* bytes, ty_exr** out, ty_error* error)
{
    pattern_state_kind kind = kind_of(run);
    return pattern_state_read(&kind, bytes, out, error);
}

ty_status ty_filter_state_load(ty_filter_run* run, const ty_bytes* bytes, ty_error* error)
{
    ty_exr* state;
    int frame = 0, step = 0;
    ty_status status = open_state(run, bytes, &state, error);
    if (status != TY_OK)
        return status;
    status = state_check(run, state, &frame, &step, error);
    for (int k = 0; k < 2 * run->field_count && status == TY_OK; k++)
        for (int y = 0; y < run->height; y++)
            memcpy(row_of(run, k, y), plane_find(state, k) + (size_t)y * (size_t)run->width,
                   (size_t)run->width * sizeof(float));
    if (status == TY_OK)
    {
        run->frame = frame;
        run->step = step;
    }
    ty_exr_destroy(state);
    return status;
}
