// SPDX-License-Identifier: Apache-2.0
// Truths are made once and kept in the folder of the suite; materials are sampled at the same points.
#include "truth.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

const double truth_albedos[ALBEDOS] = {1, 0.995, 0.98, 0.9};

static const vec lamps[LAMPS] = {{0, 0, 1}, {1, 0, 0}, {0.57735026918962576, 0.57735026918962576, 0.57735026918962576}};

static double sky_at(double normal_z)
{
    return 0.5 * (1.0 + normal_z);
}

// Adds to out[LIGHTS].
static void light_at(const implicit_shape* shape, vec x, vec n, double out[LIGHTS])
{
    for (int i = 0; i < LAMPS; i++)
    {
        double c = vec_dot(n, lamps[i]);
        if (c > 0.0 && (shape->convex || implicit_hit(shape, vec_mad(x, n, 1e-4), lamps[i], false, 1e9) < 0.0))
            out[i] += c;
    }
    out[HALF_SKY] += sky_at(n.z);
    out[EVERYWHERE] += 1.0;
}

// --- walks ---

static void walk_points(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    truth* t = context;
    for (int64_t i = begin; i < end; i++)
    {
        ty_rng rng = ty_rng_make((ty_seed){41}, (uint64_t)i, (uint64_t)(t->path * 65536));
        for (int k = 0; k < 2 * t->walks; k++)
        {
            vec exit;
            double light[LIGHTS] = {0};
            int n = implicit_walk(t->shape, t->x[i], t->n[i], t->path, &rng, &exit);
            light_at(t->shape, exit, implicit_normal(t->shape, exit), light);
            for (int a = 0; a < ALBEDOS; a++)
            {
                double w = a == 0 ? 1.0 : pow(truth_albedos[a], n);
                for (int j = 0; j < LIGHTS; j++)
                    t->light[a][i][k & 1][j] += w * light[j] / t->walks;
            }
        }
    }
}

static bool read_truth(const char* path, truth* t)
{
    FILE* file = fopen(path, "rb");
    if (!file)
        return false;
    size_t n = (size_t)t->points;
    vec* x = TY_ALLOC(vec, n);
    bool good = fread(x, sizeof *x, n, file) == n && memcmp(x, t->x, n * sizeof *x) == 0;
    for (int a = 0; a < ALBEDOS; a++)
        good = good && fread(t->light[a], sizeof *t->light[a], n, file) == n;
    ty_free(x);
    fclose(file);
    return good;
}

static void write_truth(const char* path, const truth* t)
{
    FILE* file = fopen(path, "wb");
    if (!file)
        return;
    fwrite(t->x, sizeof *t->x, (size_t)t->points, file);
    for (int a = 0; a < ALBEDOS; a++)
        fwrite(t->light[a], sizeof *t->light[a], (size_t)t->points, file);
    fclose(file);
}

static double kept_of(const halves* light, int points)
{
    double sum = 0.0;
    for (int i = 0; i < points; i++)
        sum += light[i][0][EVERYWHERE] + light[i][1][EVERYWHERE];
    return sum / (2.0 * points);
}

truth truth_make(const implicit_shape* shape, double path, const bench_options* options, int quick_walks,
                 ty_workers* workers)
{
    char file[1024] = "";
    truth t = {.shape = shape, .points = options->quick ? 200 : 1000, .walks = options->quick ? quick_walks : 1000};
    t.x = TY_ALLOC(vec, t.points);
    t.n = TY_ALLOC(vec, t.points);
    for (int a = 0; a < ALBEDOS; a++)
        t.light[a] = TY_ALLOC(halves, t.points);
    implicit_measure m = implicit_points(shape, 5, t.points, t.x);
    t.radius = 3.0 * m.volume / m.area;
    t.path = path < 0.0 ? -path * t.radius : path;
    for (int i = 0; i < t.points; i++)
        t.n[i] = implicit_normal(shape, t.x[i]);
    if (options->folder)
        snprintf(file, sizeof file, "%s/lit_%s_%.4f_%d_%d.bin", options->folder, shape->name, t.path, t.points,
                 t.walks);
    if (!options->folder || !read_truth(file, &t))
    {
        for (int a = 0; a < ALBEDOS; a++)
            memset(t.light[a], 0, (size_t)t.points * sizeof *t.light[a]);
        ty_parallel_for(workers, t.points, 4, walk_points, &t);
        if (options->folder)
            write_truth(file, &t);
    }
    for (int a = 0; a < ALBEDOS; a++)
        t.kept[a] = kept_of(t.light[a], t.points);
    return t;
}

void truth_drop(truth* t)
{
    ty_free(t->x);
    ty_free(t->n);
    for (int a = 0; a < ALBEDOS; a++)
        ty_free(t->light[a]);
}

// --- materials ---

typedef struct show_job
{
    const truth* t;
    const subject* s;
    const ty_material* material;
    int channel, samples;
    halves* light;
} show_job;

static double channel_of(ty_rgb c, int channel)
{
    return (double)(channel == 0 ? c.r : channel == 1 ? c.g : c.b);
}

static void sample_point(const show_job* job, const ty_surface_point* p, ty_rng* rng, double light[LIGHTS])
{
    double turn[4];
    for (int k = 0; k < 4; k++)
        turn[k] = random_double(rng);
    for (int k = 0; k < job->samples; k++)
    {
        float u[4];
        ty_bsdf b;
        ty_rgb weight;
        roberts_sequence(k, turn, u);
        if (!subject_leave(job->s, job->material, p, u, rng, &b, &weight))
            continue;
        double w = channel_of(weight, job->channel) / job->samples;
        subject_light(job->s, &b, w, rng, lamps, LAMPS, light);
        light[HALF_SKY] += w * sky_at((double)b.frame.n.z);
        light[EVERYWHERE] += w;
    }
}

static void show_points(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const show_job* job = context;
    const truth* t = job->t;
    for (int64_t i = begin; i < end; i++)
    {
        ty_rng rng = ty_rng_make((ty_seed){42}, (uint64_t)i, 0);
        ty_surface_point p = subject_point(job->s, t->x[i], t->n[i]);
        for (int h = 0; h < 2; h++)
            if (job->material)
                sample_point(job, &p, &rng, job->light[i][h]);
            else
                light_at(t->shape, t->x[i], t->n[i], job->light[i][h]);
    }
}

shown show(const truth* t, const subject* s, const ty_material* material, int channel, int samples,
           const bench_options* options, ty_workers* workers)
{
    show_job job = {t, s, material, channel, samples > 0 ? samples : options->quick ? 100 : 500, NULL};
    job.light = TY_ALLOC(halves, t->points);
    memset(job.light, 0, (size_t)t->points * sizeof *job.light);
    ty_parallel_for(workers, t->points, 4, show_points, &job);
    return (shown){t, job.light, kept_of(job.light, t->points)};
}

shown show_model(const truth* t, const subject* s, model m, const bench_options* options, ty_workers* workers)
{
    ty_cdrf_evaluate evaluate = m == DEPTH ? TY_CDRF_DEPTH : m == PROBE ? TY_CDRF_PROBE : TY_CDRF_LOCAL;
    ty_material* material = m == LAMBERT ? NULL
                            : m == WALK  ? subject_walk(t->path, 1)
                                         : subject_cdrf(evaluate, TY_CDRF_POISSON, t->path);
    int samples = 0;
    if (m == LOCAL)
        samples = t->shape->convex ? 1 : 20; // only its rays are random
    if (m == WALK)
        samples = t->walks;
    shown out = show(t, s, material, 1, samples, options, workers);
    ty_material_destroy(material);
    return out;
}

void shown_drop(shown* s)
{
    ty_free(s->light);
}

// --- what tells them apart ---

figures judge(const shown* s, int albedo)
{
    const truth* t = s->t;
    const halves* light = t->light[albedo];
    double scale = t->kept[albedo];
    figures f = {0};
    for (int k = 0; k < LIGHTS; k++)
    {
        double sum = 0.0, ours = 0.0, theirs = 0.0;
        for (int i = 0; i < t->points; i++)
        {
            const double(*a)[LIGHTS] = s->light[i], (*b)[LIGHTS] = light[i];
            sum += (a[0][k] / s->kept - b[0][k] / scale) * (a[1][k] / s->kept - b[1][k] / scale);
            ours += (a[0][k] + a[1][k]) / s->kept;
            theirs += (b[0][k] + b[1][k]) / scale;
        }
        f.rms[k] = sqrt(fmax(sum, 0.0) / t->points);
        f.flux[k] = ours / theirs - 1.0;
        if (k < LAMPS)
            f.pooled += sum / t->points / LAMPS;
    }
    f.pooled = sqrt(fmax(f.pooled, 0.0));
    return f;
}

double shown_difference(const shown* a, const shown* b)
{
    double sum = 0.0;
    for (int i = 0; i < a->t->points; i++)
        for (int k = 0; k < LAMPS; k++)
        {
            const double(*p)[LIGHTS] = a->light[i], (*q)[LIGHTS] = b->light[i];
            sum += (p[0][k] / a->kept - q[0][k] / b->kept) * (p[1][k] / a->kept - q[1][k] / b->kept);
        }
    return sqrt(fmax(sum / (LAMPS * a->t->points), 0.0));
}

figures measure(const truth* t, const subject* s, model m, const bench_options* options, ty_workers* workers)
{
    shown x = show_model(t, s, m, options, workers);
    figures f = judge(&x, 0);
    shown_drop(&x);
    return f;
}

double worst_flux(const figures* f)
{
    double worst = 0.0;
    for (int k = 0; k < LAMPS; k++)
        worst = fmax(worst, fabs(f->flux[k]));
    return worst;
}
