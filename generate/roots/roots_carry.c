// SPDX-License-Identifier: Apache-2.0
// Where centre lines are while roots thicken: of two that run together in the end the younger is carried by the older,
// so that nothing is stretched between a root that is there and one that has not come.
#include "roots_output.h"
#include <stdlib.h>

enum
{
    MOST_LINKS = 4, // older roots that carry a point
    TABLE = 1 << 14,
};

// How far a root that has come may stand from where it is in the end, of its radius.
#define MOST_SHIFT 5.0f

// A point of an older root beside it.
typedef struct link
{
    int by;
    float weight;     // 0..1, how much the two are one
    float reach[2];   // m, how far the older one and the point's own root reach towards each other
    ty_vec3 q, along; // m, from it in the end: across it, and along it
} link;

typedef struct carried
{
    link links[MOST_LINKS];
    int count;
    int chosen; // of the links, where it waits; -1 = at the point before it
} carried;

struct roots_carry
{
    const roots_network* network;
    const roots_host* host;
    int *order, *rank; // [point_count] points by age, and where each stands among them
    int* line;         // [point_count]
    carried* items;    // [point_count]
};

// --- who is near ---

typedef struct cells
{
    float size;
    int heads[TABLE], *next;
} cells;

static uint32_t cell_hash(int x, int y, int z)
{
    return ((uint32_t)x * 73856093u ^ (uint32_t)y * 19349663u ^ (uint32_t)z * 83492791u) & (TABLE - 1);
}

static ty_vec3 cell_of(const cells* c, ty_vec3 p)
{
    ty_vec3 q = ty_mul(p, 1.0f / c->size);
    return (ty_vec3){floorf(q.x), floorf(q.y), floorf(q.z)};
}

static float widest(const roots_network* net)
{
    float most = 1e-6f;
    for (int i = 0; i < net->point_count; i++)
        most = ty_max(most, net->points[i].r);
    return most;
}

// --- how two run together ---

static ty_vec3 tangent_at(const roots_carry* c, int i)
{
    const roots_line* line = &c->network->lines[c->line[i]];
    int before = i > line->first ? i - 1 : i, after = i < line->first + line->count - 1 ? i + 1 : i;
    return ty_normalize(ty_sub(c->network->points[after].p, c->network->points[before].p));
}

static bool is_end(const roots_carry* c, int i)
{
    const roots_line* line = &c->network->lines[c->line[i]];
    return i == line->first || i == line->first + line->count - 1;
}

// How far a flat section reaches in a direction.
static float reach_of(const roots_point* p, ty_vec3 q)
{
    float height = ty_dot(q, p->n), length = ty_length(q);
    if (length == 0.0f)
        return p->r;
    return p->r * length / sqrtf(length * length + height * height * (1.0f / (p->flat * p->flat) - 1.0f));
}

// weight 0: they stay apart.
static link link_between(const roots_carry* c, int by, int i, float join, float detail)
{
    const roots_point *older = &c->network->points[by], *own = &c->network->points[i];
    ty_vec3 d = ty_sub(own->p, older->p), t = tangent_at(c, by);
    link out = {.by = by, .along = ty_mul(t, ty_dot(d, t))};
    out.q = ty_sub(d, out.along);
    out.reach[0] = reach_of(older, out.q);
    out.reach[1] = reach_of(own, out.q);
    // Their surfaces are one where the gap is less than half of the width in which they run together.
    float gap = ty_length(is_end(c, by) ? d : out.q) - out.reach[0] - out.reach[1];
    float width = join * ty_min(older->r, own->r) + 2.0f * detail;
    out.weight = ty_clamp(2.0f - 2.0f * gap / width, 0.0f, 1.0f);
    return out;
}

// Of one root the nearest point, of roots those that it is one with most.
static void carried_add(const roots_carry* c, carried* all, const link* one)
{
    int at = 0;
    while (at < all->count && c->line[all->links[at].by] != c->line[one->by])
        at++;
    if (at == MOST_LINKS)
    {
        at = 0;
        for (int k = 1; k < MOST_LINKS; k++)
            at = all->links[k].weight < all->links[at].weight ? k : at;
        if (one->weight > all->links[at].weight)
            all->links[at] = *one;
        return;
    }
    if (at == all->count)
        all->count++;
    else if (ty_length_sqr(all->links[at].along) <= ty_length_sqr(one->along))
        return;
    all->links[at] = *one;
}

static void carried_find(roots_carry* c, const cells* near, int i, float join, float detail, float most)
{
    const roots_point* p = &c->network->points[i];
    float reach = p->r + most + join * p->r + 2.0f * detail;
    ty_vec3 r = {reach, reach, reach}, low = cell_of(near, ty_sub(p->p, r)), high = cell_of(near, ty_add(p->p, r));
    for (int z = (int)low.z; z <= (int)high.z; z++)
        for (int y = (int)low.y; y <= (int)high.y; y++)
            for (int x = (int)low.x; x <= (int)high.x; x++)
                for (int k = near->heads[cell_hash(x, y, z)]; k >= 0; k = near->next[k])
                {
                    if (c->rank[k] >= c->rank[i] || c->line[k] == c->line[i])
                        continue;
                    ty_vec3 at = cell_of(near, c->network->points[k].p);
                    if ((int)at.x != x || (int)at.y != y || (int)at.z != z)
                        continue; // of another cell of the same number
                    link one = link_between(c, k, i, join, detail);
                    if (one.weight > 0.0f && ty_length(one.along) <= c->network->points[k].r + p->r)
                        carried_add(c, &c->items[i], &one);
                }
}

// A line leaves where it waits late, so that few of its points wait elsewhere than their neighbours.
static void waits_choose(roots_carry* c, const roots_line* line)
{
    int with = -1; // a line
    for (int i = line->first; i < line->first + line->count; i++)
    {
        carried* all = &c->items[i];
        float most = 0.5f;
        all->chosen = -1;
        for (int l = 0; l < all->count; l++)
        {
            bool stays = with >= 0 && c->line[all->links[l].by] == with && all->links[l].weight > 0.1f;
            float weight = all->links[l].weight + (stays ? 2.0f : 0.0f);
            if (weight <= most)
                continue;
            most = weight;
            all->chosen = l;
        }
        with = all->chosen < 0 ? -1 : c->line[all->links[all->chosen].by];
    }
}

// --- all of them ---

typedef struct aged
{
    float birth;
    int point;
} aged;

static int compare_aged(const void* a, const void* b)
{
    const aged *p = a, *q = b;
    if (p->birth < q->birth || p->birth > q->birth)
        return p->birth < q->birth ? -1 : 1;
    return p->point < q->point ? -1 : p->point > q->point;
}

static void order_find(roots_carry* c, aged* all)
{
    int count = c->network->point_count;
    for (int l = 0; l < c->network->line_count; l++)
        for (int i = 0; i < c->network->lines[l].count; i++)
            c->line[c->network->lines[l].first + i] = l;
    for (int i = 0; i < count; i++)
        all[i] = (aged){c->network->points[i].birth, i};
    qsort(all, (size_t)count, sizeof *all, compare_aged);
    for (int i = 0; i < count; i++)
    {
        c->order[i] = all[i].point;
        c->rank[all[i].point] = i;
    }
}

roots_carry* roots_carry_create(const roots_network* network, const roots_host* host, float join, float detail)
{
    int count = network->point_count;
    float most = widest(network);
    roots_carry* c = TY_ALLOC(roots_carry, 1);
    *c = (roots_carry){.network = network,
                       .host = host,
                       .order = TY_TRY_ALLOC(int, count),
                       .rank = TY_TRY_ALLOC(int, count),
                       .line = TY_TRY_ALLOC(int, count),
                       .items = TY_TRY_ALLOC(carried, count)};
    aged* all = TY_TRY_ALLOC(aged, count);
    cells* near = TY_ALLOC(cells, 1);
    near->size = most;
    near->next = TY_TRY_ALLOC(int, count);
    bool enough = c->order && c->rank && c->line && c->items && all && near->next;
    if (enough)
    {
        order_find(c, all);
        for (int i = 0; i < TABLE; i++)
            near->heads[i] = -1;
        for (int i = 0; i < count; i++)
        {
            ty_vec3 at = cell_of(near, network->points[i].p);
            int* head = &near->heads[cell_hash((int)at.x, (int)at.y, (int)at.z)];
            near->next[i] = *head;
            *head = i;
        }
        for (int i = 0; i < count; i++)
            carried_find(c, near, i, join, detail, most);
        for (int l = 0; l < network->line_count; l++)
            waits_choose(c, &network->lines[l]);
    }
    ty_free(all);
    ty_free(near->next);
    ty_free(near);
    if (enough)
        return c;
    roots_carry_destroy(c);
    return NULL;
}

void roots_carry_destroy(roots_carry* c)
{
    if (!c)
        return;
    ty_free(c->order);
    ty_free(c->rank);
    ty_free(c->line);
    ty_free(c->items);
    ty_free(c);
}

// --- at a time ---

ty_vec3 roots_center_at(const roots_point* p, float grown)
{
    float held = ty_min(p->sink * 20.0f, 1.0f) * (p->flat - p->sink) * p->r;
    return ty_mad(p->p, p->n, -held * (1.0f - grown));
}

// What has not come yet takes no room. Where it will be one with an older root it is a point of that root's side, or
// waits where that waits; elsewhere it waits at the point before it, and so at the tip of its own. Never between two
// places: of three that do not stand on one line there would be a skin.
static ty_vec3 waiting_at(const roots_carry* c, int i, float t, const ty_vec3* places)
{
    const roots_line* line = &c->network->lines[c->line[i]];
    const carried* all = &c->items[i];
    const link* best = all->chosen < 0 ? NULL : &all->links[all->chosen];
    int before = i > line->first ? i - 1 : line->parent >= 0 ? line->parent_point : -1;
    if (!best)
        return before >= 0 && c->rank[before] < c->rank[i] ? places[before]
                                                           : roots_center_at(&c->network->points[i], 0.0f);
    float grown = roots_growth_at(c->network->points[best->by].birth, t);
    if (grown == 0.0f)
        return places[best->by];
    float apart = best->reach[0] * grown / (best->reach[0] + best->reach[1]);
    return ty_add(ty_mad(places[best->by], best->q, apart), best->along);
}

// A root on its host stays about where it is, however many carry one another; strands of the trunk part.
static ty_vec3 held_back(ty_vec3 shift, const roots_point* p)
{
    float length = ty_length(shift), most = MOST_SHIFT * p->r, over = length - 0.5f * most;
    if (over <= 0.0f || !(p->sink > 0.0f))
        return shift;
    return ty_mul(shift, 0.5f * most * (1.0f + over / (over + 0.5f * most)) / length);
}

// The host bends away under what is carried along it: nothing that has come sinks deeper than by itself.
static ty_vec3 lifted(const roots_carry* c, int i, ty_vec3 own, ty_vec3 place)
{
    if (!c->host || !(c->network->points[i].sink > 0.0f))
        return place;
    ty_vec3 n;
    float wanted = ty_min(roots_host_value(c->host, own, NULL), c->network->points[i].r);
    float height = roots_host_value(c->host, place, &n);
    return height < wanted ? ty_mad(place, n, wanted - height) : place;
}

// Of what has come.
static ty_vec3 growing_at(const roots_carry* c, int i, float t, const ty_vec3* places)
{
    const roots_point* points = c->network->points;
    const carried* all = &c->items[i];
    float grown = roots_growth_at(points[i].birth, t), sum = 0.0f, most = 0.0f;
    ty_vec3 mean = {0.0f, 0.0f, 0.0f}, own = roots_center_at(&points[i], grown);
    for (int l = 0; l < all->count; l++)
    {
        const link* one = &all->links[l];
        float older = roots_growth_at(points[one->by].birth, t), part = ty_sqr(one->weight);
        float apart = (one->reach[0] * older + one->reach[1] * grown) / (one->reach[0] + one->reach[1]);
        mean = ty_mad(mean, ty_add(ty_mad(places[one->by], one->q, apart), one->along), part);
        sum += part;
        most = ty_max(most, one->weight);
    }
    if (!(sum > 0.0f))
        return own;
    ty_vec3 shift = ty_mul(ty_sub(ty_mul(mean, 1.0f / sum), own), most);
    return lifted(c, i, own, ty_add(own, held_back(shift, &points[i])));
}

void roots_carry_at(const roots_carry* c, float t, ty_vec3* places)
{
    for (int k = 0; k < c->network->point_count; k++)
    {
        int i = c->order[k];
        bool has_come = roots_growth_at(c->network->points[i].birth, t) > 0.0f;
        places[i] = has_come ? growing_at(c, i, t, places) : waiting_at(c, i, t, places);
    }
}

// The rest of the time is left to the last part to become thick in.
#define TIP_TIME 0.7f

// The tip passes at once; from then on the part thickens, ever slower, until the end: 1 - (1 - x)^2.
float roots_growth_at(float birth, float t)
{
    float begin = TIP_TIME * ty_clamp(birth, 0.0f, 1.0f);
    if (t >= 1.0f)
        return 1.0f;
    if (t <= begin)
        return 0.0f;
    float left = (1.0f - t) / (1.0f - begin);
    return 1.0f - left * left;
}
