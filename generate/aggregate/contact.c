// SPDX-License-Identifier: Apache-2.0
// Contact candidates of a pile: found on a grid, put into blocks with the impulses they keep.
#include "pile_state.h"
#include <string.h>

// --- candidates ---

// What one piece of the bodies finds, in id order; pieces are joined in order, whoever found them.
typedef struct found
{
    pair* pairs;
    int pair_count, pair_capacity;
    touch* touches;
    int touch_count, touch_capacity;
    int first_pair; // of the piece in the whole
} found;

enum
{
    SEARCH_PIECE = 512, // bodies that are searched at a time
};

static void touch_push(found* f, int a, int b, float gap)
{
    list_reserve((void**)&f->touches, &f->touch_capacity, f->touch_count + 1, sizeof(touch));
    float units = ty_clamp(gap * (1.0f / PILE_GAP_UNIT), 0.0f, PILE_GAP_MOST);
    f->touches[f->touch_count++] = (touch){.a = (uint8_t)a, .b = (uint8_t)b, .gap = (uint8_t)units};
}

// The impulses of a pair's touches that were candidates before; both lists ascend in (a, b).
static void impulses_keep(const ty_pile* pile, found* f, int first, const pair* old)
{
    const touch *from = pile->former.touches + old->first, *end = from + old->count;
    for (int t = first; t < f->touch_count; t++)
    {
        touch* to = &f->touches[t];
        while (from < end && (from->a < to->a || (from->a == to->a && from->b < to->b)))
            from++;
        if (from < end && from->a == to->a && from->b == to->b)
        {
            to->normal_impulse = from->normal_impulse;
            to->tangent_impulse = from->tangent_impulse;
        }
    }
}

// known: the same pair before, or NULL.
static void pair_push(const ty_pile* pile, found* f, int a, int b, int first, const pair* known)
{
    if (f->touch_count == first)
        return;
    pair p = {.a = a, .b = b, .first = first, .count = (uint16_t)(f->touch_count - first), .gap = PILE_GAP_MOST};
    for (int i = first; i < f->touch_count; i++)
        p.gap = f->touches[i].gap < p.gap ? f->touches[i].gap : p.gap;
    if (known)
    {
        impulses_keep(pile, f, first, known);
        p.loaded = known->loaded;
        p.bridged = known->bridged;
    }
    list_reserve((void**)&f->pairs, &f->pair_capacity, f->pair_count + 1, sizeof(pair));
    f->pairs[f->pair_count++] = p;
}

// The pair at a place of the former ones in their order.
static const pair* former_at(const ty_pile* pile, int i)
{
    return &pile->former.pairs[pile->former.places[i]];
}

// The first of them from begin to end whose first body is at least a.
static int old_pair_at(const ty_pile* pile, int begin, int end, int a)
{
    while (begin < end)
    {
        int middle = begin + (end - begin) / 2;
        if (former_at(pile, middle)->a < a)
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

// Of the hull about the line between the first and the last ball.
static float capsule_radius(const ty_pile* pile, int body)
{
    const ty_body* b = &pile->bodies[body];
    return pile->def.grains[b->grain].capsule * b->scale * pile->growth * pile_bent_reach(pile, body);
}

static bool capsules_meet(const ty_pile* pile, int a, int b, float margin)
{
    const ty_ball *p = pile_balls(pile, a), *q = pile_balls(pile, b);
    const int last_p = pile_ball_count(pile, a) - 1, last_q = pile_ball_count(pile, b) - 1;
    float reach = capsule_radius(pile, a) + capsule_radius(pile, b) + margin;
    return segments_distance_sqr(p[0].center, ty_sub(p[last_p].center, p[0].center), q[0].center,
                                 ty_sub(q[last_q].center, q[0].center)) < reach * reach;
}

static void touches_find(const ty_pile* pile, found* f, int a, int b, float margin)
{
    const ty_ball *p = pile_balls(pile, a), *q = pile_balls(pile, b);
    if (!capsules_meet(pile, a, b, margin))
        return;
    const int of_a = pile_ball_count(pile, a), of_b = pile_ball_count(pile, b);
    const ty_vec3 axis = ty_sub(q[of_b - 1].center, q[0].center);
    const float along = 1.0f / ty_max(ty_length_sqr(axis), 1e-20f);
    const float radius = 1.001f * capsule_radius(pile, b) + margin;
    for (int i = 0; i < of_a; i++)
    {
        ty_vec3 d = ty_sub(p[i].center, q[0].center);
        float t = ty_clamp(ty_dot(d, axis) * along, 0.0f, 1.0f);
        if (ty_length_sqr(ty_mad(d, axis, -t)) > ty_sqr(radius + p[i].radius))
            continue;
        for (int k = 0; k < of_b; k++)
        {
            float square = ty_length_sqr(ty_sub(p[i].center, q[k].center)), reach = p[i].radius + q[k].radius;
            if (square < ty_sqr(reach + margin))
                touch_push(f, i, k, sqrtf(square) - reach);
        }
    }
}

typedef struct search
{
    ty_pile* pile;
    body_grid grid;
    ty_ball* spheres; // about the bodies, by half their reach wider
    found* pieces;
    pair* listed; // all, in id order
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
    int old = old_pair_at(pile, 0, pile->former.wall_first, (int)begin);
    body_list near = {0};
    for (int i = (int)begin; i < (int)end; i++)
    {
        body_grid_after(&s->grid, i, spheres_meet, s, &near);
        for (int n = 0; n < near.count; n++)
        {
            int j = near.at[n], first = f->touch_count;
            touches_find(pile, f, i, j, 0.5f * (pile->poses[i].reach + pile->poses[j].reach));
            const pair* o = NULL;
            for (; old < pile->former.wall_first; old++)
            {
                o = former_at(pile, old);
                if (o->a > i || (o->a == i && o->b >= j))
                    break;
            }
            bool known = old < pile->former.wall_first && o->a == i && o->b == j;
            pair_push(pile, f, i, j, first, known ? o : NULL);
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
        for (int w = 0; w <= walls; w++)
        {
            int wall = w < walls ? w : PILE_LID;
            float gap = w < walls || pile->lid ? pile_wall(pile, wall, balls[k].center, &n) - balls[k].radius : margin;
            if (gap < margin)
                touch_push(f, k, wall, gap);
        }
    }
}

static void walls_find(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const search* s = context;
    const ty_pile* pile = s->pile;
    found* f = &s->pieces[begin / SEARCH_PIECE];
    int old = old_pair_at(pile, pile->former.wall_first, pile->former.pair_count, (int)begin);
    for (int i = (int)begin; i < (int)end; i++)
    {
        int first = f->touch_count;
        body_walls_find(pile, f, i);
        while (old < pile->former.pair_count && former_at(pile, old)->a < i)
            old++;
        bool known = old < pile->former.pair_count && former_at(pile, old)->a == i;
        pair_push(pile, f, i, PILE_WALL, first, known ? former_at(pile, old) : NULL);
    }
}

// --- pieces to blocks ---

// All pairs in id order.
static void pieces_join(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const search* s = context;
    for (int64_t k = begin; k < end; k++)
    {
        const found* f = &s->pieces[k];
        if (f->pair_count > 0)
            memcpy(s->listed + f->first_pair, f->pairs, (size_t)f->pair_count * sizeof(pair));
    }
}

// Touches follow each other as their pairs do.
static void touches_place(const search* s, const int* order)
{
    candidates* near = &s->pile->near;
    int first = 0;
    for (int i = 0; i < near->pair_count; i++)
    {
        near->places[order[i]] = i;
        near->pairs[i] = s->listed[order[i]];
        near->pairs[i].first = first;
        first += near->pairs[i].count;
    }
}

static void pieces_scatter(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const search* s = context;
    const candidates* near = &s->pile->near;
    for (int64_t k = begin; k < end; k++)
    {
        found* f = &s->pieces[k];
        for (int i = 0; i < f->pair_count; i++)
        {
            const pair *from = &f->pairs[i], *to = &near->pairs[near->places[f->first_pair + i]];
            memcpy(near->touches + to->first, f->touches + from->first, from->count * sizeof(touch));
        }
        ty_free(f->pairs);
        ty_free(f->touches);
    }
}

static void search_run(search* s, ty_workers* workers)
{
    ty_pile* pile = s->pile;
    candidates* near = &pile->near;
    int64_t pieces = (pile->count + SEARCH_PIECE - 1) / SEARCH_PIECE;
    s->pieces = TY_ALLOC(found, 2 * pieces); // the second half are those of the walls
    // One piece at a time on the caller too: it tells its piece by its first body.
    ty_workers* shared = pieces > 1 ? workers : NULL;
    ty_parallel_all(shared, pile->count, SEARCH_PIECE, pairs_find, s);
    s->pieces += pieces;
    ty_parallel_all(shared, pile->count, SEARCH_PIECE, walls_find, s);
    s->pieces -= pieces;
    near->pair_count = near->touch_count = near->wall_first = 0;
    for (int64_t k = 0; k < 2 * pieces; k++)
    {
        found* f = &s->pieces[k];
        f->first_pair = near->pair_count;
        near->pair_count += f->pair_count, near->touch_count += f->touch_count;
        near->wall_first += k < pieces ? f->pair_count : 0;
    }
    list_reserve((void**)&near->pairs, &near->pair_capacity, near->pair_count, sizeof(pair));
    list_reserve((void**)&near->places, &near->place_capacity, near->pair_count, sizeof(int));
    list_reserve((void**)&near->touches, &near->touch_capacity, near->touch_count, sizeof(touch));
    int* order = TY_ALLOC(int, near->pair_count);
    s->listed = TY_ALLOC(pair, near->pair_count);
    ty_parallel_all(shared, 2 * pieces, 1, pieces_join, s);
    pair_blocks_make(&pile->blocks, &s->grid, s->listed, sizeof(pair), near->pair_count, order);
    touches_place(s, order);
    ty_parallel_all(shared, 2 * pieces, 1, pieces_scatter, s);
    ty_free(order);
    ty_free(s->listed);
    ty_free(s->pieces);
}

static void candidates_find(ty_pile* pile, ty_workers* workers)
{
    float widest = 0.0f;
    for (int i = 0; i < pile->count; i++)
        widest = ty_max(widest, pile->poses[i].reach);
    search s = {.pile = pile, .spheres = spheres_make(pile)};
    s.grid = body_grid_create(pile->bodies, offsetof(ty_body, position), sizeof(ty_body), pile->count,
                              2.0f * pile->max_radius * pile->growth + widest);
    search_run(&s, workers);
    ty_free(s.spheres);
    body_grid_destroy(&s.grid);
}

void pile_detect_again(ty_pile* pile, ty_workers* workers)
{
    candidates former = pile->former;
    pile->former = pile->near;
    pile->near = former;
    candidates_find(pile, workers);
    pile->stale = false;
    pile->resized = 0.0f;
}
