// SPDX-License-Identifier: Apache-2.0
// A pile's mechanics against what can be worked out by hand, with balls of known mass and inertia: impacts, rolling,
// sliding, energy, bridges of water.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/rng.h>
#include <tsuya/generate/pile.h>

#define RADIUS 1.5e-3f // m

static ty_element balls[2]; // the second has twice the radius

static int group_setup(void** state)
{
    (void)state;
    for (int i = 0; i < 2; i++)
    {
        float r = RADIUS * (float)(i + 1), inverse = 2.5f / (r * r);
        balls[i] = (ty_element){.ball_count = 1, .radius = r, .capsule = r, .width = 2.0f * r};
        balls[i].balls[0].radius = r;
        balls[i].volume = 4.0f / 3.0f * TY_PI * r * r * r;
        for (int k = 0; k < 3; k++)
            balls[i].inverse_inertia[k] = inverse;
    }
    return 0;
}

static ty_pile_def weightless(float friction)
{
    ty_pile_def def = ty_pile_def_default();
    def.grains = balls;
    def.grain_count = 1;
    def.gravity = ty_vec3_make(0.0f, 0.0f, 0.0f);
    def.friction = friction;
    def.rolling = 0.0f;
    return def;
}

static ty_body ball_at(float x, float y, float z)
{
    return (ty_body){.position = {x, y, z}, .rotation = ty_quat_identity(), .scale = 1.0f};
}

static ty_container* floor_make(void)
{
    ty_container_def def = ty_container_def_default();
    def.kind = TY_CONTAINER_BOX;
    def.shape.size = ty_vec3_make(2.0f, 0.02f, 2.0f);
    def.shape.rounding = 0.0f;
    ty_container* box;
    ty_error error;
    assert_int_equal(ty_container_create(&def, NULL, &box, &error), TY_OK);
    return box;
}

static void steps(ty_pile* pile, int count)
{
    for (int i = 0; i < count; i++)
        ty_pile_step(pile, NULL);
}

// Head on, without restitution: both go on with the common velocity m1 v1 / (m1 + m2), masses 1 : 8.
static void test_central_impact(void** state)
{
    (void)state;
    ty_pile_def def = weightless(0.5f);
    def.grain_count = 2;
    ty_pile* pile = ty_pile_create(&def);
    ty_body two[2] = {ball_at(0.0f, 0.0f, 0.0f), ball_at(3.2f * RADIUS, 0.0f, 0.0f)};
    two[0].velocity.x = 0.3f;
    two[1].grain = 1;
    ty_pile_add(pile, two, 2);
    steps(pile, 100);
    const ty_body* b = ty_pile_bodies(pile);
    for (int i = 0; i < 2; i++)
    {
        assert_true(fabsf(b[i].velocity.x / (0.3f / 9.0f) - 1.0f) < 1e-3f);
        assert_true(ty_length(b[i].spin) < 1e-3f);
    }
    ty_pile_destroy(pile);
}

// What closes within a substep is a contact before it does: a slow ball stops at another one, and not within it.
static void test_slow_impact(void** state)
{
    (void)state;
    ty_pile_def def = weightless(0.5f);
    ty_pile* pile = ty_pile_create(&def);
    ty_body two[2] = {ball_at(0.0f, 0.0f, 0.0f), ball_at(2.1f * RADIUS, 0.0f, 0.0f)};
    two[0].velocity.x = 0.06f;
    ty_pile_add(pile, two, 2);
    float least = TY_FLOAT_MAX;
    for (int i = 0; i < 40; i++)
    {
        steps(pile, 1);
        const ty_body* b = ty_pile_bodies(pile);
        least = ty_min(least, b[1].position.x - b[0].position.x - 2.0f * RADIUS);
    }
    assert_true(fabsf(least) < 1e-6f);
    ty_pile_destroy(pile);
}

// A ball hits another at 45 degrees: along the normal they part with v_n / 2 each, along the tangent the impulse is
// mu times that of the normal while it slips, and 1/7 of the mass times v_t (2/7 of the reduced one) when it sticks.
static void oblique(float friction, float rate)
{
    ty_pile_def def = weightless(friction);
    def.rate = rate;
    ty_pile* pile = ty_pile_create(&def);
    ty_body two[2] = {ball_at(0.0f, 0.0f, 0.0f), ball_at(2.05f * RADIUS, 0.0f, 0.0f)};
    two[0].velocity = ty_vec3_make(0.04f, 0.04f, 0.0f);
    two[0].position.y = -0.05f * RADIUS; // so that they meet along x, slowly enough to do so in place
    ty_pile_add(pile, two, 2);
    steps(pile, (int)(rate * 8.0f / 2500.0f));
    const ty_body* b = ty_pile_bodies(pile);
    float normal = b[1].velocity.x, tangent = b[1].velocity.y, expected = ty_min(friction * 0.02f, 0.04f / 7.0f);
    assert_true(fabsf(normal / 0.02f - 1.0f) < 0.02f);
    assert_true(fabsf(tangent / expected - 1.0f) < 0.03f);
    for (int i = 0; i < 2; i++) // both turn alike: m v_t r / I
        assert_true(fabsf(b[i].spin.z / (-2.5f * expected / RADIUS) - 1.0f) < 0.03f);
    ty_pile_destroy(pile);
}

static void test_oblique_impact(void** state)
{
    (void)state;
    for (float rate = 2500.0f; rate < 11000.0f; rate *= 2.0f) // however often one looks
    {
        oblique(0.1f, rate);
        oblique(1.0f, rate);
    }
}

// Speed after .3 s on a slope, from rest.
static float slope_speed(float angle, float friction)
{
    ty_container* box = floor_make();
    ty_pile_def def = weightless(friction);
    def.gravity = ty_vec3_make(9.81f * ty_sin(angle), -9.81f * ty_cos(angle), 0.0f);
    def.container = box;
    ty_pile* pile = ty_pile_create(&def);
    ty_body body = ball_at(0.0f, -0.02f + RADIUS, 0.0f);
    ty_pile_add(pile, &body, 1);
    steps(pile, 750);
    float speed = ty_pile_bodies(pile)->velocity.x;
    ty_pile_destroy(pile);
    ty_container_destroy(box);
    return speed;
}

// A ball rolls down with 5/7 g sin a as long as tan a <= 7/2 mu, and slips with g (sin a - mu cos a) beyond.
static void test_rolls_and_slips(void** state)
{
    (void)state;
    const float seconds = 0.3f - 0.025f; // gravity comes on over .05 s
    float a = 0.4f, rolled = 5.0f / 7.0f * 9.81f * ty_sin(a) * seconds;
    assert_true(fabsf(slope_speed(a, 0.3f) / rolled - 1.0f) < 0.01f);
    float mu = 0.05f, slipped = 9.81f * (ty_sin(a) - mu * ty_cos(a)) * seconds;
    assert_true(fabsf(slope_speed(a, mu) / slipped - 1.0f) < 0.01f);
}

// Moves of a ball on a slope within .2 s from .3 s on, m. Rolling resistance is an arm of def.rolling radii.
static float slope_roll(float angle, float rolling)
{
    ty_container* box = floor_make();
    ty_pile_def def = weightless(0.5f);
    def.rolling = rolling;
    def.gravity = ty_vec3_make(9.81f * ty_sin(angle), -9.81f * ty_cos(angle), 0.0f);
    def.container = box;
    ty_pile* pile = ty_pile_create(&def);
    ty_body body = ball_at(0.0f, -0.02f + RADIUS, 0.0f);
    ty_pile_add(pile, &body, 1);
    steps(pile, 750);
    float from = ty_pile_bodies(pile)->position.x;
    steps(pile, 500);
    float moved = ty_pile_bodies(pile)->position.x - from;
    ty_pile_destroy(pile);
    ty_container_destroy(box);
    return moved;
}

// Resistance of an arm of c radii holds a ball still up to tan a = c, without creep, and beyond takes its share of
// what turns the ball: 5/7 g (sin a - c cos a).
static void test_rolling_resistance(void** state)
{
    (void)state;
    const float c = 0.1f;
    assert_true(fabsf(slope_roll(ty_atan2(0.98f * c, 1.0f), c)) < 1e-7f);
    float a = 0.2f, ramp = 0.05f, from = 0.3f - 0.5f * ramp, to = 0.5f - 0.5f * ramp;
    float moved = 0.5f * 5.0f / 7.0f * 9.81f * (ty_sin(a) - c * ty_cos(a)) * (to * to - from * from);
    assert_true(fabsf(slope_roll(a, c) / moved - 1.0f) < 0.02f);
}

static double energy(const ty_pile* pile)
{
    const ty_body* b = ty_pile_bodies(pile);
    double sum = 0.0;
    for (int i = 0; i < ty_pile_count(pile); i++)
        sum += 0.5 * (double)(ty_length_sqr(b[i].velocity) + 0.4f * RADIUS * RADIUS * ty_length_sqr(b[i].spin));
    return sum;
}

// 64 balls fly about and hit each other without walls or weight. Where several hit at once, one sweep may leave some of
// an impulse that was kept from the substep before: no more than that is let through, and hardly any of it adds up.
static void fly_about(uint64_t seed, float rate)
{
    ty_pile_def def = weightless(0.5f);
    def.rate = rate;
    ty_pile* pile = ty_pile_create(&def);
    ty_rng rng = ty_rng_make((ty_seed){seed}, 0, 0);
    for (int i = 0; i < 64; i++)
    {
        ty_body b = ball_at((float)(i % 4), (float)(i / 4 % 4), (float)(i / 16));
        b.position = ty_mul(b.position, 2.3f * RADIUS);
        for (int k = 0; k < 3; k++)
            (&b.velocity.x)[k] = 0.2f * ty_element_bell(&rng), (&b.spin.x)[k] = 50.0f * ty_element_bell(&rng);
        b.velocity = ty_mad(b.velocity, ty_sub(b.position, ty_vec3_make(5e-3f, 5e-3f, 5e-3f)), -30.0f); // inwards
        ty_pile_add(pile, &b, 1);
    }
    ty_vec3 before = ty_pile_momentum(pile);
    double last = energy(pile), first = last, risen = 0.0;
    for (int i = 0; i < (int)(0.16f * rate); i++)
    {
        ty_pile_step(pile, NULL);
        double now = energy(pile);
        assert_true(now <= last * 1.002);
        risen += now > last ? now - last : 0.0;
        last = now;
    }
    assert_true(risen < 5e-4 * first);
    assert_true(last < 0.9 * first); // they did hit each other
    assert_true(ty_length(ty_sub(ty_pile_momentum(pile), before)) < 1e-4f);
    ty_pile_destroy(pile);
}

static void test_energy_never_grows(void** state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++)
        for (float rate = 2500.0f; rate < 6000.0f; rate *= 2.0f)
            fly_about(seed, rate);
}

// A body of three unequal moments of inertia, spun about the middle one, tumbles over and over (Euler): its angular
// momentum stays and so does its energy.
static void test_free_rotation(void** state)
{
    (void)state;
    const float moments[3] = {2.0f * RADIUS * RADIUS, 1.5f * RADIUS * RADIUS, RADIUS * RADIUS}; // per unit mass
    ty_element lump = balls[0];
    for (int k = 0; k < 3; k++)
        lump.inverse_inertia[k] = 1.0f / moments[k];
    ty_pile_def def = weightless(0.5f);
    def.grains = &lump;
    ty_pile* pile = ty_pile_create(&def);
    ty_body body = ball_at(0.0f, 0.0f, 0.0f);
    body.spin = ty_vec3_make(1.0f, 50.0f, 0.5f);
    ty_pile_add(pile, &body, 1);
    ty_vec3 first = {moments[0] * 1.0f, moments[1] * 50.0f, moments[2] * 0.5f};
    double energy = (double)ty_dot(first, body.spin);
    int flips = 0, side = 1;
    for (int i = 0; i < 5000; i++)
    {
        ty_pile_step(pile, NULL);
        const ty_body* b = ty_pile_bodies(pile);
        ty_quat q = b->rotation, back = {-q.x, -q.y, -q.z, q.w};
        ty_vec3 w = ty_quat_rotate(back, b->spin), l = {moments[0] * w.x, moments[1] * w.y, moments[2] * w.z};
        assert_true(ty_length(ty_sub(ty_quat_rotate(q, l), first)) < 1e-3f * ty_length(first));
        assert_true(fabs((double)ty_dot(l, w) / energy - 1.0) < 0.002);
        flips += w.y * (float)side < -25.0f;
        side = w.y * (float)side < -25.0f ? -side : side;
    }
    assert_true(flips >= 3);
    ty_pile_destroy(pile);
}

// --- bridges ---

static ty_bridge_def water(void)
{
    ty_bridge_def def = ty_bridge_def_default();
    def.tension = 0.072f;
    def.volume = 0.01f;
    def.angle = 0.3f;
    return def;
}

// Willett et al. 2000 written out: at contact, at half a radius' hundredth and at the rupture; and its parameters'
// sense.
static void test_force_curve(void** state)
{
    (void)state;
    ty_bridge_def def = water();
    double top = 2.0 * 3.14159265 * 1.5e-3 * 0.072 * cos(0.3);
    for (double gap = 0.0; gap < 0.5e-3; gap += 0.05e-3)
    {
        double s = gap * sqrt(1.5e-3 / (0.01 * pow(1.5e-3, 3.0)));
        double expected = top / (1.0 + 1.05 * s + 2.5 * s * s);
        assert_true(fabs((double)ty_bridge_pull(&def, RADIUS, RADIUS, (float)gap) / expected - 1.0) < 1e-4);
    }
    assert_true(ty_bridge_pull(&def, RADIUS, RADIUS, -1e-4f) == ty_bridge_pull(&def, RADIUS, RADIUS, 0.0f));
    double rupture = 1.15 * cbrt(0.01 * pow(1.5e-3, 3.0));
    assert_true(fabs((double)ty_bridge_end(&def, RADIUS) / rupture - 1.0) < 1e-4);
    def.adhesion = 0.1f;
    double pull_off = 0.75 * 3.14159265 * 0.1 * 1.5e-3;
    assert_true(fabs((double)ty_adhesion_force(&def, RADIUS, 0.0f) / pull_off - 1.0) < 1e-4);
    assert_true(fabs((double)ty_adhesion_force(&def, RADIUS, 0.015e-3f) / pull_off - 0.5) < 1e-3);
    assert_true(ty_bridge_of_moisture(0.2f).tension == 0.0f);
    assert_true(ty_bridge_of_moisture(0.4f).volume < ty_bridge_of_moisture(0.6f).volume);
    assert_true(ty_bridge_of_moisture(0.72f).tension < 0.5f * ty_bridge_of_moisture(0.6f).tension);
    assert_true(ty_bridge_of_moisture(0.8f).tension == 0.0f);
}

// Two balls that touch are torn apart. What is lost of their energy is the force's integral up to the rupture.
static void test_rupture_takes_its_work(void** state)
{
    (void)state;
    ty_pile_def def = weightless(0.5f);
    def.bridge = water();
    def.rate = 20000.0f;
    ty_pile* pile = ty_pile_create(&def);
    ty_body two[2] = {ball_at(0.0f, 0.0f, 0.0f), ball_at(2.0f * RADIUS, 0.0f, 0.0f)};
    const float speed = 0.25f;
    two[1].velocity.x = speed;
    ty_pile_add(pile, two, 2);
    steps(pile, 200);
    const ty_body* b = ty_pile_bodies(pile);
    assert_true(b[1].position.x - b[0].position.x > 2.0f * RADIUS + ty_bridge_end(&def.bridge, RADIUS));
    double work = 0.0, rupture = (double)ty_bridge_end(&def.bridge, RADIUS), step = rupture / 1000.0;
    for (int i = 0; i < 1000; i++)
        work += step * (double)ty_bridge_pull(&def.bridge, RADIUS, RADIUS, (float)((i + 0.5) * step));
    double reduced = 0.5 * (double)(def.bridge.density * balls[0].volume);
    double left = sqrt((double)(speed * speed) - 2.0 * work / reduced),
           got = (double)(b[1].velocity.x - b[0].velocity.x);
    assert_true(left < 0.9 * (double)speed);
    assert_true(fabs(got / left - 1.0) < 0.02);
    ty_pile_destroy(pile);
}

// Balls that have not touched have no bridge, however near they pass.
static void test_bridge_forms_at_contact(void** state)
{
    (void)state;
    ty_pile_def def = weightless(0.5f);
    def.bridge = water();
    ty_pile* pile = ty_pile_create(&def);
    ty_body two[2] = {ball_at(0.0f, 0.0f, 0.0f), ball_at(2.05f * RADIUS, 0.0f, 0.0f)};
    ty_pile_add(pile, two, 2);
    steps(pile, 200);
    assert_true(ty_pile_bodies(pile)[1].position.x == 2.05f * RADIUS);
    ty_pile_destroy(pile);
}

// Two balls that a bridge ties have fallen asleep, while two more are still under way: the first of these wakes the
// second ball and stops there, the other one drives both on, across. The first ball is not hit, but dragged along.
static void test_bridge_wakes(void** state)
{
    (void)state;
    ty_pile_def def = weightless(0.0f);
    def.bridge = water();
    ty_pile* pile = ty_pile_create(&def);
    ty_body four[4] = {ball_at(0.0f, 0.0f, 0.0f), ball_at(2.0f * RADIUS, 0.0f, 0.0f)};
    for (int i = 2; i < 4; i++)
    {
        four[i] = ball_at(2.0f * RADIUS, 2.0f * RADIUS + 0.022f, 0.0f);
        four[i].position.y += (float)(i - 2) * (2.0f * RADIUS + 1e-3f);
        four[i].velocity.y = -0.1f;
    }
    ty_pile_add(pile, four, 4);
    ty_pile_settle(pile, 0.3f, NULL, NULL);
    const ty_body* b = ty_pile_bodies(pile);
    assert_true(b[1].position.y < -0.5f * RADIUS);
    assert_true(ty_length(ty_sub(b[0].position, four[0].position)) > 0.02f * RADIUS);
    ty_pile_destroy(pile);
}

// Turns gravity round under a ball at the floor: it hangs when what pulls is more than its weight.
static bool hangs(ty_bridge_def bridge)
{
    ty_container* box = floor_make();
    ty_pile_def def = weightless(0.5f);
    def.bridge = bridge;
    def.container = box;
    def.gravity.y = 9.81f;
    ty_pile* pile = ty_pile_create(&def);
    ty_body body = ball_at(0.0f, -0.02f + RADIUS, 0.0f);
    ty_pile_add(pile, &body, 1);
    steps(pile, 500);
    bool held = ty_pile_bodies(pile)->position.y < -0.02f + 1.001f * RADIUS;
    ty_pile_destroy(pile);
    ty_container_destroy(box);
    return held;
}

static void test_a_ball_hangs(void** state)
{
    (void)state;
    ty_bridge_def bridge = water();
    float weight = 9.81f * bridge.density * balls[0].volume;
    float each = ty_bridge_pull(&bridge, RADIUS, 2.0f * RADIUS, 0.0f) / bridge.tension; // of a wall
    bridge.tension = 1.02f * weight / each;
    assert_true(hangs(bridge));
    bridge.tension = 0.98f * weight / each;
    assert_false(hangs(bridge));
    ty_bridge_def starch = ty_bridge_def_default();
    starch.adhesion = 1.0f;
    starch.adhesion = 1.02f * weight / ty_adhesion_force(&starch, 2.0f * RADIUS, 0.0f);
    assert_true(hangs(starch));
    starch.adhesion *= 0.96f;
    assert_false(hangs(starch));
}

// What pulls presses contacts in by its acceleration over their stiffness, (pi rate)^2 / 8: a quarter at twice the
// rate.
static void test_a_pull_presses_in(void** state)
{
    (void)state;
    for (int i = 1; i <= 2; i++)
    {
        ty_container* box = floor_make();
        ty_pile_def def = weightless(0.5f);
        def.rate = 2500.0f * (float)i;
        def.bridge.adhesion = 1.0f;
        def.container = box;
        ty_pile* pile = ty_pile_create(&def);
        ty_body body = ball_at(0.0f, -0.02f + RADIUS, 0.0f);
        ty_pile_add(pile, &body, 1);
        steps(pile, 1500);
        float pull = ty_adhesion_force(&def.bridge, 2.0f * RADIUS, 0.0f) / (def.bridge.density * def.grains[0].volume);
        float expected = 8.0f * pull / ty_sqr(TY_PI * def.rate),
              found = -0.02f + RADIUS - ty_pile_bodies(pile)->position.y;
        print_message("  %.3f um at %g substeps/s, %.3f expected\n", (double)found * 1e6, (double)def.rate,
                      (double)expected * 1e6);
        assert_true(fabsf(found / expected - 1.0f) < 0.02f);
        ty_pile_destroy(pile);
        ty_container_destroy(box);
    }
}

// --- moving walls ---

static ty_wall_motion belt(void* context, int wall, float seconds)
{
    (void)wall;
    const ty_vec3* velocity = context;
    return (ty_wall_motion){ty_mul(*velocity, seconds), ty_quat_identity(), *velocity, {0.0f, 0.0f, 0.0f}};
}

// Put on a belt, a ball slips until it rolls, at 2/7 of the belt's speed; on a lift it rises with the floor.
static void test_belt_and_lift(void** state)
{
    (void)state;
    ty_vec3 velocity = {0.1f, 0.05f, 0.0f};
    ty_container* box = floor_make();
    ty_pile_def def = weightless(0.5f);
    def.gravity.y = -9.81f;
    def.container = box;
    ty_pile* pile = ty_pile_create(&def);
    ty_body body = ball_at(0.0f, -0.02f + RADIUS, 0.0f);
    ty_pile_add(pile, &body, 1);
    ty_pile_move_walls(pile, belt, &velocity);
    steps(pile, 1000);
    const ty_body* b = ty_pile_bodies(pile);
    assert_true(fabsf(b->velocity.x / (2.0f / 7.0f * velocity.x) - 1.0f) < 0.02f);
    assert_true(fabsf(b->velocity.y / velocity.y - 1.0f) < 0.02f);
    float floor_y = -0.02f + velocity.y * ty_pile_time(pile);
    assert_true(fabsf(b->position.y - floor_y - RADIUS) < 0.02f * RADIUS);
    ty_pile_destroy(pile);
    ty_container_destroy(box);
}

// A quarter turn about z in a second.
static ty_wall_motion turning(void* context, int wall, float seconds)
{
    (void)context, (void)wall;
    const ty_vec3 axis = {0.0f, 0.0f, 1.0f};
    float angle = 0.5f * TY_PI * ty_min(seconds, 1.0f);
    ty_wall_motion m = {.rotation = ty_quat_axis_angle(axis, angle)};
    m.spin.z = seconds < 1.0f ? 0.5f * TY_PI : 0.0f;
    return m;
}

// Balls in a box that is turned end up on what was its side.
static void test_turned_box(void** state)
{
    (void)state;
    ty_container_def room = ty_container_def_default();
    room.kind = TY_CONTAINER_BOX;
    room.shape.size = ty_vec3_make(0.01f, 0.01f, 0.01f);
    room.shape.rounding = 0.0f;
    ty_container* box;
    ty_error error;
    assert_int_equal(ty_container_create(&room, NULL, &box, &error), TY_OK);
    ty_pile_def def = weightless(0.5f);
    def.gravity.y = -9.81f;
    def.rolling = 0.02f;
    def.container = box;
    ty_pile* pile = ty_pile_create(&def);
    for (int i = 0; i < 8; i++)
    {
        ty_body body = ball_at(4.5e-3f * (float)(i % 2) - 2e-3f, -7e-3f, 4e-3f * (float)(i / 2) - 6e-3f);
        ty_pile_add(pile, &body, 1);
    }
    ty_pile_move_walls(pile, turning, NULL);
    assert_int_equal(ty_pile_settle(pile, 3.0f, NULL, NULL), TY_PILE_REST);
    assert_true(ty_pile_time(pile) > 1.0f);
    int lowest = 0;
    for (int i = 1; i < 8; i++)
        if (ty_pile_bodies(pile)[i].position.y < ty_pile_bodies(pile)[lowest].position.y)
            lowest = i;
    ty_vec3 p = ty_pile_bodies(pile)[lowest].position;
    assert_true(fabsf(p.y + 0.01f - RADIUS) < 0.02f * RADIUS);
    ty_pile_destroy(pile);
    ty_container_destroy(box);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_central_impact),
        cmocka_unit_test(test_slow_impact),
        cmocka_unit_test(test_oblique_impact),
        cmocka_unit_test(test_rolls_and_slips),
        cmocka_unit_test(test_rolling_resistance),
        cmocka_unit_test(test_energy_never_grows),
        cmocka_unit_test(test_free_rotation),
        cmocka_unit_test(test_force_curve),
        cmocka_unit_test(test_rupture_takes_its_work),
        cmocka_unit_test(test_bridge_forms_at_contact),
        cmocka_unit_test(test_bridge_wakes),
        cmocka_unit_test(test_a_pull_presses_in),
        cmocka_unit_test(test_a_ball_hangs),
        cmocka_unit_test(test_belt_and_lift),
        cmocka_unit_test(test_turned_box),
    };
    return cmocka_run_group_tests(tests, group_setup, NULL);
}
