// SPDX-License-Identifier: Apache-2.0
// A frame of a fill as an image: colours through mattes, and the channels that were asked for.
#include "fill_show.h"
#include "fill_tables.h"
#include "pattern_image.h"
#include <string.h>
#include <tsuya/base/memory.h>

// --- what is needed ---

static bool all_grey(const fill_run* run)
{
    bool grey = !run->over.path && (!fill_has_closed_cells(run->recipe) || pattern_is_grey(run->recipe->outside));
    for (int i = 0; i < run->mark_count; i++)
        grey = grey && pattern_is_grey(run->marks[i].color) && pattern_is_grey(run->marks[i].ground) &&
               !run->images[i][0].path && !run->images[i][1].path;
    return grey;
}

static bool all_opaque(const fill_run* run)
{
    bool opaque = true;
    for (int i = 0; i < run->mark_count; i++)
        opaque = opaque && run->marks[i].opacity == 1.0f && run->marks[i].ground_opacity == 1.0f;
    return opaque || run->over.path;
}

// For pages on which rates are picked: {"feed": [..], "kill": [..], "presets": [[name, feed, kill, help], ..]}.
static void map_tell(const fill_run* run, ty_exr* image)
{
    const ty_fill_map* map = &run->recipe->map;
    int count;
    const ty_fill_preset* presets = ty_fill_presets(&count);
    char* text = ty_string_format("{\"feed\": [%g, %g], \"kill\": [%g, %g], \"presets\": [", (double)map->feed[0],
                                  (double)map->feed[1], (double)map->kill[0], (double)map->kill[1]);
    for (int i = 0; i < count; i++)
    {
        char* more = ty_string_format("%s%s[\"%s\", %g, %g, \"%s\"]", text, i > 0 ? ", " : "", presets[i].name,
                                      (double)presets[i].feed, (double)presets[i].kill, presets[i].help);
        ty_free(text);
        text = more;
    }
    char* whole = ty_string_format("%s]}", text);
    ty_exr_add_string(image, "tsuya/map", whole);
    ty_free(text);
    ty_free(whole);
}

static void channels_add(fill_show_state* show, ty_exr* image)
{
    const fill_run* run = show->run;
    if (!all_opaque(run))
        show->alpha = ty_exr_add_channel(image, "A", TY_EXR_HALF);
    if (run->outputs.u)
        show->u_out = ty_exr_add_channel(image, "u", TY_EXR_FLOAT);
    if (run->outputs.v)
        show->v_out = ty_exr_add_channel(image, "v", TY_EXR_FLOAT);
    if (run->outputs.distance)
        show->d_out = ty_exr_add_channel(image, "distance", TY_EXR_FLOAT);
    if (run->outputs.mark)
        show->mark = ty_exr_add_channel(image, "mark", TY_EXR_FLOAT);
    if (run->outputs.trail)
        show->trail = ty_exr_add_channel(image, "trail", TY_EXR_FLOAT);
    for (int k = 0; k < FILL_LAYERS && run->outputs.mattes; k++)
    {
        char name[64];
        if (k == FILL_CLOSED ? !fill_has_closed_cells(run->recipe) : k >= run->mark_count)
            continue;
        fill_matte_name(k == FILL_CLOSED ? "closed" : run->marks[k].name, k, name);
        show->mattes[k] = ty_exr_add_channel(image, name, TY_EXR_FLOAT);
    }
}

// --- planes ---

// Stills were read before; of sequences this frame's.
static ty_status image_take(const fill_run* run, const ty_plane_file* file, const ty_planes* still, int number,
                            ty_planes* read, const ty_planes** out, ty_error* error)
{
    ty_status status = TY_OK;
    if (!file->path)
        return TY_OK;
    if (!still->values)
        status = ty_plane_file_read_color(file, number, run->color, read, error);
    *out = still->values ? still : read;
    return status;
}

static ty_status images_take(fill_show_state* show, ty_error* error)
{
    const fill_run* run = show->run;
    int number = show->frame + run->recipe->run.first - 1;
    ty_status status = image_take(run, &run->over, &run->still_over, number, &show->read_over, &show->over, error);
    for (int i = 0; i < 2 * run->mark_count && status == TY_OK; i++)
    {
        int mark = i / 2, part = i % 2;
        status = image_take(run, &run->images[mark][part], &run->stills[mark][part], number, &show->read[mark][part],
                            &show->images[mark][part], error);
    }
    return status;
}

static void rules_take(fill_show_state* show)
{
    const fill_run* run = show->run;
    const ty_fill_auto* autos = run->recipe->autos.items;
    for (int i = 0; i < run->recipe->autos.count; i++)
    {
        show->auto_marks[i] = fill_mark_find(run, autos[i].mark, "auto", NULL);
        show->auto_over[i] = autos[i].over ? fill_mark_find(run, autos[i].over, "auto", NULL) : -1;
        show->rules_cover |= autos[i].where == TY_FILL_WHERE_HOLE || autos[i].where == TY_FILL_WHERE_FILLED;
    }
}

// What belongs to this frame alone. made: planes that nobody keeps.
static ty_status frame_begin(fill_show_state* show, float* made[2], ty_error* error)
{
    const fill_run* run = show->run;
    int scale = run->recipe->scale, rules = run->recipe->autos.count;
    size_t pixels = (size_t)show->width * (size_t)show->height;
    bool good = cubic_axis_init(&show->across, run->width, scale, show->drift, run->wrap_x) &&
                cubic_axis_init(&show->down, run->height, scale, 0.0f, run->wrap_y);
    bool finer = !show->across.whole; // else pixels are the run's own cells
    show->cell_x = TY_TRY_ALLOC(int, show->width);
    show->auto_marks = TY_TRY_ALLOC(int, 2 * rules);
    if (finer && !show->v_out)
        show->v_out = made[0] = TY_TRY_ALLOC(float, pixels);
    if (finer && run->distance && !show->d_out)
        show->d_out = made[1] = TY_TRY_ALLOC(float, pixels);
    show->v = finer ? show->v_out : run->v;
    show->distance = finer ? show->d_out : run->distance;
    if (!good || !show->cell_x || !show->auto_marks || !show->v || (run->distance && !show->distance))
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a frame of %d x %d", show->width, show->height);
    show->auto_over = show->auto_marks + rules;
    for (int x = 0; x < show->width; x++)
    {
        int i = (int)floorf(((float)x + 0.5f) / (float)scale + show->drift);
        show->cell_x[x] = cubic_neighbour(i, run->width, run->wrap_x);
    }
    rules_take(show);
    return TY_OK;
}

static void rows_upsample(void* context, int64_t begin, int64_t end, int worker)
{
    const fill_show_state* show = context;
    const float* const cells[3] = {show->run->v, show->run->distance, show->run->cover};
    float* const out[3] = {show->v_out, show->d_out, show->u_out};
    (void)worker;
    float* line = TY_ALLOC(float, show->run->width + 2 * CUBIC_PAD);
    for (int y = (int)begin; y < (int)end; y++)
        for (int k = 0; k < 3; k++)
            if (out[k])
                cubic_row(&show->across, &show->down, cells[k], y, line, out[k] + (size_t)y * (size_t)show->width);
    ty_free(line);
}

static bool planes_fill(fill_show_state* show)
{
    const fill_run* run = show->run;
    for (int y = 0; y < run->height && show->u_out; y++)
        memcpy(run->cover + fill_cell(run, 0, y), ty_gray_scott_u(run->field, y), (size_t)run->width * sizeof(float));
    fill_layers_take(run);
    return ty_parallel_for(run->workers, show->height, 16, rows_upsample, show);
}

static void show_term(fill_show_state* show)
{
    for (int i = 0; i < 2 * TY_GRAY_SCOTT_MARKS; i++)
        ty_planes_term(&show->read[i / 2][i % 2]);
    ty_planes_term(&show->read_over);
    cubic_axis_term(&show->across);
    cubic_axis_term(&show->down);
    ty_free(show->cell_x);
    ty_free(show->auto_marks);
}

ty_status fill_show(const fill_run* run, int frame, float drift, ty_exr** out, ty_error* error)
{
    int scale = run->recipe->scale;
    fill_show_state show = {
        .run = run, .frame = frame, .width = run->width * scale, .height = run->height * scale, .drift = drift};
    float* made[2] = {NULL, NULL};
    ty_exr* image = pattern_image_create(show.width, show.height, all_grey(run), show.color);
    channels_add(&show, image);
    if (run->recipe->map.feed[1] > 0.0f)
        map_tell(run, image);
    ty_status status = frame_begin(&show, made, error);
    if (status == TY_OK)
        status = images_take(&show, error);
    if (status == TY_OK && !(planes_fill(&show) && fill_paint(&show)))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while a frame was made");
    ty_free(made[0]);
    ty_free(made[1]);
    show_term(&show);
    if (status != TY_OK)
    {
        ty_exr_destroy(image);
        image = NULL;
    }
    *out = image;
    return status;
}
