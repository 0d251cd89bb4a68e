// SPDX-License-Identifier: Apache-2.0
// Contact candidates of a pile: found on a grid, listed in id order with the impulses they keep, coloured in that
// order.
#include "pile_state.h"
#include <string.h>

#define REACH_SHARE 0.08f // of a body's radius, mean distance that a pile is looked ahead

// --- candidates ---

// What one piece of the bodies finds, in id order; pieces are joined in order, whoever found them.
typedef struct found
{
    pair* pairs;
    int pair_count, pair_capacity;
    touch* touches;
    int touch_count, touch_capacity;
    int first_pair, first_touch; // of the piece in the whole
} found;

enum
{
    SEARCH_PIECE = 512, // bodies that are searched at a time
};

static void touch_push(found* f, int a, int b)
{
    list_reserve((void**)&f->touches, &f->touch_capacity, f->touch_count + 1, sizeof(touch));
    f->touches[f->touch_count++] = (touch){.a = (uint8_t)a, .b = (uint8_t)b};
}

static void pair_push(found* f, int a, int b, int first, bool bridged)
{
    if (f->touch_count == first)
        return;
    list_reserve((void**)&f->pairs, &f->pair_capacity, f->pair_count + 1, sizeof(pair));
    f->pairs[f->pair_count++] =
        (pair){.a = a, .b = b, .first = first, .count = f->touch_count - first, .bridged = bridged};
}

// The impulses of a pair's touches that were candidates before; both lists ascend in (a, b).
static void impulses_keep(const ty_pile* pile, found* f, int first, const pair* old)
{
    const touch *from = pile->old_touches + old->first, *end = from + old->count;
    for (int t = first; t < f->touch_count; t++)
    {
        touch* to = &f->touches[t];
        while (from < end && (from->a < to->a || (from->a == to->a && from->b < to->b)))
            from++;
        if (from < end && from->a == to->a && from->b == to->b)
            *to = *from;
    }
}

// The first old pair from begin to end whose first body is at least a.
static int old_pair_at(const ty_pile* pile, int begin, int end, int a)
{
    while (begin < end)
    {
        int middle = begin + (end - begin) / 2;
        if (pile->old_pairs[middle].a < a)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
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
    float reach = pile->def.grains[pile->bodies[a].grain].capsule * pile->bodies[a].scale * pile_bent_reach(pile, a);
    reach += pile->def.grains[pile->bodies[b].grain].capsule * pile->bodies[b].scale * pile_bent_reach(pile, b);
    reach = reach * pile->growth + margin;
    return segments_distance_sqr(p[0].center, ty_sub(p[last_p].center, p[0].center), q[0].center,
                                 ty_sub(q[last_q].center, q[0].center)) < reach * reach;
}

static void touches_find(const ty_pile* pile, found* f, int a, int b, float margin)
{
    const ty_ball *p = pile_balls(pile, a), *q = pile_balls(pile, b);
    if (!capsules_meet(pile, a, b, margin))
        return;
    const ty_body* other = &pile->bodies[b];
    float radius = pile->def.grains[other->grain].radius * other->scale * pile->growth;
    radius = radius * pile_bent_reach(pile, b) + margin;
    const int of_a = pile_ball_count(pile, a);
    const int of_b = pile_ball_count(pile, b);
    for (int i = 0; i < of_a; i++)
    {
        if (ty_length_sqr(ty_sub(p[i].center, other->position)) > ty_sqr(radius + p[i].radius))
            continue;
        for (int k = 0; k < of_b; k++)
            if (ty_length_sqr(ty_sub(p[i].center, q[k].center)) < ty_sqr(p[i].radius + q[k].radius + margin))
                touch_push(f, i, k);
    }
}

typedef struct search
{
    ty_pile* pile;
    body_grid grid;
    ty_ball* spheres; // about the bodies, by half their reach wider
    found* pieces;
} search;

static bool spheres_meet(const void* owner, int i, int j)
{
    const search* s = owner;
    float reach = s->spheres[i].radius + s->spheres[j].radius;
    return ty_length_sqr(ty_sub(s->spheres[i].center, s->spheres[j].center)) <= reach * reach;
}

static ty_ball* spheres_make(const ty_pile* pile)
{
    ty_ball* out = TY_ALLOC(ty_ball, pile->count);
    for (int i = 0; i < pile->count; i++)
    {
        const ty_body* b = &pile->bodies[i];
        float radius = pile->def.grains[b->grain].radius * b->scale * pile_bent_reach(pile, i) * pile->growth;
        out[i] = (ty_ball){b->position, radius + 0.5f * pile->poses[i].reach};
    }
    return out;
}

static void pairs_find(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const search* s = context;
    const ty_pile* pile = s->pile;
    found* f = &s->pieces[begin / SEARCH_PIECE];
    const pair* o = pile->old_pairs;
    int old = old_pair_at(pile, 0, pile->old_wall_first, (int)begin);
    body_list near = {0};
    for (int i = (int)begin; i < (int)end; i++)
    {
        body_grid_after(&s->grid, i, spheres_meet, s, &near);
        for (int n = 0; n < near.count; n++)
        {
            int j = near.at[n], first = f->touch_count;
            touches_find(pile, f, i, j, 0.5f * (pile->poses[i].reach + pile->poses[j].reach));
            while (old < pile->old_wall_first && (o[old].a < i || (o[old].a == i && o[old].b < j)))
                old++;
            bool known = old < pile->old_wall_first && o[old].a == i && o[old].b == j;
            if (known)
                impulses_keep(pile, f, first, &o[old]);
            pair_push(f, i, j, first, known && o[old].bridged);
        }
    }
    ty_free(near.at);
}

static void body_walls_find(const ty_pile* pile, found* f, int i)
{
    int walls = pile->def.container ? ty_container_wall_count(pile->def.container) : 0;
    const ty_ball* balls = pile_balls(pile, i);
    float margin = pile->poses[i].reach;
    const int ball_count = pile_ball_count(pile, i);
    for (int k = 0; k < ball_count; k++)
    {
        ty_vec3 n;
        for (int w = 0; w < walls; w++)
            if (pile_wall(pile, w, balls[k].center, &n) < balls[k].radius + margin)
                touch_push(f, k, w);
        if (pile->lid && pile_wall(pile, PILE_LID, balls[k].center, &n) < balls[k].radius + margin)
            touch_push(f, k, PILE_LID);
    }
}

static void walls_find(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const search* s = context;
    const ty_pile* pile = s->pile;
    found* f = &s->pieces[begin / SEARCH_PIECE];
    int old = old_pair_at(pile, pile->old_wall_first, pile->old_pair_count, (int)begin);
    for (int i = (int)begin; i < (int)end; i++)
    {
        int first = f->touch_count;
        body_walls_find(pile, f, i);
        while (old < pile->old_pair_count && pile->old_pairs[old].a < i)
            old++;
        bool known = old < pile->old_pair_count && pile->old_pairs[old].a == i;
        if (known)
            impulses_keep(pile, f, first, &pile->old_pairs[old]);
        pair_push(f, i, PILE_WALL, first, known && pile->old_pairs[old].bridged);
    }
}

static void pieces_join(const search* s, int64_t count)
{
    for (int64_t k = 0; k < count; k++)
    {
        found* f = &s->pieces[k];
        for (int i = 0; i < f->pair_count; i++)
        {
            pair* p = &s->pile->pairs[f->first_pair + i];
            *p = f->pairs[i];
            p->first += f->first_touch;
        }
        if (f->touch_count > 0)
            memcpy(s->pile->touches + f->first_touch, f->touches, (size_t)f->touch_count * sizeof(touch));
        ty_free(f->pairs);
        ty_free(f->touches);
        *f = (found){0};
    }
}

// Searches all bodies in pieces and puts what they find behind what is there, in the pieces' order.
static void search_run(search* s, ty_workers* workers, ty_range_fn* fn)
{
    ty_pile* pile = s->pile;
    int64_t count = (pile->count + SEARCH_PIECE - 1) / SEARCH_PIECE;
    // One piece at a time on the caller too: it tells its piece by its first body.
    ty_workers* shared = count > 1 ? workers : NULL;
    ty_parallel_all(shared, pile->count, SEARCH_PIECE, fn, s);
    for (int64_t k = 0; k < count; k++)
    {
        found* f = &s->pieces[k];
        f->first_pair = pile->pair_count, f->first_touch = pile->touch_count;
        pile->pair_count += f->pair_count, pile->touch_count += f->touch_count;
    }
    list_reserve((void**)&pile->pairs, &pile->pair_capacity, pile->pair_count, sizeof(pair));
    list_reserve((void**)&pile->touches, &pile->touch_capacity, pile->touch_count, sizeof(touch));
    pieces_join(s, count);
}

static void candidates_find(ty_pile* pile, ty_workers* workers)
{
    float widest = 0.0f;
    for (int i = 0; i < pile->count; i++)
        widest = ty_max(widest, pile->poses[i].reach);
    search s = {.pile = pile, .spheres = spheres_make(pile)};
    s.grid = body_grid_create(pile->bodies, offsetof(ty_body, position), sizeof(ty_body), pile->count,
                              2.0f * pile->max_radius * pile->growth + widest);
    s.pieces = TY_ALLOC(found, (pile->count + SEARCH_PIECE - 1) / SEARCH_PIECE);
    search_run(&s, workers, pairs_find);
    pile->wall_first = pile->pair_count;
    search_run(&s, workers, walls_find);
    ty_free(s.pieces);
    ty_free(s.spheres);
    body_grid_destroy(&s.grid);
}

// --- colours ---

static void pairs_order(ty_pile* pile)
{
    list_reserve((void**)&pile->order, &pile->order_capacity, pile->pair_count, sizeof(int));
    pairs_color(pile->pairs, sizeof *pile->pairs, pile->pair_count, pile->count, pile->order, pile->color_first);
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

// m/s, of a point of the body at most.
static float body_speed(const ty_pile* pile, int i)
{
    const motion* m = &pile->motions[i];
    return ty_length(m->v) + ty_length(m->w) * pile->def.grains[pile->bodies[i].grain].radius;
}

// Seconds that a body's speed is looked ahead: twelve substeps each way, or fewer when the whole pile is fast, for
// candidates grow with the cube of the reach. Single fast bodies reach far and keep the others from being searched.
static float look_ahead(const ty_pile* pile)
{
    const float longest = 24.0f / pile->def.rate;
    float speeds = 0.0f, radii = 0.0f;
    for (int i = 0; i < pile->count; i++)
    {
        speeds += body_speed(pile, i);
        radii += pile->def.grains[pile->bodies[i].grain].radius * pile->bodies[i].scale;
    }
    return speeds * longest > REACH_SHARE * radii ? REACH_SHARE * radii / speeds : longest;
}

void pile_detect(ty_pile* pile, float margin, ty_workers* workers)
{
    const float ahead = look_ahead(pile);
    for (int i = 0; i < pile->count; i++)
    {
        float radius = pile->def.grains[pile->bodies[i].grain].radius;
        pile->poses[i].reach = ty_min(ty_max(margin, ahead * body_speed(pile, i)), margin + radius);
        pile->poses[i].seen = pile->bodies[i].position;
        pile->poses[i].seen_rotation = pile->bodies[i].rotation;
    }
    pile_walls_see(pile);
    pile_detect_again(pile, workers);
}

void pile_detect_again(ty_pile* pile, ty_workers* workers)
{
    lists_swap(pile);
    candidates_find(pile, workers);
    pairs_order(pile);
    pile->stale = false;
    pile->resized = 0.0f;
}

// Each of two balls may come nearer by .45 of the margin. An angle is at most 2.1 times the distance of its
// quaternions.
bool pile_moved(const ty_pile* pile)
{
    if (pile->stale || pile_walls_moved(pile))
        return true;
    for (int i = 0; i < pile->count; i++)
    {
        const ty_body* b = &pile->bodies[i];
        const pose* at = &pile->poses[i];
        ty_quat p = b->rotation, q = at->seen_rotation;
        float turn = ty_sqr(p.x - q.x) + ty_sqr(p.y - q.y) + ty_sqr(p.z - q.z) + ty_sqr(p.w - q.w);
        float lever = 2.1f * pile->def.grains[b->grain].radius * b->scale * pile->growth * pile_bent_reach(pile, i);
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

// As they lie in memory.
static void each_range(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const sweep* s = context;
    for (int64_t i = begin; i < end; i++)
        s->fn(s->pile, &s->pile->pairs[i]);
}

void pile_sweep(ty_pile* pile, ty_workers* workers, pile_pair_fn* fn)
{
    enum
    {
        WORTH_SHARING = 768, // pairs of a colour; below, waking a thread costs more than it gives
    };
    for (int c = 0; c <= PAIR_COLORS; c++)
    {
        sweep s = {pile, fn, pile->color_first[c]};
        int count = pile->color_first[c + 1] - s.first;
        bool share = count >= WORTH_SHARING && c != PAIR_COLORS - 1;
        if (count > 0)
            ty_parallel_all(share ? workers : NULL, count, share ? (count + 7) / 8 : count, sweep_range, &s);
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
    ty_parallel_all(share ? workers : NULL, pile->pair_count, share ? PIECE : pile->pair_count + 1, each_range, &s);
}
