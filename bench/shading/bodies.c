// SPDX-License-Identifier: Apache-2.0
// More bodies against walks: shapes that no choice was made by, channels of different matter, matter that absorbs, and
// instances that are stretched.
#include "truth.h"
#include <math.h>
#include <stdio.h>

static ty_workers* make_workers(const bench_options* options)
{
    ty_workers* workers;
    ty_error error;
    return ty_workers_create(options->threads, &workers, &error) == TY_OK ? workers : NULL;
}

static int divisions_of(const bench_options* options)
{
    return options->quick ? 96 : 192;
}

// --- shapes that no choice was made by ---

#define PATHS 3
static const double path_ratios[PATHS] = {0.05, 0.25, 1};

void bench_held_out(const bench_options* options)
{
    ty_workers* workers = make_workers(options);
    double mean[2] = {0};
    report_title("Three more shapes, white, which no choice of the model was made by: RMS against walks",
                 "  shape            l / R   lambert    probe    depth     largest error of flux");
    for (int i = 0; i < IMPLICIT_HELD; i++)
    {
        const implicit_shape* shape = &implicit_shapes[IMPLICIT_COUNT + i];
        subject s;
        subject_init(&s, shape, divisions_of(options));
        for (int p = 0; p < PATHS; p++)
        {
            truth t = truth_make(shape, -path_ratios[p], options, 100, workers);
            figures f[MODELS];
            for (int m = 0; m < MODELS; m++)
                if (m == LAMBERT || m == PROBE || m == DEPTH)
                    f[m] = measure(&t, &s, (model)m, options, workers);
            printf("  %-16s %5g  %8.4f %8.4f %8.4f     %.1f %%\n", shape->name, path_ratios[p], f[LAMBERT].pooled,
                   f[PROBE].pooled, f[DEPTH].pooled, 100 * worst_flux(&f[DEPTH]));
            mean[0] += f[PROBE].pooled / (IMPLICIT_HELD * PATHS);
            mean[1] += f[DEPTH].pooled / (IMPLICIT_HELD * PATHS);
            truth_drop(&t);
        }
        subject_term(&s);
    }
    report_most("depth, mean of nine", mean[1], 0.009, options->quick ? 0.013 : 0.012);
    report_near("probe, mean of nine", mean[0], 0.077, 0.02);
    ty_workers_destroy(workers);
}

// --- channels ---

// Red light goes far and blue is absorbed, as in skin.
static const double channel_ratios[3] = {1, 0.25, 0.05};
static const int channel_albedos[3] = {1, 2, 3};
// What depth was measured at where the three channels were three bodies.
static const double channel_limits[3] = {0.012, 0.022, 0.022};

static void report_channels(const implicit_shape* shape, const bench_options* options, double limit,
                            ty_workers* workers)
{
    static const char* const names[3] = {"red", "green", "blue"};
    subject s;
    truth t[3];
    double path[3], color[3];
    char name[80];
    subject_init(&s, shape, divisions_of(options));
    for (int i = 0; i < 3; i++)
    {
        t[i] = truth_make(shape, -channel_ratios[i], options, 100, workers);
        path[i] = t[i].path;
        color[i] = subject_color_of(truth_albedos[channel_albedos[i]]);
    }
    ty_material* together = subject_depth_colored(path, color);
    for (int i = 0; i < 3; i++)
    {
        ty_material* alone =
            subject_depth_colored((double[3]){path[i], path[i], path[i]}, (double[3]){color[i], color[i], color[i]});
        // Three channels share the samples.
        shown a = show(&t[i], &s, together, i, options->quick ? 300 : 1500, options, workers);
        shown b = show(&t[i], &s, alone, i, 0, options, workers);
        figures f = judge(&a, channel_albedos[i]), g = judge(&b, channel_albedos[i]);
        printf("  %-9s %-6s l / R %4g  albedo %5.3f   %.4f   alone %.4f     keeps %.4f, colour %.4f, walk %.4f\n",
               shape->name, names[i], channel_ratios[i], truth_albedos[channel_albedos[i]], f.pooled, g.pooled, a.kept,
               color[i], t[i].kept[channel_albedos[i]]);
        snprintf(name, sizeof name, "%s, %s: pooled", shape->name, names[i]);
        report_most(name, f.pooled, g.pooled, limit + (options->quick ? 0.006 : 0));
        snprintf(name, sizeof name, "%s, %s: against the channel alone", shape->name, names[i]);
        report_most(name, shown_difference(&a, &b), 0, options->quick ? 0.009 : 0.003);
        snprintf(name, sizeof name, "%s, %s: light kept over colour", shape->name, names[i]);
        report_near(name, a.kept / color[i], 1, options->quick ? 0.01 : 0.004);
        shown_drop(&a);
        shown_drop(&b);
        ty_material_destroy(alone);
    }
    ty_material_destroy(together);
    for (int i = 0; i < 3; i++)
        truth_drop(&t[i]);
    subject_term(&s);
}

void bench_channels(const bench_options* options)
{
    static const int shapes[3] = {0, 3, 8}; // sphere, triaxial, torus
    ty_workers* workers = make_workers(options);
    report_title(
        "Channels of different matter in one body, depth: RMS of each against its own walks, body albedo apart", NULL);
    for (int i = options->quick ? 2 : 0; i < 3; i++) // the torus has all that can go wrong
        report_channels(&implicit_shapes[shapes[i]], options, channel_limits[i], workers);
    ty_workers_destroy(workers);
}

// --- absorption ---

// Diffusion's albedo of a whole sphere of radius 1: (1 - h) / (1 + h), h = 2/3 (l / L) (coth z - 1/z), z = 1 / L.
static double diffusion_albedo(double path, double albedo)
{
    double length = path / sqrt(3 * (1 - albedo)), z = 1 / length, h = 2.0 / 3 * path / length * (1 / tanh(z) - 1 / z);
    return (1 - h) / (1 + h);
}

void bench_absorption(const bench_options* options)
{
    static const double radii[3] = {12, 4, 1};
    static const double expected[3][ALBEDOS] = {{1, .932, .805, .534}, {1, .974, .905, .659}, {1, .993, .974, .878}};
    ty_workers* workers = make_workers(options);
    subject s;
    subject_init(&s, &implicit_shapes[0], divisions_of(options));
    report_title(
        "Spheres that absorb within: light kept, and RMS over the body's own",
        "   R/l  albedo    walk   material  diffusion  colour of a thick piece   RMS of depth with that colour, "
        "with the sphere's");
    for (int r = 0; r < 3; r++)
    {
        if (options->quick && radii[r] != 4)
            continue;
        truth t = truth_make(&implicit_shapes[0], 1 / radii[r], options, 300, workers);
        for (int a = 1; a < ALBEDOS; a++)
        {
            char name[80];
            double thick = subject_color_of(truth_albedos[a]), own = t.kept[a];
            const double colors[2] = {thick, own};
            figures f[2];
            ty_material* walk = subject_walk(t.path, truth_albedos[a]);
            shown w = show(&t, &s, walk, 1, options->quick ? 300 : 1000, options, workers);
            figures g = judge(&w, a);
            for (int k = 0; k < 2; k++)
            {
                ty_material* m = subject_depth_colored((double[3]){t.path, t.path, t.path},
                                                       (double[3]){colors[k], colors[k], colors[k]});
                shown x = show(&t, &s, m, 1, 0, options, workers);
                f[k] = judge(&x, a);
                shown_drop(&x);
                ty_material_destroy(m);
            }
            double diffusion = diffusion_albedo(t.path, truth_albedos[a]);
            printf("  %4g  %6.3f  %7.4f  %7.4f   %7.4f   %7.4f                   %.4f  %.4f\n", radii[r],
                   truth_albedos[a], own, w.kept, diffusion, thick, f[0].pooled, f[1].pooled);
            snprintf(name, sizeof name, "R/l %g, albedo %g: material walk, kept", radii[r], truth_albedos[a]);
            report_near(name, w.kept, expected[r][a], options->quick ? 0.008 : 0.005);
            snprintf(name, sizeof name, "R/l %g, albedo %g: material walk, RMS", radii[r], truth_albedos[a]);
            report_most(name, g.pooled, 0, options->quick ? 0.01 : 0.005);
            snprintf(name, sizeof name, "R/l %g, albedo %g: diffusion, kept", radii[r], truth_albedos[a]);
            report_near(name, diffusion, expected[r][a], 0.03);
            snprintf(name, sizeof name, "R/l %g, albedo %g: depth, RMS", radii[r], truth_albedos[a]);
            report_most(name, f[0].pooled, 0.0035, options->quick ? 0.014 : 0.011);
            snprintf(name, sizeof name, "R/l %g, albedo %g: its colour the sphere's, RMS", radii[r], truth_albedos[a]);
            report_most(name, f[1].pooled, 0.016, 0.02);
            shown_drop(&w);
            ty_material_destroy(walk);
        }
        truth_drop(&t);
    }
    subject_term(&s);
    ty_workers_destroy(workers);
}

// --- stretched instances ---

void bench_stretched(const bench_options* options)
{
    static const double paths[2] = {0.25, 0.6}, expected[2] = {0.009, 0.010};
    const ty_affine map = {{2.5f, 0, 0}, {0, 1.4f, 0}, {0, 0, 1}, {0, 0, 0}};
    const implicit_shape *ellipsoid = &implicit_shapes[3], *sphere = &implicit_shapes[0];
    ty_workers* workers = make_workers(options);
    subject mesh, ball;
    subject_init(&mesh, ellipsoid, divisions_of(options));
    subject_init_mapped(&ball, sphere, divisions_of(options), &map);
    report_title("A sphere's instance stretched to 2.5 x 1.4 x 1.0 mm beside the mesh of that ellipsoid, white",
                 "  l mm  model      mesh     instance (RMS against walks)");
    for (int i = options->quick ? 1 : 0; i < 2; i++)
    {
        truth t = truth_make(ellipsoid, paths[i], options, 300, workers);
        for (int m = LOCAL; m <= WALK; m++)
        {
            static const char* const names[MODELS] = {"", "local", "probe", "depth", "walk"};
            char name[80];
            shown a = show_model(&t, &mesh, (model)m, options, workers);
            shown b = show_model(&t, &ball, (model)m, options, workers);
            figures f = judge(&a, 0), g = judge(&b, 0);
            printf("  %4.2f  %-8s  %.4f    %.4f\n", paths[i], names[m], f.pooled, g.pooled);
            snprintf(name, sizeof name, "l %.2f mm: %s, instance against mesh", paths[i], names[m]);
            report_most(name, shown_difference(&a, &b), 0, options->quick ? 0.013 : m == DEPTH ? 0.011 : 0.007);
            if (m == DEPTH)
            {
                snprintf(name, sizeof name, "l %.2f mm: depth, instance against walks", paths[i]);
                report_most(name, g.pooled, expected[i], 0.02);
            }
            shown_drop(&a);
            shown_drop(&b);
        }
        truth_drop(&t);
    }
    subject_term(&mesh);
    subject_term(&ball);
    ty_workers_destroy(workers);
}
