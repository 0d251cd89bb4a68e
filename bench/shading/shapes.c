// SPDX-License-Identifier: Apache-2.0
// Materials on triangle meshes of nine shapes against walks in the shapes: irradiance under three lights, pooled.
#include "report.h"
#include "subject.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/workers.h>

#define LIGHTS 3

static const vec lights[LIGHTS] = {
    {0, 0, 1}, {1, 0, 0}, {0.57735026918962576, 0.57735026918962576, 0.57735026918962576}};

typedef enum model
{
    LAMBERT,
    LOCAL,
    PROBE,
    DEPTH,
    WALK, // the material, against the walks of implicit.c
    MODELS
} model;

// Two halves of everything that is random: the mean of their product is free of noise.
typedef double halves[2][LIGHTS];

typedef struct truth
{
    const implicit_shape* shape;
    double path, radius; // mean free path; 3 V / S
    int points, walks;   // walks: of a half
    vec *x, *n;
    halves* light; // by point
} truth;

typedef struct figures
{
    double rms[LIGHTS], pooled; // area-weighted
    double flux[LIGHTS];        // what the whole surface shows over the truth, minus 1
} figures;

// --- truth ---

static void light_at(const implicit_shape* shape, vec x, vec n, double out[LIGHTS])
{
    for (int i = 0; i < LIGHTS; i++)
    {
        double c = vec_dot(n, lights[i]);
        if (c > 0.0 && (shape->convex || implicit_hit(shape, vec_mad(x, n, 1e-4), lights[i], false, 1e9) < 0.0))
            out[i] += c;
    }
}

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
            implicit_walk(t->shape, t->x[i], t->n[i], t->path, &rng, &exit);
            light_at(t->shape, exit, implicit_normal(t->shape, exit), t->light[i][k & 1]);
        }
        for (int k = 0; k < 2 * LIGHTS; k++)
            (&t->light[i][0][0])[k] /= t->walks;
    }
}

static bool read_truth(const char* path, truth* t)
{
    FILE* file = fopen(path, "rb");
    if (!file)
        return false;
    size_t n = (size_t)t->points;
    vec* x = TY_ALLOC(vec, n);
    bool good = fread(x, sizeof *x, n, file) == n && memcmp(x, t->x, n * sizeof *x) == 0 &&
                fread(t->light, sizeof *t->light, n, file) == n;
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
    fwrite(t->light, sizeof *t->light, (size_t)t->points, file);
    fclose(file);
}

// path: in millimetres, or negative: times 3 V / S.
static truth make_truth(const implicit_shape* shape, double path, const bench_options* options, int quick_walks,
                        ty_workers* workers)
{
    char file[1024] = "";
    truth t = {.shape = shape, .points = options->quick ? 200 : 1000, .walks = options->quick ? quick_walks : 1000};
    t.x = TY_ALLOC(vec, t.points);
    t.n = TY_ALLOC(vec, t.points);
    t.light = TY_ALLOC(halves, t.points);
    implicit_measure m = implicit_points(shape, 5, t.points, t.x);
    t.radius = 3.0 * m.volume / m.area;
    t.path = path < 0.0 ? -path * t.radius : path;
    for (int i = 0; i < t.points; i++)
        t.n[i] = implicit_normal(shape, t.x[i]);
    if (options->folder)
        snprintf(file, sizeof file, "%s/walks_%s_%.4f_%d_%d.bin", options->folder, shape->name, t.path, t.points,
                 t.walks);
    if (options->folder && read_truth(file, &t))
        return t;
    memset(t.light, 0, (size_t)t.points * sizeof *t.light);
    ty_parallel_for(workers, t.points, 4, walk_points, &t);
    if (options->folder)
        write_truth(file, &t);
    return t;
}

static void drop_truth(truth* t)
{
    ty_free(t->x);
    ty_free(t->n);
    ty_free(t->light);
}

// --- models ---

typedef struct model_job
{
    const truth* t;
    const subject* s;
    const ty_material* material; // NULL = Lambert
    int samples;                 // of a half
    halves* light;
} model_job;

static void model_points(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const model_job* job = context;
    for (int64_t i = begin; i < end; i++)
    {
        const truth* t = job->t;
        ty_rng rng = ty_rng_make((ty_seed){42}, (uint64_t)i, 0);
        ty_surface_point p = subject_point(job->s, t->x[i], t->n[i]);
        for (int h = 0; h < 2; h++)
        {
            double turn[4];
            for (int k = 0; k < 4; k++)
                turn[k] = random_double(&rng);
            if (!job->material)
            {
                light_at(t->shape, t->x[i], t->n[i], job->light[i][h]);
                continue;
            }
            for (int k = 0; k < job->samples; k++)
            {
                float u[4];
                roberts_sequence(k, turn, u);
                subject_light(job->s, job->material, &p, u, &rng, lights, LIGHTS, job->light[i][h]);
            }
            for (int k = 0; k < LIGHTS; k++)
                job->light[i][h][k] /= job->samples;
        }
    }
}

static figures judge(const truth* t, const halves* light)
{
    figures f = {0};
    for (int k = 0; k < LIGHTS; k++)
    {
        double sum = 0.0, ours = 0.0, theirs = 0.0;
        for (int i = 0; i < t->points; i++)
        {
            const double(*a)[LIGHTS] = light[i], (*b)[LIGHTS] = t->light[i];
            sum += (a[0][k] - b[0][k]) * (a[1][k] - b[1][k]);
            ours += a[0][k] + a[1][k];
            theirs += b[0][k] + b[1][k];
        }
        f.rms[k] = sqrt(fmax(sum, 0.0) / t->points);
        f.pooled += sum / t->points / LIGHTS;
        f.flux[k] = ours / theirs - 1.0;
    }
    f.pooled = sqrt(fmax(f.pooled, 0.0));
    return f;
}

static figures measure(const truth* t, const subject* s, model m, const bench_options* options, ty_workers* workers)
{
    ty_cdrf_evaluate evaluate = m == DEPTH ? TY_CDRF_DEPTH : m == PROBE ? TY_CDRF_PROBE : TY_CDRF_LOCAL;
    ty_material* material = m == LAMBERT ? NULL
                            : m == WALK  ? subject_walk(t->path)
                                         : subject_cdrf(evaluate, TY_CDRF_POISSON, t->path);
    model_job job = {t, s, material, options->quick ? 100 : 500, TY_ALLOC(halves, t->points)};
    if (m == LOCAL)
        job.samples = t->shape->convex ? 1 : 20; // only its rays are random
    if (m == WALK)
        job.samples = t->walks;
    ty_parallel_for(workers, t->points, 4, model_points, &job);
    figures f = judge(t, job.light);
    ty_free(job.light);
    ty_material_destroy(material);
    return f;
}

static double worst_flux(const figures* f)
{
    double worst = 0.0;
    for (int k = 0; k < LIGHTS; k++)
        worst = fmax(worst, fabs(f->flux[k]));
    return worst;
}

static ty_workers* make_workers(const bench_options* options)
{
    ty_workers* workers;
    ty_error error;
    return ty_workers_create(options->threads, &workers, &error) == TY_OK ? workers : NULL;
}

// --- the tables ---

void bench_ellipsoid(const bench_options* options)
{
    static const char* const names[MODELS] = {"lambert", "local, poisson", "probe", "depth", "walk"};
    static const double paths[2] = {0.25, 0.6};
    static const double expected[2][MODELS][LIGHTS + 1] = {
        {{.138, .030, .100, .100}, {.063, .029, .055, .051}, {.035, .009, .020, .024}, {.013, .005, .006, .009}, {0}},
        {{.243, .052, .174, .175}, {.108, .048, .087, .084}, {.062, .020, .035, .043}, {.014, .006, .008, .010}, {0}}};
    ty_workers* workers = make_workers(options);
    subject s;
    const implicit_shape* shape = &implicit_shapes[3];
    subject_init(&s, shape, options->quick ? 96 : 192);
    report_title(
        "Ellipsoid 2.5 x 1.4 x 1.0 mm, white, lights along short axis / long axis / diagonal: RMS against walks",
        "  l mm  model               measured (pooled)            expected (pooled)            largest error of flux");
    for (int i = 0; i < 2; i++)
    {
        truth t = make_truth(shape, paths[i], options, 600, workers);
        figures f[MODELS];
        for (int m = 0; m < MODELS; m++)
        {
            const double* e = expected[i][m];
            f[m] = measure(&t, &s, (model)m, options, workers);
            printf("  %4.2f  %-16s  %.3f/%.3f/%.3f (%.4f)     %.3f/%.3f/%.3f (%.3f)     %.1f %%\n", paths[i], names[m],
                   f[m].rms[0], f[m].rms[1], f[m].rms[2], f[m].pooled, e[0], e[1], e[2], e[3], 100 * worst_flux(&f[m]));
        }
        char name[80];
        snprintf(name, sizeof name, "l %.2f mm: depth, pooled", paths[i]);
        report_most(name, f[DEPTH].pooled, expected[i][DEPTH][LIGHTS], 0.02);
        snprintf(name, sizeof name, "l %.2f mm: lambert, pooled", paths[i]);
        report_near(name, f[LAMBERT].pooled, expected[i][LAMBERT][LIGHTS], options->quick ? 0.02 : 0.006);
        snprintf(name, sizeof name, "l %.2f mm: walk, pooled", paths[i]);
        report_most(name, f[WALK].pooled, 0, options->quick ? 0.008 : 0.004);
        drop_truth(&t);
    }
    subject_term(&s);
    ty_workers_destroy(workers);
}

#define PATHS 5
static const double path_ratios[PATHS] = {0.05, 0.1, 0.25, 0.5, 1};
// RMS of depth x 1000, by path and shape; means of lambert, probe, depth; mean error of flux.
static const int depth_expected[PATHS][IMPLICIT_COUNT] = {{1, 2, 7, 4, 3, 15, 9, 6, 6},
                                                          {0, 3, 10, 6, 5, 17, 11, 7, 7},
                                                          {3, 5, 12, 9, 7, 20, 8, 7, 9},
                                                          {6, 8, 10, 10, 8, 20, 12, 9, 11},
                                                          {8, 7, 14, 9, 7, 15, 32, 16, 12}};
static const double mean_expected[PATHS][MODELS] = {{.036, 0, .0177, .0059, 0},
                                                    {.069, 0, .0247, .0073, 0},
                                                    {.134, 0, .0416, .0090, 0},
                                                    {.198, 0, .0598, .0104, 0},
                                                    {.262, 0, .0794, .0132, 0}};
static const double flux_expected[PATHS] = {0.017, 0.027, 0.028, 0.019, 0.037};
static const double mean_limit[PATHS] = {0.012, 0, 0.015, 0, 0.02};

typedef struct nine
{
    figures f[PATHS][IMPLICIT_COUNT][MODELS];
    double noise; // of the RMS of a shape
} nine;

static void report_nine(const nine* n, int path)
{
    double mean[MODELS] = {0}, flux = 0.0, worst = 0.0;
    char name[80];
    for (int i = 0; i < IMPLICIT_COUNT; i++)
    {
        for (int m = 0; m < MODELS; m++)
            mean[m] += n->f[path][i][m].pooled / IMPLICIT_COUNT;
        double e = worst_flux(&n->f[path][i][DEPTH]);
        flux += e / IMPLICIT_COUNT;
        worst = fmax(worst, e);
    }
    printf("  %-4g measured ", path_ratios[path]);
    for (int i = 0; i < IMPLICIT_COUNT; i++)
        printf(" %8.1f", 1000 * n->f[path][i][DEPTH].pooled);
    printf("   lambert %.1f  probe %.1f  depth %.1f   flux %.1f %% (%.1f)\n       expected ", 1000 * mean[LAMBERT],
           1000 * mean[PROBE], 1000 * mean[DEPTH], 100 * flux, 100 * worst);
    for (int i = 0; i < IMPLICIT_COUNT; i++)
        printf(" %8d", depth_expected[path][i]);
    const double* e = mean_expected[path];
    printf("   lambert %.1f  probe %.1f  depth %.1f   flux %.1f %%\n", 1000 * e[LAMBERT], 1000 * e[PROBE],
           1000 * e[DEPTH], 100 * flux_expected[path]);
    snprintf(name, sizeof name, "l / R %g: walk, mean of nine shapes", path_ratios[path]);
    report_most(name, mean[WALK], 0, n->noise);
    if (mean_limit[path] == 0.0)
        return;
    snprintf(name, sizeof name, "l / R %g: depth, mean of nine shapes", path_ratios[path]);
    report_most(name, mean[DEPTH], e[DEPTH], mean_limit[path]);
    snprintf(name, sizeof name, "l / R %g: probe over depth", path_ratios[path]);
    report_least(name, mean[PROBE] / mean[DEPTH], e[PROBE] / e[DEPTH], 2.0);
}

static FILE* open_table(const bench_options* options, const char* name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.tsv", options->folder, name);
    return fopen(path, "w");
}

static void write_nine(const nine* n, const bench_options* options)
{
    FILE *each = open_table(options, "nine_shapes"), *means = open_table(options, "nine_means");
    if (each && means)
    {
        fprintf(each, "shape\tl_over_R\tlambert\tprobe\tdepth\tdepth_flux\n");
        fprintf(means, "l_over_R\tlambert\tprobe\tdepth\n");
        for (int p = 0; p < PATHS; p++)
        {
            double mean[MODELS] = {0};
            if (options->quick && mean_limit[p] == 0.0)
                continue;
            for (int i = 0; i < IMPLICIT_COUNT; i++)
            {
                const figures* f = n->f[p][i];
                fprintf(each, "%s\t%g\t%.5f\t%.5f\t%.5f\t%.5f\n", implicit_shapes[i].name, path_ratios[p],
                        f[LAMBERT].pooled, f[PROBE].pooled, f[DEPTH].pooled, worst_flux(&f[DEPTH]));
                for (int m = 0; m < MODELS; m++)
                    mean[m] += f[m].pooled / IMPLICIT_COUNT;
            }
            fprintf(means, "%g\t%.5f\t%.5f\t%.5f\n", path_ratios[p], mean[LAMBERT], mean[PROBE], mean[DEPTH]);
        }
    }
    if (each)
        fclose(each);
    if (means)
        fclose(means);
}

void bench_nine_shapes(const bench_options* options)
{
    static nine n;
    ty_workers* workers = make_workers(options);
    n.noise = options->quick ? 0.008 : 0.004;
    report_title("Nine shapes as triangle meshes, white: RMS x 1000 of depth against walks, pooled over three lights",
                 NULL);
    printf("  l / R         ");
    for (int i = 0; i < IMPLICIT_COUNT; i++)
    {
        subject s;
        const implicit_shape* shape = &implicit_shapes[i];
        printf(" %8s", shape->name);
        fflush(stdout);
        subject_init(&s, shape, options->quick ? 96 : 192);
        for (int p = 0; p < PATHS; p++)
        {
            if (options->quick && mean_limit[p] == 0.0)
                continue;
            truth t = make_truth(shape, -path_ratios[p], options, 100, workers);
            for (int m = 0; m < MODELS; m++)
                if (m != LOCAL)
                    n.f[p][i][m] = measure(&t, &s, (model)m, options, workers);
            drop_truth(&t);
        }
        subject_term(&s);
    }
    printf("   means x 1000\n");
    for (int p = 0; p < PATHS; p++)
        if (!options->quick || mean_limit[p] > 0.0)
            report_nine(&n, p);
    if (options->folder)
        write_nine(&n, options);
    ty_workers_destroy(workers);
}
