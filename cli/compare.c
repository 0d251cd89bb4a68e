// SPDX-License-Identifier: Apache-2.0
// `tsuya compare`: a picture against its reference, with limits that decide the exit status.
#include "comparison.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

enum
{
    MOST = 64,
};

typedef struct compare_job
{
    const ty_arguments* arguments;
    ty_comparison_def def;
    const char* layers[MOST];
    const char* channels[MOST];
    char* copies[MOST + 1]; // of comma-separated values
    int copy_count;
    int crop[4];
    ty_picture mask;
    ty_limit limits[MOST];
    int limit_count;
} compare_job;

// --- the command line ---

// Every value of a repeatable option, with commas in it as separators too.
static ty_status read_list(compare_job* job, const char* name, const char** out, int* count)
{
    *count = 0;
    for (int i = 0; i < job->arguments->given_count; i++)
    {
        const ty_given* given = &job->arguments->given[i];
        if (strcmp(given->option->name, name) != 0)
        {
            continue;
        }
        if (job->copy_count == MOST)
        {
            return ty_usage(job->arguments->command, "too many options");
        }
        char* copy = job->copies[job->copy_count++] = ty_string_copy(given->text);
        char* rest = copy;
        for (char* part; (part = strsep(&rest, ","));)
        {
            if (*count == MOST || !part[0])
            {
                return ty_usage(job->arguments->command, "--%s: '%s' is no list of up to %d names", name, given->text,
                                MOST);
            }
            out[(*count)++] = part;
        }
    }
    return TY_OK;
}

static ty_status read_metrics(compare_job* job)
{
    const char* names[MOST];
    int count;
    ty_status status = read_list(job, "metric", names, &count);
    for (int i = 0; i < TY_METRIC_COUNT; i++)
    {
        job->def.metrics[i] = count == 0;
    }
    for (int i = 0; i < count && status == TY_OK; i++)
    {
        ty_metric metric;
        if (!ty_metric_find(names[i], &metric))
        {
            return ty_usage(job->arguments->command,
                            "--metric: '%s' is none of rmse, relmse, trelmse, mae, psnr, max, flip, hdrflip", names[i]);
        }
        job->def.metrics[metric] = true;
    }
    return status;
}

static ty_status read_limits(compare_job* job)
{
    const char* texts[MOST];
    ty_status status = read_list(job, "fail", texts, &job->limit_count);
    for (int i = 0; i < job->limit_count && status == TY_OK; i++)
    {
        if (!ty_limit_parse(texts[i], &job->limits[i]))
        {
            return ty_usage(job->arguments->command,
                            "--fail: '%s' is not of the form METRIC>NUMBER (for psnr: psnr<NUMBER)", texts[i]);
        }
        job->def.metrics[job->limits[i].metric] = true;
    }
    return status;
}

static ty_status read_numbers(compare_job* job)
{
    const ty_arguments* arguments = job->arguments;
    double value = 0.0;
    ty_status status = TY_OK;
    if (ty_argument_has(arguments, "ppd"))
    {
        status = ty_argument_float(arguments, "ppd", 1, 1000, &value);
        job->def.ppd = (float)value;
    }
    if (status == TY_OK && ty_argument_has(arguments, "peak"))
    {
        status = ty_argument_float(arguments, "peak", 1e-30, 1e30, &job->def.peak);
    }
    if (status == TY_OK && ty_argument_has(arguments, "exposure"))
    {
        status = ty_argument_float(arguments, "exposure", -64, 64, &value);
        job->def.develop.exposure = (float)value;
    }
    const char* crop = ty_argument_text(arguments, "crop", NULL);
    int used = 0;
    int* c = job->crop;
    if (status == TY_OK && crop &&
        (sscanf(crop, "%9d,%9d,%9d,%9d%n", &c[0], &c[1], &c[2], &c[3], &used) != 4 || crop[used] || c[0] > c[2] ||
         c[1] > c[3]))
    {
        return ty_usage(arguments->command, "--crop: '%s' is not x0,y0,x1,y1 (inclusive)", crop);
    }
    job->def.crop = crop ? job->crop : NULL;
    return status;
}

static ty_status read_options(compare_job* job)
{
    const ty_arguments* arguments = job->arguments;
    job->def = ty_comparison_def_default();
    job->def.layers = job->layers;
    job->def.channels = job->channels;
    job->def.mask = ty_argument_text(arguments, "mask", NULL);
    job->def.develop.display = ty_argument_text(arguments, "display", NULL);
    job->def.develop.view = ty_argument_text(arguments, "view", NULL);
    job->def.develop.ocio = ty_argument_text(arguments, "ocio", NULL);
    job->def.keep = ty_argument_has(arguments, "heat") || ty_argument_has(arguments, "html");
    ty_status status = read_metrics(job);
    status = status == TY_OK ? read_limits(job) : status;
    status = status == TY_OK ? read_list(job, "layer", job->layers, &job->def.layer_count) : status;
    status = status == TY_OK ? read_list(job, "channels", job->channels, &job->def.channel_count) : status;
    return status == TY_OK ? read_numbers(job) : status;
}

// --- results ---

static bool is_broken(const compare_job* job, const ty_comparison* comparison)
{
    bool broken = comparison->differs;
    for (int i = 0; i < comparison->layer_count; i++)
    {
        broken |= ty_limits_broken(job->limits, job->limit_count, &comparison->layers[i]) != 0;
    }
    return broken;
}

static void print_table(const compare_job* job, const ty_comparison* comparison)
{
    printf("%-10s", "layer");
    for (int m = 0; m < TY_METRIC_COUNT; m++)
    {
        if (job->def.metrics[m])
        {
            printf(" %11s", ty_metric_name((ty_metric)m));
        }
    }
    printf("\n");
    for (int i = 0; i < comparison->layer_count; i++)
    {
        const ty_compared_layer* layer = &comparison->layers[i];
        printf("%-10s", layer->layer.name);
        for (int m = 0; m < TY_METRIC_COUNT; m++)
        {
            if (job->def.metrics[m] && isnan(layer->value[m]))
            {
                printf(" %11s", "-");
            }
            else if (job->def.metrics[m])
            {
                printf(" %11.5g", layer->value[m]);
            }
        }
        printf("\n");
    }
    for (int i = 0; i < comparison->layer_count; i++)
    {
        const ty_compared_layer* layer = &comparison->layers[i];
        const ty_pixel_errors* worst = &layer->worst;
        printf("%s: means %.6g and %.6g; ", layer->layer.name, layer->mean[0], layer->mean[1]);
        if (worst->value[TY_METRIC_MAX] > 0.0)
        {
            printf("farthest apart at pixel %d,%d in %s: %.6g and %.6g\n", worst->x, worst->y,
                   layer->layer.channels[worst->channel], (double)worst->reference, (double)worst->test);
        }
        else
        {
            printf("equal\n");
        }
    }
}

static json_t* layer_json(const compare_job* job, const ty_compared_layer* layer)
{
    json_t *root = json_object(), *metrics = json_object();
    json_object_set_new(root, "layer", ty_json_from_text(layer->layer.name));
    for (int m = 0; m < TY_METRIC_COUNT; m++)
    {
        if (job->def.metrics[m])
        {
            double value = layer->value[m]; // JSON has neither NaN nor infinity
            json_object_set_new(metrics, ty_metric_name((ty_metric)m),
                                isfinite(value) ? json_real(value) : json_null());
        }
    }
    json_object_set_new(root, "metrics", metrics);
    json_object_set_new(root, "equal", json_boolean(layer->worst.value[TY_METRIC_MAX] == 0.0));
    json_object_set_new(root, "reference_mean", json_real(layer->mean[0]));
    json_object_set_new(root, "test_mean", json_real(layer->mean[1]));
    json_object_set_new(root, "farthest",
                        json_pack("{s:i, s:i, s:o, s:f, s:f}", "x", layer->worst.x, "y", layer->worst.y, "channel",
                                  ty_json_from_text(layer->layer.channels[layer->worst.channel]), "reference",
                                  (double)layer->worst.reference, "test", (double)layer->worst.test));
    return root;
}

static ty_status print_json(const compare_job* job, const ty_comparison* comparison)
{
    json_t *root = json_object(), *layers = json_array();
    json_object_set_new(root, "reference", ty_json_from_text(job->arguments->positional[0]));
    json_object_set_new(root, "test", ty_json_from_text(job->arguments->positional[1]));
    json_object_set_new(root, "passed", json_boolean(!is_broken(job, comparison)));
    json_object_set_new(root, "difference",
                        comparison->differs ? ty_json_from_text(comparison->difference) : json_null());
    for (int i = 0; i < comparison->layer_count && !comparison->differs; i++)
    {
        json_array_append_new(layers, layer_json(job, &comparison->layers[i]));
    }
    json_object_set_new(root, "layers", layers);
    return ty_json_print(root);
}

static void tell_failures(const compare_job* job, const ty_comparison* comparison)
{
    if (comparison->differs)
    {
        ty_log(TY_LOG_ERROR, "%s: %s", job->arguments->positional[1], comparison->difference);
        return;
    }
    for (int i = 0; i < comparison->layer_count; i++)
    {
        const ty_compared_layer* layer = &comparison->layers[i];
        for (int k = 0; k < job->limit_count; k++)
        {
            const ty_limit* limit = &job->limits[k];
            if (ty_limit_breaks(limit, layer))
            {
                ty_log(TY_LOG_ERROR, "%s: %s of %s is %.6g, which is %s %.6g", job->arguments->positional[1],
                       ty_metric_name(limit->metric), layer->layer.name, layer->value[limit->metric],
                       limit->below ? "below" : "above", limit->bound);
            }
        }
    }
}

// A limit that no layer can break would pass whatever the pictures are.
static ty_status check_limits(const compare_job* job, const ty_comparison* comparison)
{
    for (int k = 0; k < job->limit_count && !comparison->differs; k++)
    {
        bool judged = false;
        for (int i = 0; i < comparison->layer_count; i++)
        {
            judged |= !isnan(comparison->layers[i].value[job->limits[k].metric]);
        }
        if (!judged)
        {
            return ty_usage(job->arguments->command, "--fail: these pictures have no %s (it is for %s)",
                            ty_metric_name(job->limits[k].metric),
                            job->limits[k].metric == TY_METRIC_HDRFLIP ? "linear colours" : "colours");
        }
    }
    return TY_OK;
}

static ty_status write_files(const compare_job* job, const ty_comparison* comparison, ty_error* error)
{
    const char* heat = ty_argument_text(job->arguments, "heat", NULL);
    const char* html = ty_argument_text(job->arguments, "html", NULL);
    ty_status status = TY_OK;
    if (heat && !comparison->differs)
    {
        ty_image image;
        status = ty_comparison_heat(&comparison->layers[0], &image, error);
        status = status == TY_OK ? ty_image_write(heat, &image, 8, error) : status;
        ty_image_term(&image);
    }
    if (html && status == TY_OK)
    {
        const char* const* names = job->arguments->positional;
        ty_report_entry entry = {.title = names[1],
                                 .reference = names[0],
                                 .test = names[1],
                                 .comparison = comparison,
                                 .limits = job->limits,
                                 .limit_count = job->limit_count,
                                 .fault = comparison->differs ? comparison->difference : NULL,
                                 .failed = is_broken(job, comparison)};
        status = ty_compare_report(html, &entry, &job->def.develop, error);
    }
    return status;
}

static ty_status compare_pictures(compare_job* job, const ty_picture side[2], ty_error* error)
{
    ty_comparison comparison;
    ty_status status = ty_compare(&side[0], &side[1], &job->def, &comparison, error);
    status = status == TY_OK ? check_limits(job, &comparison) : status;
    status = status == TY_OK ? write_files(job, &comparison, error) : status;
    if (status == TY_OK && ty_argument_has(job->arguments, "json"))
    {
        status = print_json(job, &comparison);
    }
    else if (status == TY_OK && !comparison.differs)
    {
        print_table(job, &comparison);
        status = ty_output_finish();
    }
    if (status == TY_OK)
    {
        tell_failures(job, &comparison);
        status = is_broken(job, &comparison) ? TY_DIFFERS : TY_OK;
    }
    ty_comparison_term(&comparison);
    return status;
}

// "FILE:CHANNEL>X": the mask's picture, and what stands behind the colon.
static ty_status read_mask(compare_job* job, ty_error* error)
{
    const char* colon = job->def.mask ? strrchr(job->def.mask, ':') : NULL;
    if (!colon)
    {
        return TY_OK;
    }
    char* path = job->copies[job->copy_count++] = ty_string_format("%.*s", (int)(colon - job->def.mask), job->def.mask);
    job->def.mask = colon + 1;
    job->def.mask_of = &job->mask;
    return ty_picture_read(path, &job->mask, error);
}

static ty_status compare_files(compare_job* job)
{
    ty_error error = {0};
    ty_picture side[2] = {{0}, {0}};
    const char* const outputs[] = {ty_argument_text(job->arguments, "heat", NULL),
                                   ty_argument_text(job->arguments, "html", NULL)};
    ty_status status = ty_workers_create(0, &job->def.workers, &error);
    for (int i = 0; i < 2 && status == TY_OK; i++)
    {
        status = outputs[i] ? ty_output_probe(outputs[i], &error) : TY_OK;
    }
    for (int i = 0; i < 2 && status == TY_OK; i++)
    {
        status = ty_picture_read(job->arguments->positional[i], &side[i], &error);
    }
    status = status == TY_OK ? read_mask(job, &error) : status;
    status = status == TY_OK ? compare_pictures(job, side, &error) : status;
    ty_picture_term(&job->mask);
    ty_picture_term(&side[0]);
    ty_picture_term(&side[1]);
    ty_workers_destroy(job->def.workers);
    if (error.text[0])
    {
        ty_log_error(&error);
    }
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    static compare_job job;
    job = (compare_job){.arguments = arguments};
    ty_status status = read_options(&job);
    status = status == TY_OK ? compare_files(&job) : status;
    for (int i = 0; i < job.copy_count; i++)
    {
        ty_free(job.copies[i]);
    }
    return status;
}

static const ty_option options[] = {
    {"metric", 'm', "LIST", "rmse, relmse, trelmse, mae, psnr, max, flip, hdrflip (default: all)"},
    {"fail", 'f', "METRIC>X", "exit 1 beyond a limit, e.g. 'flip>0.05', 'psnr<40' (repeatable)"},
    {"layer", 0, "LIST", "beauty (default), N, Z, albedo, ... or all"},
    {"channels", 0, "LIST", "exactly these channels"},
    {"crop", 0, "x0,y0,x1,y1", "only these pixels (inclusive)"},
    {"mask", 0, "[FILE:]CHANNEL>X", "only where the reference's (or FILE's) channel is above (<, =) X"},
    {"ppd", 0, "N", "pixels a degree for FLIP (default 67: 4K at arm's length)"},
    {"peak", 0, "X", "of psnr (default: 1, of linear pictures the reference's largest)"},
    {"exposure", 'e', "EV", "stops, for what FLIP looks at"},
    {"display", 0, "D", "display of the OCIO configuration (default: sRGB)"},
    {"view", 0, "V", "view (default: ACES 1.0 SDR)"},
    {"ocio", 0, "FILE", "OpenColorIO configuration"},
    {"heat", 0, "OUT.png", "the error of each pixel in colours: FLIP, black to white"},
    {"html", 0, "OUT.html", "a page in one file: exposure, swipe, flip, difference, numbers"},
    {"json", 0, NULL, "the result as JSON on standard output"},
};

const ty_command ty_command_compare = {
    "compare",
    "REFERENCE TEST",
    "tell how far a picture is from a reference",
    "tsuya compare reference.exr out.exr --fail 'flip>0.05' --html out.html",
    2,
    2,
    options,
    TY_PARAM_COUNT(options),
    run,
};
