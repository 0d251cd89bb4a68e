// SPDX-License-Identifier: Apache-2.0
// What a Turing filter goes on from, as an EXR file: U and V of every field, the frame and how far its reaction is.
#include "filter_run.h"
#include <string.h>

#define FORMAT "tsuya filter state 1"

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
    const int window[4] = {0, 0, run->width - 1, run->height - 1};
    ty_exr* state = ty_exr_create(window, window);
    for (int k = 0; k < 2 * run->field_count; k++)
    {
        char name[3];
        channel_name(k, name);
        float* plane = ty_exr_add_channel(state, name, TY_EXR_FLOAT);
        for (int y = 0; y < run->height; y++)
            memcpy(plane + (size_t)y * (size_t)run->width, row_of(run, k, y), (size_t)run->width * sizeof(float));
    }
    ty_exr_add_string(state, "tsuya/state", FORMAT);
    ty_exr_add_int(state, "tsuya/frame", run->frame);
    ty_exr_add_int(state, "tsuya/step", (int)run->step);
    return state;
}

static bool number_take(const ty_exr* state, const char* name, int* out)
{
    const ty_exr_attribute* a = ty_exr_find_attribute(state, name);
    if (!a || a->type != TY_EXR_INT1)
        return false;
    *out = a->integer[0];
    return true;
}

static const float* plane_find(const ty_exr* state, int k)
{
    char name[3];
    channel_name(k, name);
    const ty_exr_channel* channel = ty_exr_find_channel(state, name);
    return channel && channel->type == TY_EXR_FLOAT ? channel->pixels : NULL;
}

static ty_status state_check(const ty_filter_run* run, const ty_exr* state, int* frame, int* step, ty_error* error)
{
    const ty_exr_attribute* format = ty_exr_find_attribute(state, "tsuya/state");
    if (!format || format->type != TY_EXR_STRING || strcmp(format->text, FORMAT) != 0 ||
        !number_take(state, "tsuya/frame", frame) || !number_take(state, "tsuya/step", step) || *step < 0)
        return ty_error_set(error, TY_BAD_FILE, "the state to go on from is not one of a filter");
    if (ty_exr_width(state) != run->width || ty_exr_height(state) != run->height)
        return ty_error_set(error, TY_BAD_INPUT, "cells: [%d, %d]; the state to go on from has %d x %d", run->width,
                            run->height, ty_exr_width(state), ty_exr_height(state));
    for (int k = 0; k < 2 * TY_FILTER_FIELDS; k++)
        if ((plane_find(state, k) != NULL) != (k < 2 * run->field_count))
            return ty_error_set(error, TY_BAD_INPUT, "color: the state to go on from has %d fields for %d",
                                plane_find(state, 2) ? 3 : 1, run->field_count);
    if (*frame < 1 || *frame > run->frame_count)
        return ty_error_set(error, TY_BAD_INPUT, "frames: %d; the state is in frame %d", run->frame_count, *frame);
    if (*step > ty_filter_steps(run, *frame))
        return ty_error_set(error, TY_BAD_INPUT, "time: %g; frame %d ends at step %lld and the state is at step %d",
                            (double)run->recipe->time, *frame, (long long)ty_filter_steps(run, *frame), *step);
    return TY_OK;
}

ty_status ty_filter_state_load(ty_filter_run* run, const ty_bytes* bytes, ty_error* error)
{
    ty_exr* state;
    int frame = 0, step = 0;
    ty_status status = ty_exr_read_memory("the state", bytes->data, bytes->size, &state, error);
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
