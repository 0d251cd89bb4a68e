// SPDX-License-Identifier: Apache-2.0
// A frame of a fill as an image: colours through mattes, and the channels that were asked for.
#include "fill_show.h"
#include "fill_tables.h"
#include <string.h>
#include <tsuya/base/memory.h>

// --- what is needed ---

static bool is_grey(ty_rgb c)
{
    return c.r == c.g && c.g == c.b;
}

static bool all_grey(const fill_run* run)
{
    bool grey = !run->over.path && (!fill_has_closed_cells(run->recipe) || is_grey(run->recipe->outside));
    for (int i = 0; i < run->mark_count; i++)
        grey = grey && is_grey(run->marks[i].color) && is_grey(run->marks[i].ground) && !run->images[i][0].path &&
               !run->images[i][1].path;
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
    static const char* const names[] = {"R", "G", "B"};
    static const float ap1[8] = TY_ACESCG_CHROMATICITIES;
    const fill_run* run = show->run;
    bool grey = all_grey(run);
    for (int c = 0; c < (grey ? 1 : 3); c++)
        show->color[c] = ty_exr_add_channel(image, grey ? "Y" : names[c], TY_EXR_HALF);
    if (!grey)
        ty_exr_add_chromaticities(image, ap1);
    if (!all_opaque(run))
        show->alpha = ty_exr_add_channel(image, "A", TY_EXR_HALF);
    if (run->outputs.u)
        show->u = ty_exr_add_channel(image, "u", TY_EXR_FLOAT);
    if (run->outputs.v)
        show->v = ty_exr_add_channel(image, "v", TY_EXR_FLOAT);
    if (run->outputs.distance)
        show->distance = ty_exr_add_channel(image, "distance", TY_EXR_FLOAT);
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

static ty_status images_read(fill_show_state* show, ty_error* error)
{
    const fill_run* run = show->run;
    int number = show->frame + run->recipe->run.first - 1;
    ty_status status = TY_OK;
    if (run->over.path)
        status = ty_plane_file_read_color(&run->over, number, run->color, &show->over, error);
    for (int i = 0; i < 2 * run->mark_count && status == TY_OK; i++)
    {
        const ty_plane_file* file = &run->images[i / 2][i % 2];
        if (file->path)
            status = ty_plane_file_read_color(file, number, run->color, &show->images[i / 2][i % 2], error);
    }
    return status;
}

static void layers_take(fill_show_state* show)
{
    const fill_run* run = show->run;
    for (int y = 0; y < run->height; y++)
    {
        const uint8_t* marks = ty_gray_scott_marks(run->field, y);
        for (int x = 0; x < run->width; x++)
        {
            size_t at = fill_cell(run, x, y);
            show->layers[at] = run->closed[at] ? FILL_CLOSED : (uint8_t)(marks[x] & (TY_GRAY_SCOTT_MARKS - 1));
        }
    }
    for (int y = 0; y < run->height; y++)
        for (int x = 0; x < run->width; x++)
            show->single[fill_cell(run, x, y)] = fill_is_single(show, x, y);
    const ty_fill_auto* autos = run->recipe->autos.items;
    for (int i = 0; i < run->recipe->autos.count; i++)
    {
        show->auto_marks[i] = fill_mark_find(run, autos[i].mark, "auto", NULL);
        show->auto_over[i] = autos[i].over ? fill_mark_find(run, autos[i].over, "auto", NULL) : -1;
    }
}

// Planes of the frame's size: those that are channels are there, the others are made; v is always wanted.
static ty_status planes_fill(fill_show_state* show, float** made, ty_error* error)
{
    const fill_run* run = show->run;
    size_t pixels = (size_t)show->width * (size_t)show->height;
    bool distance = fill_needs_distance(run), good = true;
    made[0] = show->v ? NULL : TY_TRY_ALLOC(float, pixels);
    made[1] = show->distance || !distance ? NULL : TY_TRY_ALLOC(float, pixels);
    show->v = show->v ? show->v : made[0];
    show->distance = show->distance ? show->distance : made[1];
    show->layers = TY_TRY_ALLOC(uint8_t, fill_cells(run));
    show->single = TY_TRY_ALLOC(bool, fill_cells(run));
    show->auto_marks = TY_TRY_ALLOC(int, 2 * run->recipe->autos.count);
    if (!show->v || (distance && !show->distance) || !show->layers || !show->single || !show->auto_marks)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a frame of %d x %d", show->width, show->height);
    show->auto_over = show->auto_marks + run->recipe->autos.count;
    layers_take(show);
    good = fill_upsample(show, run->v, show->v);
    if (distance && good)
    {
        fill_distance(run, run->cover);
        good = fill_upsample(show, run->cover, show->distance);
    }
    if (show->u && good)
    {
        for (int y = 0; y < run->height; y++)
            memcpy(run->cover + fill_cell(run, 0, y), ty_gray_scott_u(run->field, y),
                   (size_t)run->width * sizeof(float));
        good = fill_upsample(show, run->cover, show->u);
    }
    return good ? TY_OK : ty_error_set(error, TY_INTERRUPTED, "interrupted while a frame was made");
}

// --- pixels ---

static ty_rgb planes_at(const ty_planes* planes, size_t at)
{
    size_t size = (size_t)planes->width * (size_t)planes->height;
    return (ty_rgb){planes->values[at], planes->values[at + size], planes->values[at + 2 * size]};
}

static ty_rgb layer_color(const fill_show_state* show, int mark, int part, size_t at)
{
    const ty_planes* image = &show->images[mark][part];
    if (image->values)
        return planes_at(image, at);
    return part ? show->run->marks[mark].ground : show->run->marks[mark].color;
}

// Adds a layer's colour times its share; how much it covers.
static float layer_add(const fill_show_state* show, int layer, float share, float tone, size_t at, ty_rgb* sum)
{
    const fill_run* run = show->run;
    if (layer == FILL_CLOSED)
    {
        if (run->over.path)
            return 0.0f;
        *sum = ty_rgb_add(*sum, ty_rgb_scale(run->recipe->outside, share));
        return share;
    }
    const ty_fill_mark* mark = &run->marks[layer];
    float high = tone * mark->opacity, low = (1.0f - tone) * mark->ground_opacity;
    ty_rgb color = layer_color(show, layer, 0, at), ground = layer_color(show, layer, 1, at);
    if (mark->opacity == 1.0f && mark->ground_opacity == 1.0f)
        color = ty_rgb_lerp(ground, color, tone);
    else
        color = ty_rgb_add(ty_rgb_scale(color, high), ty_rgb_scale(ground, low));
    *sum = ty_rgb_add(*sum, ty_rgb_scale(color, share));
    return share * (high + low);
}

static void pixel_paint(const fill_show_state* show, int x, int y, const float matte[FILL_LAYERS])
{
    const ty_fill_recipe* r = show->run->recipe;
    size_t at = (size_t)y * (size_t)show->width + (size_t)x;
    ty_rgb sum = {0.0f, 0.0f, 0.0f};
    float covered = 0.0f, tone;
    if (r->sharp)
        tone = fill_coverage(show, x, y);
    else
        tone = ty_smoothstep(ty_clamp((show->v[at] - r->tone[0]) / (r->tone[1] - r->tone[0]), 0.0f, 1.0f));
    for (int k = 0; k < FILL_LAYERS; k++)
        if (matte[k] > 0.0f)
            covered += layer_add(show, k, matte[k], tone, at, &sum);
    if (show->over.values)
        sum = ty_rgb_add(sum, ty_rgb_scale(planes_at(&show->over, at), 1.0f - covered));
    const float values[3] = {sum.r, sum.g, sum.b};
    for (int c = 0; c < 3; c++)
        if (show->color[c])
            show->color[c][at] = values[c];
    if (show->alpha)
        show->alpha[at] = covered;
}

static void rows_paint(void* context, int64_t begin, int64_t end, int worker)
{
    const fill_show_state* show = context;
    const fill_run* run = show->run;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < show->width; x++)
        {
            float matte[FILL_LAYERS];
            int cx, cy;
            size_t at = (size_t)y * (size_t)show->width + (size_t)x;
            fill_matte(show, x, y, matte);
            pixel_paint(show, x, y, matte);
            for (int k = 0; k < FILL_LAYERS; k++)
                if (show->mattes[k])
                    show->mattes[k][at] = matte[k];
            fill_pixel_cell(show, x, y, &cx, &cy);
            size_t cell = fill_cell(run, cx, cy);
            if (show->mark)
                show->mark[at] = show->layers[cell] == FILL_CLOSED ? -1.0f : (float)show->layers[cell];
            if (show->trail)
                show->trail[at] = run->trail[cell];
        }
}

ty_status fill_show(const fill_run* run, int frame, float drift, ty_exr** out, ty_error* error)
{
    fill_show_state show = {.run = run,
                            .frame = frame,
                            .width = run->width * run->recipe->scale,
                            .height = run->height * run->recipe->scale,
                            .drift = drift};
    const int window[4] = {0, 0, show.width - 1, show.height - 1};
    float* made[2] = {NULL, NULL};
    ty_exr* image = ty_exr_create(window, window);
    channels_add(&show, image);
    if (run->recipe->map.feed[1] > 0.0f)
        map_tell(run, image);
    ty_status status = planes_fill(&show, made, error);
    if (status == TY_OK)
        status = images_read(&show, error);
    if (status == TY_OK && !ty_parallel_for(run->workers, show.height, 16, rows_paint, &show))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while a frame was made");
    for (int i = 0; i < 2; i++)
        ty_free(made[i]);
    for (int i = 0; i < 2 * TY_GRAY_SCOTT_MARKS; i++)
        ty_planes_term(&show.images[i / 2][i % 2]);
    ty_planes_term(&show.over);
    ty_free(show.layers);
    ty_free(show.single);
    ty_free(show.auto_marks);
    if (status != TY_OK)
    {
        ty_exr_destroy(image);
        image = NULL;
    }
    *out = image;
    return status;
}
