// SPDX-License-Identifier: Apache-2.0
// Counts of pixels, frame by frame, as JSON.
#include "loop_report.h"
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/sink.h>

struct ty_loop_report
{
    const ty_loop_recipe* recipe;
    const ty_loop_volume* volume;
    size_t pixels;
    uint8_t *first, *last, *now; // inside
    ty_loop_pair* pairs;         // i: from frame i to i + 1, the last back to the first
    int count;                   // frames taken
};

ty_status ty_loop_report_create(const ty_loop_recipe* recipe, const ty_loop_volume* volume, ty_loop_report** out,
                                ty_error* error)
{
    ty_loop_report* r = TY_ALLOC(ty_loop_report, 1);
    r->recipe = recipe;
    r->volume = volume;
    r->pixels = (size_t)recipe->size[0] * (size_t)recipe->size[1];
    r->first = TY_TRY_ALLOC(uint8_t, r->pixels);
    r->last = TY_TRY_ALLOC(uint8_t, r->pixels);
    r->now = TY_TRY_ALLOC(uint8_t, r->pixels);
    r->pairs = TY_TRY_ALLOC(ty_loop_pair, recipe->frames);
    *out = r;
    if (r->first && r->last && r->now && r->pairs)
        return TY_OK;
    ty_loop_report_destroy(r);
    *out = NULL;
    return ty_error_set(error, TY_NO_MEMORY, "no memory for the figures of %d frames", recipe->frames);
}

void ty_loop_report_destroy(ty_loop_report* report)
{
    if (!report)
        return;
    ty_free(report->first);
    ty_free(report->last);
    ty_free(report->now);
    ty_free(report->pairs);
    ty_free(report);
}

ty_loop_pair ty_loop_pair_of(int64_t pixels, int64_t first, int64_t second, int64_t both)
{
    double n = (double)pixels, a = (double)first / n, b = (double)second / n, ab = (double)both / n;
    double agreed = 1.0 - a - b + 2.0 * ab, chance = a * b + (1.0 - a) * (1.0 - b);
    return (ty_loop_pair){
        .changed = a + b - 2.0 * ab,
        .overlap = first > 0 ? ab / a : 0.0,
        .density = a,
        .jaccard = a + b - ab > 0.0 ? ab / (a + b - ab) : 1.0,
        .kappa = chance < 1.0 ? (agreed - chance) / (1.0 - chance) : 1.0,
    };
}

static ty_loop_pair compare(const uint8_t* first, const uint8_t* second, size_t pixels)
{
    int64_t a = 0, b = 0, both = 0;
    for (size_t i = 0; i < pixels; i++)
    {
        a += first[i];
        b += second[i];
        both += first[i] & second[i];
    }
    return ty_loop_pair_of((int64_t)pixels, a, b, both);
}

void ty_loop_report_add(ty_loop_report* report, const float* coverage)
{
    uint8_t* inside = report->count == 0 ? report->first : report->now;
    for (size_t i = 0; i < report->pixels; i++)
        inside[i] = coverage[i] >= 0.5f;
    if (report->count > 0)
    {
        report->pairs[report->count - 1] = compare(report->last, inside, report->pixels);
        report->now = report->last;
        report->last = inside;
    }
    else
        memcpy(report->last, inside, report->pixels);
    report->count++;
    if (report->count == report->recipe->frames)
        report->pairs[report->count - 1] = compare(report->last, report->first, report->pixels);
}

// --- wavelength ---

// Entries along axis k on every skip-th line, and voxels of these lines.
static void entries_count(const ty_loop_volume* v, int k, size_t skip, uint16_t iso, int64_t* entries, int64_t* voxels)
{
    const size_t steps[3] = {1, v->row, v->slice};
    int p = (k + 1) % 3, q = (k + 2) % 3;
    size_t line = 0;
    for (int j = 0; j < v->size[q]; j++)
        for (int i = 0; i < v->size[p]; i++, line++)
        {
            if (line % skip)
                continue;
            const uint16_t* at = v->values + (size_t)i * steps[p] + (size_t)j * steps[q];
            for (int x = 1; x < v->size[k]; x++)
                *entries += at[(size_t)(x - 1) * steps[k]] < iso && at[(size_t)x * steps[k]] >= iso;
            *voxels += v->size[k];
        }
}

double ty_loop_wavelength(const ty_loop_volume* volume, float iso)
{
    double least = 0.0;
    size_t lines = volume->count >> 22; // about four million voxels are enough
    for (int k = 0; k < 3; k++)
    {
        int64_t entries = 0, voxels = 0;
        entries_count(volume, k, lines | 1, ty_loop_number_of(iso), &entries, &voxels);
        double length = entries > 0 ? (double)voxels / (double)entries : 0.0;
        if (length > 0.0 && (least == 0.0 || length < least))
            least = length;
    }
    return least;
}

// --- text ---

static void pair_add(ty_sink* t, const ty_loop_pair* p)
{
    ty_sink_format(t, "{\"changed\": %.6f, \"overlap\": %.6f, \"density\": %.6f, \"jaccard\": %.6f, \"kappa\": %.6f}",
                   p->changed, p->overlap, p->density, p->jaccard, p->kappa);
}

// Largest change and largest difference from one change to the next, the seam apart; means of the rest.
static void summary_add(ty_sink* t, const ty_loop_report* r)
{
    int n = r->recipe->frames;
    ty_loop_pair mean = {0};
    double most = 0.0, jump = 0.0, density[2] = {1.0, 0.0};
    for (int i = 0; i < n; i++)
    {
        const ty_loop_pair* p = &r->pairs[i];
        mean.changed += p->changed / n;
        mean.overlap += p->overlap / n;
        mean.density += p->density / n;
        mean.jaccard += p->jaccard / n;
        mean.kappa += p->kappa / n;
        density[0] = p->density < density[0] ? p->density : density[0];
        density[1] = p->density > density[1] ? p->density : density[1];
        if (i < n - 1 && p->changed > most)
            most = p->changed;
        if (i > 0 && i < n - 1 && fabs(p->changed - r->pairs[i - 1].changed) > jump)
            jump = fabs(p->changed - r->pairs[i - 1].changed);
    }
    double seam = r->pairs[n - 1].changed, before = n > 1 ? r->pairs[n - 2].changed : 0.0, after = r->pairs[0].changed;
    double seam_jump = fabs(seam - before) > fabs(after - seam) ? fabs(seam - before) : fabs(after - seam);
    ty_sink_format(t, "\"mean\": ");
    pair_add(t, &mean);
    ty_sink_format(
        t, ", \"density_least\": %.6f, \"density_most\": %.6f, \"changed_most\": %.6f, \"changed_at_seam\": %.6f, ",
        density[0], density[1], most, seam);
    ty_sink_format(t, "\"speed_jump_most\": %.6f, \"speed_jump_at_seam\": %.6f, ", jump, seam_jump);
}

static double longest_step(const ty_loop_report* r)
{
    double most = 0.0;
    for (int i = 0; i < r->recipe->frames; i++)
    {
        double step = ty_loop_motion_step(r->recipe, r->volume->size, i, r->recipe->frames);
        most = step > most ? step : most;
    }
    return most;
}

static double outside_mean(const ty_loop_report* r)
{
    double sum = 0.0;
    for (int i = 0; i < r->recipe->frames; i++)
        sum += ty_loop_motion_outside(r->recipe, r->volume, i);
    return sum / r->recipe->frames;
}

int ty_loop_report_quietest(const ty_loop_report* report)
{
    int n = report->count, least = n - 1;
    for (int i = 0; i < n; i++)
        if (report->pairs[i].changed < report->pairs[least].changed)
            least = i;
    return (least + 1) % n;
}

char* ty_loop_report_end(const ty_loop_report* report, int first)
{
    const ty_loop_recipe* recipe = report->recipe;
    const int* size = report->volume->size;
    ty_sink t = {0};
    double wave =
        recipe->wavelength > 0.0f ? (double)recipe->wavelength : ty_loop_wavelength(report->volume, recipe->iso);
    double step = longest_step(report);
    int needed = wave > 0.0 && step > 0.25 * wave ? (int)ceil(recipe->frames * step / (0.25 * wave)) : 0;
    if (needed > 0)
        ty_log(TY_LOG_WARNING,
               "from frame to frame the rectangle moves up to %.1f voxels, above a quarter of the pattern's wavelength "
               "of %.1f: it will seem to jump; %d frames do not",
               step, wave, needed);
    ty_sink_format(&t, "{\"frames\": %d, \"volume\": [%d, %d, %d], ", recipe->frames, size[0], size[1], size[2]);
    ty_sink_format(&t, "\"colors\": %d, \"wavelength\": %.3f, \"step_most\": %.4f, \"frames_needed\": %d, ",
                   report->volume->palette.count, wave, step, needed > 0 ? needed : recipe->frames);
    ty_sink_format(&t, "\"outside\": %.6f, \"start\": %.6f, ", outside_mean(report), (double)first / recipe->frames);
    summary_add(&t, report);
    ty_sink_format(&t, "\"steps\": [");
    for (int i = 0; i < recipe->frames; i++)
    {
        if (i > 0)
            ty_sink_format(&t, ", ");
        pair_add(&t, &report->pairs[i]);
    }
    ty_sink_format(&t, "]}");
    ty_sink_put(&t, "", 1);
    return (char*)t.bytes;
}
