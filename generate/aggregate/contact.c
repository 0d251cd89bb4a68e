// SPDX-License-Identifier: Apache-2.0
// Contact candidates of a pile: found on a grid, listed in id order with the impulses they keep, coloured in that
// order.
#include "pile_state.h"
#include <string.h>

// --- a grid over the bodies' centres ---

typedef struct grid
{
    ty_vec3 low;
    float cell;
    int size[3];
    int* start;  // [cells + 1]
    int* sorted; // bodies by cell, ascending within one
    int* cell_of;
} grid;

static int grid_coordinate(const grid* g, float x, float low, int axis)
{
    float f = ty_clamp((x - low) / g->cell, 0.0f, (float)(g->size[axis] - 1));
    return (int)f;
}

static grid grid_create(const ty_pile* pile, float cell)
{
    grid g = {.cell = cell};
    ty_bounds b = ty_bounds_empty();
    for (int i = 0; i < pile->count; i++)
        b = ty_bounds_add(b, pile->bodies[i].position);
    g.low = b.low;
    float extent[3] = {b.high.x - b.low.x, b.high.y - b.low.y, b.high.z - b.low.z};
    for (int axis = 0; axis < 3; axis++)
        g.size[axis] = (int)ty_clamp(extent[axis] / cell + 1.0f, 1.0f, 128.0f);
    int cells = g.size[0] * g.size[1] * g.size[2];
    g.start = TY_ALLOC(int, cells + 1);
    g.sorted = TY_ALLOC(int, pile->count);
    g.cell_of = TY_ALLOC(int, pile->count);
    for (int i = 0; i < pile->count; i++)
    {
        ty_vec3 p = pile->bodies[i].position;
        int x = grid_coordinate(&g, p.x, g.low.x, 0), y = grid_coordinate(&g, p.y, g.low.y, 1);
        int z = grid_coordinate(&g, p.z, g.low.z, 2);
        g.cell_of[i] = (z * g.size[1] + y) * g.size[0] + x;
        g.start[g.cell_of[i] + 1]++;
    }
    for (int c = 0; c < cells; c++)
        g.start[c + 1] += g.start[c];
    for (int i = pile->count - 1; i >= 0; i--) // fills each cell from its end, and moves its end to its start
        g.sorted[--g.start[g.cell_of[i] + 1]] = i;
    memmove(g.start, g.start + 1, (size_t)cells * sizeof(int));
    g.start[cells] = pile->count;
    return g;
}

static void grid_destroy(grid* g)
{
    ty_free(g->start);
    ty_free(g->sorted);
    ty_free(g->cell_of);
}

static float pair_margin(const ty_pile* pile, int a, int b)
{
    return 0.5f * (pile->poses[a].reach + pile->poses[b].reach);
}

// Bodies after i whose bounding spheres come within the margin, ascending. Returns how many; at most limit.
static int grid_neighbours(const ty_pile* pile, const grid* g, int i, int* out, int limit)
{
    int count = 0, c = g->cell_of[i];
    int x = c % g->size[0], y = c / g->size[0] % g->size[1], z = c / (g->size[0] * g->size[1]);
    float radius = pile->def.grains[pile->bodies[i].grain].radius * pile->bodies[i].scale;
    for (int dz = z > 0 ? -1 : 0; dz <= (z < g->size[2] - 1 ? 1 : 0); dz++)
        for (int dy = y > 0 ? -1 : 0; dy <= (y < g->size[1] - 1 ? 1 : 0); dy++)
            for (int dx = x > 0 ? -1 : 0; dx <= (x < g->size[0] - 1 ? 1 : 0); dx++)
            {
                int cell = c + (dz * g->size[1] + dy) * g->size[0] + dx;
                for (int k = g->start[cell]; k < g->start[cell + 1]; k++)
                {
                    int j = g->sorted[k];
                    if (j <= i)
                        continue;
                    const ty_body* other = &pile->bodies[j];
                    float reach = pile->def.grains[other->grain].radius * other->scale + radius;
                    reach = reach * pile->growth + pair_margin(pile, i, j);
                    if (ty_length_sqr(ty_sub(other->position, pile->bodies[i].position)) > reach * reach ||
                        count == limit)
                        continue;
                    int at = count++;
                    for (; at > 0 && out[at - 1] > j; at--)
                        out[at] = out[at - 1];
                    out[at] = j;
                }
            }
    return count;
}

// --- candidates ---

static touch* touch_push(ty_pile* pile, int a, int b)
{
    pile_reserve((void**)&pile->touches, &pile->touch_capacity, pile->touch_count + 1, sizeof(touch));
    touch* t = &pile->touches[pile->touch_count++];
    *t = (touch){.a = (uint8_t)a, .b = (uint8_t)b};
    return t;
}

static void pair_push(ty_pile* pile, int a, int b, int first)
{
    if (pile->touch_count == first)
        return;
    pile_reserve((void**)&pile->pairs, &pile->pair_capacity, pile->pair_count + 1, sizeof(pair));
    pile->pairs[pile->pair_count++] = (pair){.a = a, .b = b, .first = first, .count = pile->touch_count - first};
}

// The impulses of a pair's touches that were candidates before; both lists ascend in (a, b).
static void impulses_keep(ty_pile* pile, int first, const pair* old)
{
    const touch *from = pile->old_touches + old->first, *end = from + old->count;
    for (int t = first; t < pile->touch_count; t++)
    {
        touch* to = &pile->touches[t];
        while (from < end && (from->a < to->a || (from->a == to->a && from->b < to->b)))
            from++;
        if (from < end && from->a == to->a && from->b == to->b)
            *to = *from;
    }
}

// Squared distance of the segments from p along d and from q along e (Ericson 2005, 5.1.9).
static float segments_distance_sqr(ty_vec3 p, ty_vec3 d, ty_vec3 q, ty_vec3 e)
{
    ty_vec3 r = ty_sub(p, q);
    float dd = ty_length_sqr(d), ee = ty_length_sqr(e), de = ty_dot(d, e), dr = ty_dot(d, r), er = ty_dot(e, r);
    float area = dd * ee - de * de;
    float s = area > 1e-6f * dd * ee ? ty_clamp((de * er - dr * ee) / area, 0.0f, 1.0f) : 0.0f;
    float t = ty_clamp((de * s + er) / ty_max(ee, 1e-20f), 0.0f, 1.0f);
    s = ty_clamp((de * t - dr) / ty_max(dd, 1e-20f), 0.0f, 1.0f);
    return ty_length_sqr(ty_sub(ty_mad(r, d, s), ty_mul(e, t)));
}

static bool capsules_meet(const ty_pile* pile, int a, int b, float margin)
{
    const ty_ball *p = pile_balls(pile, a), *q = pile_balls(pile, b);
    const int last_p = pile_ball_count(pile, a) - 1, last_q = pile_ball_count(pile, b) - 1;
    float reach = pile->def.grains[pile->bodies[a].grain].capsule * pile->bodies[a].scale;
    reach += pile->def.grains[pile->bodies[b].grain].capsule * pile->bodies[b].scale;
    reach = reach * pile->growth + margin;
    return segments_distance_sqr(p[0].center, ty_sub(p[last_p].center, p[0].center), q[0].center,
                                 ty_sub(q[last_q].center, q[0].center)) < reach * reach;
}

static void touches_find(ty_pile* pile, int a, int b, float margin)
{
    const ty_ball *p = pile_balls(pile, a), *q = pile_balls(pile, b);
    if (!capsules_meet(pile, a, b, margin))
        return;
    const ty_body* other = &pile->bodies[b];
    float radius = pile->def.grains[other->grain].radius * other->scale * pile->growth + margin;
    const int of_a = pile_ball_count(pile, a);
    const int of_b = pile_ball_count(pile, b);
    for (int i = 0; i < of_a; i++)
    {
        if (ty_length_sqr(ty_sub(p[i].center, other->position)) > ty_sqr(radius + p[i].radius))
            continue;
        for (int k = 0; k < of_b; k++)
            if (ty_length_sqr(ty_sub(p[i].center, q[k].center)) < ty_sqr(p[i].radius + q[k].radius + margin))
                touch_push(pile, i, k);
    }
}

static void pairs_find(ty_pile* pile)
{
    float widest = 0.0f;
    for (int i = 0; i < pile->count; i++)
        widest = ty_max(widest, pile->poses[i].reach);
    grid g = grid_create(pile, 2.0f * pile->max_radius * pile->growth + widest);
    int neighbours[512], old = 0;
    for (int i = 0; i < pile->count; i++)
    {
        int count = grid_neighbours(pile, &g, i, neighbours, 512);
        for (int n = 0; n < count; n++)
        {
            int j = neighbours[n], first = pile->touch_count;
            touches_find(pile, i, j, pair_margin(pile, i, j));
            const pair* o = pile->old_pairs;
            while (old < pile->old_wall_first && (o[old].a < i || (o[old].a == i && o[old].b < j)))
                old++;
            if (old < pile->old_wall_first && o[old].a == i && o[old].b == j)
                impulses_keep(pile, first, &o[old]);
            pair_push(pile, i, j, first);
        }
    }
    grid_destroy(&g);
}

static void walls_find(ty_pile* pile)
{
    int walls = pile->def.container ? ty_container_wall_count(pile->def.container) : 0, old = pile->old_wall_first;
    for (int i = 0; i < pile->count; i++)
    {
        int first = pile->touch_count;
        const ty_ball* balls = pile_balls(pile, i);
        float margin = pile->poses[i].reach;
        const int ball_count = pile_ball_count(pile, i);
        for (int k = 0; k < ball_count; k++)
        {
            ty_vec3 n;
            for (int w = 0; w < walls; w++)
                if (pile_wall(pile, w, balls[k].center, &n) < balls[k].radius + margin)
                    touch_push(pile, k, w);
            if (pile->lid && pile_wall(pile, PILE_LID, balls[k].center, &n) < balls[k].radius + margin)
                touch_push(pile, k, PILE_LID);
        }
        while (old < pile->old_pair_count && pile->old_pairs[old].a < i)
            old++;
        if (old < pile->old_pair_count && pile->old_pairs[old].a == i)
            impulses_keep(pile, first, &pile->old_pairs[old]);
        pair_push(pile, i, PILE_WALL, first);
    }
}

// --- colours ---

// Greedy, in id order: the lowest colour that neither body has; then pairs by colour, in id order within one.
static void pairs_color(ty_pile* pile)
{
    uint64_t* used = TY_ALLOC(uint64_t, pile->count);
    uint8_t* color = TY_ALLOC(uint8_t, pile->pair_count);
    int count[PILE_COLORS + 1] = {0};
    for (int i = 0; i < pile->wall_first; i++)
    {
        const pair* p = &pile->pairs[i];
        uint64_t taken = used[p->a] | used[p->b] | 1ull << (PILE_COLORS - 1);
        uint64_t open = ~taken & ((1ull << PILE_COLORS) - 1);
        int c = open ? __builtin_ctzll(open) : PILE_COLORS - 1;
        color[i] = (uint8_t)c;
        count[c]++;
        used[p->a] |= 1ull << c;
        used[p->b] |= 1ull << c;
    }
    for (int i = pile->wall_first; i < pile->pair_count; i++)
        color[i] = PILE_COLORS;
    count[PILE_COLORS] = pile->pair_count - pile->wall_first;
    int next[PILE_COLORS + 1];
    pile->color_first[0] = 0;
    for (int c = 0; c <= PILE_COLORS; c++)
    {
        next[c] = pile->color_first[c];
        pile->color_first[c + 1] = pile->color_first[c] + count[c];
    }
    pile_reserve((void**)&pile->order, &pile->order_capacity, pile->pair_count, sizeof(int));
    for (int i = 0; i < pile->pair_count; i++)
        pile->order[next[color[i]]++] = i;
    int slot = 0;
    for (int i = 0; i < pile->pair_count; i++)
    {
        pair* p = &pile->pairs[pile->order[i]];
        p->slot = slot;
        slot += p->count;
    }
    pile_reserve((void**)&pile->contacts, &pile->contact_capacity, slot, sizeof(contact));
    ty_free(used);
    ty_free(color);
}

static void lists_swap(ty_pile* pile)
{
    pair* pairs = pile->old_pairs;
    touch* touches = pile->old_touches;
    int pair_capacity = pile->old_pair_capacity, touch_capacity = pile->old_touch_capacity;
    pile->old_pairs = pile->pairs, pile->old_pair_capacity = pile->pair_capacity;
    pile->old_touches = pile->touches, pile->old_touch_capacity = pile->touch_capacity;
    pile->old_pair_count = pile->pair_count, pile->old_wall_first = pile->wall_first;
    pile->pairs = pairs, pile->pair_capacity = pair_capacity, pile->pair_count = 0;
    pile->touches = touches, pile->touch_capacity = touch_capacity, pile->touch_count = 0;
}

void pile_detect(ty_pile* pile, float margin)
{
    const float ahead = 12.0f / pile->def.rate; // s that a body's speed is looked ahead
    for (int i = 0; i < pile->count; i++)
    {
        const motion* m = &pile->motions[i];
        float radius = pile->def.grains[pile->bodies[i].grain].radius;
        float speed = ty_length(m->v) + ty_length(m->w) * radius;
        pile->poses[i].reach = ty_min(ty_max(margin, 2.0f * ahead * speed), margin + radius);
        pile->poses[i].seen = pile->bodies[i].position;
        pile->poses[i].seen_rotation = pile->bodies[i].rotation;
    }
    lists_swap(pile);
    pairs_find(pile);
    pile->wall_first = pile->pair_count;
    walls_find(pile);
    pairs_color(pile);
    pile->stale = false;
}

// Each of two balls may come nearer by .45 of the margin. An angle is at most 2.1 times the distance of its
// quaternions.
bool pile_moved(const ty_pile* pile)
{
    if (pile->stale)
        return true;
    for (int i = 0; i < pile->count; i++)
    {
        const ty_body* b = &pile->bodies[i];
        const pose* at = &pile->poses[i];
        ty_quat p = b->rotation, q = at->seen_rotation;
        float turn = ty_sqr(p.x - q.x) + ty_sqr(p.y - q.y) + ty_sqr(p.z - q.z) + ty_sqr(p.w - q.w);
        float lever = 2.1f * pile->def.grains[b->grain].radius * b->scale * pile->growth;
        float distance = ty_length(ty_sub(b->position, at->seen)) + lever * sqrtf(turn);
        if (distance > 0.45f * at->reach)
            return true;
    }
    return false;
}

// --- working through the colours ---

typedef struct sweep
{
    ty_pile* pile;
    pile_pair_fn* fn;
    int first;
} sweep;

static void sweep_range(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const sweep* s = context;
    for (int64_t i = begin; i < end; i++)
        s->fn(s->pile, &s->pile->pairs[s->pile->order[s->first + i]]);
}

void pile_sweep(ty_pile* pile, ty_workers* workers, pile_pair_fn* fn)
{
    enum
    {
        WORTH_SHARING = 768, // pairs of a colour; below, waking a thread costs more than it gives
    };
    for (int c = 0; c <= PILE_COLORS; c++)
    {
        sweep s = {pile, fn, pile->color_first[c]};
        int count = pile->color_first[c + 1] - s.first;
        bool share = count >= WORTH_SHARING && c != PILE_COLORS - 1;
        if (count > 0)
            ty_parallel_for(share ? workers : NULL, count, share ? (count + 7) / 8 : count, sweep_range, &s);
    }
}

void pile_each(ty_pile* pile, ty_workers* workers, pile_pair_fn* fn)
{
    enum
    {
        WORTH_SHARING = 1024,
        PIECE = 256,
    };
    sweep s = {pile, fn, 0};
    bool share = pile->pair_count >= WORTH_SHARING;
    ty_parallel_for(share ? workers : NULL, pile->pair_count, share ? PIECE : pile->pair_count + 1, sweep_range, &s);
}
