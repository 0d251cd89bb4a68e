// SPDX-License-Identifier: Apache-2.0
// What can be compared, and the metrics of each layer.
#include "comparison.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/color.h>

typedef struct comparing
{
    const ty_picture* side[2];
    const ty_comparison_def* def;
    ty_comparison* out;
    uint8_t* mask; // NULL = all
    ty_color* color;
    ty_error* error;
} comparing;

ty_comparison_def ty_comparison_def_default(void)
{
    ty_comparison_def def = {.ppd = TY_FLIP_PPD, .develop = {.bits = 8}};
    for (int i = 0; i < TY_METRIC_COUNT; i++)
    {
        def.metrics[i] = true;
    }
    return def;
}

TY_PRINTF(2, 3) static void differ(ty_comparison* out, const char* format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(out->difference, sizeof out->difference, format, list);
    va_end(list);
    out->differs = true;
}

// --- what is compared ---

static bool same_window(const int a[4], const int b[4])
{
    return memcmp(a, b, 4 * sizeof a[0]) == 0;
}

static bool is_within(const int inner[4], const int outer[4])
{
    return inner[0] >= outer[0] && inner[1] >= outer[1] && inner[2] <= outer[2] && inner[3] <= outer[3];
}

static void check_windows(comparing* job)
{
    const ty_exr *a = job->side[0]->exr, *b = job->side[1]->exr;
    const int *da = a->display_window, *db = b->display_window, *wa = a->data_window, *wb = b->data_window;
    const int* crop = job->def->crop;
    if (!same_window(da, db))
    {
        differ(job->out, "the display windows differ: %d,%d to %d,%d in the reference, %d,%d to %d,%d in the test",
               da[0], da[1], da[2], da[3], db[0], db[1], db[2], db[3]);
    }
    else if (!crop && !same_window(wa, wb))
    {
        differ(job->out,
               "the data windows differ: %d,%d to %d,%d in the reference, %d,%d to %d,%d in the test (--crop compares "
               "what both have)",
               wa[0], wa[1], wa[2], wa[3], wb[0], wb[1], wb[2], wb[3]);
    }
    else if (crop && (!is_within(crop, wa) || !is_within(crop, wb)))
    {
        const int* narrow = is_within(crop, wa) ? wb : wa;
        differ(job->out, "--crop %d,%d,%d,%d is not within the data window %d,%d to %d,%d", crop[0], crop[1], crop[2],
               crop[3], narrow[0], narrow[1], narrow[2], narrow[3]);
    }
    memcpy(job->out->window, crop ? crop : wa, sizeof job->out->window);
}

// Every channel of one side must be in the other.
static void check_channels(comparing* job)
{
    static const char* const sides[] = {"reference", "test"};
    for (int s = 0; s < 2 && !job->out->differs; s++)
    {
        const ty_exr *mine = job->side[s]->exr, *other = job->side[1 - s]->exr;
        for (int i = 0; i < mine->channel_count && !job->out->differs; i++)
        {
            if (!ty_exr_find_channel(other, mine->channels[i].name))
            {
                differ(job->out, "channel '%s' is in the %s but not in the %s (--layer or --channels chooses some)",
                       mine->channels[i].name, sides[s], sides[1 - s]);
            }
        }
    }
}

static ty_status add_layer(comparing* job, const ty_layer* layer)
{
    static const char* const sides[] = {"reference", "test"};
    for (int s = 0; s < 2; s++)
    {
        for (int c = 0; c < layer->channel_count; c++)
        {
            if (!ty_exr_find_channel(job->side[s]->exr, layer->channels[c]))
            {
                differ(job->out, "the %s has no channel '%s'", sides[s], layer->channels[c]);
                return TY_OK;
            }
        }
    }
    job->out->layers = ty_grow(job->out->layers, (size_t)job->out->layer_count, (size_t)job->out->layer_count + 1,
                               sizeof *job->out->layers);
    ty_compared_layer* added = &job->out->layers[job->out->layer_count++];
    *added = (ty_compared_layer){.layer = *layer};
    for (int i = 0; i < TY_METRIC_COUNT; i++)
    {
        added->value[i] = (double)NAN;
    }
    return TY_OK;
}

static ty_status add_named_layer(comparing* job, const ty_layer* known, int count, const char* name)
{
    char list[TY_LAYERS_MAX * 66] = "";
    size_t used = 0;
    for (int i = 0; i < count; i++)
    {
        if (strcmp(known[i].name, name) == 0)
        {
            return add_layer(job, &known[i]);
        }
        int written = snprintf(list + used, sizeof list - used, "%s%.63s", i ? ", " : "", known[i].name);
        used += written > 0 ? (size_t)written : 0;
    }
    return ty_error_set(job->error, TY_USAGE, "the reference has no layer '%s'; it has %.600s", name, list);
}

static ty_status add_channel_layer(comparing* job)
{
    ty_layer layer = {.name = "channels", .channel_count = job->def->channel_count};
    if (layer.channel_count > TY_LAYER_CHANNELS)
    {
        return ty_error_set(job->error, TY_USAGE, "--channels: at most %d", TY_LAYER_CHANNELS);
    }
    for (int i = 0; i < layer.channel_count; i++)
    {
        snprintf(layer.channels[i], sizeof layer.channels[i], "%s", job->def->channels[i]);
    }
    return add_layer(job, &layer);
}

static ty_status choose_layers(comparing* job)
{
    const ty_comparison_def* def = job->def;
    if (def->channel_count)
    {
        return add_channel_layer(job);
    }
    static ty_layer known[TY_LAYERS_MAX]; // 20 kB, and commands run on one thread
    int count = ty_picture_layers(job->side[0], known);
    bool all = def->layer_count == 1 && strcmp(def->layers[0], "all") == 0;
    if (def->layer_count == 0 || all)
    {
        if (job->side[0]->is_display == job->side[1]->is_display || all) // else only colours can be meant
        {
            check_channels(job);
        }
        ty_status status = TY_OK;
        for (int i = 0; i < (all ? count : 1) && status == TY_OK && !job->out->differs; i++)
        {
            status = add_layer(job, &known[i]);
        }
        return status;
    }
    ty_status status = TY_OK;
    for (int i = 0; i < def->layer_count && status == TY_OK; i++)
    {
        status = add_named_layer(job, known, count, def->layers[i]);
    }
    return status;
}

// --- the mask ---

static ty_status check_mask(const comparing* job, const ty_picture* picture, const char* channel)
{
    if (!ty_exr_find_channel(picture->exr, channel))
    {
        return ty_error_set(job->error, TY_USAGE, "--mask: %s has no channel '%s'", picture->path, channel);
    }
    return is_within(job->out->window, picture->exr->data_window)
               ? TY_OK
               : ty_error_set(job->error, TY_USAGE, "--mask: %s has another data window", picture->path);
}

static ty_status read_mask(comparing* job)
{
    const char* text = job->def->mask;
    const ty_picture* picture = job->def->mask_of ? job->def->mask_of : job->side[0];
    size_t length = strcspn(text, "<>=");
    ty_layer layer = {.channel_count = 1};
    snprintf(layer.channels[0], sizeof layer.channels[0], "%.*s", (int)length, text);
    char* end = NULL;
    double bound = text[length] ? strtod(text + length + 1, &end) : 0.0;
    if (!text[length] || end == text + length + 1 || *end)
    {
        return ty_error_set(job->error, TY_USAGE, "--mask: '%s' is not of the form CHANNEL>NUMBER (or <, =)", text);
    }
    ty_image values = {0};
    ty_status status = check_mask(job, picture, layer.channels[0]);
    status = status == TY_OK ? ty_picture_take(picture, &layer, job->out->window, &values, job->error) : status;
    if (status != TY_OK)
    {
        return status;
    }
    int64_t count = (int64_t)values.width * values.height, used = 0;
    job->mask = TY_ALLOC(uint8_t, count);
    for (int64_t i = 0; i < count; i++)
    {
        double value = (double)values.pixels[i];
        job->mask[i] = text[length] == '>' ? value > bound : text[length] == '<' ? value < bound : value == bound;
        used += job->mask[i];
    }
    ty_image_term(&values);
    return used ? TY_OK : ty_error_set(job->error, TY_USAGE, "--mask: no pixel has %s", text);
}

// --- colours ---

static ty_status open_color(comparing* job)
{
    const char* source;
    return job->color
               ? TY_OK
               : ty_color_create(ty_color_choose(job->def->develop.ocio, NULL, &source), &job->color, job->error);
}

static ty_status convert(comparing* job, ty_image* image, const char* from, const char* to)
{
    ty_status status = open_color(job);
    return status == TY_OK ? ty_color_convert(job->color, from, to, image->pixels, image->width * image->height,
                                              image->channels, job->error)
                           : status;
}

static ty_status copy_image(const ty_image* from, ty_image* out, ty_error* error)
{
    *out = *from;
    size_t count = (size_t)from->width * (size_t)from->height * (size_t)from->channels;
    out->pixels = TY_TRY_ALLOC(float, count);
    if (!out->pixels)
    {
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory to compare");
    }
    memcpy(out->pixels, from->pixels, count * sizeof(float));
    return TY_OK;
}

// A linear picture as the display shows it.
static ty_status develop(comparing* job, ty_image* image, const char* space)
{
    const ty_develop_def* def = &job->def->develop;
    ty_status status = convert(job, image, space, "ACEScg");
    return status == TY_OK ? ty_color_develop(job->color, def->display, def->view, def->exposure, image->pixels,
                                              image->width * image->height, image->channels, job->error)
                           : status;
}

// Both sides as one kind of number: display values if one of them has those, else the reference's colour space.
static ty_status agree(comparing* job, ty_compared_layer* layer, ty_image image[2])
{
    const ty_picture *a = job->side[0], *b = job->side[1];
    bool color = ty_layer_is_color(&layer->layer);
    if (a->is_display != b->is_display)
    {
        if (!color)
        {
            differ(job->out, "one picture holds display values, the other linear ones: only colours can be compared");
            return TY_OK;
        }
        int linear = a->is_display ? 1 : 0;
        return develop(job, &image[linear], job->side[linear]->color_space);
    }
    bool convertible = color && !a->is_display && strcmp(a->color_space, b->color_space) != 0;
    return convertible ? convert(job, &image[1], b->color_space, a->color_space) : TY_OK;
}

// --- metrics ---

static ty_status flip(comparing* job, ty_compared_layer* layer, const ty_image image[2], bool hdr)
{
    int64_t count = (int64_t)image[0].width * image[0].height;
    float* map = TY_TRY_ALLOC(float, count);
    if (!map)
    {
        return ty_error_set(job->error, TY_NO_MEMORY, "not enough memory to compare");
    }
    float ppd = job->def->ppd;
    ty_status status = hdr ? ty_flip_hdr(&image[0], &image[1], ppd, job->def->workers, map, job->error)
                           : ty_flip_ldr(&image[0], &image[1], true, ppd, job->def->workers, map, job->error);
    if (status == TY_OK)
    {
        layer->value[hdr ? TY_METRIC_HDRFLIP : TY_METRIC_FLIP] = ty_map_mean(map, job->mask, count);
    }
    if (status == TY_OK && job->def->keep && !hdr)
    {
        layer->error_map = map;
        return TY_OK;
    }
    ty_free(map);
    return status;
}

// LDR-FLIP on what the display shows; those pictures stay for reports.
static ty_status display_flip(comparing* job, ty_compared_layer* layer, const ty_image image[2], bool linear)
{
    ty_image shown[2] = {{0}, {0}};
    ty_status status = TY_OK;
    for (int s = 0; s < 2 && status == TY_OK; s++)
    {
        status = copy_image(&image[s], &shown[s], job->error);
        if (status == TY_OK && linear)
        {
            status = develop(job, &shown[s], job->side[0]->color_space);
        }
    }
    status = status == TY_OK ? flip(job, layer, shown, false) : status;
    for (int s = 0; s < 2; s++)
    {
        if (status == TY_OK && job->def->keep)
        {
            layer->shown[s] = shown[s];
        }
        else
        {
            ty_image_term(&shown[s]);
        }
    }
    return status;
}

// What a page can expose otherwise.
static ty_status keep_light(comparing* job, ty_compared_layer* layer, const ty_image image[2])
{
    ty_status status = TY_OK;
    for (int s = 0; s < 2 && status == TY_OK; s++)
    {
        status = copy_image(&image[s], &layer->light[s], job->error);
        status = status == TY_OK ? convert(job, &layer->light[s], job->side[0]->color_space, "ACEScg") : status;
    }
    return status;
}

static ty_status hdr_flip(comparing* job, ty_compared_layer* layer, const ty_image image[2])
{
    ty_image linear[2] = {{0}, {0}};
    ty_status status = TY_OK;
    for (int s = 0; s < 2 && status == TY_OK; s++)
    {
        status = copy_image(&image[s], &linear[s], job->error);
        if (status == TY_OK && strcmp(job->side[0]->color_space, "lin_rec709") != 0)
        {
            status = convert(job, &linear[s], job->side[0]->color_space, "lin_rec709");
        }
    }
    status = status == TY_OK ? flip(job, layer, linear, true) : status;
    ty_image_term(&linear[0]);
    ty_image_term(&linear[1]);
    return status;
}

// Numbers that are no colours as greys or colours: the reference's range becomes 0..1, the error its share of the
// worst.
static ty_status show_numbers(comparing* job, ty_compared_layer* layer, const ty_image image[2])
{
    int channels = image[0].channels, shown = channels < 3 ? 1 : 3;
    int64_t count = (int64_t)image[0].width * image[0].height;
    float low = image[0].pixels[0], high = low;
    for (int64_t i = 0; i < count * channels; i++)
    {
        low = ty_min(low, image[0].pixels[i]);
        high = ty_max(high, image[0].pixels[i]);
    }
    layer->error_map = TY_ALLOC(float, count);
    for (int s = 0; s < 2; s++)
    {
        layer->shown[s] = (ty_image){.width = image[0].width, .height = image[0].height, .channels = 3};
        layer->shown[s].pixels = TY_ALLOC(float, 3 * count);
        for (int64_t i = 0; i < 3 * count; i++)
        {
            float value = image[s].pixels[i / 3 * channels + (shown == 3 ? i % 3 : 0)];
            layer->shown[s].pixels[i] = high > low ? ty_clamp((value - low) / (high - low), 0.0f, 1.0f) : 0.5f;
        }
    }
    float scale = layer->worst.value[TY_METRIC_MAX] > 0.0 ? 1.0f / (float)layer->worst.value[TY_METRIC_MAX] : 0.0f;
    for (int64_t i = 0; i < count * channels; i++)
    {
        float error = fabsf(image[0].pixels[i] - image[1].pixels[i]) * scale;
        layer->error_map[i / channels] = ty_max(layer->error_map[i / channels], error);
    }
    (void)job;
    return TY_OK;
}

static void find_means(const comparing* job, ty_compared_layer* layer, const ty_image image[2])
{
    int64_t count = (int64_t)image[0].width * image[0].height, used = 0;
    for (int64_t i = 0; i < count; i++)
    {
        if (job->mask && !job->mask[i])
        {
            continue;
        }
        used += image[0].channels;
        for (int c = 0; c < image[0].channels; c++)
        {
            layer->mean[0] += (double)image[0].pixels[i * image[0].channels + c];
            layer->mean[1] += (double)image[1].pixels[i * image[0].channels + c];
        }
    }
    layer->mean[0] /= (double)used;
    layer->mean[1] /= (double)used;
}

static bool is_finite(comparing* job, const ty_compared_layer* layer, const ty_image image[2])
{
    static const char* const sides[] = {"reference", "test"};
    for (int s = 0; s < 2; s++)
    {
        ty_non_finite found = ty_image_find_non_finite(&image[s]);
        if (found.count)
        {
            differ(job->out, "%lld values of the %s are not finite; the first is %s in channel '%s' at pixel %d,%d",
                   (long long)found.count, sides[s],
                   isnan(found.value)   ? "nan"
                   : found.value > 0.0f ? "inf"
                                        : "-inf",
                   layer->layer.channels[found.channel], found.x + job->out->window[0], found.y + job->out->window[1]);
            return false;
        }
    }
    return true;
}

static ty_status measure(comparing* job, ty_compared_layer* layer, ty_image image[2])
{
    ty_status status = is_finite(job, layer, image) ? agree(job, layer, image) : TY_OK;
    if (status != TY_OK || job->out->differs)
    {
        return status;
    }
    bool display = job->side[0]->is_display || job->side[1]->is_display;
    double peak = job->def->peak > 0.0 ? job->def->peak : display ? 1.0 : 0.0;
    status = ty_pixel_errors_measure(&image[0], &image[1], job->mask, peak, &layer->worst, job->error);
    if (status != TY_OK)
    {
        return status;
    }
    for (int i = TY_METRIC_RMSE; i <= TY_METRIC_MAX; i++)
    {
        layer->value[i] = job->def->metrics[i] ? layer->worst.value[i] : (double)NAN;
    }
    layer->worst.x += job->out->window[0];
    layer->worst.y += job->out->window[1];
    find_means(job, layer, image);
    if (!ty_layer_is_color(&layer->layer))
    {
        return job->def->keep ? show_numbers(job, layer, image) : TY_OK;
    }
    if (job->def->metrics[TY_METRIC_FLIP] || job->def->keep)
    {
        status = display_flip(job, layer, image, !display);
    }
    if (status == TY_OK && !display && job->def->keep)
    {
        status = keep_light(job, layer, image);
    }
    if (status == TY_OK && !display && job->def->metrics[TY_METRIC_HDRFLIP])
    {
        status = hdr_flip(job, layer, image);
    }
    return status;
}

static ty_status measure_layers(comparing* job)
{
    ty_status status = TY_OK;
    for (int i = 0; i < job->out->layer_count && status == TY_OK && !job->out->differs; i++)
    {
        ty_compared_layer* layer = &job->out->layers[i];
        ty_image image[2] = {{0}, {0}};
        for (int s = 0; s < 2 && status == TY_OK; s++)
        {
            status = ty_picture_take(job->side[s], &layer->layer, job->out->window, &image[s], job->error);
        }
        status = status == TY_OK ? measure(job, layer, image) : status;
        ty_image_term(&image[0]);
        ty_image_term(&image[1]);
    }
    return status;
}

ty_status ty_compare(const ty_picture* reference, const ty_picture* test, const ty_comparison_def* def,
                     ty_comparison* out, ty_error* error)
{
    *out = (ty_comparison){0};
    comparing job = {.side = {reference, test}, .def = def, .out = out, .error = error};
    check_windows(&job);
    ty_status status = out->differs ? TY_OK : choose_layers(&job);
    if (status == TY_OK && !out->differs && def->mask)
    {
        status = read_mask(&job);
    }
    status = status == TY_OK && !out->differs ? measure_layers(&job) : status;
    ty_free(job.mask);
    ty_color_destroy(job.color);
    return status;
}

void ty_comparison_term(ty_comparison* comparison)
{
    for (int i = 0; i < comparison->layer_count; i++)
    {
        ty_compared_layer* layer = &comparison->layers[i];
        ty_image_term(&layer->shown[0]);
        ty_image_term(&layer->shown[1]);
        ty_image_term(&layer->light[0]);
        ty_image_term(&layer->light[1]);
        ty_free(layer->error_map);
    }
    ty_free(comparison->layers);
    *comparison = (ty_comparison){0};
}

bool ty_limit_parse(const char* text, ty_limit* out)
{
    char name[16];
    size_t length = strcspn(text, "<>");
    if (!text[length] || length >= sizeof name)
    {
        return false;
    }
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    char* end;
    out->below = text[length] == '<';
    out->bound = strtod(text + length + 1, &end);
    return ty_metric_find(name, &out->metric) && end != text + length + 1 && !*end && isfinite(out->bound);
}

bool ty_limit_breaks(const ty_limit* limit, const ty_compared_layer* layer)
{
    double value = layer->value[limit->metric];
    return limit->below ? value < limit->bound : value > limit->bound;
}

unsigned ty_limits_broken(const ty_limit* limits, int count, const ty_compared_layer* layer)
{
    unsigned broken = 0;
    for (int i = 0; i < count; i++)
    {
        broken |= ty_limit_breaks(&limits[i], layer) ? 1u << limits[i].metric : 0u;
    }
    return broken;
}

ty_status ty_comparison_heat(const ty_compared_layer* layer, ty_image* out, ty_error* error)
{
    int64_t count = (int64_t)layer->shown[0].width * layer->shown[0].height;
    *out = (ty_image){.width = layer->shown[0].width, .height = layer->shown[0].height, .channels = 3};
    out->pixels = TY_TRY_ALLOC(float, 3 * count);
    if (!out->pixels)
    {
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory for the heat map");
    }
    for (int64_t i = 0; i < count; i++)
    {
        ty_heat_color(layer->error_map[i], &out->pixels[3 * i]);
    }
    return TY_OK;
}
