// SPDX-License-Identifier: Apache-2.0
// Materials on triangle meshes of an ellipsoid and of nine shapes against walks in them: irradiance under lamps,
// pooled, and under a half sky.
#include "truth.h"
#include <math.h>
#include <stdio.h>

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
    static const double expected[2][MODELS][LAMPS + 1] = {
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
        truth t = truth_make(shape, paths[i], options, 600, workers);
        figures f[MODELS];
        for (int m = 0; m < MODELS; m++)
        {
            const double* e = expected[i][m];
            f[m] = measure(&t, &s, (model)m, options, workers);
            printf("  %4.2f  %-16s  %.3f/%.3f/%.3f (%.4f)     %.3f/%.3f/%.3f (%.3f)     %.1f %%\n", paths[i], names[m],
                   f[m].rms[0], f[m].rms[1], f[m].rms[2], f[m].pooled, e[0], e[1], e[2], e[LAMPS],
                   100 * worst_flux(&f[m]));
        }
        char name[80];
        snprintf(name, sizeof name, "l %.2f mm: depth, pooled", paths[i]);
        report_most(name, f[DEPTH].pooled, expected[i][DEPTH][LAMPS], 0.02);
        snprintf(name, sizeof name, "l %.2f mm: lambert, pooled", paths[i]);
        report_near(name, f[LAMBERT].pooled, expected[i][LAMBERT][LAMPS], options->quick ? 0.02 : 0.006);
        for (int m = LOCAL; m <= PROBE; m++)
        {
            snprintf(name, sizeof name, "l %.2f mm: %s, pooled", paths[i], names[m]);
            report_near(name, f[m].pooled, expected[i][m][LAMPS], options->quick ? 0.012 : 0.006);
        }
        snprintf(name, sizeof name, "l %.2f mm: walk, pooled", paths[i]);
        report_most(name, f[WALK].pooled, 0, options->quick ? 0.008 : 0.004);
        truth_drop(&t);
    }
    subject_term(&s);
    ty_workers_destroy(workers);
}

#define PATHS 5
static const double path_ratios[PATHS] = {0.05, 0.1, 0.25, 0.5, 1};
// RMS of depth x 1000, by path and shape; means of lambert, probe, depth; mean error of flux.
static const int depth_expected[PATHS][IMPLICIT_COUNT] = {{1, 2, 7, 4, 3, 16, 8, 6, 7},
                                                          {1, 3, 10, 7, 4, 18, 11, 7, 8},
                                                          {3, 6, 11, 10, 7, 21, 6, 7, 9},
                                                          {5, 4, 0, 4, 4, 16, 1, 5, 4},
                                                          {0, 3, 3, 0, 1, 0, 3, 1, 0}};
static const double mean_expected[PATHS][MODELS] = {{.036, 0, .0177, .0060, 0},
                                                    {.069, 0, .0247, .0077, 0},
                                                    {.134, 0, .0416, .0088, 0},
                                                    {.198, 0, .0598, .0049, 0},
                                                    {.262, 0, .0794, .0012, 0}};
static const double flux_expected[PATHS] = {0.022, 0.029, 0.027, 0.010, 0.003};
static const double mean_limit[PATHS] = {0.012, 0.012, 0.015, 0.015, 0.02};
static const bool in_quick[PATHS] = {true, false, true, false, true};

// Half sky: means of probe and depth; and of depth, pooled, where .9 of the light goes on after a scattering.
static const double sky_expected[PATHS][2] = {{.020, .005}, {0, 0}, {.055, .007}, {0, 0}, {.103, .012}};
static const double absorbing_expected[PATHS] = {.012, 0, .021, 0, .013};

typedef struct nine
{
    figures f[PATHS][IMPLICIT_COUNT][MODELS];
    figures absorbing[PATHS][IMPLICIT_COUNT]; // depth
    double noise;                             // of the RMS of a shape
} nine;

static double farthest_above(const nine* n, int path)
{
    double most = -1.0;
    for (int i = 0; i < IMPLICIT_COUNT; i++)
        most = fmax(most, n->f[path][i][DEPTH].pooled - 1e-3 * depth_expected[path][i]);
    return most;
}

static void report_sky(const nine* n, int path)
{
    double mean[2] = {0}, absorbing = 0.0;
    char name[80];
    for (int i = 0; i < IMPLICIT_COUNT; i++)
    {
        mean[0] += n->f[path][i][PROBE].rms[HALF_SKY] / IMPLICIT_COUNT;
        mean[1] += n->f[path][i][DEPTH].rms[HALF_SKY] / IMPLICIT_COUNT;
        absorbing += n->absorbing[path][i].pooled / IMPLICIT_COUNT;
    }
    snprintf(name, sizeof name, "l / R %g: half sky, depth", path_ratios[path]);
    report_most(name, mean[1], sky_expected[path][1], sky_expected[path][1] + 0.75 * n->noise);
    snprintf(name, sizeof name, "l / R %g: half sky, probe over depth", path_ratios[path]);
    report_least(name, mean[0] / mean[1], sky_expected[path][0] / sky_expected[path][1], 3);
    snprintf(name, sizeof name, "l / R %g: albedo .9, depth", path_ratios[path]);
    report_most(name, absorbing, absorbing_expected[path], absorbing_expected[path] + 0.75 * n->noise);
}

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
    snprintf(name, sizeof name, "l / R %g: lambert, mean of nine shapes", path_ratios[path]);
    report_near(name, mean[LAMBERT], e[LAMBERT], 0.006);
    snprintf(name, sizeof name, "l / R %g: depth, farthest above a shape's own", path_ratios[path]);
    report_most(name, farthest_above(n, path), 0, n->noise + 0.0005); // the table's are rounded
    snprintf(name, sizeof name, "l / R %g: depth, error of flux, mean", path_ratios[path]);
    report_most(name, flux, flux_expected[path], flux_expected[path] + n->noise + 0.002);
    snprintf(name, sizeof name, "l / R %g: depth, mean of nine shapes", path_ratios[path]);
    report_most(name, mean[DEPTH], e[DEPTH], mean_limit[path]);
    snprintf(name, sizeof name, "l / R %g: probe over depth", path_ratios[path]);
    report_least(name, mean[PROBE] / mean[DEPTH], e[PROBE] / e[DEPTH], 2.0);
    if (sky_expected[path][0] > 0.0)
        report_sky(n, path);
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
            if (options->quick && !in_quick[p])
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

static figures measure_absorbing(const truth* t, const subject* s, const bench_options* options, ty_workers* workers)
{
    double color = subject_color_of(truth_albedos[ALBEDOS - 1]);
    ty_material* material =
        subject_depth_colored((double[3]){t->path, t->path, t->path}, (double[3]){color, color, color});
    shown x = show(t, s, material, 1, 0, options, workers);
    figures f = judge(&x, ALBEDOS - 1);
    shown_drop(&x);
    ty_material_destroy(material);
    return f;
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
            if (options->quick && !in_quick[p])
                continue;
            truth t = truth_make(shape, -path_ratios[p], options, 100, workers);
            for (int m = 0; m < MODELS; m++)
                if (m != LOCAL)
                    n.f[p][i][m] = measure(&t, &s, (model)m, options, workers);
            n.absorbing[p][i] = measure_absorbing(&t, &s, options, workers);
            truth_drop(&t);
        }
        subject_term(&s);
    }
    printf("   means x 1000\n");
    for (int p = 0; p < PATHS; p++)
        if (!options->quick || in_quick[p])
            report_nine(&n, p);
    if (options->folder)
        write_nine(&n, options);
    ty_workers_destroy(workers);
}
