// SPDX-License-Identifier: Apache-2.0
// Whole pictures: cdrf beside walk at matched parameters (bias, noise, seconds), and what cdrf costs beside Lambert.
#include "picture.h"
#include "report.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define MAX_ROUNDS 9

// What one way of shading gives: pictures of several seeds.
typedef struct series
{
    ty_exr* pictures[MAX_ROUNDS];
    double seconds[MAX_ROUNDS];
    int count, samples;
} series;

typedef struct noise
{
    double mse, relmse; // of one picture, from the differences between seeds: bias is not in it
    double mean;        // of green
} noise;

static double median_seconds(const series* s)
{
    double v[MAX_ROUNDS];
    memcpy(v, s->seconds, sizeof v);
    for (int i = 1; i < s->count; i++)
        for (int k = i; k > 0 && v[k] < v[k - 1]; k--)
        {
            double t = v[k];
            v[k] = v[k - 1];
            v[k - 1] = t;
        }
    return v[s->count / 2];
}

static void add_picture(series* s, picture_def def, uint64_t seed)
{
    def.seed = seed;
    s->samples = def.samples;
    s->pictures[s->count] = picture_render(&def, &s->seconds[s->count]);
    s->count++;
}

static void drop_series(series* s)
{
    for (int i = 0; i < s->count; i++)
        ty_exr_destroy(s->pictures[i]);
}

// last_instance > 0: the pixels of instances 1 to that; 0: all.
static bool counts(const ty_exr* exr, int i, uint32_t last_instance)
{
    if (last_instance == 0)
        return true;
    const ty_exr_channel* c = ty_exr_find_channel(exr, "instance");
    uint32_t id = ((const uint32_t*)c->pixels)[i];
    return id >= 1 && id <= last_instance;
}

static double average(const series* s, int pixel)
{
    double sum = 0.0;
    for (int k = 0; k < s->count; k++)
        sum += (double)picture_channel(s->pictures[k], "G")[pixel];
    return sum / s->count;
}

static noise measure_noise(const series* s, uint32_t last_instance)
{
    noise n = {0};
    int count = 0, size = ty_exr_width(s->pictures[0]) * ty_exr_height(s->pictures[0]);
    for (int i = 0; i < size; i++)
    {
        if (!counts(s->pictures[0], i, last_instance))
            continue;
        double mean = average(s, i), variance = 0.0;
        for (int k = 0; k < s->count; k++)
        {
            double d = (double)picture_channel(s->pictures[k], "G")[i] - mean;
            variance += d * d / (s->count - 1);
        }
        n.mean += mean;
        n.mse += variance;
        n.relmse += variance / (mean * mean + 0.01);
        count++;
    }
    return (noise){n.mse / count, n.relmse / count, n.mean / count};
}

typedef struct bias
{
    double mean; // of the picture, relative
    double rms;  // of the pixels over the mean, free of noise
} bias;

// Of a against b: halves of their seeds differ in noise alone.
static bias measure_bias(const series* a, const series* b)
{
    int size = ty_exr_width(a->pictures[0]) * ty_exr_height(a->pictures[0]), half = a->count / 2;
    double sum = 0.0, mean_a = 0.0, mean_b = 0.0;
    for (int i = 0; i < size; i++)
    {
        double d[2] = {0};
        for (int k = 0; k < 2 * half; k++)
        {
            double x = (double)picture_channel(a->pictures[k], "G")[i];
            double y = (double)picture_channel(b->pictures[k], "G")[i];
            d[k / half] += (x - y) / half;
            mean_a += x;
            mean_b += y;
        }
        sum += d[0] * d[1];
    }
    mean_b /= (double)size * 2 * half;
    return (bias){mean_a / (double)size / (2 * half) / mean_b - 1.0, sqrt(fmax(sum / size, 0)) / mean_b};
}

static const char* const grain_text =
    "tsuya: 1\nfilm: { size: [96, 64] }\n"
    "camera: { position: [0, 0.03, 0.05], look_at: [0, 0.0012, 0], vfov: 6.5 }\nrender: { max_depth: 12 }\n"
    "assets:\n  grain: { shape: ellipsoid, size: [0.003, 0.00125, 0.0015], divisions: 128 }\n"
    "  table: { shape: plane, size: [1, 0, 1] }\n"
    "materials:\n  rice: { model: cdrf, color: 0.8, specular_weight: 0 }\n"
    "  table: { model: surface, base_color: 0.2, specular_weight: 0 }\n"
    "objects:\n  - { mesh: grain, material: rice, translate: [0, 0.00125, 0], rotate: [0, 20, 0] }\n"
    "  - { mesh: table, material: table }\n"
    "lights:\n  - { type: environment, radiance: 0.1 }\n"
    "  - { type: rectangle, center: [-0.3, 0.2, -0.15], target: [0, 0, 0], size: [0.1, 0.1], radiance: 20 }\n";

typedef struct subject_picture
{
    const char* name;
    picture_def def;
} subject_picture;

static void compare_walk(const subject_picture* subject, double mm, const bench_options* options)
{
    char path_set[80], name[100];
    series s[2] = {0};
    int rounds = options->quick ? 4 : 8;
    snprintf(path_set, sizeof path_set, "materials.rice.mean_free_path=%g", mm);
    const char* sets[2][2] = {{path_set, "materials.rice.model=cdrf"}, {path_set, "materials.rice.model=walk"}};
    for (int r = 0; r < rounds; r++)
        for (int m = 0; m < 2; m++) // in turn
        {
            picture_def def = subject->def;
            def.sets = sets[m];
            def.set_count = 2;
            add_picture(&s[m], def, (uint64_t)(1 + r + 100 * m));
        }
    noise depth = measure_noise(&s[0], 0), walk = measure_noise(&s[1], 0);
    bias b = measure_bias(&s[0], &s[1]);
    double seconds[2] = {median_seconds(&s[0]), median_seconds(&s[1])};
    double ratio = walk.relmse * seconds[1] / (depth.relmse * seconds[0]);
    printf("  %-6s %4.2f   %+7.2f %%  %7.4f    %8.5f %8.5f     %6.2f %6.2f      %5.2f\n", subject->name, mm,
           100 * b.mean, b.rms, depth.relmse, walk.relmse, seconds[0], seconds[1], ratio);
    snprintf(name, sizeof name, "%s, l %.2f mm: mean error of the image, %%", subject->name, mm);
    report_near(name, 100 * b.mean, 0, 1);
    snprintf(name, sizeof name, "%s, l %.2f mm: time of walk to equal relMSE", subject->name, mm);
    report_least(name, ratio, 3, 3);
    drop_series(&s[0]);
    drop_series(&s[1]);
}

void bench_pictures(const bench_options* options)
{
    static const double paths[] = {0.05, 0.2, 0.4, 0.7};
    ty_workers* workers;
    ty_error error;
    if (ty_workers_create(options->threads, &workers, &error) != TY_OK)
        workers = NULL;
    int samples = options->quick ? 8 : 32;
    const subject_picture subjects[] = {
        {"grain", {.path = "grain", .text = grain_text, .samples = 4 * samples, .workers = workers}},
        {"bowl", {.path = "scenes/rice_bowl", .size = {192, 108}, .samples = samples, .workers = workers}},
    };
    report_title(
        "Pictures by cdrf (depth) and by walk: mean and pixels against walk, noise and CPU seconds at equal samples",
        "  scene  l mm  mean error  pixels     relMSE depth, walk    seconds depth, walk   walk's time to equal "
        "relMSE");
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 4; k++)
            compare_walk(&subjects[i], paths[k], options);
    ty_workers_destroy(workers);
}

// --- speed ---

typedef enum way
{
    DIFFUSE,
    LOCAL,
    DEPTH,
    WALK,
    WAYS
} way;

void bench_speed(const bench_options* options)
{
    static const char* const names[WAYS] = {"diffuse", "cdrf, local", "cdrf, depth", "walk"};
    static const char* const materials[WAYS] = {
        "materials.rice={ model: surface, base_color: 0.8, specular_weight: 0 }",
        "materials.rice={ model: cdrf, color: 0.8, mean_free_path: 0.4, specular_weight: 0, evaluate: local }",
        "materials.rice={ model: cdrf, color: 0.8, mean_free_path: 0.4, specular_weight: 0 }",
        "materials.rice={ model: walk, color: 0.8, mean_free_path: 0.4, specular_weight: 0 }"};
    static series s[WAYS];
    ty_workers* workers;
    ty_error error;
    if (ty_workers_create(options->threads, &workers, &error) != TY_OK)
        workers = NULL;
    int rounds = options->quick ? 3 : 7, width = options->quick ? 240 : 480, height = width * 9 / 16;
    for (int r = 0; r < rounds; r++)
        for (int w = 0; w < WAYS; w++)
        {
            picture_def def = {.path = "build/bench/heap",
                               .sets = &materials[w],
                               .set_count = 1,
                               .size = {width, height},
                               .samples = 16,
                               .workers = workers};
            add_picture(&s[w], def, (uint64_t)(1 + r));
        }
    report_title("Speed on the heap of bench/heap, colour .8, l .4 mm, in turn, medians of CPU time", NULL);
    printf("  %-14s %12s %12s %12s %12s\n", "", "Msamples/s", "grain MSE", "K = MSE s", "grain mean");
    double speed[WAYS], k[WAYS];
    for (int w = 0; w < WAYS; w++)
    {
        noise n = measure_noise(&s[w], 2000);
        double seconds = median_seconds(&s[w]);
        speed[w] = (double)width * height * s[w].samples / seconds;
        k[w] = n.mse * seconds;
        printf("  %-14s %12.4f %12.6f %12.6f %12.6f\n", names[w], speed[w] * 1e-6, n.mse, k[w], n.mean);
    }
    report_least("samples/s of depth over diffuse", speed[DEPTH] / speed[DIFFUSE], 0.75, 0.75);
    report_least("samples/s of local over diffuse", speed[LOCAL] / speed[DIFFUSE], 0.9, 0.9);
    report_most("K of depth over diffuse", k[DEPTH] / k[DIFFUSE], 2, 2);
    for (int w = 0; w < WAYS; w++)
        drop_series(&s[w]);
    ty_workers_destroy(workers);
}
