// SPDX-License-Identifier: Apache-2.0
// One frame of a scene: rendered, written, developed; or found to be there already.
#include "render_job.h"
#include "render_report.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

// More dropped samples than this share of all is a fault of the scene or of ours, told by the exit status.
static const double NON_FINITE_SHARE = 1e-4;

static ty_status write_preview(const ty_render_job* job, const ty_exr* exr, ty_error* error)
{
    return ty_develop(exr, &job->develop, job->preview, error);
}

// A first look after a few seconds, then at doubling intervals: a failure here is only a warning.
static bool on_pass(void* context, const ty_film* film, int samples, double seconds)
{
    ty_render_job* job = context;
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

static ty_status write_results(const ty_render_job* job, const ty_film* film, ty_error* error)
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

static ty_status judge_samples(const ty_render_job* job, const ty_scene* scene, const ty_render_stats* stats)
{
    if (stats->nonfinite_samples == 0)
    {
        return TY_OK;
    }
    const int* first = stats->first_nonfinite;
    char frame[32] = "";
    if (job->lists && !job->repeat)
    {
        snprintf(frame, sizeof frame, " --frames %d", (int)scene->frame);
    }
    ty_log(TY_LOG_WARNING,
           "%" PRIu64 " samples were not finite and count as black; the first is pixel %d,%d sample %d: %s%s "
           "--crop %d,%d,%d,%d --samples %d-%d%s -o bad.exr",
           stats->nonfinite_samples, first[0], first[1], first[2], job->repeat ? job->repeat : "tsuya render ",
           job->repeat ? "" : job->arguments->positional[0], first[0], first[1], first[0], first[1], first[2], first[2],
           frame);
    return (double)stats->nonfinite_samples > NON_FINITE_SHARE * (double)stats->camera_rays ? TY_NON_FINITE : TY_OK;
}

static ty_status report(ty_render_job* job, const ty_scene* scene, const ty_render_stats* stats)
{
    const char* output = stats->samples_done > 0 ? job->output : NULL;
    if (!job->lists)
    {
        return ty_render_report(scene, job->arguments, stats, output, job->preview);
    }
    if (job->results)
    {
        json_array_append_new(job->results, ty_render_stats_json(scene, stats, output));
    }
    return ty_render_report_files(job->arguments, output, job->preview);
}

ty_status ty_render_frame(ty_render_job* job, const ty_scene* scene, ty_workers* workers, ty_error* error)
{
    ty_film* film;
    ty_status status = ty_film_create(&job->setup, &film, error);
    if (status != TY_OK)
    {
        return status;
    }
    job->write.partial = false;
    job->write.sample_end = job->setup.sample_end;
    job->render.on_pass = on_pass;
    job->render.pass_context = job;
    job->next_preview = job->lists ? 10.0 : 1.0; // of many, only long ones
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
    status = report(job, scene, &stats);
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
    return status == TY_OK ? judge_samples(job, scene, &stats) : status;
}

static bool has_text(const ty_exr* exr, const char* name, const char* text)
{
    const ty_exr_attribute* attribute = ty_exr_find_attribute(exr, name);
    return attribute && attribute->type == TY_EXR_STRING && attribute->text && strcmp(attribute->text, text) == 0;
}

ty_status ty_render_find(const ty_render_job* job, const ty_scene* scene, bool* found, ty_error* error)
{
    ty_exr* exr;
    ty_error unreadable;
    char samples[32];
    *found = false;
    if (!ty_file_exists(job->output) || ty_exr_read(job->output, &exr, &unreadable) != TY_OK)
    {
        return TY_OK;
    }
    snprintf(samples, sizeof samples, "%d-%d", job->setup.sample_begin, job->setup.sample_end - 1);
    *found = has_text(exr, "tsuya/hash", scene->hash) && has_text(exr, "tsuya/samples", samples) &&
             !ty_exr_find_attribute(exr, "tsuya/partial") &&
             memcmp(exr->data_window, job->setup.crop, sizeof job->setup.crop) == 0 &&
             ty_film_setup_matches(&job->setup, exr);
    // The PNG does not tell how it was developed: it is made again.
    ty_status status = *found && job->preview[0] ? write_preview(job, exr, error) : TY_OK;
    ty_exr_destroy(exr);
    return status;
}
