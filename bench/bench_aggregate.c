// SPDX-License-Identifier: Apache-2.0
// The solver of piles in time and memory: bench_aggregate [COUNT...] [--rest] [--threads N] [--sweeps N] [--steps N].
// Rice in a box as deep as wide, of mu .5, for each count: seconds of the fill, then microseconds a grain and substep
// on one thread and on N (interleaved, medians of five rounds), growth against the first count, the peak of memory, and
// with --rest seconds until at rest and polished, with what is measured then. One count of a million takes minutes.
#include "cpu_time.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/rng.h>
#include <tsuya/generate/pile.h>

enum
{
    VARIANTS = 8,
    ROUNDS = 5,
    COUNTS = 16,
};

typedef struct settings
{
    int counts[COUNTS], count_count;
    int threads, sweeps, steps;
    bool rest;
} settings;

typedef struct subject
{
    ty_container* box;
    ty_pile* pile;
} subject;

static ty_element grains[VARIANTS];
static float mean_volume;

static void die(const char* what)
{
    fprintf(stderr, "bench_aggregate: %s\n", what);
    exit(1);
}

static void grains_make(void)
{
    ty_element_def def = ty_element_def_default();
    ty_error error;
    for (int i = 0; i < VARIANTS; i++)
    {
        if (ty_element_init(&def, (ty_seed){7}, i, &grains[i], &error) != TY_OK)
            die(error.text);
        mean_volume += grains[i].volume / VARIANTS;
    }
}

// Grains near the points of a lattice that fills the box; inflation pushes them off it.
static void grains_place(ty_pile* pile, int count, float edge)
{
    int across = 1;
    while (across * across * across < count)
        across++;
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    float cell = 2.0f * edge / (float)across;
    for (int i = 0; i < count; i++)
    {
        float at[3] = {(float)(i % across), (float)(i / across / across), (float)(i / across % across)};
        for (int axis = 0; axis < 3; axis++)
            at[axis] = (at[axis] + ty_rng_range(&rng, 0.1f, 0.9f)) * cell - edge;
        float u = ty_rng_float(&rng), v = ty_rng_float(&rng), w = ty_rng_float(&rng);
        ty_body body = {.position = {at[0], at[1], at[2]}, .rotation = ty_quat_uniform(u, v, w), .scale = 1.0f};
        body.grain = (uint32_t)(i % VARIANTS);
        ty_pile_add(pile, &body, 1);
    }
}

static subject subject_make(int count, int sweeps, ty_workers* workers)
{
    subject s;
    float edge = 0.5f * ty_pow((float)count * mean_volume / 0.60f, 1.0f / 3.0f);
    ty_container_def box = ty_container_def_default();
    box.kind = TY_CONTAINER_BOX;
    box.shape.size = ty_vec3_make(edge, edge, edge);
    box.shape.rounding = 0.0f;
    ty_error error;
    if (ty_container_create(&box, workers, &s.box, &error) != TY_OK)
        die(error.text);
    ty_pile_def def = ty_pile_def_default();
    def.grains = grains;
    def.grain_count = VARIANTS;
    def.container = s.box;
    s.pile = ty_pile_create(&def);
    grains_place(s.pile, count, edge);
    ty_fill_top top = {.level = edge, .radius_x = edge, .radius_z = edge};
    ty_pile_inflate(s.pile, &top, sweeps, workers);
    return s;
}

typedef struct spent
{
    double wall, cpu; // s a grain and substep
} spent;

static spent steps_time(ty_pile* pile, int steps, ty_workers* workers)
{
    double start = ty_time_now(), cpu = cpu_seconds(), each = 1.0 / steps / ty_pile_count(pile);
    for (int i = 0; i < steps; i++)
        ty_pile_step(pile, workers);
    return (spent){each * (ty_time_now() - start), each * (cpu_seconds() - cpu)};
}

static int ascending(const void* a, const void* b)
{
    double p = *(const double*)a, q = *(const double*)b;
    return (p > q) - (p < q);
}

static void rest_print(ty_pile* pile, ty_workers* workers)
{
    ty_pile_metrics m, polished;
    double start = ty_time_now();
    ty_pile_end end = ty_pile_settle(pile, 5.0f, workers, NULL);
    double settled = ty_time_now();
    ty_pile_measure(pile, &m, NULL);
    double measured = ty_time_now();
    ty_pile_polish(pile, 200, workers);
    double done = ty_time_now();
    ty_pile_measure(pile, &polished, NULL);
    printf("         %s after %d substeps, %.1f s; measured in %.2f s; polished in %.2f s: v_rms %.4f mm/s, overlap "
           "%.2f / %.3f %%, polished %.3f / %.4f %%, phi %.3f, contacts %.2f, floating %d\n",
           end == TY_PILE_REST ? "at rest" : "not at rest", m.substeps, settled - start, measured - settled,
           done - measured, (double)m.speed_rms * 1e3, (double)m.overlap_max * 1e2, (double)m.overlap_mean * 1e2,
           (double)polished.overlap_max * 1e2, (double)polished.overlap_mean * 1e2, (double)m.phi, (double)m.contacts,
           polished.floating);
}

static double count_measure(const settings* set, int count, double first, ty_workers* workers)
{
    double start = ty_time_now();
    subject s = subject_make(count, set->sweeps, workers);
    double filled = ty_time_now() - start, one[ROUNDS], gain[ROUNDS];
    for (int r = 0; r < ROUNDS; r++)
    {
        spent alone = steps_time(s.pile, set->steps, NULL), shared = steps_time(s.pile, set->steps, workers);
        one[r] = alone.cpu;
        gain[r] = alone.wall / shared.wall;
    }
    qsort(one, ROUNDS, sizeof *one, ascending);
    qsort(gain, ROUNDS, sizeof *gain, ascending);
    double cost = one[ROUNDS / 2];
    printf("%8d  %8.2f  %8.3f  %6.2f  %6.2f  %8.0f\n", count, filled, cost * 1e6, first > 0.0 ? cost / first : 1.0,
           gain[ROUNDS / 2], 1e-6 * (double)ty_memory_peak());
    if (set->rest)
        rest_print(s.pile, workers);
    fflush(stdout);
    ty_pile_destroy(s.pile);
    ty_container_destroy(s.box);
    return cost;
}

static settings settings_read(int argc, char** argv)
{
    settings s = {.threads = 2, .sweeps = 80, .steps = 40};
    for (int i = 1; i < argc; i++)
    {
        int* value = strcmp(argv[i], "--threads") == 0  ? &s.threads
                     : strcmp(argv[i], "--sweeps") == 0 ? &s.sweeps
                     : strcmp(argv[i], "--steps") == 0  ? &s.steps
                                                        : NULL;
        if (strcmp(argv[i], "--rest") == 0)
            s.rest = true;
        else if (value && i + 1 < argc)
            *value = atoi(argv[++i]);
        else if (atoi(argv[i]) > 0 && s.count_count < COUNTS)
            s.counts[s.count_count++] = atoi(argv[i]);
        else
            die("usage: bench_aggregate [COUNT...] [--rest] [--threads N] [--sweeps N] [--steps N]");
    }
    if (s.threads < 1 || s.sweeps < 1 || s.steps < 1)
        die("threads, sweeps and steps are at least 1");
    const int usual[] = {1000, 5000, 10000, 100000};
    for (int i = 0; s.count_count == 0 && i < 4; i++)
        s.counts[i] = usual[i];
    s.count_count = s.count_count > 0 ? s.count_count : 4;
    return s;
}

int main(int argc, char** argv)
{
    settings s = settings_read(argc, argv);
    ty_workers* workers;
    ty_error error;
    if (ty_workers_create(s.threads, &workers, &error) != TY_OK)
        die(error.text);
    grains_make();
    printf("%8s  %8s  %8s  %6s  gain%2d  %8s\n", "grains", "fill s", "cpu us", "growth", s.threads, "peak MB");
    double first = 0.0;
    for (int i = 0; i < s.count_count; i++)
    {
        double cost = count_measure(&s, s.counts[i], first, workers);
        first = first > 0.0 ? first : cost;
    }
    for (int i = 0; i < VARIANTS; i++)
        ty_element_term(&grains[i]);
    ty_workers_destroy(workers);
    return 0;
}
