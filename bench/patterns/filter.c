// SPDX-License-Identifier: Apache-2.0
// How fast a Turing filter steps: against the straightforward program in double precision, in one run, in turns.
//   bench_patterns_filter [WIDTH HEIGHT]   1920 x 1080 unless said
#include "cpu_time.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <tsuya/base/log.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/rng.h>
#include <tsuya/generate/turing.h>

enum
{
    ROUNDS = 5,
    PLAIN_STEPS = 4,
    OUR_STEPS = 64,
    FLOPS = 26 // of a cell: of each field 3 around, 6 of the reaction, 4 of the sum
};

// --- as one would write it down ---

typedef struct plain_field
{
    int w, h;
    double *u, *v, *next_u, *next_v, *constant;
} plain_field;

static double clamped(double x, double most)
{
    return x < 0.0 ? 0.0 : x > most ? most : x;
}

static void plain_step(plain_field* f, const ty_turing_def* d, double dt)
{
    int w = f->w, h = f->h;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
        {
            int i = y * w + x, left = x > 0 ? i - 1 : i, right = x < w - 1 ? i + 1 : i;
            int up = y > 0 ? i - w : i, down = y < h - 1 ? i + w : i;
            double u = f->u[i], v = f->v[i];
            double lap_u = f->u[left] + f->u[right] + f->u[up] + f->u[down] - 4.0 * u;
            double lap_v = f->v[left] + f->v[right] + f->v[up] + f->v[down] - 4.0 * v;
            double rate_u = clamped((double)d->u.u * u + (double)d->u.v * v + f->constant[i], (double)d->u.most);
            double rate_v = clamped((double)d->v.u * u + (double)d->v.v * v + (double)d->v.constant, (double)d->v.most);
            f->next_u[i] = u + dt * (rate_u - (double)d->u.decay * u + (double)d->u.diffusion * lap_u);
            f->next_v[i] = v + dt * (rate_v - (double)d->v.decay * v + (double)d->v.diffusion * lap_v);
        }
    double *old_u = f->u, *old_v = f->v;
    f->u = f->next_u;
    f->v = f->next_v;
    f->next_u = old_u;
    f->next_v = old_v;
}

// --- both from the same start ---

static void start(plain_field* f, ty_turing* field)
{
    ty_rng rng = ty_rng_make((ty_seed){1}, 0, 0);
    size_t size = (size_t)f->w * (size_t)f->h;
    f->u = TY_ALLOC(double, size);
    f->v = TY_ALLOC(double, size);
    f->next_u = TY_ALLOC(double, size);
    f->next_v = TY_ALLOC(double, size);
    f->constant = TY_ALLOC(double, size);
    for (int y = 0; y < f->h; y++)
        for (int x = 0; x < f->w; x++)
        {
            size_t i = (size_t)y * (size_t)f->w + (size_t)x;
            float u = ty_rng_float(&rng), v = ty_rng_float(&rng), c = 0.2f * (float)x / (float)f->w;
            f->u[i] = (double)(ty_turing_u(field, y)[x] = u);
            f->v[i] = (double)(ty_turing_v(field, y)[x] = v);
            f->constant[i] = (double)(ty_turing_row(field, TY_TURING_CONSTANT, y)[x] = c);
        }
}

static int by_value(const void* a, const void* b)
{
    double p = *(const double*)a, q = *(const double*)b;
    return (p > q) - (p < q);
}

static double median(double* values)
{
    qsort(values, ROUNDS, sizeof *values, by_value);
    return values[ROUNDS / 2];
}

static double difference(const plain_field* f, ty_turing* field)
{
    double most = 0.0;
    for (int i = 0; i < f->w * f->h; i++)
        most = fmax(most, fabs(f->u[i] - (double)ty_turing_u(field, i / f->w)[i % f->w]));
    return most;
}

static void measure(plain_field* f, ty_turing* field, const ty_turing_def* def)
{
    double cells = (double)f->w * (double)f->h * 1e-9, plain[ROUNDS], ours[ROUNDS], ratio[ROUNDS];
    for (int r = 0; r < ROUNDS; r++)
    {
        double t0 = cpu_seconds();
        for (int i = 0; i < PLAIN_STEPS; i++)
            plain_step(f, def, (double)ty_turing_time_step(field));
        double t1 = cpu_seconds();
        ty_turing_step(field, r == 0 ? PLAIN_STEPS : OUR_STEPS, NULL);
        double t2 = cpu_seconds();
        if (r == 0)
            printf("largest difference of U after %d steps: %.2g\n", PLAIN_STEPS, difference(f, field));
        plain[r] = cells * PLAIN_STEPS / (t1 - t0);
        ours[r] = cells * (r == 0 ? PLAIN_STEPS : OUR_STEPS) / (t2 - t1);
        ratio[r] = ours[r] / plain[r];
    }
    double rate = median(ours);
    printf("double, plain:  %7.3f Gcell/s (CPU time, median of %d)\n", median(plain), ROUNDS);
    printf("float, streamed: %6.3f Gcell/s a core, %.1f Gflop/s; ratio %.1f\n", rate, FLOPS * rate, median(ratio));
}

// A disc of half the cells lives, with a rim of two cells; the rest is held.
static void cut_disc(ty_turing* field, const ty_turing_def* def, bool is_free)
{
    float radius = 0.4f * sqrtf((float)def->width * (float)def->height);
    for (int y = 0; y < def->height; y++)
        for (int x = 0; x < def->width; x++)
        {
            float d = hypotf((float)(x - def->width / 2), (float)(y - def->height / 2));
            float inside = ty_clamp(0.5f * (radius - d), 0.0f, 1.0f);
            float soft = is_free ? 0.0f : 0.06f * (1.0f - inside) / inside;
            ty_turing_row(field, TY_TURING_HOLD, y)[x] = inside > 0.0f ? soft : INFINITY;
            if (is_free)
                ty_turing_row(field, TY_TURING_OPEN, y)[x] = inside;
        }
}

typedef struct kind
{
    const char* name;
    ty_turing_plane planes[2];
    ty_turing_limit limit;
    bool disc;
} kind;

static ty_turing* kind_create(const ty_turing_def* given, const kind* k)
{
    ty_error error;
    ty_turing* field;
    ty_turing_def def = *given;
    def.limit = k->limit;
    ty_status status = ty_turing_create(&def, &field, &error);
    for (int i = 0; i < 2 && status == TY_OK; i++)
        status = ty_turing_need(field, k->planes[i], &error);
    if (status != TY_OK)
    {
        ty_log_error(&error);
        return NULL;
    }
    if (k->disc)
        cut_disc(field, &def, k->planes[1] == TY_TURING_OPEN);
    return field;
}

// What masks and limits cost: the same field with more of them. The cells that are held count like the others.
static void measure_kinds(const ty_turing_def* def)
{
    static const kind kinds[] = {
        {"fixed masks, all lives", {TY_TURING_HOLD, TY_TURING_HOLD}, 0, false},
        {"fixed masks, a disc", {TY_TURING_HOLD, TY_TURING_HOLD}, 0, true},
        {"free masks, all lives", {TY_TURING_HOLD, TY_TURING_OPEN}, 0, false},
        {"free masks, a disc", {TY_TURING_HOLD, TY_TURING_OPEN}, 0, true},
        {"directions", {TY_TURING_ALONG_COS, TY_TURING_ALONG_COS}, 0, false},
        {"limit of both", {TY_TURING_CONSTANT, TY_TURING_CONSTANT}, TY_TURING_LIMIT_BOTH, false},
        {"limit, a free disc", {TY_TURING_HOLD, TY_TURING_OPEN}, TY_TURING_LIMIT_BOTH, true},
    };
    for (int i = 0; i < (int)(sizeof kinds / sizeof *kinds); i++)
    {
        ty_turing* field = kind_create(def, &kinds[i]);
        if (!field)
            return;
        double rate[ROUNDS];
        for (int r = 0; r < ROUNDS; r++)
        {
            double t = cpu_seconds();
            ty_turing_step(field, OUR_STEPS, NULL);
            rate[r] = (double)def->width * (double)def->height * OUR_STEPS / (cpu_seconds() - t) * 1e-9;
        }
        printf("  %-24s %6.3f Gcell/s a core\n", kinds[i].name, median(rate));
        ty_turing_destroy(field);
    }
}

static void measure_full(ty_turing* field, int width, int height, ty_workers* workers)
{
    int steps = (int)(2000.0f / ty_turing_time_step(field) + 0.5f);
    double cpu = cpu_seconds(), wall = ty_time_now();
    for (int done = 0; done < steps; done += OUR_STEPS)
        ty_turing_step(field, steps - done < OUR_STEPS ? steps - done : OUR_STEPS, workers);
    cpu = cpu_seconds() - cpu;
    wall = ty_time_now() - wall;
    printf("to t = 2000 (%d steps of %g) with %d workers: %.2f s, %.2f s of CPU time, %.3f Gcell/s\n", steps,
           (double)ty_turing_time_step(field), ty_workers_count(workers), wall, cpu,
           (double)width * (double)height * steps / wall * 1e-9);
}

int main(int argc, char** argv)
{
    ty_error error;
    ty_turing* field;
    ty_workers* workers;
    ty_turing_def def = ty_turing_def_default();
    def.width = argc > 2 ? atoi(argv[1]) : 1920;
    def.height = argc > 2 ? atoi(argv[2]) : 1080;
    def.u.diffusion = 0.04f; // spots, and what tones are drawn with
    def.v.diffusion = 0.5f;
    if (ty_turing_create(&def, &field, &error) != TY_OK || ty_turing_need(field, TY_TURING_CONSTANT, &error) != TY_OK ||
        ty_workers_create(0, &workers, &error) != TY_OK)
    {
        ty_log_error(&error);
        return 1;
    }
    plain_field f = {.w = def.width, .h = def.height};
    start(&f, field);
    printf("%d x %d cells, constant by cell\n", def.width, def.height);
    measure(&f, field, &def);
    measure_kinds(&def);
    measure_full(field, def.width, def.height, workers);
    ty_workers_destroy(workers);
    ty_turing_destroy(field);
    double* const planes[] = {f.u, f.v, f.next_u, f.next_v, f.constant};
    for (int i = 0; i < 5; i++)
        ty_free(planes[i]);
    return 0;
}
