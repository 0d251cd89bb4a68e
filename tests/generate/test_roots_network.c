// SPDX-License-Identifier: Apache-2.0
// The net of centre lines: nothing asked for is missing, nothing kinks or goes into the host, small changes stay small.
#include "roots_grown.h"
#include "roots_hosts.h"
#include <stdlib.h>
#include <string.h>

// --- what is measured ---

static float angle_at(ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    ty_vec3 u = ty_sub(a, b), v = ty_sub(c, b);
    return acosf(ty_clamp(ty_dot(u, v) / (ty_length(u) * ty_length(v)), -1.0f, 1.0f)) * 180.0f / TY_PI;
}

static int ascending(const void* a, const void* b)
{
    float x = *(const float*)a, y = *(const float*)b;
    return (x > y) - (x < y);
}

typedef struct measures
{
    float least, low;     // degrees within lines: the least, and of one in a hundred
    float join, join_low; // the same where lines meet
    float deep;           // the deepest centre under where it should be, of its radius
    int asked, got, first, second;
    int apart; // lines that nothing leads to from the trunk
} measures;

// Lines that the first does not reach over parents and ends, of those that begin and end where those are.
static int apart(const roots_network* net)
{
    bool* reached = calloc((size_t)net->line_count, sizeof *reached);
    int count = net->line_count - 1;
    reached[0] = true;
    for (bool more = true; more;)
    {
        more = false;
        for (int i = 0; i < net->line_count; i++)
            for (int k = 0; k < 2; k++)
            {
                const roots_line* l = &net->lines[i];
                int other = k ? l->end : l->parent, there = k ? l->end_point : l->parent_point;
                int here = k ? l->first + l->count - 1 : l->first;
                if (other < 0 || reached[i] == reached[other])
                    continue;
                float most = l->kind == ROOTS_MAIN ? net->points[there].r + net->points[here].r : 0.0f;
                if (!(ty_length(ty_sub(net->points[there].p, net->points[here].p)) <= most))
                    continue;
                reached[i] = reached[other] = more = true;
                count--;
            }
    }
    free(reached);
    return count;
}

// The straighter way on into the other line.
static float join_angle(const roots_network* net, ty_vec3 before, int line, int point)
{
    const roots_line* l = &net->lines[line];
    ty_vec3 p = net->points[point].p;
    float best = 0.0f;
    if (point > l->first)
        best = ty_max(best, angle_at(before, p, net->points[point - 1].p));
    if (point + 1 < l->first + l->count)
        best = ty_max(best, angle_at(before, p, net->points[point + 1].p));
    return best;
}

static measures measure(const grown* g)
{
    const roots_network* net = &g->net;
    measures m = {.deep = -1.0f, .first = net->grown[ROOTS_FIRST], .second = net->grown[ROOTS_SECOND]};
    float* angles = malloc((size_t)net->point_count * sizeof *angles);
    float* joins = malloc(2 * (size_t)net->line_count * sizeof *joins);
    int count = 0, join_count = 0;
    for (int line = 0; line < net->line_count; line++)
    {
        const roots_line* l = &net->lines[line];
        const roots_point* p = net->points + l->first;
        for (int i = 0; i < l->count; i++)
        {
            ty_vec3 n;
            if (i > 0 && i + 1 < l->count)
                angles[count++] = angle_at(p[i - 1].p, p[i].p, p[i + 1].p);
            if (p[i].sink > 0.0f && l->kind != ROOTS_TRUNK)
                m.deep = ty_max(m.deep, ((p[i].flat - p[i].sink) * p[i].r -
                                         roots_host_exact(&g->host, p[i].p, 4.0f * p[i].r + g->host.field.step, &n)) /
                                            p[i].r);
        }
        if (l->parent >= 0 && l->kind != ROOTS_MAIN) // which run beside the trunk
            joins[join_count++] = join_angle(net, p[1].p, l->parent, l->parent_point);
        if (l->end >= 0)
            joins[join_count++] = join_angle(net, p[l->count - 2].p, l->end, l->end_point);
    }
    qsort(angles, (size_t)count, sizeof *angles, ascending);
    qsort(joins, (size_t)join_count, sizeof *joins, ascending);
    m.least = angles[0];
    m.low = angles[count / 100];
    m.join = join_count ? joins[0] : 180.0f;
    m.join_low = join_count ? joins[join_count / 100] : 180.0f;
    for (int k = 0; k < ROOTS_KINDS; k++)
    {
        m.asked += net->requested[k];
        m.got += net->grown[k];
    }
    m.apart = apart(net);
    free(angles);
    free(joins);
    return m;
}

// --- hosts ---

enum
{
    GROUND,
    PILLAR,
    COMPOUND,
    KNOT,
    BUST,
    ROUGH,
    HOSTS,
};

static const char* const names[] = {"ground", "pillar", "compound", "knot", "bust", "rough"};

static ty_roots_recipe recipe_for(int host)
{
    ty_roots_recipe r = ty_roots_recipe_default();
    static const char* const files[] = {NULL,           NULL,           "net_compound.ply",
                                        "net_knot.ply", "net_bust.ply", "net_rough.ply"};
    r.tip = r.detail = 0.8e-3f;
    r.length = 0.5f;
    r.host.kind = TY_ROOTS_HOST_BOX;
    r.host.shape.size = host == GROUND ? (ty_vec3){0.3f, 0.01f, 0.3f} : (ty_vec3){0.02f, 0.1f, 0.02f};
    r.host.shape.rounding = 0.0f;
    if (host >= COMPOUND)
    {
        r.host.kind = TY_ROOTS_HOST_MESH;
        r.host.mesh = files[host];
    }
    r.host.floor = host != GROUND;
    return r;
}

static int hosts_make(void** state)
{
    (void)state;
    host_implicit("net_compound.ply", distance_compound, (ty_vec3){0.06f, 0.115f, 0.06f}, 0.7e-3f);
    host_implicit("net_bust.ply", distance_bust, (ty_vec3){0.07f, 0.12f, 0.06f}, 0.7e-3f);
    host_lying_knot("net_knot.ply", 0.08f, 0.014f, 600, 48);
    host_rough("net_rough.ply", 0.05f, 1160);
    return 0;
}

static void all_that_is_asked_for_grows(void** state)
{
    (void)state;
    for (int host = 0; host < HOSTS; host++)
    {
        ty_roots_recipe recipe = recipe_for(host);
        grown g;
        grow(&recipe, NULL, &g);
        measures m = measure(&g);
        print_message("%-9s %4d of %4d (%d first, %d second)  angles %5.1f p1 %5.1f  joins %5.1f p1 %5.1f  deep %.3f\n",
                      names[host], m.got, m.asked, m.first, m.second, m.least, m.low, m.join, m.join_low, m.deep);
        assert_true(m.first > 40 && m.second > 20);
        assert_true(m.got == m.asked);
        assert_int_equal(m.apart, 0);
        assert_true(m.least >= 100.0f && m.low >= 120.0f);
        assert_true(m.join >= 100.0f && m.join_low >= 120.0f);
        assert_true(m.deep <= 0.05f);
        drop(&g);
    }
}

// --- small changes ---

static int by_key(const roots_network* net, uint64_t key)
{
    for (int i = 0; i < net->line_count; i++)
        if (net->lines[i].kind != ROOTS_TRUNK && net->lines[i].key == key)
            return i;
    return -1;
}

// The mean way from points of a line to the nearest of its like, of its radius.
static float moved(const roots_network* a, int line, const roots_network* b)
{
    const roots_line* l = &a->lines[line];
    int other = by_key(b, l->key);
    double sum = 0.0, r = 0.0;
    for (int i = 0; other >= 0 && i < l->count; i++)
    {
        float best = TY_FLOAT_MAX;
        const roots_line* k = &b->lines[other];
        for (int j = 0; j < k->count; j++)
            best = ty_min(best, ty_length(ty_sub(a->points[l->first + i].p, b->points[k->first + j].p)));
        sum += (double)best;
        r += (double)a->points[l->first + i].r;
    }
    return other < 0 ? TY_FLOAT_MAX : (float)(sum / r);
}

static void small_changes_move_few_roots(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(PILLAR);
    float* const changed[] = {&recipe.radius,         &recipe.growth.gravity, &recipe.growth.wander,
                              &recipe.growth.repel,   &recipe.taper,          &recipe.growth.sink,
                              &recipe.first.spacing,  &recipe.first.reach,    &recipe.first.slant,
                              &recipe.second.spacing, &recipe.flare,          &recipe.variation,
                              &recipe.growth.flatten, &recipe.exponent,       &recipe.tip};
    static const char* const what[] = {"radius", "gravity",   "wander",  "repel",    "taper",
                                       "sink",   "spacing",   "reach",   "slant",    "second.spacing",
                                       "flare",  "variation", "flatten", "exponent", "tip"};
    int moves = 0, roots = 0;
    grown before;
    grow(&recipe, NULL, &before);
    for (size_t k = 0; k < sizeof changed / sizeof *changed; k++)
    {
        float was = *changed[k];
        grown after;
        int count = 0, all = 0;
        *changed[k] = 1.01f * was;
        grow(&recipe, NULL, &after);
        *changed[k] = was;
        for (int i = 0; i < before.net.line_count; i++)
            if (before.net.lines[i].kind != ROOTS_TRUNK)
            {
                all++;
                count += moved(&before.net, i, &after.net) > 1.0f;
            }
        print_message("%-14s + 1 %%: %3d of %3d roots move by more than a radius\n", what[k], count, all);
        assert_true(3 * count < all);
        moves += count;
        roots += all;
        drop(&after);
    }
    assert_true(10 * moves < roots);
    drop(&before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_that_is_asked_for_grows),
        cmocka_unit_test(small_changes_move_few_roots),
    };
    return cmocka_run_group_tests(tests, hosts_make, NULL);
}
