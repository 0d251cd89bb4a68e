// SPDX-License-Identifier: Apache-2.0
// The state of a run as an EXR file: u, v, marks with what is closed, and the trail.
#include "fill_run.h"
#include <string.h>

#define FORMAT "tsuya fill state 1"

ty_exr* fill_state_save(const fill_run* run, int frame)
{
    const int window[4] = {0, 0, run->width - 1, run->height - 1};
    size_t row = (size_t)run->width * sizeof(float);
    ty_exr* state = ty_exr_create(window, window);
    float *u = ty_exr_add_channel(state, "u", TY_EXR_FLOAT), *v = ty_exr_add_channel(state, "v", TY_EXR_FLOAT);
    uint32_t* cells = ty_exr_add_channel(state, "cell", TY_EXR_UINT);
    for (int y = 0; y < run->height; y++)
    {
        size_t at = fill_cell(run, 0, y);
        const uint8_t* marks = ty_gray_scott_marks(run->field, y);
        memcpy(u + at, ty_gray_scott_u(run->field, y), row);
        memcpy(v + at, ty_gray_scott_v(run->field, y), row);
        for (int x = 0; x < run->width; x++)
            cells[at + (size_t)x] =
                (uint32_t)(marks[x] & (TY_GRAY_SCOTT_MARKS - 1)) | (uint32_t)run->closed[at + (size_t)x] << 8;
    }
    if (run->trail)
        memcpy(ty_exr_add_channel(state, "trail", TY_EXR_FLOAT), run->trail, fill_cells(run) * sizeof(float));
    ty_exr_add_string(state, "tsuya/state", FORMAT);
    ty_exr_add_int(state, "tsuya/frame", frame);
    return state;
}

static const void* channel_find(const ty_exr* state, const char* name, ty_exr_type type)
{
    const ty_exr_channel* channel = ty_exr_find_channel(state, name);
    return channel && channel->type == type ? channel->pixels : NULL;
}

static ty_status state_check(const fill_run* run, const ty_exr* state, int* frame, ty_error* error)
{
    const ty_exr_attribute* format = ty_exr_find_attribute(state, "tsuya/state");
    const ty_exr_attribute* number = ty_exr_find_attribute(state, "tsuya/frame");
    if (!format || format->type != TY_EXR_STRING || strcmp(format->text, FORMAT) != 0 || !number ||
        number->type != TY_EXR_INT1 || !channel_find(state, "u", TY_EXR_FLOAT) ||
        !channel_find(state, "v", TY_EXR_FLOAT) || !channel_find(state, "cell", TY_EXR_UINT))
        return ty_error_set(error, TY_BAD_FILE, "the state to go on from is not one of a fill");
    *frame = number->integer[0];
    if (ty_exr_width(state) != run->width || ty_exr_height(state) != run->height)
        return ty_error_set(error, TY_BAD_INPUT, "cells: [%d, %d]; the state to go on from has %d x %d", run->width,
                            run->height, ty_exr_width(state), ty_exr_height(state));
    if (*frame < 1 || *frame >= run->recipe->run.frames)
        return ty_error_set(error, TY_BAD_INPUT,
                            "run.frames: %d; the state is that of frame %d: there is nothing to go on to",
                            run->recipe->run.frames, *frame);
    const uint32_t* cells = channel_find(state, "cell", TY_EXR_UINT);
    for (size_t i = 0; i < fill_cells(run); i++)
        if ((cells[i] & 0xff) >= (uint32_t)run->mark_count || cells[i] >> 8 > (FILL_OUTSIDE | FILL_BARRIER))
            return ty_error_set(error, TY_BAD_INPUT, "marks: %d rows; a cell of the state has mark %u", run->mark_count,
                                cells[i] & 0xff);
    return TY_OK;
}

ty_status fill_state_load(fill_run* run, const ty_bytes* bytes, int* frame, ty_error* error)
{
    ty_exr* state;
    ty_status status = ty_exr_read_memory("the state", bytes->data, bytes->size, &state, error);
    if (status != TY_OK)
        return status;
    status = state_check(run, state, frame, error);
    const float *u = channel_find(state, "u", TY_EXR_FLOAT), *v = channel_find(state, "v", TY_EXR_FLOAT);
    const float* trail = channel_find(state, "trail", TY_EXR_FLOAT);
    const uint32_t* cells = channel_find(state, "cell", TY_EXR_UINT);
    for (int y = 0; y < run->height && status == TY_OK; y++)
    {
        uint8_t* marks = ty_gray_scott_marks(run->field, y);
        size_t at = fill_cell(run, 0, y), row = (size_t)run->width * sizeof(float);
        memcpy(ty_gray_scott_u(run->field, y), u + at, row);
        memcpy(ty_gray_scott_v(run->field, y), v + at, row);
        for (int x = 0; x < run->width; x++)
        {
            uint32_t cell = cells[at + (size_t)x];
            run->closed[at + (size_t)x] = (uint8_t)(cell >> 8);
            marks[x] = (uint8_t)((cell & 0xff) | (cell >> 8 ? TY_GRAY_SCOTT_BARRIER : 0));
        }
        if (run->trail && trail)
            memcpy(run->trail + at, trail + at, row);
        if (run->before)
            memcpy(run->before + at, v + at, row);
    }
    ty_exr_destroy(state);
    return status == TY_OK ? fill_vary(run, error) : status;
}
