// SPDX-License-Identifier: Apache-2.0
// Gray–Scott: the same bits as a plain loop, whatever the kernel, the depth, the cut of the field and the threads.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/gray_scott.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

// --- a plain loop over cells ---

typedef struct plain
{
    ty_gray_scott_def def;
    float *u, *v, *next_u, *next_v;
    const uint8_t* marks;
    const float *feed, *kill; // NULL without
} plain;

static int around(int i, int n, bool wrap)
{
    return wrap ? (i + n) % n : i < 0 ? 0 : i >= n ? n - 1 : i;
}

static float grid(double a)
{
    return (float)(floor(a * 0x1p24 + 0.5) * 0x1p-24);
}

static size_t place(const plain* p, int x, int y)
{
    x = around(x, p->def.width, p->def.wrap_x);
    y = around(y, p->def.height, p->def.wrap_y);
    return (size_t)y * (size_t)p->def.width + (size_t)x;
}

static bool barrier(const plain* p, int x, int y)
{
    return p->marks[place(p, x, y)] >= TY_GRAY_SCOTT_BARRIER;
}

static float near_value(const plain* p, const float* a, int x, int y, int dx, int dy)
{
    bool closed = barrier(p, x + dx, y + dy);
    if (dx && dy && barrier(p, x + dx, y) && barrier(p, x, y + dy))
        closed = true;
    return a[closed ? place(p, x, y) : place(p, x + dx, y + dy)];
}

// The weighted neighbours and the share that stays.
static float near_sum(const plain* p, const float* a, int x, int y, double diffusion, float* stays)
{
    bool nine = p->def.stencil == 9;
    float edge = grid(nine ? diffusion * 2.0 / 3.0 : diffusion), corner = nine ? grid(diffusion / 6.0) : 0.0f;
    *stays = (float)(1.0 - 4.0 * (double)edge - 4.0 * (double)corner);
    float up = near_value(p, a, x, y, 0, -1), down = near_value(p, a, x, y, 0, 1);
    float left = near_value(p, a, x, y, -1, 0), right = near_value(p, a, x, y, 1, 0);
    float sum = edge * ((up + down) + (left + right));
    if (nine)
        sum += corner * ((near_value(p, a, x, y, -1, -1) + near_value(p, a, x, y, -1, 1)) +
                         (near_value(p, a, x, y, 1, -1) + near_value(p, a, x, y, 1, 1)));
    return sum;
}

static void cell_step(plain* p, int x, int y)
{
    size_t at = place(p, x, y);
    double dt = (double)p->def.time_step;
    const ty_gray_scott_rates* r = &p->def.rates[p->marks[at] & 15];
    float u = p->u[at], v = p->v[at], stays_u, stays_v;
    float feed = grid(dt * (double)r->feed), kill = grid(dt * (double)r->kill);
    feed += p->feed ? p->def.time_step * p->feed[at] : 0.0f;
    kill += p->kill ? p->def.time_step * p->kill[at] : 0.0f;
    float near_u = near_sum(p, p->u, x, y, dt * (double)p->def.diffusion_u, &stays_u);
    float near_v = near_sum(p, p->v, x, y, dt * (double)p->def.diffusion_v, &stays_v);
    float reaction = p->def.time_step * (u * v * v);
    bool stands = barrier(p, x, y);
    p->next_u[at] = stands ? u : (((stays_u - feed) * u + near_u) + feed) - reaction;
    p->next_v[at] = stands ? v : ((stays_v - (feed + kill)) * v + near_v) + reaction;
}

static void plain_step(plain* p, int count)
{
#if defined(__SSE__)
    unsigned mode = _mm_getcsr();
    _mm_setcsr(mode | 0x8040u);
#endif
    for (int i = 0; i < count; i++)
    {
        for (int y = 0; y < p->def.height; y++)
            for (int x = 0; x < p->def.width; x++)
                cell_step(p, x, y);
        float *u = p->u, *v = p->v;
        p->u = p->next_u;
        p->v = p->next_v;
        p->next_u = u;
        p->next_v = v;
    }
#if defined(__SSE__)
    _mm_setcsr(mode);
#endif
}

// --- a field with everything in it ---

typedef struct setting
{
    int width, height, stencil;
    bool wrap_x, wrap_y, varied;
    float time_step;
} setting;

typedef struct scene
{
    ty_gray_scott_def def;
    size_t count;
    float *u, *v, *feed, *kill;
    uint8_t* marks;
} scene;

static scene scene_make(const setting* s, uint64_t number)
{
    scene c = {.def = ty_gray_scott_def_default(), .count = (size_t)s->width * (size_t)s->height};
    c.def.width = s->width;
    c.def.height = s->height;
    c.def.stencil = s->stencil;
    c.def.wrap_x = s->wrap_x;
    c.def.wrap_y = s->wrap_y;
    c.def.time_step = s->time_step;
    c.def.rate_count = 16;
    ty_rng rng = ty_rng_make((ty_seed){number}, 0, 0);
    for (int i = 0; i < 16; i++)
        c.def.rates[i] = (ty_gray_scott_rates){ty_rng_range(&rng, 0.02f, 0.075f), ty_rng_range(&rng, 0.05f, 0.065f)};
    c.u = TY_ALLOC(float, c.count);
    c.v = TY_ALLOC(float, c.count);
    c.feed = TY_ALLOC(float, c.count);
    c.kill = TY_ALLOC(float, c.count);
    c.marks = TY_ALLOC(uint8_t, c.count);
    int bx = s->width / 2, by = s->height / 2;
    for (size_t i = 0; i < c.count; i++)
    {
        int x = (int)(i % (size_t)s->width), y = (int)(i / (size_t)s->width);
        c.u[i] = ty_rng_range(&rng, 0.2f, 1.0f);
        c.v[i] = ty_rng_float(&rng) < 0.3f ? 0.0f : ty_rng_range(&rng, 0.0f, 0.4f);
        c.feed[i] = ty_rng_range(&rng, -0.005f, 0.005f);
        c.kill[i] = ty_rng_range(&rng, -0.002f, 0.002f);
        // even stretches, stretches of chance, a wall, a lone slanted line, crumbs
        int mark = y % 7 < 3 ? (x / 40) % 3 : (int)(ty_rng_float(&rng) * 16.0f);
        bool wall =
            (y == by && x > bx / 2) || (x == y + 3) || (y % 11 == 5 && ty_rng_float(&rng) < 0.1f) || (x == 0 && y == 2);
        c.marks[i] = (uint8_t)(mark | (wall ? TY_GRAY_SCOTT_BARRIER : 0));
    }
    return c;
}

static void scene_free(scene* c)
{
    ty_free(c->u);
    ty_free(c->v);
    ty_free(c->feed);
    ty_free(c->kill);
    ty_free(c->marks);
}

static void scene_into_field(const scene* c, bool varied, ty_gray_scott* field)
{
    size_t w = (size_t)c->def.width;
    for (int y = 0; y < c->def.height; y++)
    {
        memcpy(ty_gray_scott_u(field, y), c->u + (size_t)y * w, w * sizeof(float));
        memcpy(ty_gray_scott_v(field, y), c->v + (size_t)y * w, w * sizeof(float));
        memcpy(ty_gray_scott_marks(field, y), c->marks + (size_t)y * w, w);
    }
    ty_error error;
    if (varied)
        assert_int_equal(ty_gray_scott_vary(field, c->feed, c->kill, &error), TY_OK);
}

static void expect_same(ty_gray_scott* field, const plain* p)
{
    size_t w = (size_t)p->def.width;
    for (int y = 0; y < p->def.height; y++)
        for (size_t x = 0; x < w; x++)
        {
            float u = ty_gray_scott_u(field, y)[x], v = ty_gray_scott_v(field, y)[x];
            bool same = memcmp(&u, p->u + (size_t)y * w + x, sizeof u) == 0 &&
                        memcmp(&v, p->v + (size_t)y * w + x, sizeof v) == 0;
            if (!same)
                fail_msg("cell (%zu, %d): %.9g %.9g instead of %.9g %.9g", x, y, (double)u, (double)v,
                         (double)p->u[(size_t)y * w + x], (double)p->v[(size_t)y * w + x]);
        }
}

// Steps of a field against those of the plain loop, for each tuning given.
static void compare(const setting* s, int steps, const ty_gray_scott_tuning* tunings, int count, ty_workers* workers)
{
    scene c = scene_make(s, 5);
    plain p = {.def = c.def, .marks = c.marks, .next_u = TY_ALLOC(float, c.count), .next_v = TY_ALLOC(float, c.count)};
    p.u = TY_ALLOC(float, c.count);
    p.v = TY_ALLOC(float, c.count);
    memcpy(p.u, c.u, c.count * sizeof(float));
    memcpy(p.v, c.v, c.count * sizeof(float));
    p.feed = s->varied ? c.feed : NULL;
    p.kill = s->varied ? c.kill : NULL;
    plain_step(&p, steps);
    for (int i = 0; i < count; i++)
    {
        ty_gray_scott* field;
        ty_error error;
        assert_int_equal(ty_gray_scott_create(&c.def, &field, &error), TY_OK);
        scene_into_field(&c, s->varied, field);
        if (ty_gray_scott_tune(field, tunings[i]))
        {
            ty_gray_scott_step(field, steps, workers);
            expect_same(field, &p);
        }
        else
            print_message("no kernel %d on this machine\n", (int)tunings[i].path);
        ty_gray_scott_destroy(field);
    }
    ty_free(p.u);
    ty_free(p.v);
    ty_free(p.next_u);
    ty_free(p.next_v);
    scene_free(&c);
}

// --- tests ---

static const setting settings[] = {{67, 45, 5, true, true, false, 1.0f},  {67, 45, 5, false, false, false, 1.0f},
                                   {67, 45, 9, true, false, false, 1.0f}, {67, 45, 9, false, true, false, 0.7f},
                                   {150, 31, 5, false, true, true, 0.5f}, {150, 31, 9, true, true, true, 1.0f},
                                   {8, 8, 5, true, true, false, 1.0f},    {9, 8, 9, false, false, false, 1.0f},
                                   {16, 9, 5, true, true, false, 0.9f},   {400, 12, 5, false, false, false, 1.0f}};

static void every_kernel_gives_the_bits_of_a_loop(void** state)
{
    (void)state;
    const ty_gray_scott_tuning paths[] = {
        {.path = TY_GRAY_SCOTT_BEST},
        {.path = TY_GRAY_SCOTT_PORTABLE},
        {.path = TY_GRAY_SCOTT_AVX2},
        {.path = TY_GRAY_SCOTT_AVX512},
    };
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++)
        compare(&settings[i], 37, paths, 4, NULL);
}

static void every_depth_and_cut_gives_the_bits_of_a_loop(void** state)
{
    (void)state;
    ty_gray_scott_tuning cuts[60];
    int count = 0;
    const int depths[] = {1, 2, 3, 5, 8, 16, 17, 40, 64}, strips[] = {0, 16, 48}, bands[] = {1, 3};
    for (int d = 0; d < 9; d++)
        for (int s = 0; s < 3; s++)
            for (int b = 0; b < 2; b++)
                cuts[count++] = (ty_gray_scott_tuning){TY_GRAY_SCOTT_BEST, depths[d], strips[s], bands[b]};
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++)
        compare(&settings[i], 64, cuts, count, NULL);
}

static void threads_change_no_bit(void** state)
{
    (void)state;
    const setting large = {1100, 70, 5, true, false, false, 1.0f};
    const ty_gray_scott_tuning cuts[] = {{0}, {.depth = 7, .strip = 256, .bands = 5}};
    for (int threads = 1; threads <= 3; threads++)
    {
        ty_workers* crew;
        ty_error error;
        assert_int_equal(ty_workers_create(threads, &crew, &error), TY_OK);
        compare(&large, 45, cuts, 2, crew);
        ty_workers_destroy(crew);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kernel_gives_the_bits_of_a_loop),
        cmocka_unit_test(every_depth_and_cut_gives_the_bits_of_a_loop),
        cmocka_unit_test(threads_change_no_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
