// SPDX-License-Identifier: Apache-2.0
// `tsuya render`: a scene to an EXR, with a developed PNG on the way.
#include "cli.h"
#include "render_report.h"
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

// More dropped samples than this share of all is a fault of the scene or of ours, told by the exit status.
static const double NON_FINITE_SHARE = 1e-4;

typedef struct render_job
{
    const ty_arguments* arguments;
    char output[TY_PATH_MAX];
    char preview[TY_PATH_MAX]; // "" = not developed
    ty_film_setup setup;
    ty_film_write write;
    ty_render_options render;
    double next_preview; // seconds of rendering
} render_job;

// --- the command line ---

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

// The short forms of --set, so that they are recorded like any other override.
static ty_status read_overrides(const ty_arguments* arguments, ty_scene_arguments* scene)
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

static void default_output(const char* scene_path, char out[TY_PATH_MAX])
{
    char name[TY_PATH_MAX];
    snprintf(name, sizeof name, "%s", scene_path);
    size_t length = strlen(name);
    while (length > 1 && name[length - 1] == '/')
    {
        name[--length] = '\0';
    }
    const char* slash = strrchr(name, '/');
    char* stem = slash ? name + (slash - name) + 1 : name;
    char* dot = ty_file_exists(scene_path) ? strrchr(stem, '.') : NULL;
    if (dot && dot != stem)
    {
        *dot = '\0';
    }
    snprintf(out, TY_PATH_MAX, "%.*s.exr", TY_PATH_MAX - 8, stem);
}

static ty_status read_outputs(const ty_arguments* arguments, render_job* job)
{
    const char* output = ty_argument_text(arguments, "output", NULL);
    default_output(arguments->positional[0], job->output);
    if (output)
    {
        snprintf(job->output, sizeof job->output, "%s", output);
    }
    if (strcmp(ty_path_extension(job->output), "exr") != 0)
    {
        return ty_usage(arguments->command, "the output '%s' must end in .exr (--develop adds a PNG)", job->output);
    }
    if (ty_argument_has(arguments, "develop"))
    {
        snprintf(job->preview, sizeof job->preview, "%.*s.png", (int)strlen(job->output) - 4, job->output);
    }
    return TY_OK;
}

static ty_status plan(const ty_arguments* arguments, const ty_scene* scene, render_job* job)
{
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

// --- rendering ---

static ty_status write_preview(const render_job* job, const ty_exr* exr, ty_error* error)
{
    ty_develop_def def = {.ocio = ty_argument_text(job->arguments, "ocio", NULL), .bits = 8};
    return ty_develop(exr, &def, job->preview, error);
}

// A first look after a few seconds, then at doubling intervals: a failure here is only a warning.
static bool on_pass(void* context, const ty_film* film, int samples, double seconds)
{
    render_job* job = context;
    if (job->preview[0] == '\0' || seconds < job->next_preview || samples >= job->render.sample_end)
    {
        return true;
    }
    job->next_preview = seconds < 10.0 ? 10.0 : 2.0 * seconds;
    ty_film_write write = job->write;
    write.sample_end = samples;
    write.partial = true;
    write.part = false;
    ty_exr* exr;
    ty_error error;
    ty_status status = ty_film_to_exr(film, &write, &exr, &error);
    if (status == TY_OK)
    {
        status = write_preview(job, exr, &error);
        ty_exr_destroy(exr);
    }
    if (status != TY_OK)
    {
        ty_log(TY_LOG_WARNING, "no preview: %s", error.text);
    }
    else
    {
        ty_log(TY_LOG_INFO, "%s after %.1f s with %d samples", job->preview, seconds, samples);
    }
    return true;
}

static ty_status write_results(const render_job* job, const ty_film* film, ty_error* error)
{
    ty_exr* exr;
    ty_status status = ty_film_to_exr(film, &job->write, &exr, error);
    if (status != TY_OK)
    {
        return status;
    }
    status = ty_exr_write(job->output, exr, error);
    if (status == TY_OK && job->preview[0])
    {
        status = write_preview(job, exr, error);
    }
    ty_exr_destroy(exr);
    return status;
}

static ty_status judge_samples(const render_job* job, const ty_render_stats* stats)
{
    if (stats->nonfinite_samples == 0)
    {
        return TY_OK;
    }
    const int* first = stats->first_nonfinite;
    ty_log(TY_LOG_WARNING,
           "%" PRIu64
           " samples were not finite and count as black; the first is pixel %d,%d sample %d: tsuya render %s "
           "--crop %d,%d,%d,%d --samples %d-%d -o bad.exr",
           stats->nonfinite_samples, first[0], first[1], first[2], job->arguments->positional[0], first[0], first[1],
           first[0], first[1], first[2], first[2]);
    return (double)stats->nonfinite_samples > NON_FINITE_SHARE * (double)stats->camera_rays ? TY_NON_FINITE : TY_OK;
}

// Renders, writes what there is (also after a signal) and reports.
static ty_status run_job(render_job* job, const ty_scene* scene, ty_workers* workers, ty_error* error)
{
    ty_film* film;
    ty_status status = ty_film_create(&job->setup, &film, error);
    if (status != TY_OK)
    {
        return status;
    }
    job->render.on_pass = on_pass;
    job->render.pass_context = job;
    job->next_preview = 1.0;
    ty_render_stats stats = {0};
    ty_status rendered = ty_render(scene, &job->render, workers, film, &stats, error);
    bool stopped = rendered == TY_INTERRUPTED || rendered == TY_TERMINATED;
    bool short_of_time = rendered == TY_OK && stats.samples_done < job->setup.sample_end - job->setup.sample_begin;
    if ((rendered == TY_OK || stopped) && stats.samples_done > 0)
    {
        job->write.partial = stopped || short_of_time;
        job->write.sample_end = job->setup.sample_begin + stats.samples_done;
        status = write_results(job, film, error);
    }
    ty_film_destroy(film);
    if (status != TY_OK || (rendered != TY_OK && !stopped))
    {
        return status != TY_OK ? status : rendered;
    }
    status = ty_render_report(scene, job->arguments, &stats, stats.samples_done > 0 ? job->output : NULL, job->preview);
    if (job->write.partial)
    {
        ty_log(TY_LOG_WARNING, "%s after %d of %d samples; the picture is marked partial",
               stopped ? "stopped by a signal" : "the time is over", stats.samples_done,
               job->setup.sample_end - job->setup.sample_begin);
    }
    if (stopped)
    {
        return rendered;
    }
    return status == TY_OK ? judge_samples(job, &stats) : status;
}

// Every output must be writable before an hour of rendering.
static ty_status probe_outputs(const render_job* job, ty_error* error)
{
    const char* const paths[] = {job->output, job->preview, ty_argument_text(job->arguments, "stats", "")};
    ty_status status = TY_OK;
    for (int i = 0; i < TY_PARAM_COUNT(paths) && status == TY_OK; i++)
    {
        status = paths[i][0] ? ty_output_probe(paths[i], error) : TY_OK;
    }
    return status;
}

static ty_status render_scene(render_job* job, ty_scene_arguments* scene_arguments)
{
    ty_error error = {0};
    bool dry = ty_argument_has(job->arguments, "dry-run");
    scene_arguments->options.check_only = dry;
    ty_status status = dry ? TY_OK : probe_outputs(job, &error);
    if (status != TY_OK)
    {
        ty_log_error(&error);
        return status;
    }
    ty_scene* scene;
    status = ty_scene_open(job->arguments->positional[0], &scene_arguments->options, &scene);
    if (status != TY_OK)
    {
        return status;
    }
    status = plan(job->arguments, scene, job);
    if (status == TY_OK && dry)
    {
        printf("would render %s: %dx%d, pixels %d,%d to %d,%d, samples %d-%d, to %s\n", scene->path,
               scene->film.size[0], scene->film.size[1], job->setup.crop[0], job->setup.crop[1], job->setup.crop[2],
               job->setup.crop[3], job->setup.sample_begin, job->setup.sample_end - 1, job->output);
        status = ty_output_finish();
    }
    else if (status == TY_OK)
    {
        status = run_job(job, scene, scene_arguments->options.workers, &error);
        if (error.text[0])
        {
            ty_log_error(&error);
        }
    }
    ty_scene_destroy(scene);
    return status;
}

static ty_status read_progress(const ty_arguments* arguments)
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

static ty_status run(const ty_arguments* arguments)
{
    static render_job job; // paths: too large for the stack
    static ty_scene_arguments scene_arguments;
    job = (render_job){.arguments = arguments};
    ty_status status = read_progress(arguments);
    status = status == TY_OK ? read_outputs(arguments, &job) : status;
    status = status == TY_OK ? ty_scene_arguments_read(arguments, &scene_arguments) : status;
    if (status != TY_OK)
    {
        return status;
    }
    status = read_overrides(arguments, &scene_arguments);
    status = status == TY_OK ? render_scene(&job, &scene_arguments) : status;
    ty_scene_arguments_term(&scene_arguments);
    return status;
}

static const ty_option options[] = {
    {"output", 'o', "OUT.exr", "the picture (default: the scene's name)"},
    {"develop", 0, NULL, "also a PNG beside it, from early on"},
    TY_SCENE_OPTIONS,
    {"quick", 'q', NULL, "half size, 16 samples, where --size, --spp and --set say nothing"},
    {"spp", 0, "N", "samples a pixel"},
    {"samples", 0, "A-B", "only these sample indices: a part for `tsuya merge`"},
    {"size", 0, "WxH", "picture size"},
    {"crop", 0, "x0,y0,x1,y1", "only these pixels (inclusive)"},
    {"seed", 0, "N", "seed of all random decisions"},
    {"aov", 0, "LIST", "alpha,Z,N,P,albedo,variance,instance,light | all | none"},
    {"integrator", 0, "X", "path, albedo, normal, curvature, ao"},
    {"time-limit", 0, "SECONDS", "stop after the pass that exceeds it"},
    {"trace", 0, "PATH", "fast, or reference: plain Embree instances"},
    {"isa", 0, "NAME", "pin the CPU kernels: sse2, sse4.2, avx, avx2, avx512"},
    {"stats", 0, "F.json", "statistics as JSON"},
    {"progress", 0, "M", "auto, bar, lines, none"},
    {"json", 0, NULL, "the result as JSON on standard output"},
    {"dry-run", 0, NULL, "check everything, render nothing"},
};

const ty_command ty_command_render = {
    "render",
    "SCENE [options]",
    "trace a scene into an EXR",
    "tsuya render scenes/rice_bowl -o out/rice_bowl.exr --quick --develop -D moisture=0.3",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
