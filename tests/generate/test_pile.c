// SPDX-License-Identifier: Apache-2.0
// The mechanics of a pile: free fall, momentum, friction on a slope, rest, overlaps, and the same bits for any workers.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/hash.h>
#include <tsuya/generate/pile.h>

enum
{
    VARIANTS = 4,
};

static ty_element grains[VARIANTS];
static float mean_volume;

static int group_setup(void** state)
{
    (void)state;
    ty_element_def def = ty_element_def_default();
    ty_error error;
    for (int i = 0; i < VARIANTS; i++)
    {
        assert_int_equal(ty_element_init(&def, (ty_seed){5}, i, &grains[i], &error), TY_OK);
        mean_volume += grains[i].volume / VARIANTS;
    }
    return 0;
}

static int group_teardown(void** state)
{
    (void)state;
    for (int i = 0; i < VARIANTS; i++)
        ty_element_term(&grains[i]);
    return 0;
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

static float rate = 2500.0f; // 1/s

static ty_pile* pile_make(const ty_container* container, float friction)
{
    ty_pile_def def = ty_pile_def_default();
    def.grains = grains;
    def.grain_count = VARIANTS;
    def.container = container;
    def.friction = friction;
    def.rate = rate;
    return ty_pile_create(&def);
}

static ty_body body_at(float x, float y, float z)
{
    return (ty_body){.position = {x, y, z}, .rotation = ty_quat_identity(), .scale = 1.0f};
}

// After the ramp of gravity: y = g (t - ramp/2)^2 / 2 + g ramp^2 / 24, v = g (t - ramp / 2).
static void test_free_fall(void** state)
{
    (void)state;
    ty_pile* pile = pile_make(NULL, 0.5f);
    ty_body body = body_at(0.0f, 0.0f, 0.0f);
    body.velocity.x = 0.1f;
    ty_pile_add(pile, &body, 1);
    const double ramp = 0.05, t = 0.2, g = 9.81;
    for (int i = 0; i < 500; i++)
        ty_pile_step(pile, NULL);
    const ty_body* b = ty_pile_bodies(pile);
    double fall = g * (t - ramp / 2) * (t - ramp / 2) / 2 + g * ramp * ramp / 24;
    assert_true(fabs(-(double)b->position.y / fall - 1.0) < 0.01);
    assert_true(fabs(-(double)b->velocity.y / (g * (t - ramp / 2)) - 1.0) < 0.005);
    assert_true(fabs((double)b->position.x - 0.02) < 1e-5);
    assert_true(ty_length(b->spin) == 0.0f);
    ty_pile_destroy(pile);
}

// Two grains hit each other off centre, without gravity: they part, spin, and no momentum is made or lost.
// Of the body's own rotation, for density 1.
static ty_vec3 spin_momentum(const ty_body* body)
{
    const ty_element* grain = &grains[body->grain];
    const float* s = grain->inverse_inertia;
    const ty_vec3 x = {s[0], s[3], s[4]}, y = {s[3], s[1], s[5]}, z = {s[4], s[5], s[2]};
    ty_quat q = body->rotation, back = {-q.x, -q.y, -q.z, q.w};
    ty_vec3 w = ty_quat_rotate(back, body->spin), yz = ty_cross(y, z);
    ty_vec3 l = {ty_dot(w, yz), ty_dot(w, ty_cross(z, x)), ty_dot(w, ty_cross(x, y))};
    return ty_mul(ty_quat_rotate(q, l), grain->volume / ty_dot(x, yz));
}

static ty_vec3 angular_momentum(const ty_body* bodies, int count)
{
    ty_vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < count; i++)
    {
        ty_vec3 orbit = ty_mul(ty_cross(bodies[i].position, bodies[i].velocity), grains[bodies[i].grain].volume);
        sum = ty_add(sum, ty_add(orbit, spin_momentum(&bodies[i])));
    }
    return sum;
}

static void test_momentum(void** state)
{
    (void)state;
    ty_pile_def def = ty_pile_def_default();
    def.grains = grains;
    def.grain_count = VARIANTS;
    def.gravity = ty_vec3_make(0.0f, 0.0f, 0.0f);
    ty_pile* pile = ty_pile_create(&def);
    ty_body two[2] = {body_at(0.0f, 0.0f, 0.0f), body_at(0.0035f, 0.0045f, 0.0003f)};
    two[0].velocity = ty_vec3_make(0.05f, 0.3f, 0.0f);
    two[1].grain = 1;
    ty_pile_add(pile, two, 2);
    ty_vec3 before = ty_pile_momentum(pile), angular = angular_momentum(two, 2);
    const ty_body* b = ty_pile_bodies(pile);
    for (int i = 0; i < 100; i++)
    {
        ty_pile_step(pile, NULL);
        ty_vec3 lost = ty_sub(angular_momentum(b, 2), angular); // the two arms end a gap of up to .03 mm apart
        assert_true(ty_length(lost) <= 1e-18f + 0.03f * ty_length(spin_momentum(&b[0])));
    }
    assert_true(ty_length(ty_sub(ty_pile_momentum(pile), before)) < 1e-6f);
    assert_true(b[1].velocity.y > 0.05f); // there was a collision
    assert_true(ty_length(b[0].velocity) < 0.3f);
    assert_true(ty_length(b[0].spin) > 1.0f);
    ty_pile_destroy(pile);
}

static void test_drop_comes_to_rest(void** state)
{
    (void)state;
    ty_container* box = box_make(0.03f, 0.03f, 0.03f);
    ty_pile* pile = pile_make(box, 0.5f);
    ty_body body = body_at(0.0f, -0.022f, 0.0f);
    body.rotation = ty_quat_euler(ty_vec3_make(0.4f, 0.3f, 0.7f));
    ty_pile_add(pile, &body, 1);
    assert_int_equal(ty_pile_settle(pile, 3.0f, NULL, NULL), TY_PILE_REST);
    ty_pile_metrics metrics;
    bool held;
    ty_pile_measure(pile, &metrics, &held);
    assert_true(held && metrics.floating == 0);
    assert_true(metrics.overlap_max < 0.01f);
    float height = ty_pile_bodies(pile)->position.y + 0.03f;
    assert_true(height > 0.35f * 0.0025f && height < 0.75f * 0.003f); // it lies on its side
    ty_pile_destroy(pile);
    ty_container_destroy(box);
}

// How far a grain that lies at rest, along x, moves in .3 s, the floor tilted by angle for .3 s.
static float slide(float angle, float friction)
{
    ty_container* box = box_make(1.0f, 0.02f, 0.05f);
    ty_pile_def def = ty_pile_def_default();
    def.grains = grains;
    def.grain_count = VARIANTS;
    def.container = box;
    def.friction = friction;
    ty_pile* pile = ty_pile_create(&def);
    ty_body body = body_at(0.0f, -0.02f + 0.0014f, 0.0f);
    ty_pile_add(pile, &body, 1);
    assert_int_equal(ty_pile_settle(pile, 3.0f, NULL, NULL), TY_PILE_REST);
    body = ty_pile_bodies(pile)[0];
    ty_pile_destroy(pile);
    def.gravity = ty_vec3_make(9.81f * ty_sin(angle), -9.81f * ty_cos(angle), 0.0f);
    pile = ty_pile_create(&def);
    ty_pile_add(pile, &body, 1);
    for (int i = 0; i < 750; i++)
        ty_pile_step(pile, NULL);
    float from = ty_pile_bodies(pile)->position.x;
    for (int i = 0; i < 750; i++)
        ty_pile_step(pile, NULL);
    float moved = ty_pile_bodies(pile)->position.x - from;
    ty_pile_destroy(pile);
    ty_container_destroy(box);
    return moved;
}

static void test_slope(void** state)
{
    (void)state;
    for (float mu = 0.3f; mu < 0.7f; mu += 0.3f)
    {
        float critical = ty_atan2(mu, 1.0f);
        assert_true(slide(0.98f * critical, mu) < 1e-5f);
        assert_true(slide(1.02f * critical, mu) > 1e-3f);
    }
}

// --- small piles in a box ---

typedef struct settled
{
    ty_pile* pile;
    ty_container* box;
    ty_pile_metrics filled, rest;
    ty_pile_end end;
} settled;

static settled pile_settled(int count, float friction, float seconds, ty_workers* workers)
{
    settled s = {0};
    float edge = 0.5f * ty_pow((float)count * mean_volume / 0.55f, 1.0f / 3.0f);
    s.box = box_make(edge, edge, edge);
    s.pile = pile_make(s.box, friction);
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    for (int i = 0; i < count; i++)
    {
        float u = ty_rng_float(&rng), v = ty_rng_float(&rng), w = ty_rng_float(&rng);
        ty_body body = body_at((1.8f * u - 0.9f) * edge, (1.8f * v - 0.9f) * edge, (1.8f * w - 0.9f) * edge);
        u = ty_rng_float(&rng), v = ty_rng_float(&rng), w = ty_rng_float(&rng);
        body.rotation = ty_quat_uniform(u, v, w);
        body.grain = (uint32_t)(i % VARIANTS);
        ty_pile_add(s.pile, &body, 1);
    }
    ty_fill_top top = {.level = edge, .radius_x = edge, .radius_z = edge};
    ty_pile_inflate(s.pile, &top, 400, workers);
    ty_pile_measure(s.pile, &s.filled, NULL);
    s.end = ty_pile_settle(s.pile, seconds, workers, NULL);
    ty_pile_measure(s.pile, &s.rest, NULL);
    return s;
}

static void settled_term(settled* s)
{
    ty_pile_destroy(s->pile);
    ty_container_destroy(s->box);
}

static void test_small_pile_rests(void** state)
{
    (void)state;
    enum
    {
        COUNT = 150
    };
    settled s = pile_settled(COUNT, 0.5f, 2.0f, NULL);
    assert_int_equal(s.end, TY_PILE_REST);
    assert_true(s.rest.speed_rms < 0.3e-3f);
    assert_int_equal(s.rest.floating, 0);
    assert_true(s.rest.contacts > 4.0f);
    assert_true(s.rest.overlap_max < 0.03f && s.rest.overlap_mean < 0.004f);
    static ty_body before[COUNT];
    memcpy(before, ty_pile_bodies(s.pile), sizeof before);
    for (int i = 0; i < 750; i++)
        ty_pile_step(s.pile, NULL);
    double drift = 0.0;
    for (int i = 0; i < COUNT; i++)
        drift += (double)ty_length(ty_sub(ty_pile_bodies(s.pile)[i].position, before[i].position)) / COUNT;
    assert_true(drift < 0.001 * (double)grains[0].width);
    ty_pile_polish(s.pile, 100, NULL);
    ty_pile_metrics polished;
    ty_pile_measure(s.pile, &polished, NULL);
    assert_true(polished.overlap_max < 2e-4f);
    assert_int_equal(polished.floating, 0);
    settled_term(&s);
}

static void test_friction_holds_the_pile_open(void** state)
{
    (void)state;
    settled rough = pile_settled(400, 0.5f, 1.0f, NULL), smooth = pile_settled(400, 0.0f, 1.0f, NULL);
    assert_true(smooth.rest.phi > rough.rest.phi + 0.005f);
    assert_true(rough.rest.phi > 0.5f && smooth.rest.phi < 0.8f);
    settled_term(&rough);
    settled_term(&smooth);
}

static float mean_height(const settled* s)
{
    float sum = 0.0f;
    for (int i = 0; i < ty_pile_count(s->pile); i++)
        sum += ty_pile_bodies(s->pile)[i].position.y - ty_container_interior(s->box).low.y;
    return sum / (float)ty_pile_count(s->pile);
}

// Twice as many substeps: the pile that comes to rest is as high and as dense.
static void test_substeps_do_not_matter(void** state)
{
    (void)state;
    settled usual = pile_settled(400, 0.5f, 2.0f, NULL);
    rate *= 2.0f;
    settled twice = pile_settled(400, 0.5f, 2.0f, NULL);
    rate *= 0.5f;
    assert_true(usual.end == TY_PILE_REST && twice.end == TY_PILE_REST);
    assert_true(fabsf(mean_height(&twice) / mean_height(&usual) - 1.0f) < 0.02f);
    assert_true(fabsf(twice.rest.phi / usual.rest.phi - 1.0f) < 0.03f);
    settled_term(&usual);
    settled_term(&twice);
}

static ty_hash state_hash(int count, int thread_count)
{
    ty_workers* workers = NULL;
    ty_error error;
    assert_int_equal(ty_workers_create(thread_count, &workers, &error), TY_OK);
    settled s = pile_settled(count, 0.5f, 0.06f, workers);
    ty_pile_polish(s.pile, 10, workers);
    ty_hash hash = ty_hash_bytes(ty_pile_bodies(s.pile), (size_t)count * sizeof(ty_body));
    settled_term(&s);
    ty_workers_destroy(workers);
    return hash;
}

// Enough grains that colours and bodies are shared out.
static void test_same_bits_for_any_workers(void** state)
{
    (void)state;
    ty_hash one = state_hash(2500, 1), two = state_hash(2500, 2), three = state_hash(2500, 3);
    assert_memory_equal(&one, &two, sizeof one);
    assert_memory_equal(&one, &three, sizeof one);
}

// What is left keeps its place and stays at rest when a grain at the top goes.
static void test_removal_keeps_impulses(void** state)
{
    (void)state;
    settled s = pile_settled(100, 0.5f, 2.0f, NULL);
    bool gone[100] = {false};
    int top = 0;
    for (int i = 1; i < 100; i++)
        if (ty_pile_bodies(s.pile)[i].position.y > ty_pile_bodies(s.pile)[top].position.y)
            top = i;
    gone[top] = true;
    ty_pile_remove(s.pile, gone);
    assert_int_equal(ty_pile_count(s.pile), 99);
    ty_pile_step(s.pile, NULL);
    ty_pile_metrics metrics;
    ty_pile_measure(s.pile, &metrics, NULL);
    assert_true(metrics.speed_rms < 2e-3f); // without the impulses of their contacts grains would fall by g h = 4 mm/s
    settled_term(&s);
}

static void test_what_floats(void** state)
{
    (void)state;
    // On the floor; alone in the air; and two in the air that touch each other alone.
    ty_container* box = box_make(0.02f, 0.02f, 0.02f);
    ty_pile* pile = pile_make(box, 0.5f);
    ty_body four[4] = {body_at(0.01f, -0.019f, 0.0f), body_at(0.0f, 0.0f, 0.0f), body_at(-0.01f, 0.01f, 0.0f),
                       body_at(-0.01f, 0.012f, 0.0f)};
    ty_pile_add(pile, four, 4);
    ty_pile_metrics metrics;
    bool held[4];
    ty_pile_measure(pile, &metrics, held);
    assert_true(held[0] && !held[1] && !held[2] && !held[3]);
    assert_int_equal(metrics.floating, 3);
    assert_true(metrics.neighbours == 0.5f);
    ty_pile_destroy(pile);
    ty_container_destroy(box);
}

static void test_depth(void** state)
{
    (void)state;
    ty_pile* pile = pile_make(NULL, 0.5f);
    ty_body three[3] = {body_at(0.0f, 0.0f, 0.0f), body_at(0.0f, 0.01f, 0.0f), body_at(0.02f, 0.003f, 0.0f)};
    ty_pile_add(pile, three, 3);
    float depth[3];
    ty_pile_depth(pile, depth);
    assert_true(depth[0] > 0.009f && depth[0] < 0.0105f);
    assert_true(depth[1] < 1e-3f);
    assert_true(depth[2] < 1e-3f);
    ty_pile_destroy(pile);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_fall),
        cmocka_unit_test(test_momentum),
        cmocka_unit_test(test_drop_comes_to_rest),
        cmocka_unit_test(test_slope),
        cmocka_unit_test(test_small_pile_rests),
        cmocka_unit_test(test_friction_holds_the_pile_open),
        cmocka_unit_test(test_substeps_do_not_matter),
        cmocka_unit_test(test_same_bits_for_any_workers),
        cmocka_unit_test(test_removal_keeps_impulses),
        cmocka_unit_test(test_what_floats),
        cmocka_unit_test(test_depth),
    };
    return cmocka_run_group_tests(tests, group_setup, group_teardown);
}
