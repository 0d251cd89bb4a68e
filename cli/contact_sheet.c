// SPDX-License-Identifier: Apache-2.0
// Frames side by side, made smaller, with their numbers.
#include "fill_pages.h"
#include "picture.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/color.h>
#include <tsuya/image/label.h>

enum
{
    MOST_FRAMES = 24,
    COLUMNS = 6,
    SLOT = 300, // pixels, at most
    GAP = 8,
    TEXT = 11,
    CAPTION = 24,
    MOST_SIDE = 32768
};

typedef struct sheet
{
    const char* pattern;
    ty_frame_numbers frames;
    int every, columns, rows;
    int slot[2];
    ty_color* color;
    ty_image image;
} sheet;

// A frame as a display shows it, three channels.
static ty_status frame_read(const sheet* s, int number, ty_image* out, ty_error* error)
{
    char path[TY_PATH_MAX];
    ty_layer layers[TY_LAYERS_MAX];
    ty_picture picture;
    ty_image some = {0};
    ty_path_frame(s->pattern, number, path);
    ty_status status = ty_picture_read(path, &picture, error);
    if (status != TY_OK)
        return status;
    int count = ty_picture_layers(&picture, layers);
    TY_ASSERT(count > 0);
    const int window[4] = {0, 0, ty_exr_width(picture.exr) - 1, ty_exr_height(picture.exr) - 1};
    status = ty_picture_take(&picture, &layers[0], window, &some, error);
    *out = (ty_image){.width = some.width, .height = some.height, .channels = 3};
    size_t size = (size_t)some.width * (size_t)some.height;
    out->pixels = status == TY_OK ? TY_TRY_ALLOC(float, 3 * size) : NULL;
    if (status == TY_OK && !out->pixels)
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for '%s'", path);
    for (size_t i = 0; status == TY_OK && i < 3 * size; i++)
        out->pixels[i] = some.pixels[i / 3 * (size_t)some.channels + (some.channels < 3 ? 0 : i % 3)];
    if (status == TY_OK && !picture.is_display)
        status = ty_color_convert(s->color, picture.color_space, "srgb_texture", out->pixels, (int)size, 3, error);
    ty_image_term(&some);
    ty_picture_term(&picture);
    return status;
}

static ty_status place(sheet* s, const ty_image* first, ty_error* error)
{
    int count = (s->frames.count + s->every - 1) / s->every;
    s->columns = count < COLUMNS ? count : COLUMNS;
    s->rows = (count + s->columns - 1) / s->columns;
    s->slot[0] = first->width < SLOT ? first->width : SLOT;
    s->slot[1] = (int)((int64_t)s->slot[0] * first->height / first->width);
    s->slot[1] = s->slot[1] > 0 ? s->slot[1] : 1;
    int64_t height = GAP + (int64_t)s->rows * (s->slot[1] + CAPTION + GAP);
    if (height > MOST_SIDE)
        return ty_error_set(error, TY_BAD_INPUT, "a sheet of %d frames would be %lld pixels high: --every %d", count,
                            (long long)height, s->every * 2);
    s->image = (ty_image){.width = GAP + s->columns * (s->slot[0] + GAP), .height = (int)height, .channels = 3};
    size_t size = 3 * (size_t)s->image.width * (size_t)s->image.height;
    s->image.pixels = TY_TRY_ALLOC(float, size);
    for (size_t i = 0; s->image.pixels && i < size; i++)
        s->image.pixels[i] = 0.106f;
    return s->image.pixels ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "no memory for the sheet");
}

static ty_status frame_put(sheet* s, int slot, ty_image* frame, int number, ty_error* error)
{
    static const float ink[3] = {0.86f, 0.86f, 0.86f};
    char text[32];
    int x0 = GAP + slot % s->columns * (s->slot[0] + GAP);
    int y0 = GAP + slot / s->columns * (s->slot[1] + CAPTION + GAP);
    ty_image small = {0};
    ty_status status = ty_image_shrink(frame, s->slot[0], s->slot[1], &small, error);
    for (int y = 0; status == TY_OK && y < small.height; y++)
        memcpy(s->image.pixels + 3 * ((size_t)(y0 + y) * (size_t)s->image.width + (size_t)x0),
               small.pixels + 3 * (size_t)y * (size_t)small.width, 3 * (size_t)small.width * sizeof(float));
    ty_image_term(&small);
    snprintf(text, sizeof text, "%d", number);
    ty_label_draw(&s->image, (float)x0, (float)(y0 + s->slot[1] + CAPTION - GAP), text, TEXT, ink);
    return status;
}

static ty_status frames_put(sheet* s, ty_error* error)
{
    ty_status status = TY_OK;
    for (int i = 0; i < s->frames.count && status == TY_OK; i += s->every)
    {
        ty_image frame = {0};
        int number = s->frames.numbers[i];
        status = frame_read(s, number, &frame, error);
        if (status == TY_OK && i == 0)
            status = place(s, &frame, error);
        if (status == TY_OK && (frame.width < s->slot[0] || frame.height < s->slot[1]))
            status = ty_error_set(error, TY_BAD_INPUT, "frame %d has %d x %d pixels, fewer than the first", number,
                                  frame.width, frame.height);
        if (status == TY_OK)
            status = frame_put(s, i / s->every, &frame, number, error);
        ty_image_term(&frame);
    }
    return status;
}

ty_status ty_contact_sheet_write(const char* path, const char* pattern, int every, ty_error* error)
{
    sheet s = {.pattern = pattern};
    ty_status status = ty_frame_numbers_find(pattern, &s.frames, error);
    if (status != TY_OK)
        return status;
    s.every = every > 0 ? every : (s.frames.count + MOST_FRAMES - 1) / MOST_FRAMES;
    status = ty_color_create(NULL, &s.color, error);
    if (status == TY_OK)
        status = frames_put(&s, error);
    if (status == TY_OK)
        status = ty_image_write(path, &s.image, 8, error);
    ty_color_destroy(s.color);
    ty_image_term(&s.image);
    ty_frame_numbers_term(&s.frames);
    return status;
}
