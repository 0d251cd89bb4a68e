// SPDX-License-Identifier: Apache-2.0
// The contact sheet of a sweep: every cell, made smaller, with its values: as EXR, scene-linear, and developed as PNG.
#include "sweep_view.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/label.h>

enum
{
    SHEET_WIDTH = 1920, // pixels, at most, but for very many columns
    LEAST_SLOT = 96,
    GAP = 12,
    MARGIN = 24,
    TEXT = 11,    // a capital's height
    CAPTION = 26, // a line of text with its distance
    MOST_SIDE = 32768,
};

typedef struct sheet
{
    const ty_sweep_job* job;
    ty_sweep_layout layout;
    int slot[2];   // pixels of a cell
    int left, top; // of the first cell
    int step[2];   // from cell to cell
    int size[2];
    ty_image* cells; // [cell_count], scene-linear; NULL pixels = no picture
} sheet;

// --- where things stand ---

static float widest_row(const sheet* s)
{
    float widest = 0.0f;
    for (int r = 0; r < s->layout.rows && s->layout.grid; r++)
    {
        char text[TY_SWEEP_LABEL_MAX];
        ty_sweep_row_label(s->job, &s->layout, r, text);
        widest = ty_max(widest, ty_label_width(text, TEXT));
    }
    char title[TY_SWEEP_LABEL_MAX];
    ty_sweep_row_title(s->job, &s->layout, title);
    return s->layout.rows > 1 && s->layout.grid ? ty_max(widest, ty_label_width(title, TEXT)) : 0.0f;
}

// Slots have the shape of the largest picture, and no more pixels than it has.
static ty_status place(sheet* s, const int largest[2], ty_error* error)
{
    int columns = s->layout.columns, rows = s->layout.rows;
    float label = ty_min(widest_row(s), 0.2f * SHEET_WIDTH);
    s->left = MARGIN + (label > 0.0f ? (int)ceilf(label) + 2 * GAP : 0);
    int room = (SHEET_WIDTH - s->left - MARGIN - (columns - 1) * GAP) / columns;
    room = room > LEAST_SLOT ? room : LEAST_SLOT;
    s->slot[0] = room < largest[0] ? room : largest[0];
    s->slot[1] = (int)((int64_t)s->slot[0] * largest[1] / largest[0]);
    s->slot[1] = s->slot[1] > 0 ? s->slot[1] : 1;
    s->top = MARGIN + CAPTION + (s->layout.grid ? 2 * CAPTION : 0);
    s->step[0] = s->slot[0] + GAP;
    s->step[1] = s->slot[1] + GAP + (s->layout.grid ? 0 : CAPTION);
    int64_t width = s->left + (int64_t)columns * s->step[0] - GAP + MARGIN;
    int64_t height = s->top + (int64_t)rows * s->step[1] - GAP + MARGIN;
    if (width > MOST_SIDE || height > MOST_SIDE)
    {
        return ty_error_set(error, TY_BAD_INPUT, "a sheet of %d by %d cells would have more than %d pixels a side",
                            columns, rows, MOST_SIDE);
    }
    s->size[0] = (int)width;
    s->size[1] = (int)height;
    return TY_OK;
}

static void slot_of(const sheet* s, int cell, int corner[2])
{
    corner[0] = s->left + cell % s->layout.columns * s->step[0];
    corner[1] = s->top + cell / s->layout.columns * s->step[1];
}

// --- pictures ---

// Pictures differ in size where that varies.
static void find_largest(const sheet* s, int largest[2])
{
    largest[0] = largest[1] = 1;
    for (int i = 0; i < s->job->sweep.cell_count; i++)
    {
        const int* size = s->job->cells[i].size;
        largest[0] = size[0] > largest[0] ? size[0] : largest[0];
        largest[1] = size[1] > largest[1] ? size[1] : largest[1];
    }
}

static ty_status shrink_cells(sheet* s, ty_error* error)
{
    ty_status status = TY_OK;
    for (int i = 0; i < s->job->sweep.cell_count && status == TY_OK; i++)
    {
        if (!s->job->cells[i].done)
        {
            continue;
        }
        ty_image whole;
        status = ty_sweep_picture(s->job, i, &whole, error);
        if (status != TY_OK)
        {
            break;
        }
        float scale = ty_min((float)s->slot[0] / (float)whole.width, (float)s->slot[1] / (float)whole.height);
        int width = (int)ty_clamp((float)whole.width * scale + 0.5f, 1.0f, (float)whole.width);
        int height = (int)ty_clamp((float)whole.height * scale + 0.5f, 1.0f, (float)whole.height);
        status = ty_image_shrink(&whole, width, height, &s->cells[i], error);
        ty_image_term(&whole);
    }
    return status;
}

static void put(ty_image* out, const ty_image* cell, const int corner[2])
{
    for (int y = 0; y < cell->height; y++)
    {
        memcpy(out->pixels + 3 * ((int64_t)(corner[1] + y) * out->width + corner[0]),
               cell->pixels + 3 * (int64_t)y * cell->width, 3 * (size_t)cell->width * sizeof(float));
    }
}

// --- words ---

typedef struct ink
{
    float paper, text, faint; // greys
} ink;

static void write_at(ty_image* out, float x, float y, float room, const char* text, float grey)
{
    char shown[TY_SWEEP_LABEL_MAX];
    const float color[3] = {grey, grey, grey};
    ty_label_fit(text, TEXT, room, shown, sizeof shown);
    ty_label_draw(out, x, y, shown, TEXT, color);
}

static void write_grid(const sheet* s, ty_image* out, const ink* k)
{
    char text[TY_SWEEP_LABEL_MAX];
    float line = (float)s->top - GAP, room = (float)(s->left - MARGIN - GAP);
    ty_sweep_column_title(s->job, &s->layout, text);
    write_at(out, (float)s->left, line - CAPTION, (float)(s->size[0] - s->left - MARGIN), text, k->faint);
    if (s->layout.rows > 1)
    {
        ty_sweep_row_title(s->job, &s->layout, text);
        write_at(out, MARGIN, line, room, text, k->faint);
    }
    for (int c = 0; c < s->layout.columns; c++)
    {
        ty_sweep_column_label(s->job, &s->layout, c, text);
        write_at(out, (float)(s->left + c * s->step[0]), line, (float)s->slot[0], text, k->text);
    }
    for (int r = 0; r < s->layout.rows && s->layout.rows > 1; r++)
    {
        ty_sweep_row_label(s->job, &s->layout, r, text);
        write_at(out, MARGIN, (float)(s->top + r * s->step[1]) + 0.5f * (float)(s->slot[1] + TEXT), room, text,
                 k->text);
    }
}

static void write_words(const sheet* s, ty_image* out, const ink* k)
{
    char text[TY_SWEEP_LABEL_MAX];
    const char* title = s->job->arguments->positional[0];
    float right = (float)(s->size[0] - MARGIN), after = MARGIN + ty_label_width(title, TEXT) + 2 * GAP;
    write_at(out, MARGIN, MARGIN + TEXT, right - MARGIN, title, k->text);
    ty_sweep_fixed(s->job, text);
    write_at(out, after, MARGIN + TEXT, right - after, text, k->faint);
    if (s->layout.grid)
    {
        write_grid(s, out, k);
    }
    for (int i = 0; i < s->job->sweep.cell_count; i++)
    {
        int corner[2];
        slot_of(s, i, corner);
        if (!s->layout.grid)
        {
            ty_sweep_cell_label(s->job, i, text);
            write_at(out, (float)corner[0], (float)(corner[1] + s->slot[1] + CAPTION - GAP + 4), (float)s->slot[0],
                     text, k->text);
        }
        if (!s->cells[i].pixels)
        {
            write_at(out, (float)(corner[0] + GAP), (float)corner[1] + 0.5f * (float)(s->slot[1] + TEXT),
                     (float)(s->slot[0] - 2 * GAP), s->job->cells[i].status != TY_OK ? "failed" : "not rendered",
                     k->faint);
        }
    }
}

static ty_status compose(const sheet* s, const ink* k, ty_image* out, ty_error* error)
{
    int64_t count = (int64_t)s->size[0] * s->size[1] * 3;
    *out = (ty_image){.width = s->size[0], .height = s->size[1], .channels = 3, .is_float = true};
    out->pixels = TY_TRY_ALLOC(float, count);
    if (!out->pixels)
    {
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory for the sheet");
    }
    for (int64_t i = 0; i < count; i++)
    {
        out->pixels[i] = k->paper;
    }
    for (int i = 0; i < s->job->sweep.cell_count; i++)
    {
        int corner[2];
        slot_of(s, i, corner);
        if (s->cells[i].pixels)
        {
            put(out, &s->cells[i], corner);
        }
    }
    write_words(s, out, k);
    return TY_OK;
}

// --- files ---

static ty_status write_exr(const char* path, const ty_image* image, ty_error* error)
{
    static const char* const names[] = {"R", "G", "B"};
    static const float acescg[8] = TY_ACESCG_CHROMATICITIES;
    int window[4] = {0, 0, image->width - 1, image->height - 1};
    ty_exr* exr = ty_exr_create(window, window);
    ty_exr_add_chromaticities(exr, acescg);
    for (int c = 0; c < 3; c++)
    {
        float* plane = ty_exr_add_channel(exr, names[c], TY_EXR_HALF);
        for (int64_t i = 0; i < (int64_t)image->width * image->height; i++)
        {
            plane[i] = image->pixels[3 * i + c];
        }
    }
    ty_status status = ty_exr_write(path, exr, error);
    ty_exr_destroy(exr);
    return status;
}

static ty_status develop_cells(sheet* s, ty_error* error)
{
    const ty_develop_def* def = &s->job->render.develop;
    const char* source;
    ty_color* color = NULL;
    ty_status status = ty_color_create(ty_color_choose(def->ocio, NULL, &source), &color, error);
    for (int i = 0; i < s->job->sweep.cell_count && status == TY_OK; i++)
    {
        ty_image* cell = &s->cells[i];
        if (cell->pixels)
        {
            status = ty_color_develop(color, def->display, def->view, def->exposure, cell->pixels,
                                      cell->width * cell->height, 3, error);
        }
    }
    ty_color_destroy(color);
    return status;
}

static ty_status write_sheets(sheet* s, const char* exr_path, const char* png_path, ty_error* error)
{
    static const ink linear = {0.012f, 0.7f, 0.28f}, display = {0.106f, 0.86f, 0.58f};
    ty_image out = {0};
    ty_status status = compose(s, &linear, &out, error);
    status = status == TY_OK ? write_exr(exr_path, &out, error) : status;
    ty_image_term(&out);
    status = status == TY_OK ? develop_cells(s, error) : status;
    status = status == TY_OK ? compose(s, &display, &out, error) : status;
    status = status == TY_OK ? ty_image_write(png_path, &out, 8, error) : status;
    ty_image_term(&out);
    return status;
}

ty_status ty_sweep_sheet(const ty_sweep_job* job, const char* exr_path, const char* png_path, ty_error* error)
{
    sheet s = {.job = job, .layout = ty_sweep_layout_of(&job->sweep)};
    int largest[2];
    s.cells = TY_ALLOC(ty_image, job->sweep.cell_count);
    find_largest(&s, largest);
    ty_status status = place(&s, largest, error);
    status = status == TY_OK ? shrink_cells(&s, error) : status;
    status = status == TY_OK ? write_sheets(&s, exr_path, png_path, error) : status;
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        ty_image_term(&s.cells[i]);
    }
    ty_free(s.cells);
    return status;
}
