// SPDX-License-Identifier: Apache-2.0
// Which root a branch grows into, and where: found by the cells of a grid, then down along it so that it crosses
// aslant.
#include "roots_link.h"

enum
{
    CELLS = 1 << 14,
    LINES = 64, // that are looked at for one branch
};

#define FUSE 2.0f // of both radii: what is closer to each other runs together without branches
#define AIR 0.1f  // of the way over, from the host: what lies at its other end may be no neighbour

// --- where points are ---

// Points of lines that may be grown into, by the cell of a grid in a table by hash.
struct places
{
    float cell; // m
    int heads[CELLS];
    int* next; // [count]
    int* points;
    int* lines;
    int count;
};

static uint32_t cell_hash(int x, int y, int z)
{
    return ty_mix32(ty_mix32(ty_mix32((uint32_t)x) + (uint32_t)y) + (uint32_t)z) % CELLS;
}

bool link_may_join(const linking* k, int point)
{
    float sink = k->g->network->points[point].sink;
    return sink > 0.0f && sink < k->g->recipe->growth.sink + 0.1f;
}

places* link_places_create(const linking* k)
{
    const roots_network* net = k->g->network;
    float reach = k->def->reach;
    roots_kind kind = k->from;
    places* all = TY_ALLOC(places, 1);
    int most = 0;
    for (int line = 0; line < net->line_count; line++)
        most += net->lines[line].kind == kind ? net->lines[line].count : 0;
    *all = (places){.cell = 0.5f * reach, .next = TY_ALLOC(int, most), .points = TY_ALLOC(int, most)};
    all->lines = TY_ALLOC(int, most);
    for (int i = 0; i < CELLS; i++)
        all->heads[i] = -1;
    for (int line = 0; line < net->line_count; line++)
    {
        const roots_line* l = &net->lines[line];
        for (int i = l->first + MARGIN; l->kind == kind && i < l->first + l->count - MARGIN; i++)
        {
            if (!link_may_join(k, i))
                continue;
            ty_vec3 q = ty_mul(net->points[i].p, 1.0f / all->cell);
            int* head = &all->heads[cell_hash((int)floorf(q.x), (int)floorf(q.y), (int)floorf(q.z))];
            all->points[all->count] = i;
            all->lines[all->count] = line;
            all->next[all->count] = *head;
            *head = all->count++;
        }
    }
    return all;
}

void link_places_destroy(places* all)
{
    ty_free(all->next);
    ty_free(all->points);
    ty_free(all->lines);
    ty_free(all);
}

// --- partners ---

typedef struct partner
{
    int line, point;
    float distance;
} partner;

typedef struct search
{
    const linking* k;
    const plan* plan;
    ty_vec3 side;
    partner found[LINES]; // the nearest point of each line
    int count;
} search;

static void search_meet(search* s, int line, int point)
{
    const roots_network* net = s->k->g->network;
    const roots_point *at = &net->points[s->plan->point], *to = &net->points[point];
    ty_vec3 way = ty_sub(to->p, at->p);
    float d = ty_length(way);
    if (line == s->plan->line || d > s->k->def->reach || ty_dot(way, s->side) < 0.3f * d || d < FUSE * (at->r + to->r))
        return;
    if (ty_dot(way, at->n) > 0.7f * d || ty_dot(way, to->n) < -0.7f * d) // through the air
        return;
    int i = 0;
    while (i < s->count && s->found[i].line != line)
        i++;
    if (i == LINES || (i < s->count && (s->found[i].distance < d || (s->found[i].distance == d && // as found in order
                                                                     s->found[i].point < point))))
        return;
    s->found[i] = (partner){line, point, d};
    s->count += i == s->count;
}

static void search_cells(search* s)
{
    const places* all = s->k->places;
    ty_vec3 p = s->k->g->network->points[s->plan->point].p,
            reach = {s->k->def->reach, s->k->def->reach, s->k->def->reach};
    ty_vec3 low = ty_mul(ty_sub(p, reach), 1.0f / all->cell), high = ty_mul(ty_add(p, reach), 1.0f / all->cell);
    for (int z = (int)floorf(low.z); z <= (int)floorf(high.z); z++)
        for (int y = (int)floorf(low.y); y <= (int)floorf(high.y); y++)
            for (int x = (int)floorf(low.x); x <= (int)floorf(high.x); x++)
                for (int i = all->heads[cell_hash(x, y, z)]; i >= 0; i = all->next[i])
                    search_meet(s, all->lines[i], all->points[i]);
}

// Goes down the line by a length, or up where that is below 0.
static int downstream(const linking* k, int line, int point, float way)
{
    const roots_network* net = k->g->network;
    const roots_line* l = &net->lines[line];
    float from = net->points[point].s;
    int last = l->first + l->count - 1 - MARGIN, i = point;
    while (i < last && net->points[i].s < from + way && link_may_join(k, i + 1))
        i++;
    while (i > l->first + MARGIN && net->points[i].s > from + way && link_may_join(k, i - 1))
        i--;
    return i;
}

// Is it clear of the root that the branch leaves?
static bool is_apart(const linking* k, const plan* p, int point)
{
    const roots_network* net = k->g->network;
    const roots_line* l = &net->lines[p->line];
    const roots_point* to = &net->points[point];
    for (int i = l->first; i < l->first + l->count; i++)
        if (ty_length_sqr(ty_sub(net->points[i].p, to->p)) < ty_sqr(FUSE * (net->points[i].r + to->r)))
            return false;
    return true;
}

// Is there a way over the surface that keeps near the straight one? Points between are drawn to the host and towards
// one another; where two neighbours are left on either side of free air there is none.
static bool is_neighbour(const roots_host* host, ty_vec3 a, ty_vec3 b)
{
    enum
    {
        STEPS = 12,
        ROUNDS = 12
    };
    ty_vec3 p[STEPS + 1], n;
    float air = 0.0f, chord = ty_length(ty_sub(b, a));
    for (int i = 0; i <= STEPS; i++)
    {
        p[i] = ty_lerp3(a, b, (float)i / STEPS);
        air = ty_max(air, roots_host_value(host, p[i], NULL));
    }
    for (int round = 0; round < ROUNDS && air > AIR * chord; round++)
        for (int i = 1; i < STEPS; i++)
            p[i] = roots_host_project(host, ty_mul(ty_add(p[i - 1], p[i + 1]), 0.5f), 0.0f, &n);
    for (int i = 0; i < STEPS && air > AIR * chord; i++)
        if (roots_host_value(host, ty_lerp3(p[i], p[i + 1], 0.5f), NULL) > 0.3f * ty_length(ty_sub(p[i + 1], p[i])))
            return false;
    return true;
}

// Where on its partner a branch ends: as far down as the way over asks for, or up where that flows against it; less far
// where both come close to each other. -1: it would cross too steeply, or through the air.
static int landing(const linking* k, const plan* p, const partner* to, ty_vec3 t, float steepest)
{
    const roots_network* net = k->g->network;
    const roots_point *a = &net->points[p->point], *b = &net->points[to->point];
    const roots_line* other = &net->lines[to->line];
    float way = k->def->slant * (to->distance + a->r + b->r); // of what is seen, not of what is inside of both
    way = ty_dot(growth_tangent(net, other, to->point), t) < 0.0f ? -way : way;
    int point = downstream(k, to->line, to->point, way);
    for (int i = 0; i < 3 && !is_apart(k, p, point); i++)
        point = downstream(k, to->line, to->point, way *= 0.6f);
    ty_vec3 over = ty_sub(net->points[point].p, a->p), tb = growth_tangent(net, other, point);
    float least = steepest * ty_length(over);
    if (!is_neighbour(k->g->host, a->p, net->points[point].p))
        return -1;
    return ty_dot(over, t) > least && fabsf(ty_dot(over, tb)) > least ? point : -1;
}

void link_partners(const linking* k, plan* p, float side, float steepest)
{
    const roots_network* net = k->g->network;
    ty_vec3 t = growth_tangent(net, &net->lines[p->line], p->point);
    search s = {.k = k, .plan = p, .side = ty_mul(ty_cross(net->points[p->point].n, t), side)};
    search_cells(&s);
    for (int most = p->partner_count + PARTNERS / 2, left = s.count; left > 0 && p->partner_count < most; left--)
    {
        int best = 0; // equal ones in the order of lines
        for (int i = 1; i < s.count; i++)
            if (s.found[i].distance < s.found[best].distance ||
                (s.found[i].distance == s.found[best].distance && s.found[i].line < s.found[best].line))
                best = i;
        int point = landing(k, p, &s.found[best], t, steepest);
        s.found[best].distance = TY_FLOAT_MAX;
        if (point < 0)
            continue;
        p->partners[p->partner_count] = s.found[best].line;
        p->partner_points[p->partner_count++] = point;
    }
}
