// SPDX-License-Identifier: Apache-2.0
// What the command line of a render says: overrides, window, samples, channels.
#include "render_job.h"
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>

// Exactly count whole numbers with a separator between them; none wraps around.
static bool parse_numbers(const char* text, char separator, int count, int* out)
{
    for (int i = 0; i < count; i++)
    {
        char* end;
        errno = 0;
        long value = strtol(text, &end, 10);
        if (end == text || errno || value < 0 || value >= INT_MAX || *end != (i + 1 < count ? separator : '\0'))
        {
            return false;
        }
        out[i] = (int)value;
        text = end + 1;
    }
    return true;
}

static ty_status read_pair(const ty_arguments* arguments, const char* name, char separator, int low, int out[2])
{
    const char* text = ty_argument_text(arguments, name, "");
    if (!parse_numbers(text, separator, 2, out) || out[0] < low || out[1] < low)
    {
        return ty_usage(arguments->command, "--%s: '%s' is not of the form A%cB with numbers of at least %d", name,
                        text, separator, low);
    }
    return TY_OK;
}

static ty_status read_number_overrides(const ty_arguments* arguments, ty_scene_arguments* scene)
{
    long value;
    ty_status status = TY_OK;
    if (ty_argument_has(arguments, "spp"))
    {
        status = ty_argument_int(arguments, "spp", 1, 65536, &value);
        if (status == TY_OK)
        {
            ty_scene_arguments_set(scene, "render.samples=%ld", value);
        }
    }
    if (status == TY_OK && ty_argument_has(arguments, "seed"))
    {
        status = ty_argument_int(arguments, "seed", 0, 0x7fffffffffffffffL, &value);
        if (status == TY_OK)
        {
            ty_scene_arguments_set(scene, "render.seed=%ld", value);
        }
    }
    return status;
}

static ty_status check_isa(const ty_arguments* arguments)
{
    static const char* const names[] = {"sse2", "sse4.2", "avx", "avx2", "avx512"};
    const char* text = ty_argument_text(arguments, "isa", names[0]);
    for (int i = 0; i < TY_PARAM_COUNT(names); i++)
    {
        if (strcmp(text, names[i]) == 0)
        {
            return TY_OK;
        }
    }
    return ty_usage(arguments->command, "--isa: '%s' is none of sse2, sse4.2, avx, avx2, avx512", text);
}

ty_status ty_render_overrides(const ty_arguments* arguments, ty_scene_arguments* scene)
{
    scene->options.quick = ty_argument_has(arguments, "quick");
    const char* trace = ty_argument_text(arguments, "trace", "fast");
    if (strcmp(trace, "fast") != 0 && strcmp(trace, "reference") != 0)
    {
        return ty_usage(arguments->command, "--trace: '%s' is neither fast nor reference", trace);
    }
    scene->options.trace_path = trace[0] == 'f' ? TY_TRACE_FAST : TY_TRACE_REFERENCE;
    ty_status status = check_isa(arguments);
    status = status == TY_OK ? read_number_overrides(arguments, scene) : status;
    if (status == TY_OK && ty_argument_has(arguments, "size"))
    {
        int size[2] = {0};
        status = read_pair(arguments, "size", 'x', 1, size);
        if (status == TY_OK)
        {
            ty_scene_arguments_set(scene, "film.size=[%d, %d]", size[0], size[1]);
        }
    }
    if (status == TY_OK && ty_argument_has(arguments, "integrator"))
    {
        ty_scene_arguments_set(scene, "render.integrator=%.60s", ty_argument_text(arguments, "integrator", ""));
    }
    return status;
}

// `all` has light groups where the scene names any.
static ty_status read_aovs(const ty_arguments* arguments, const ty_scene* scene, unsigned* aovs)
{
    static const char* const names[] = {"alpha", "Z", "N", "P", "albedo", "variance", "instance", "light"};
    const char* text = ty_argument_text(arguments, "aov", "all");
    if (strcmp(text, "all") == 0)
    {
        *aovs = TY_AOV_ALL | (scene->light_group_count > 1 ? TY_AOV_LIGHT : 0u);
        return TY_OK;
    }
    *aovs = 0;
    while (*text && strcmp(text, "none") != 0)
    {
        size_t length = strcspn(text, ",");
        unsigned found = 0;
        for (unsigned i = 0; i < TY_PARAM_COUNT(names); i++)
        {
            if (strlen(names[i]) == length && strncmp(names[i], text, length) == 0)
            {
                found = 1u << i;
            }
        }
        if (!found)
        {
            return ty_usage(arguments->command,
                            "--aov: '%.*s' is none of alpha, Z, N, P, albedo, variance, instance, light, all, none",
                            (int)length, text);
        }
        *aovs |= found;
        text += length + (text[length] == ',');
    }
    return TY_OK;
}

static ty_status read_crop(const ty_arguments* arguments, const int size[2], int crop[4])
{
    crop[0] = crop[1] = 0;
    crop[2] = size[0] - 1;
    crop[3] = size[1] - 1;
    const char* text = ty_argument_text(arguments, "crop", NULL);
    if (!text)
    {
        return TY_OK;
    }
    if (!parse_numbers(text, ',', 4, crop) || crop[2] >= size[0] || crop[3] >= size[1] || crop[0] > crop[2] ||
        crop[1] > crop[3])
    {
        return ty_usage(arguments->command, "--crop: '%s' is not x0,y0,x1,y1 (inclusive) within 0,0,%d,%d", text,
                        size[0] - 1, size[1] - 1);
    }
    return TY_OK;
}

static ty_status read_samples(const ty_arguments* arguments, int samples, int range[2])
{
    range[0] = 0;
    range[1] = samples;
    if (!ty_argument_has(arguments, "samples"))
    {
        return TY_OK;
    }
    ty_status status = read_pair(arguments, "samples", '-', 0, range);
    if (status != TY_OK)
    {
        return status;
    }
    range[1]++; // as typed, the last one is meant as well
    if (range[0] >= range[1] || range[1] > samples)
    {
        return ty_usage(arguments->command,
                        "--samples: %d-%d is no range within 0-%d (the scene's samples; --spp "
                        "changes them)",
                        range[0], range[1] - 1, samples - 1);
    }
    return TY_OK;
}

ty_status ty_render_plan(ty_render_job* job, const ty_scene* scene)
{
    const ty_arguments* arguments = job->arguments;
    int range[2];
    memcpy(job->setup.size, scene->film.size, sizeof job->setup.size);
    job->setup.half = scene->film.half;
    job->setup.groups = scene->light_groups;
    job->setup.group_count = scene->light_group_count;
    ty_status status = read_crop(arguments, scene->film.size, job->setup.crop);
    status = status == TY_OK ? read_aovs(arguments, scene, &job->setup.aovs) : status;
    status = status == TY_OK ? read_samples(arguments, scene->render.samples, range) : status;
    if (status == TY_OK && ty_argument_has(arguments, "time-limit"))
    {
        status = ty_argument_float(arguments, "time-limit", 0.001, 1e9, &job->render.time_limit);
    }
    if (status != TY_OK)
    {
        return status;
    }
    job->setup.sample_begin = job->render.sample_begin = range[0];
    job->setup.sample_end = job->render.sample_end = range[1];
    job->render.progress = true;
    job->write = (ty_film_write){.scene = scene,
                                 .sample_begin = range[0],
                                 .sample_end = range[1],
                                 .part = range[0] != 0 || range[1] != scene->render.samples};
    return TY_OK;
}

ty_status ty_render_progress(const ty_arguments* arguments)
{
    const char* text = ty_argument_text(arguments, "progress", "auto");
    static const char* const names[] = {"auto", "bar", "lines", "none"};
    for (int i = 0; i < 4; i++)
    {
        if (strcmp(text, names[i]) == 0)
        {
            ty_progress_set_style((ty_progress_style)i);
            return TY_OK;
        }
    }
    return ty_usage(arguments->command, "--progress: '%s' is none of auto, bar, lines, none", text);
}
