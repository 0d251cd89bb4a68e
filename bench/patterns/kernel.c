// SPDX-License-Identifier: Apache-2.0
// Gray–Scott against the straightforward program: bench_patterns_kernel [SECONDS a figure]. Five rates in tiles of 64
// cells and walls of barriers, on fields of 512, 1024 and 2048 squared; billions of cell steps a second. One thread:
// processor time; two: time on the clock, in turn with one; the best of what fits in the seconds, interleaved, since
// the machine is never ours alone. At the end 240 frames of 60 steps at 1920 x 1080, the steps alone.
#include "../cpu_time.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/gray_scott.h>

enum
{
    MARKS = 5,
    OPERATIONS_5 = 17, // a cell: 6 multiplications and 11 additions
    OPERATIONS_9 = 27  // the corners: 6 additions, 2 multiplications and 2 additions more
};

static void die(const char* what)
{
    fprintf(stderr, "bench_patterns_kernel: %s\n", what);
    exit(1);
}

// --- the field of all versions ---

static uint8_t mark_at(int x, int y, int n)
{
    bool ring = false, wall = y % 256 < 2 && x % 128 > 40; // walls with gates
    int dx = x - n / 2, dy = y - n / 2, d = dx * dx + dy * dy, r = n / 5;
    ring = d > r * r && d < (r + 3) * (r + 3) && dx < r / 2; // a round one, open to the right
    return (uint8_t)((x / 64 + y / 64) % MARKS | (wall || ring ? TY_GRAY_SCOTT_BARRIER : 0));
}

static bool seeded(int x, int y)
{
    return (x / 37 + y / 41) % 3 == 0;
}

static ty_gray_scott_def field_def(int width, int height, int stencil)
{
    ty_gray_scott_def def = ty_gray_scott_def_default();
    const ty_gray_scott_rates rates[MARKS] = {
        {0.072f, 0.059f}, {0.052f, 0.079f}, {0.072f, 0.060f}, {0.0265f, 0.0605f}, {0.067f, 0.062f}};
    def.width = width;
    def.height = height;
    def.stencil = stencil;
    memcpy(def.rates, rates, sizeof rates);
    def.rate_count = MARKS;
    return def;
}

static ty_gray_scott* field_make(int width, int height, int stencil)
{
    ty_gray_scott_def def = field_def(width, height, stencil);
    ty_gray_scott* field;
    ty_error error;
    if (ty_gray_scott_create(&def, &field, &error) != TY_OK)
        die(error.text);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
        {
            ty_gray_scott_marks(field, y)[x] = mark_at(x, y, height);
            if (seeded(x, y))
            {
                ty_gray_scott_u(field, y)[x] = 0.4f;
                ty_gray_scott_v(field, y)[x] = 0.33f;
            }
        }
    return field;
}

// --- what one writes first: double precision, a cell after the other ---

typedef struct cell
{
    double u, v;
    int mark;
    bool barrier;
} cell;

typedef struct naive
{
    ty_gray_scott_def def;
    cell *now, *next;
} naive;

static naive naive_make(int n, int stencil)
{
    size_t count = (size_t)n * (size_t)n;
    naive a = {field_def(n, n, stencil), TY_ALLOC(cell, count), TY_ALLOC(cell, count)};
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++)
        {
            uint8_t mark = mark_at(x, y, n);
            a.now[y * n + x] = (cell){seeded(x, y) ? 0.4 : 1.0, seeded(x, y) ? 0.33 : 0.0, mark & 15, mark >= 128};
        }
    return a;
}

static void naive_near(const cell* c, const cell* other, double weight, double* u, double* v)
{
    if (other->barrier)
        return;
    *u += weight * (other->u - c->u);
    *v += weight * (other->v - c->v);
}

static cell naive_cell(const naive* a, int x, int y)
{
    int n = a->def.width, left = (x + n - 1) % n, right = (x + 1) % n, up = (y + n - 1) % n, down = (y + 1) % n;
    const cell* c = &a->now[y * n + x];
    double lap_u = 0.0, lap_v = 0.0, edge = a->def.stencil == 9 ? 4.0 / 6.0 : 1.0;
    if (c->barrier)
        return *c;
    naive_near(c, &a->now[y * n + left], edge, &lap_u, &lap_v);
    naive_near(c, &a->now[y * n + right], edge, &lap_u, &lap_v);
    naive_near(c, &a->now[up * n + x], edge, &lap_u, &lap_v);
    naive_near(c, &a->now[down * n + x], edge, &lap_u, &lap_v);
    if (a->def.stencil == 9)
    {
        naive_near(c, &a->now[up * n + left], 1.0 / 6.0, &lap_u, &lap_v);
        naive_near(c, &a->now[up * n + right], 1.0 / 6.0, &lap_u, &lap_v);
        naive_near(c, &a->now[down * n + left], 1.0 / 6.0, &lap_u, &lap_v);
        naive_near(c, &a->now[down * n + right], 1.0 / 6.0, &lap_u, &lap_v);
    }
    double feed = (double)a->def.rates[c->mark].feed, kill = (double)a->def.rates[c->mark].kill;
    double reaction = c->u * c->v * c->v, dt = (double)a->def.time_step;
    cell out = *c;
    out.u += dt * ((double)a->def.diffusion_u * lap_u - reaction + feed * (1.0 - c->u));
    out.v += dt * ((double)a->def.diffusion_v * lap_v + reaction - (feed + kill) * c->v);
    return out;
}

static void naive_step(naive* a)
{
    int n = a->def.width;
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++)
            a->next[y * n + x] = naive_cell(a, x, y);
    cell* done = a->next;
    a->next = a->now;
    a->now = done;
}

// --- measuring ---

static int double_order(const void* a, const void* b)
{
    double p = *(const double*)a, q = *(const double*)b;
    return (p > q) - (p < q);
}

typedef enum version
{
    NAIVE,
    PLAIN, // the fast row, a step after the other
    PORTABLE,
    AVX2,
    FAST,
    TWO,
    VERSIONS
} version;

typedef struct subject
{
    int n, stencil;
    naive simple;
    ty_gray_scott* field;
    ty_workers* two;
    double best[VERSIONS];       // cell steps a second of processor time
    double clock_one, clock_two; // on the clock
} subject;

static void measure(subject* s, version v)
{
    const ty_gray_scott_tuning tunings[VERSIONS] = {
        [PLAIN] = {.depth = 1}, [PORTABLE] = {.path = TY_GRAY_SCOTT_PORTABLE}, [AVX2] = {.path = TY_GRAY_SCOTT_AVX2}};
    int steps = v == NAIVE ? 1 : 16 * (1 + (1 << 19) / (s->n * s->n)); // some milliseconds
    if (v != NAIVE && !ty_gray_scott_tune(s->field, tunings[v]))
        return;
    double clock = ty_time_now(), begin = cpu_seconds();
    if (v == NAIVE)
        naive_step(&s->simple);
    else
        ty_gray_scott_step(s->field, steps, v == TWO ? s->two : NULL);
    double work = (double)steps * s->n * s->n, rate = work / (cpu_seconds() - begin);
    clock = work / (ty_time_now() - clock);
    s->best[v] = rate > s->best[v] ? rate : s->best[v];
    if (v == FAST)
        s->clock_one = clock > s->clock_one ? clock : s->clock_one;
    if (v == TWO)
        s->clock_two = clock > s->clock_two ? clock : s->clock_two;
}

// Operations a second that this machine does on its widest vectors, in registers: the median, since clocks jump.
static double peak(void)
{
    enum
    {
        ROUNDS = 101,
        TURNS = 200000
    };
    double rates[ROUNDS] = {0};
#if defined(__x86_64__)
    bool wide = __builtin_cpu_supports("avx512f");
    for (int round = 0; round < ROUNDS; round++)
    {
        double begin = cpu_seconds();
        for (int i = 0; i < TURNS; i++)
#define PEAK(r)                                                                                                        \
    "vaddps %%" r "0, %%" r "1, %%" r "1\nvmulps %%" r "0, %%" r "2, %%" r "2\nvaddps %%" r "0, %%" r "3, %%" r "3\n"  \
    "vmulps %%" r "0, %%" r "4, %%" r "4\nvaddps %%" r "0, %%" r "5, %%" r "5\nvaddps %%" r "0, %%" r "6, %%" r "6\n"  \
    "vaddps %%" r "0, %%" r "7, %%" r "7\nvmulps %%" r "0, %%" r "8, %%" r "8\nvaddps %%" r "0, %%" r "9, %%" r "9\n"  \
    "vaddps %%" r "0, %%" r "10, %%" r "10\n"
            if (wide)
                __asm__ volatile(PEAK("zmm")::
                                     : "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9", "xmm10");
            else
                __asm__ volatile(PEAK("ymm")::
                                     : "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9", "xmm10");
        rates[round] = (double)TURNS * 10.0 * (wide ? 16.0 : 8.0) / (cpu_seconds() - begin);
    }
    qsort(rates, ROUNDS, sizeof rates[0], double_order);
#endif
    return rates[ROUNDS / 2];
}

static void compare(int n, int stencil, double seconds, double limit)
{
    subject s = {.n = n, .stencil = stencil, .simple = naive_make(n, stencil), .field = field_make(n, n, stencil)};
    ty_error error;
    if (ty_workers_create(2, &s.two, &error) != TY_OK)
        die(error.text);
    double end = ty_time_now() + seconds * VERSIONS;
    while (ty_time_now() < end)
        for (int v = 0; v < VERSIONS; v++)
            measure(&s, (version)v);
    double g = 1e-9, per_cell = stencil == 9 ? OPERATIONS_9 : OPERATIONS_5;
    printf("%5d %3d  %6.3f %6.2f %8.2f %6.2f %6.2f %6.2f  %6.1f %7.2f %7.2f %6.2f\n", n, stencil, g * s.best[NAIVE],
           g * s.best[PLAIN], g * s.best[PORTABLE], g * s.best[AVX2], g * s.best[FAST], g * s.clock_two,
           s.best[FAST] / s.best[NAIVE], s.clock_two / s.clock_one, 2.0 * s.best[TWO] / s.best[FAST],
           limit > 0.0 ? s.best[FAST] * per_cell / limit : 0.0);
    fflush(stdout);
    ty_free(s.simple.now);
    ty_free(s.simple.next);
    ty_gray_scott_destroy(s.field);
    ty_workers_destroy(s.two);
}

static void film(void)
{
    ty_workers* all;
    ty_error error;
    if (ty_workers_create(0, &all, &error) != TY_OK)
        die(error.text);
    ty_gray_scott* field = field_make(1920, 1080, 5);
    double begin = ty_time_now(), work = cpu_seconds();
    for (int frame = 0; frame < 240; frame++)
        ty_gray_scott_step(field, 60, all);
    double clock = ty_time_now() - begin;
    work = cpu_seconds() - work;
    printf("1920 x 1080, 240 frames of 60 steps, %d threads: %.1f s on the clock, %.1f s of processors, %.2f Gcell/s\n",
           ty_workers_count(all), clock, work, 240.0 * 60.0 * 1920.0 * 1080.0 * 1e-9 / clock);
    ty_gray_scott_destroy(field);
    ty_workers_destroy(all);
}

int main(int argc, char** argv)
{
    double seconds = argc > 1 ? atof(argv[1]) : 1.0, limit = peak();
    printf("%.0f G operations/s in registers: %.2f Gcell/s for %d a cell (5 points), %.2f for %d (9 points)\n",
           limit * 1e-9, limit * 1e-9 / OPERATIONS_5, OPERATIONS_5, limit * 1e-9 / OPERATIONS_9, OPERATIONS_9);
    printf("cells pts   naive  plain portable   avx2   fast    two  fast/  two/one by their  of the\n"
           "                                                        naive on clock     work   limit\n");
    for (int stencil = 5; stencil <= 9; stencil += 4)
        for (int n = 512; n <= 2048; n *= 2)
            compare(n, stencil, seconds, limit);
    film();
    return 0;
}
