// SPDX-License-Identifier: Apache-2.0
// `tsuya render`: a scene to an EXR, or to one a frame, with developed PNGs and a video on the way.
#include "render_job.h"
#include "video.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

static void default_output(const char* scene_path, bool frames, char out[TY_PATH_MAX])
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
    snprintf(out, TY_PATH_MAX, "%.*s%s.exr", TY_PATH_MAX - 16, stem, frames ? ".####" : "");
}

static ty_status read_outputs(ty_render_job* job)
{
    const ty_arguments* arguments = job->arguments;
    default_output(arguments->positional[0], job->lists, job->pattern);
    if (ty_argument_has(arguments, "output"))
    {
        ty_frame_pattern(ty_argument_text(arguments, "output", ""), job->pattern);
    }
    if (strcmp(ty_path_extension(job->pattern), "exr") != 0)
    {
        return ty_usage(arguments->command, "the output '%s' must end in .exr (--develop adds a PNG)", job->pattern);
    }
    job->skips = ty_argument_has(arguments, "skip-existing");
    job->video = ty_argument_text(arguments, "video", NULL);
    job->develops = ty_argument_has(arguments, "develop") || job->video;
    if (job->video && !job->lists)
    {
        return ty_usage(arguments->command, "--video needs frames: give --frames");
    }
    ty_status status = ty_develop_options(arguments, &job->develop);
    return status == TY_OK && job->develops ? ty_develop_check(&job->develop) : status;
}

// Names of the frame's files.
static void set_names(ty_render_job* job, int frame)
{
    char preview[TY_PATH_MAX];
    ty_path_frame(job->pattern, frame, job->output);
    job->preview[0] = '\0';
    if (job->develops)
    {
        snprintf(preview, sizeof preview, "%.*s.png", (int)strlen(job->pattern) - 4, job->pattern);
        ty_path_frame(preview, frame, job->preview);
    }
}

// Every output must be writable before an hour of rendering.
static ty_status probe_outputs(const ty_render_job* job, ty_error* error)
{
    const char* const paths[] = {job->output, job->preview, ty_argument_text(job->arguments, "stats", "")};
    ty_status status = TY_OK;
    for (int i = 0; i < TY_PARAM_COUNT(paths) && status == TY_OK; i++)
    {
        status = paths[i][0] ? ty_output_probe(paths[i], error) : TY_OK;
    }
    if (status != TY_OK || !job->video)
    {
        return status;
    }
    if (!ty_video_available())
    {
        ty_log(TY_LOG_WARNING, "there is no ffmpeg in PATH: the frames will be written, '%s' will not", job->video);
    }
    return ty_video_probe(job->video, error);
}

// The frames of --frames, if there is none yet.
static ty_status read_list(ty_render_job* job, const ty_scene_options* options)
{
    if (!job->lists || job->list.count > 0)
    {
        return TY_OK;
    }
    return ty_frame_list_read(job->arguments, options, &job->list);
}

static ty_status check_pattern(const ty_render_job* job)
{
    if (job->list.count > 1 && !ty_path_is_sequence(job->pattern))
    {
        return ty_usage(job->arguments->command, "%d frames need an output with #### or %%04d in its name, not '%s'",
                        job->list.count, job->pattern);
    }
    return TY_OK;
}

static ty_status set_frame(ty_scene* scene, int frame)
{
    ty_error_list errors = {0};
    ty_status status = ty_scene_set_frame(scene, frame, &errors);
    ty_errors_log(&errors);
    return status;
}

static void tell_progress(const ty_render_job* job, int index, bool found, double start, int rendered)
{
    double seconds = ty_time_now() - start, left = rendered ? seconds / rendered * (job->list.count - index - 1) : 0.0;
    ty_log(TY_LOG_INFO, "frame %d (%d of %d): %s%s%s; %.1f s so far, about %.0f s to go", job->list.frames[index],
           index + 1, job->list.count, found ? "there already, " : "", job->output,
           job->preview[0] ? " and its PNG" : "", seconds, left);
}

static bool is_stop(ty_status status)
{
    return status == TY_INTERRUPTED || status == TY_TERMINATED;
}

// All frames of the list. A frame with too many bad samples is written like the others and told at the end.
static ty_status run_list(ty_render_job* job, ty_scene* scene, ty_workers* workers, ty_error* error)
{
    double start = ty_time_now();
    int rendered = 0;
    ty_status judged = TY_OK;
    for (int i = 0; i < job->list.count; i++)
    {
        bool found = false;
        set_names(job, job->list.frames[i]);
        ty_status status = set_frame(scene, job->list.frames[i]);
        if (status == TY_OK && job->skips)
        {
            status = ty_render_find(job, scene, &found, error);
        }
        if (status == TY_OK && !found)
        {
            status = ty_render_frame(job, scene, workers, error);
            rendered++;
        }
        if (status == TY_NON_FINITE)
        {
            judged = status;
        }
        else if (status != TY_OK)
        {
            if (is_stop(status))
            {
                ty_log(TY_LOG_WARNING, "%d of %d frames are complete; --skip-existing goes on from there", i,
                       job->list.count);
            }
            return status;
        }
        tell_progress(job, i, found, start, rendered);
    }
    return judged;
}

static ty_status make_video(const ty_render_job* job, const ty_scene* scene, ty_error* error)
{
    char pattern[TY_PATH_MAX];
    if (!ty_video_available())
    {
        ty_log(TY_LOG_WARNING, "there is no ffmpeg in PATH: '%s' was not made", job->video);
        return TY_OK;
    }
    snprintf(pattern, sizeof pattern, "%.*s.png", (int)strlen(job->pattern) - 4, job->pattern);
    ty_status status = ty_video_write(job->video, pattern, &job->list, (double)scene->timeline.fps, error);
    if (status == TY_OK && !ty_argument_has(job->arguments, "json"))
    {
        printf("%s\n", job->video);
        status = ty_output_finish();
    }
    return status;
}

// Statistics of all frames: what one frame says, in a list.
static ty_status report_list(ty_render_job* job, const ty_scene* scene)
{
    const char* path = ty_argument_text(job->arguments, "stats", NULL);
    ty_log(TY_LOG_INFO, "%d frames; load %.1f s, peak %.0f MB", job->list.count, scene->load_seconds,
           (double)ty_memory_peak() * 1e-6);
    if (!job->results)
    {
        return TY_OK;
    }
    ty_status status = path ? ty_json_write(path, json_incref(job->results)) : TY_OK;
    bool prints = ty_argument_has(job->arguments, "json");
    return status == TY_OK && prints ? ty_json_print(json_incref(job->results)) : status;
}

static ty_status run_frames(ty_render_job* job, ty_scene* scene, ty_workers* workers, ty_error* error)
{
    if (!job->lists)
    {
        bool found = false;
        ty_status status = job->skips ? ty_render_find(job, scene, &found, error) : TY_OK;
        return status == TY_OK && !found ? ty_render_frame(job, scene, workers, error) : status;
    }
    if (ty_argument_has(job->arguments, "json") || ty_argument_has(job->arguments, "stats"))
    {
        job->results = json_array();
    }
    ty_status judged = run_list(job, scene, workers, error);
    ty_status status = judged == TY_NON_FINITE ? TY_OK : judged;
    if (status == TY_OK && job->video)
    {
        status = make_video(job, scene, error);
    }
    if (status == TY_OK || is_stop(status))
    {
        ty_status reported = report_list(job, scene);
        status = status == TY_OK ? reported : status;
    }
    json_decref(job->results);
    return status == TY_OK ? judged : status;
}

static ty_status tell_plan(const ty_render_job* job, ty_scene* scene)
{
    for (int i = 0; i < job->list.count; i++)
    {
        ty_status status = set_frame(scene, job->list.frames[i]);
        if (status != TY_OK)
        {
            return status;
        }
    }
    printf("would render %s: %dx%d, pixels %d,%d to %d,%d, samples %d-%d, to %s\n", scene->path, scene->film.size[0],
           scene->film.size[1], job->setup.crop[0], job->setup.crop[1], job->setup.crop[2], job->setup.crop[3],
           job->setup.sample_begin, job->setup.sample_end - 1, job->lists ? job->pattern : job->output);
    if (job->lists)
    {
        printf("%d frames: %d to %d\n", job->list.count, job->list.frames[0], job->list.frames[job->list.count - 1]);
    }
    return ty_output_finish();
}

static ty_status render_scene(ty_render_job* job, ty_scene* scene, ty_workers* workers)
{
    ty_error error = {0};
    bool dry = ty_argument_has(job->arguments, "dry-run");
    ty_status status = ty_render_plan(job, scene);
    set_names(job, job->list.count ? job->list.frames[0] : (int)floor(scene->frame + 0.5));
    if (status == TY_OK && dry)
    {
        return tell_plan(job, scene);
    }
    if (status == TY_OK)
    {
        status = run_frames(job, scene, workers, &error);
    }
    if (error.text[0])
    {
        ty_log_error(&error);
    }
    return status;
}

// What is wrong with frames and outputs is told before a scene is loaded for minutes.
static ty_status prepare(ty_render_job* job, ty_scene_arguments* scene_arguments)
{
    ty_error error;
    ty_status status = ty_render_progress(job->arguments);
    status = status == TY_OK ? read_outputs(job) : status;
    status = status == TY_OK ? read_list(job, &scene_arguments->options) : status;
    status = status == TY_OK ? check_pattern(job) : status;
    status = status == TY_OK ? ty_render_overrides(job->arguments, scene_arguments) : status;
    scene_arguments->options.check_only = ty_argument_has(job->arguments, "dry-run");
    if (status == TY_OK && job->list.count > 0)
    {
        job->first = job->list.frames[0];
        scene_arguments->options.frame = &job->first;
        scene_arguments->options.frames = job->list.frames;
        scene_arguments->options.frame_count = job->list.count;
    }
    if (status != TY_OK || scene_arguments->options.check_only)
    {
        return status;
    }
    set_names(job, job->list.count ? job->list.frames[0] : 1);
    status = probe_outputs(job, &error);
    if (status != TY_OK)
    {
        ty_log_error(&error);
    }
    return status;
}

ty_status ty_render_run(const ty_arguments* arguments, ty_scene_arguments* scene_arguments, ty_frame_list list)
{
    static ty_render_job job; // paths: too large for the stack
    job = (ty_render_job){.arguments = arguments, .list = list};
    job.lists = list.count > 0 || ty_argument_has(arguments, "frames");
    ty_scene* scene = NULL;
    ty_status status = prepare(&job, scene_arguments);
    status = status == TY_OK ? ty_scene_open(arguments->positional[0], &scene_arguments->options, &scene) : status;
    status = status == TY_OK ? render_scene(&job, scene, scene_arguments->options.workers) : status;
    ty_scene_destroy(scene);
    ty_frame_list_term(&job.list);
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    static ty_scene_arguments scene_arguments;
    ty_status status = ty_scene_arguments_read(arguments, &scene_arguments);
    if (status != TY_OK)
    {
        return status;
    }
    status = ty_render_run(arguments, &scene_arguments, (ty_frame_list){0});
    ty_scene_arguments_term(&scene_arguments);
    return status;
}

static const ty_option options[] = {
    {"frames", 'f', "LIST", "frames, e.g. 1-24:2,40, or all of the timeline; the scene is loaded once"},
    TY_RENDER_OPTIONS,
};

const ty_command ty_command_render = {
    "render",
    "SCENE [options]",
    "trace a scene into an EXR, or into one a frame",
    "tsuya render scenes/rice_bowl -o out/rice_bowl.exr --quick --develop -D moisture=0.3",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
