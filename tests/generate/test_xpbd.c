// SPDX-License-Identifier: Apache-2.0
// The elastic solver against mechanics: beams, falls, impacts, slopes, momentum, energy, volume, water, any workers.
#include "base/cmocka_all.h"
#include "recipe_made.h"
#include <math.h>
#include <tsuya/base/hash.h>
#include <tsuya/generate/aggregate_recipe.h>
#include <tsuya/generate/xpbd.h>

static ty_xpbd_def free_def(void)
{
    ty_xpbd_def def = ty_xpbd_def_default();
    def.gravity = ty_vec3_make(0.0f, 0.0f, 0.0f);
    return def;
}

// --- a beam of n segments, clamped at one end ---

enum
{
    MOST = 16,
};

typedef struct beam
{
    ty_ball balls[MOST + 1];
    float masses[MOST + 1];
    ty_stretch stretches[MOST];
    ty_bend bends[MOST];
    ty_soft_body body;
} beam;

// Length 10 mm, EI = 1e-7 N m^2, 20 mg in all.
static void beam_make(beam* b, int n, bool clamped)
{
    const float length = 10e-3f, stiffness = 1e-7f, mass = 2e-5f, area_modulus = 0.05f;
    float l = length / (float)n;
    for (int i = 0; i <= n; i++)
    {
        b->balls[i] = (ty_ball){{l * (float)i, 0.0f, 0.0f}, 0.5e-3f};
        b->masses[i] = mass / (float)n * (i == 0 || i == n ? 0.5f : 1.0f);
    }
    if (clamped)
        b->masses[0] = 0.0f;
    int bends = 0;
    for (int i = 0; i < n; i++)
        b->stretches[i] = (ty_stretch){i, i + 1, l, l / area_modulus};
    if (clamped) // half the compliance of an inner node
        b->bends[bends++] = (ty_bend){-1, 0, 1, 0.5f, {l, 0.0f, 0.0f}, 0.5f * l * l * l / stiffness};
    for (int i = 1; i < n; i++)
        b->bends[bends++] = (ty_bend){i - 1, i, i + 1, 0.5f, {0.0f, 0.0f, 0.0f}, 0.25f * l * l * l / stiffness};
    b->body = (ty_soft_body){.balls = b->balls,
                             .masses = b->masses,
                             .ball_count = n + 1,
                             .stretches = b->stretches,
                             .stretch_count = n,
                             .bends = b->bends,
                             .bend_count = bends};
}

// Deflection of the tip under a force there, in units of P L^3 / (3 E I): the force grows slowly over twelve periods
// of the beam, and then the mean over one is taken.
static double deflection(int n, float rate)
{
    const float force = 1e-5f, ramp = 0.3f;
    beam b;
    beam_make(&b, n, true);
    ty_xpbd_def def = free_def();
    def.rate = rate;
    def.damping = 0.0f;
    ty_xpbd* x = ty_xpbd_create(&def);
    ty_xpbd_add(x, &b.body, ty_vec3_make(0.0f, 0.0f, 0.0f), ty_quat_identity(), 1.0f, ty_vec3_make(0.0f, 0.0f, 0.0f));
    int grow = (int)(ramp * rate), mean = (int)(0.025f * rate);
    double tip = 0.0;
    for (int i = 0; i < grow + mean; i++)
    {
        float t = ty_min(1.0f, (float)i / (float)grow);
        ty_xpbd_push(x, n, ty_vec3_make(0.0f, force * t * t * (3.0f - 2.0f * t), 0.0f));
        ty_xpbd_step(x, NULL);
        tip += i >= grow ? (double)ty_xpbd_position(x, n).y / mean : 0.0;
    }
    ty_xpbd_destroy(x);
    return tip / ((double)force * 1e-6 / (3.0 * 1e-7));
}

// The trapezoidal sum of the moments: 1 + 1 / (2 n^2).
static void test_cantilever(void** state)
{
    (void)state;
    double error[3];
    for (int k = 0; k < 3; k++)
    {
        int n = 4 << k;
        double found = deflection(n, 60000.0f * (float)(n * n) / 16.0f);
        error[k] = found - 1.0;
        print_message("n %d: %.5f, expected %.5f\n", n, found, 1.0 + 0.5 / (n * n));
        assert_true(fabs(found - (1.0 + 0.5 / (n * n))) < 1e-3);
    }
    assert_true(error[0] / error[1] > 3.5 && error[0] / error[1] < 4.6);
}

static void test_substeps_double(void** state)
{
    (void)state;
    double once = deflection(8, 40000.0f), twice = deflection(8, 80000.0f);
    print_message("substeps: %.5f %.5f\n", once, twice);
    assert_true(fabs(once / twice - 1.0) < 0.05);
}

// --- single balls ---

static int ball_add(ty_xpbd* x, float radius, float mass, ty_vec3 position, ty_vec3 velocity)
{
    ty_ball ball = {{0.0f, 0.0f, 0.0f}, radius};
    ty_soft_body body = {.balls = &ball, .masses = &mass, .ball_count = 1};
    return ty_xpbd_add(x, &body, position, ty_quat_identity(), 1.0f, velocity);
}

static void test_free_fall(void** state)
{
    (void)state;
    ty_xpbd_def def = ty_xpbd_def_default();
    ty_xpbd* x = ty_xpbd_create(&def);
    ball_add(x, 1e-3f, 1e-5f, ty_vec3_make(0.0f, 0.0f, 0.0f), ty_vec3_make(0.1f, 0.0f, 0.0f));
    const int steps = 1200;
    for (int i = 0; i < steps; i++)
        ty_xpbd_step(x, NULL);
    double t = steps / (double)def.rate, h = 1.0 / (double)def.rate;
    ty_vec3 p = ty_xpbd_position(x, 0), v = ty_xpbd_velocity(x, 0);
    assert_true(fabs((double)p.y / (-9.81 * t * (t + h) / 2.0) - 1.0) < 2e-3);
    assert_true(fabs((double)v.y / (-9.81 * t) - 1.0) < 2e-3);
    assert_true(fabs((double)p.x - 0.1 * t) < 2e-5);
    ty_xpbd_destroy(x);
}

// Two equal balls meet: a damped spring of k = 1 / compliance that does not pull. Their rebound is that of Schwager &
// Poeschel 2007, and the overlap at its deepest u sqrt(m / 2 k) without damping.
static void test_two_body_impact(void** state)
{
    (void)state;
    const double mass = 1e-5, radius = 1e-3, speed = 0.05;
    const float dampings[3] = {0.0f, 1e-4f, 5e-4f};
    for (int damped = 0; damped < 3; damped++)
    {
        ty_xpbd_def def = free_def();
        def.rate = 200000.0f;
        def.push_out = 10.0f;
        def.damping = dampings[damped];
        ty_xpbd* x = ty_xpbd_create(&def);
        float r = (float)radius;
        ball_add(x, r, (float)mass, ty_vec3_make(-1.02f * r, 0.0f, 0.0f), ty_vec3_make((float)speed, 0.0f, 0.0f));
        ball_add(x, r, (float)mass, ty_vec3_make(1.02f * r, 0.0f, 0.0f), ty_vec3_make(-(float)speed, 0.0f, 0.0f));
        double k = 4.0 / 3.0 * 3e5 / (2.0 * (1.0 - 0.16)) * sqrt(0.5 * radius * 0.02 * 0.5 * radius), deepest = 0.0;
        for (int i = 0; i < 1200; i++)
        {
            ty_xpbd_step(x, NULL);
            double gap = (double)(ty_xpbd_position(x, 1).x - ty_xpbd_position(x, 0).x) - 2.0 * radius;
            deepest = gap < -deepest ? -gap : deepest;
        }
        double rebound = (double)(ty_xpbd_velocity(x, 1).x - ty_xpbd_velocity(x, 0).x) / (2.0 * speed);
        double zeta = (double)dampings[damped] * sqrt(2.0 * k / mass) / 2.0, turn = sqrt(1.0 - zeta * zeta);
        double end = 3.14159265 - atan2(2.0 * zeta * turn, turn * turn - zeta * zeta);
        double expected = exp(-zeta / turn * end);
        print_message("zeta %.3f: rebound %.4f, expected %.4f; deepest %.3g of %.3g\n", zeta, rebound, expected,
                      deepest, 2.0 * speed * sqrt(mass / (2.0 * k)));
        assert_true(fabs(rebound - expected) < 0.02);
        if (!damped)
            assert_true(fabs(deepest / (2.0 * speed * sqrt(mass / (2.0 * k))) - 1.0) < 0.03);
        assert_true((double)ty_length(ty_xpbd_momentum(x)) < 2e-3 * mass * speed);
        ty_xpbd_destroy(x);
    }
}

static ty_container* box_make(float x, float y, float z)
{
    ty_container_def def = ty_container_def_default();
    def.kind = TY_CONTAINER_BOX;
    def.shape.size = ty_vec3_make(x, y, z);
    def.shape.rounding = 0.0f;
    ty_container* box;
    ty_error error;
    assert_int_equal(ty_container_create(&def, NULL, &box, &error), TY_OK);
    return box;
}

// How far a ball slides in .3 s on a floor tilted by angle.
static float slide(const ty_container* box, float angle, float mu)
{
    ty_xpbd_def def = ty_xpbd_def_default();
    def.container = box;
    def.friction = mu;
    def.gravity = ty_vec3_make(9.81f * ty_sin(angle), -9.81f * ty_cos(angle), 0.0f);
    ty_xpbd* x = ty_xpbd_create(&def);
    ball_add(x, 1e-3f, 1e-5f, ty_vec3_make(0.0f, -0.019f, 0.0f), ty_vec3_make(0.0f, 0.0f, 0.0f));
    for (int i = 0; i < 1800; i++)
        ty_xpbd_step(x, NULL);
    float moved = ty_xpbd_position(x, 0).x;
    ty_xpbd_destroy(x);
    return moved;
}

static void test_slope(void** state)
{
    (void)state;
    ty_container* box = box_make(1.0f, 0.02f, 0.05f);
    for (float mu = 0.3f; mu < 0.7f; mu += 0.3f)
    {
        float critical = ty_atan2(mu, 1.0f);
        float below = slide(box, 0.98f * critical, mu), above = slide(box, 1.02f * critical, mu);
        float expected = 0.5f * 9.81f * 0.09f * (ty_sin(1.02f * critical) - mu * ty_cos(1.02f * critical));
        print_message("mu %.1f: below %.3g m, above %.3g of %.3g m\n", (double)mu, (double)below, (double)above,
                      (double)expected);
        assert_true(below < 1e-5f);
        assert_true(above > 0.8f * expected && above < 1.1f * expected);
    }
    ty_container_destroy(box);
}

// --- what holds a body together ---

// A bent beam that flies and turns, with match, stretch, bend and damping: momentum and spin stay, energy never grows.
static void test_internal_constraints_conserve(void** state)
{
    (void)state;
    beam b;
    beam_make(&b, 8, false);
    for (int i = 0; i <= 8; i++) // curved, so that the bends' rest vectors are not zero
        b.balls[i].center.y = 1e-3f * (float)((i - 4) * (i - 4)) / 16.0f;
    for (int i = 0; i < 7; i++)
        b.bends[i].rest = ty_vec3_make(0.0f, 1e-3f / 16.0f, 0.0f);
    b.body.match = 5.0f;
    ty_xpbd_def def = free_def();
    def.rate = 20000.0f;
    def.damping = 1e-4f;
    ty_xpbd* x = ty_xpbd_create(&def);
    ty_xpbd_add(x, &b.body, ty_vec3_make(0.0f, 0.0f, 0.0f), ty_quat_identity(), 1.0f, ty_vec3_make(0.1f, 0.0f, 0.0f));
    ty_xpbd_push(x, 8, ty_vec3_make(0.0f, 2e-4f, 1e-4f));
    ty_xpbd_push(x, 2, ty_vec3_make(0.0f, -2e-4f, 0.0f));
    for (int i = 0; i < 400; i++)
        ty_xpbd_step(x, NULL);
    ty_xpbd_push(x, 8, ty_vec3_make(0.0f, 0.0f, 0.0f));
    ty_xpbd_push(x, 2, ty_vec3_make(0.0f, 0.0f, 0.0f));
    ty_vec3 momentum = ty_xpbd_momentum(x), spin = ty_xpbd_spin(x);
    double energy = ty_xpbd_energy(x, true), most = 0.0;
    for (int i = 0; i < 4000; i++)
    {
        ty_xpbd_step(x, NULL);
        most = fmax(most, ty_xpbd_energy(x, true));
    }
    float lost = ty_length(ty_sub(ty_xpbd_momentum(x), momentum)) / ty_length(momentum);
    float turned = ty_length(ty_sub(ty_xpbd_spin(x), spin)) / ty_length(spin);
    print_message("momentum %.2g, spin %.2g, energy %.4g -> at most %.4g, then %.4g\n", (double)lost, (double)turned,
                  energy, most, ty_xpbd_energy(x, true));
    assert_true(lost < 2e-3f);
    assert_true(turned < 1e-2f);
    assert_true(most <= 1.01 * energy);
    assert_true(ty_xpbd_energy(x, true) < energy);
    ty_xpbd_destroy(x);
}

static const float corners[12][3] = {{0, 1, 1.618034f}, {0, -1, 1.618034f}, {0, 1, -1.618034f}, {0, -1, -1.618034f},
                                     {1, 1.618034f, 0}, {-1, 1.618034f, 0}, {1, -1.618034f, 0}, {-1, -1.618034f, 0},
                                     {1.618034f, 0, 1}, {-1.618034f, 0, 1}, {1.618034f, 0, -1}, {-1.618034f, 0, -1}};
static const int faces[20][3] = {{0, 1, 8},  {0, 8, 4},  {0, 4, 5},  {0, 5, 9},  {0, 9, 1},  {1, 6, 8},  {8, 6, 10},
                                 {8, 10, 4}, {4, 10, 2}, {4, 2, 5},  {5, 2, 11}, {5, 11, 9}, {9, 11, 7}, {9, 7, 1},
                                 {1, 7, 6},  {3, 6, 7},  {3, 7, 11}, {3, 11, 2}, {3, 2, 10}, {3, 10, 6}};

// A bag with membranes of springs, pressed from both sides: it bulges, and its volume stays; without the constraint
// not.
static double pressed_volume(float bulk, double* bulge)
{
    ty_ball balls[12];
    float masses[12];
    ty_stretch edges[30];
    int count = 0;
    for (int i = 0; i < 12; i++)
    {
        balls[i] = (ty_ball){ty_mul(ty_vec3_make(corners[i][0], corners[i][1], corners[i][2]), 1e-3f), 0.3e-3f};
        masses[i] = 2e-6f;
    }
    for (int i = 0; i < 12; i++)
        for (int j = i + 1; j < 12; j++)
        {
            float l = ty_length(ty_sub(balls[i].center, balls[j].center));
            if (l < 2.1e-3f)
                edges[count++] = (ty_stretch){i, j, l, 0.1f};
        }
    assert_int_equal(count, 30);
    ty_soft_body body = {.balls = balls, .masses = masses, .ball_count = 12, .stretches = edges, .stretch_count = 30};
    body.triangles = faces;
    body.triangle_count = 20;
    body.bulk = bulk;
    body.swell = 1.0f;
    ty_xpbd_def def = free_def();
    def.rate = 20000.0f;
    ty_xpbd* x = ty_xpbd_create(&def);
    ty_xpbd_add(x, &body, ty_vec3_make(0.0f, 0.0f, 0.0f), ty_quat_identity(), 1.0f, ty_vec3_make(0.0f, 0.0f, 0.0f));
    double start = (double)ty_xpbd_volume(x, 0), wide = (double)ty_xpbd_position(x, 8).x;
    assert_true(start > 0.0);
    const float force = 2e-3f;
    for (int i = 0; i < 4; i++) // the four highest and the four lowest
    {
        ty_xpbd_push(x, 4 + i, ty_vec3_make(0.0f, corners[4 + i][1] > 0.0f ? -force : force, 0.0f));
        ty_xpbd_push(x, i, ty_vec3_make(0.0f, corners[i][1] > 0.0f ? -force : force, 0.0f));
    }
    for (int i = 0; i < 6000; i++)
        ty_xpbd_step(x, NULL);
    double share = (double)ty_xpbd_volume(x, 0) / start;
    *bulge = (double)ty_xpbd_position(x, 8).x / wide;
    ty_xpbd_destroy(x);
    return share;
}

static void test_volume(void** state)
{
    (void)state;
    double with, without, kept = pressed_volume(1e6f, &with), lost = pressed_volume(1e-3f, &without);
    print_message("volume kept %.5f (width %.3f), without %.4f (width %.3f)\n", kept, with, lost, without);
    assert_true(fabs(kept - 1.0) < 2e-3);
    assert_true(lost < 0.97);
    assert_true(with > without + 0.005);
}

// --- water ---

// Two wet balls pulled apart hold below the force at contact and part above it; a gap once broken stays dry.
static float pulled_gap(float share)
{
    ty_xpbd_def def = free_def();
    def.bridge.tension = 0.072f;
    def.bridge.volume = 0.01f;
    ty_xpbd* x = ty_xpbd_create(&def);
    const ty_vec3 still = {0.0f, 0.0f, 0.0f};
    ball_add(x, 1e-3f, 1e-5f, ty_vec3_make(-0.999e-3f, 0.0f, 0.0f), still);
    ball_add(x, 1e-3f, 1e-5f, ty_vec3_make(0.999e-3f, 0.0f, 0.0f), still);
    float force = share * ty_bridge_pull(&def.bridge, 1e-3f, 1e-3f, 0.0f);
    for (int i = 0; i < 1800; i++)
    {
        float t = ty_clamp((float)(i - 300) / 900.0f, 0.0f, 1.0f);
        ty_xpbd_push(x, 0, ty_vec3_make(-force * t, 0.0f, 0.0f));
        ty_xpbd_push(x, 1, ty_vec3_make(force * t, 0.0f, 0.0f));
        ty_xpbd_step(x, NULL);
    }
    float gap = ty_xpbd_position(x, 1).x - ty_xpbd_position(x, 0).x - 2e-3f;
    ty_xpbd_destroy(x);
    return gap;
}

static void test_cohesion(void** state)
{
    (void)state;
    print_message("pulled: %.3g, %.3g m\n", (double)pulled_gap(0.9f), (double)pulled_gap(1.1f));
    assert_true(pulled_gap(0.9f) < 1e-5f);
    assert_true(pulled_gap(1.1f) > 1e-2f);
}

// --- piles ---

static ty_hash heap_hash(const ty_element* grain, int threads, double* energy_growth)
{
    ty_workers* workers;
    ty_error error;
    assert_int_equal(ty_workers_create(threads, &workers, &error), TY_OK);
    ty_container* box = box_make(0.03f, 0.03f, 0.03f);
    ty_xpbd_def def = ty_xpbd_def_default();
    def.container = box;
    ty_xpbd* x = ty_xpbd_create(&def);
    enum
    {
        SIDE = 8
    };
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    for (int i = 0; i < SIDE * SIDE * SIDE; i++)
    {
        ty_body body = {.scale = 1.0f};
        body.position = ty_vec3_make((float)(i % SIDE), (float)(i / SIDE % SIDE), (float)(i / SIDE / SIDE));
        body.position = ty_mul(ty_sub(body.position, ty_vec3_make(3.5f, 3.5f, 3.5f)), 0.0068f);
        float u = ty_rng_float(&rng), v = ty_rng_float(&rng), w = ty_rng_float(&rng);
        body.rotation = ty_quat_uniform(u, v, w);
        ty_xpbd_add_element(x, grain, &body);
    }
    double before = ty_xpbd_energy(x, false);
    *energy_growth = 0.0;
    for (int i = 0; i < 500; i++)
    {
        ty_xpbd_step(x, workers);
        if (i % 50 == 49)
        {
            double now = ty_xpbd_energy(x, false);
            *energy_growth = fmax(*energy_growth, now - before);
            before = now;
        }
    }
    ty_hasher* hasher = ty_hasher_create();
    for (int i = 0; i < ty_xpbd_particle_count(x); i++)
    {
        ty_vec3 p = ty_xpbd_position(x, i);
        ty_hasher_add(hasher, &p, sizeof p);
    }
    ty_hash hash = ty_hasher_end(hasher);
    *energy_growth /=
        (double)(def.density * grain->volume) * SIDE * SIDE * SIDE * 9.81 * 0.03; // of the fall by half the box
    ty_xpbd_destroy(x);
    ty_container_destroy(box);
    ty_workers_destroy(workers);
    return hash;
}

static void test_same_bits_and_energy(void** state)
{
    (void)state;
    ty_element grain;
    ty_element_def element = ty_element_def_default();
    ty_error error;
    assert_int_equal(ty_element_init(&element, (ty_seed){5}, 0, &grain, &error), TY_OK);
    double growth[3];
    ty_hash one = heap_hash(&grain, 1, &growth[0]), two = heap_hash(&grain, 2, &growth[1]);
    ty_hash three = heap_hash(&grain, 3, &growth[2]);
    print_message("energy grew by %.3g of a fall\n", growth[0]);
    assert_memory_equal(&one, &two, sizeof one);
    assert_memory_equal(&one, &three, sizeof one);
    assert_true(growth[0] < 1e-3);
    ty_element_term(&grain);
}

// --- the frame of a bent element ---

static void test_frame(void** state)
{
    (void)state;
    ty_element grain;
    ty_element_def element = ty_element_def_default();
    ty_error error;
    assert_int_equal(ty_element_init(&element, (ty_seed){5}, 0, &grain, &error), TY_OK);
    ty_xpbd_def def = free_def();
    ty_xpbd* x = ty_xpbd_create(&def);
    ty_body body = {.position = {0.01f, 0.02f, 0.03f}, .scale = 1.1f};
    body.rotation = ty_quat_euler(ty_vec3_make(0.4f, 0.3f, 0.7f));
    int number = ty_xpbd_add_element(x, &grain, &body);
    ty_body rigid;
    ty_affine frame, expected = ty_affine_from_trs(body.position, body.rotation, ty_vec3_make(1.1f, 1.1f, 1.1f));
    ty_xpbd_frame(x, number, &rigid, &frame);
    assert_true(ty_length(ty_sub(rigid.position, body.position)) < 1e-7f);
    assert_true(ty_length(ty_sub(frame.x, expected.x)) < 1e-4f && ty_length(ty_sub(frame.z, expected.z)) < 1e-4f);
    assert_true(ty_length(ty_sub(frame.t, expected.t)) < 1e-6f);
    const float force = 5e-3f; // lengthwise, at its ends: it grows longer
    int low = 0, high = 0;
    for (int i = 0; i < grain.ball_count; i++)
    {
        low = grain.balls[i].center.x < grain.balls[low].center.x ? i : low;
        high = grain.balls[i].center.x > grain.balls[high].center.x ? i : high;
    }
    ty_xpbd_push(x, low, ty_mul(ty_normalize(expected.x), -force));
    ty_xpbd_push(x, high, ty_mul(ty_normalize(expected.x), force));
    for (int i = 0; i < 1200; i++)
        ty_xpbd_step(x, NULL);
    ty_xpbd_frame(x, number, &rigid, &frame);
    print_message("stretched to %.4f\n", (double)(ty_length(frame.x) / 1.1f));
    assert_true(ty_length(frame.x) > 1.1f * 1.001f && ty_length(frame.x) < 1.1f * 1.2f);
    ty_xpbd_destroy(x);
    ty_element_term(&grain);
}

// --- from a recipe ---

static ty_aggregate* packed(int solver, float strain, int cut, ty_status expected)
{
    ty_aggregate_recipe recipe = ty_aggregate_recipe_default();
    recipe.element.variants = 2;
    set_bowl(&recipe.container.shape, 0.015f, 0.015f, 0.0015f, 0.007f, 0.002f);
    recipe.fill.count = 60;
    recipe.settle.solver = solver;
    recipe.settle.rate = 4000.0f;
    recipe.settle.max_seconds = solver == TY_SOLVER_XPBD ? 0.15f : 3.0f;
    recipe.press.strain = strain;
    recipe.press.seconds = 0.2f;
    recipe.container.cut = (ty_cut_def){.kind = cut, .normal = {1.0f, 0.0f, 0.0f}};
    ty_aggregate* made;
    ty_error error;
    assert_int_equal(ty_aggregate_make(&recipe, NULL, &made, &error), expected);
    assert_non_null(made);
    return made;
}

// Largest difference of an instance's columns from a rotation with a size.
static float bent_most(const ty_aggregate* a)
{
    float most = 0.0f;
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        ty_affine t = a->transforms[i];
        float size = ty_length(t.x);
        most = ty_max(most, fabsf(ty_length(t.y) / size - 1.0f));
        most = ty_max(most, fabsf(ty_dot(t.x, t.y)) / (size * size));
    }
    return most;
}

// A rigid pile stays rigid; elastic and pressed ones are bent, a little, and end as not at rest.
static void test_recipe(void** state)
{
    (void)state;
    ty_aggregate* rigid = packed(TY_SOLVER_IMPULSE, 0.0f, TY_CUT_NONE, TY_OK);
    ty_aggregate* soft = packed(TY_SOLVER_XPBD, 0.0f, TY_CUT_NONE, TY_NOT_AT_REST);
    ty_aggregate* slight = packed(TY_SOLVER_IMPULSE, 0.01f, TY_CUT_NONE, TY_OK);
    ty_aggregate* pressed = packed(TY_SOLVER_IMPULSE, 0.2f, TY_CUT_NONE, TY_OK);
    print_message("bent: %.3g %.3g %.3g\n", (double)bent_most(rigid), (double)bent_most(soft),
                  (double)bent_most(pressed));
    assert_true(bent_most(rigid) < 1e-5f);
    assert_true(bent_most(soft) > 1e-4f && bent_most(soft) < 0.3f);
    assert_true(bent_most(pressed) > 1e-3f && bent_most(pressed) < 0.4f);
    assert_int_equal(rigid->instance_count, 60);
    float top_slight = -1.0f, top_pressed = -1.0f;
    for (uint32_t i = 0; i < pressed->instance_count; i++)
    {
        top_slight = ty_max(top_slight, slight->transforms[i].t.y);
        top_pressed = ty_max(top_pressed, pressed->transforms[i].t.y);
    }
    print_message("top: %.5f, pressed %.5f\n", (double)top_slight, (double)top_pressed);
    assert_true(top_pressed < top_slight - 0.3e-3f);
    ty_aggregate_destroy(rigid);
    ty_aggregate_destroy(soft);
    ty_aggregate_destroy(slight);
    ty_aggregate_destroy(pressed);
}

// Those that a cut leaves lie, bent as they are, where they lie without it.
static void test_cut_keeps_frames(void** state)
{
    (void)state;
    ty_aggregate* whole = packed(TY_SOLVER_IMPULSE, 0.1f, TY_CUT_NONE, TY_OK);
    ty_aggregate* cut = packed(TY_SOLVER_IMPULSE, 0.1f, TY_CUT_PLANE, TY_OK);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < whole->instance_count; i++)
        if (kept < cut->instance_count && whole->transforms[i].t.x <= 0.0f)
            assert_memory_equal(&whole->transforms[i], &cut->transforms[kept++], sizeof(ty_affine));
    assert_int_equal(kept, cut->instance_count);
    assert_true(kept > 15 && kept < whole->instance_count - 15);
    ty_aggregate_destroy(whole);
    ty_aggregate_destroy(cut);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cantilever),
        cmocka_unit_test(test_substeps_double),
        cmocka_unit_test(test_free_fall),
        cmocka_unit_test(test_two_body_impact),
        cmocka_unit_test(test_slope),
        cmocka_unit_test(test_internal_constraints_conserve),
        cmocka_unit_test(test_volume),
        cmocka_unit_test(test_cohesion),
        cmocka_unit_test(test_same_bits_and_energy),
        cmocka_unit_test(test_frame),
        cmocka_unit_test(test_recipe),
        cmocka_unit_test(test_cut_keeps_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
