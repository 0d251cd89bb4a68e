// SPDX-License-Identifier: Apache-2.0
// Rings of tubes: frames that do not twist, no sections through one another, the thesis' spread where branches meet
// roots.
#include "base/cmocka_all.h"
#include "roots_tubes.h"
#include <math.h>

// --- frames and bends, of lines made here ---

enum
{
    POINTS = 400,
    UNBROKEN = 21, // points of a branch that has met nothing
};

typedef struct single
{
    roots_point points[POINTS];
    roots_line line;
    roots_network net;
    ty_roots_recipe recipe;
    tubes_def def;
} single;

static void single_set(single* s, float r)
{
    s->line = (roots_line){.count = POINTS, .kind = ROOTS_MAIN, .parent = -1, .end = -1};
    for (int i = 0; i < POINTS; i++)
    {
        roots_point* p = &s->points[i];
        ty_vec3 step = i > 0 ? ty_sub(p->p, p[-1].p) : (ty_vec3){0.0f, 0.0f, 0.0f};
        p->r = r;
        p->flat = 1.0f;
        p->n = (ty_vec3){0.0f, 0.0f, 1.0f};
        p->s = i > 0 ? p[-1].s + ty_length(step) : 0.0f;
    }
    s->net = (roots_network){.points = s->points, .point_count = POINTS, .lines = &s->line, .line_count = 1};
    s->recipe = ty_roots_recipe_default();
    s->def = (tubes_def){&s->recipe, &s->net, 16, 1.0f - ty_cos(TY_PI / 16.0f), 8.0f, false};
}

// About a helix the frame that turns least falls behind the curve's own by its torsion.
static void frames_do_not_twist(void** state)
{
    (void)state;
    const float a = 0.02f, b = 0.01f, turns = 2.5f * 2.0f * TY_PI;
    const float speed = sqrtf(a * a + b * b), torsion = b / (a * a + b * b);
    static single s;
    for (int i = 0; i < POINTS; i++)
    {
        float t = turns * (float)i / (POINTS - 1);
        s.points[i].p = (ty_vec3){a * ty_cos(t), a * ty_sin(t), b * t};
    }
    single_set(&s, 2e-3f);
    tube_ring* rings = TY_ALLOC(tube_ring, POINTS + TUBE_CAP);
    int count = tube_rings(&s.def, 0, rings) - 4; // but the round end
    assert_true(count > 20 && count < POINTS);    // there are enough points to choose from
    float first = 0.0f, worst = 0.0f;
    for (int i = 1; i < count - 1; i++) // tangents at the ends are of one side
    {
        float t = rings[i].at.s / speed;
        ty_vec3 inward = {-ty_cos(t), -ty_sin(t), 0.0f}, beside = ty_cross(rings[i].t, inward);
        float turn = ty_atan2(ty_dot(rings[i].e1, beside), ty_dot(rings[i].e1, inward)) + torsion * rings[i].at.s;
        first = i == 1 ? turn : first;
        float off = (turn - first) / (2.0f * TY_PI);
        worst = ty_max(worst, fabsf(off - floorf(off + 0.5f)) * 360.0f);
    }
    print_message("frames: off by %.2f degrees at most on %.0f degrees of torsion\n", (double)worst,
                  (double)(torsion * turns * speed * 180.0f / TY_PI));
    assert_true(worst < 0.5f);
    ty_free(rings);
}

// Vertices of each ring lie ahead of those of the ring before.
static int crossings(const single* s, float* off)
{
    tube_ring* rings = TY_ALLOC(tube_ring, POINTS + TUBE_CAP);
    int count = tube_rings(&s->def, 0, rings) - 4, found = 0;
    *off = 0.0f;
    for (int i = 0; i + 1 < count; i++)
        for (int k = 0; k < s->def.divisions; k++)
        {
            ty_vec3 step = ty_sub(tube_vertex(&s->def, &rings[i + 1], k), tube_vertex(&s->def, &rings[i], k));
            found += ty_dot(step, rings[i].t) <= 0.0f || ty_dot(step, rings[i + 1].t) <= 0.0f;
        }
    for (int p = 0; p < POINTS; p++) // the line against the rings' middles
    {
        float least = 1.0f;
        for (int i = 0; i + 1 < count; i++)
        {
            ty_vec3 d = ty_sub(rings[i + 1].at.p, rings[i].at.p), e = ty_sub(s->points[p].p, rings[i].at.p);
            float t = ty_clamp(ty_dot(e, d) / ty_length_sqr(d), 0.0f, 1.0f);
            least = ty_min(least, ty_length(ty_mad(e, d, -t)));
        }
        *off = ty_max(*off, least / s->points[p].r);
    }
    ty_free(rings);
    return found;
}

// Straight, a bend of so many half turns, straight.
static void bend_make(single* s, float bend, float halves)
{
    for (int i = 0; i < POINTS; i++)
    {
        float t = (2.0f + halves) * (float)i / (POINTS - 1) - 1.0f, a = ty_clamp(t, 0.0f, halves) * TY_PI;
        float over = t - ty_clamp(t, 0.0f, halves);
        ty_vec3 on = {ty_sin(a), 1.0f - ty_cos(a), 0.0f}, way = {ty_cos(a), ty_sin(a), 0.0f};
        s->points[i].p = ty_mul(ty_mad(on, way, over * TY_PI), bend);
    }
    single_set(s, 1e-3f);
}

static void sections_keep_apart_in_bends(void** state)
{
    (void)state;
    static single s;
    float off;
    bend_make(&s, 1.15e-3f, 1.5f); // a bend little wider than the root is thick keeps its line
    assert_int_equal(crossings(&s, &off), 0);
    assert_true(off < 2.0f * s.def.sag);
    bend_make(&s, 0.5e-3f, 0.5f); // in a tighter one rings are left out
    assert_int_equal(crossings(&s, &off), 0);
    assert_true(off < 0.5f);
}

// --- the thesis' spread ---

static ty_roots_recipe recipe_for(int method)
{
    ty_roots_recipe r = ty_roots_recipe_default();
    r.host.kind = TY_ROOTS_HOST_BOX;
    r.host.shape.size = (ty_vec3){0.03f, 0.06f, 0.03f};
    r.host.shape.rounding = 0.0f;
    r.host.resolution = 96;
    r.tip = 1.2e-3f;
    r.method = method;
    r.thesis.fall = 100.0f;
    r.count = method == TY_ROOTS_SEED ? 6 : 8;
    return r;
}

typedef struct grown
{
    roots_host host;
    roots_network net;
} grown;

static void grow(const ty_roots_recipe* recipe, grown* out)
{
    ty_error error;
    assert_int_equal(roots_host_init(recipe, NULL, NULL, &out->host, &error), TY_OK);
    assert_int_equal(roots_grow(recipe, &out->host, NULL, &out->net, &error), TY_OK);
}

static void drop(grown* g)
{
    roots_network_term(&g->net);
    roots_host_term(&g->host);
}

// (3.16): half of the circle, turned about y by the angle between z and the way from end to end, about the growth point
// three before, the other half about that two after; at its end two and two.
static float spread_error(const tubes_def* def, const roots_line* l, const tube_ring* ring, bool end)
{
    const roots_point* points = def->network->points;
    int n = def->divisions, at = end ? l->end_point : l->parent_point;
    ty_vec3 k = ty_sub(points[l->first].p, points[l->first + l->count - 1].p);
    float length = sqrtf(k.x * k.x + k.z * k.z), worst = 0.0f;
    ty_vec3 aside = {k.z / length, 0.0f, -k.x / length};
    for (int i = 0; i < n; i++)
    {
        float angle = 2.0f * TY_PI * (float)i / (float)n, best = 1.0f;
        ty_vec3 circle = ty_mul(aside, def->recipe->radius * ty_cos(angle));
        circle.y = def->recipe->radius * ty_sin(angle);
        ty_vec3 wanted = ty_add(circle, points[i < n / 2 ? at - (end ? 2 : 3) : at + 2].p);
        for (int j = 0; j < n; j++)
            best = ty_min(best, ty_length(ty_sub(tube_vertex(def, ring, j), wanted)));
        worst = ty_max(worst, best);
    }
    return worst / def->recipe->radius;
}

static void branches_spread_as_in_the_thesis(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(TY_ROOTS_SEED);
    recipe.thesis.fall = 1.0f; // few obstacles: branches of 21 points
    grown g;
    grow(&recipe, &g);
    const tubes_def def = {&recipe, &g.net, 16, 0.02f, 8.0f, true};
    tube_ring* rings = TY_ALLOC(tube_ring, 4096);
    int seen = 0;
    for (int i = 0; i < g.net.line_count; i++)
    {
        const roots_line* l = &g.net.lines[i];
        if (l->kind != ROOTS_FIRST || l->end < 0 || l->count != UNBROKEN)
            continue;
        const roots_line* to = &g.net.lines[l->end];
        if (l->parent_point + 2 >= g.net.lines[l->parent].first + g.net.lines[l->parent].count ||
            l->end_point + 2 >= to->first + to->count)
            continue;
        int count = tube_rings(&def, i, rings);
        assert_int_equal(count, UNBROKEN);
        assert_true(spread_error(&def, l, &rings[0], false) < 1e-3f);
        assert_true(spread_error(&def, l, &rings[count - 1], true) < 1e-3f);
        assert_true(rings[0].join == 1.0f && rings[count - 1].join == 1.0f);
        float half = 0.5f * (rings[0].at.s + rings[count - 1].at.s);
        for (int k = 1; k < count; k++) // ever narrower towards the middle
            if (rings[k].at.s < half)
                assert_true(rings[k].join <= rings[k - 1].join);
            else if (rings[k - 1].at.s > half)
                assert_true(rings[k].join >= rings[k - 1].join);
        seen++;
    }
    assert_true(seen > 3);
    ty_free(rings);
    drop(&g);
}

// Of ours they spread within the root that they leave, and none where they run along it.
static void our_branches_begin_within_roots(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(TY_ROOTS_WRAP);
    grown g;
    grow(&recipe, &g);
    const tubes_def def = {&recipe, &g.net, 16, 0.02f, 8.0f, false};
    tube_ring* rings = TY_ALLOC(tube_ring, 8192);
    int spread = 0, out = 0, vertices = 0;
    for (int i = 0; i < g.net.line_count; i++)
    {
        const roots_line* l = &g.net.lines[i];
        if (l->kind != ROOTS_FIRST && l->kind != ROOTS_SECOND)
            continue;
        const roots_line* from = &g.net.lines[l->parent];
        assert_true(tube_rings(&def, i, rings) > 1);
        spread += rings[0].join > 0.0f;
        for (int k = 0; k < def.divisions; k++)
        {
            ty_vec3 p = tube_vertex(&def, &rings[0], k);
            float least = TY_FLOAT_MAX;
            for (int j = from->first; j < from->first + from->count; j++)
                least = ty_min(least, ty_length(ty_sub(p, g.net.points[j].p)) / g.net.points[j].r);
            out += least > 1.15f;
            vertices++;
        }
    }
    assert_true(spread > 10);
    assert_true(50 * out < vertices);
    ty_free(rings);
    drop(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_do_not_twist),
        cmocka_unit_test(sections_keep_apart_in_bends),
        cmocka_unit_test(branches_spread_as_in_the_thesis),
        cmocka_unit_test(our_branches_begin_within_roots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
