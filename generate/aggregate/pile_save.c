// SPDX-License-Identifier: Apache-2.0
// A pile as bytes and back, such that it goes on to the bit. Candidates are not saved but found again from where the
// bodies stood when they were found; of them the impulses that are kept, and which pairs hold a bridge of liquid.
#include "pile_state.h"
#include <string.h>

static const char magic[8] = "tsuyaPI1";

enum
{
    MAY_SLEEP = 1,
    STALE = 2,
    HELD = 4,
    RESTED = 8,
    PAUSE_MAY_SLEEP = 16,
    FLAGS = 32,
};

// In the machine's byte order, without gaps.
typedef struct saved_head
{
    char magic[8];
    float time, max_radius;
    int32_t substeps, settled, calm;
    uint32_t flags;
    int32_t body_count, bend_count, pair_count, wall_first, touch_count, wall_count;
} saved_head;

typedef struct saved_body
{
    ty_body body;
    ty_vec3 seen;
    ty_quat seen_rotation;
    float reach;
    ty_vec3 roll;
    uint16_t quiet;
    uint8_t asleep, slept;
} saved_body;

typedef struct saved_pair
{
    int32_t a, b;
    uint16_t count, bridged;
} saved_pair;

typedef struct saved_touch
{
    uint8_t a, b, gap[2];
    float normal_impulse;
    ty_vec3 tangent_impulse;
} saved_touch;

typedef struct saved_wall
{
    ty_wall_motion seen;
    float farthest;
} saved_wall;

_Static_assert(sizeof(saved_head) == 56 && sizeof(saved_body) == 108 && sizeof(saved_pair) == 12 &&
                   sizeof(saved_touch) == 20 && sizeof(bend) == 80 && sizeof(saved_wall) == 56,
               "saved structs have no gaps");

static size_t saved_size(const saved_head* h)
{
    return sizeof *h + (size_t)h->body_count * sizeof(saved_body) + (size_t)h->bend_count * sizeof(bend) +
           (size_t)h->pair_count * sizeof(saved_pair) + (size_t)h->touch_count * sizeof(saved_touch) +
           (size_t)h->wall_count * sizeof(saved_wall);
}

// --- saving ---

static bool is_kept(const touch* t)
{
    const ty_vec3 none = {0.0f, 0.0f, 0.0f}; // compared as bytes: a negative zero is not none
    return t->normal_impulse != 0.0f || memcmp(&t->tangent_impulse, &none, sizeof none) != 0;
}

static int kept_touches(const ty_pile* pile, const pair* p)
{
    int count = 0;
    for (int i = p->first; i < p->first + p->count; i++)
        count += is_kept(&pile->near.touches[i]);
    return count;
}

static saved_head head_of(const ty_pile* pile)
{
    saved_head h = {.time = pile->time, .max_radius = pile->max_radius, .substeps = pile->substeps};
    memcpy(h.magic, magic, sizeof magic);
    h.settled = pile->pause.held ? pile->pause.settled : 0;
    h.calm = pile->pause.held ? pile->pause.calm : 0;
    h.flags = (pile->may_sleep ? MAY_SLEEP : 0u) | (pile->stale ? STALE : 0u) | (pile->pause.held ? HELD : 0u);
    if (pile->pause.held)
        h.flags |= (pile->pause.rested ? RESTED : 0u) | (pile->pause.may_sleep ? PAUSE_MAY_SLEEP : 0u);
    h.body_count = pile->count;
    h.bend_count = pile->bends ? pile->count : 0;
    h.wall_count = pile_moving_walls(pile);
    for (int i = 0; i < pile->near.pair_count; i++)
    {
        int touches = kept_touches(pile, &pile->near.pairs[i]);
        bool saved = touches > 0 || pile->near.pairs[i].bridged;
        h.pair_count += saved;
        h.wall_first += saved && i < pile->near.wall_first;
        h.touch_count += touches;
    }
    return h;
}

static uint8_t* put(uint8_t* at, const void* value, size_t size)
{
    memcpy(at, value, size);
    return at + size;
}

static uint8_t* bodies_put(const ty_pile* pile, uint8_t* at)
{
    for (int i = 0; i < pile->count; i++)
    {
        const motion* m = &pile->motions[i];
        saved_body b = {
            pile->bodies[i], pile->poses[i].seen, pile->poses[i].seen_rotation, pile->poses[i].reach, pile->rolls[i],
            m->quiet,        m->asleep,           pile->pause.held && m->slept};
        b.body.velocity = m->v;
        b.body.spin = m->w;
        at = put(at, &b, sizeof b);
    }
    return at;
}

static uint8_t* pairs_put(const ty_pile* pile, uint8_t* at)
{
    for (int i = 0; i < pile->near.pair_count; i++)
    {
        const pair* p = &pile->near.pairs[pile->near.places[i]];
        saved_pair s = {p->a, p->b, (uint16_t)kept_touches(pile, p), p->bridged};
        if (s.count > 0 || s.bridged)
            at = put(at, &s, sizeof s);
    }
    return at;
}

static uint8_t* touches_put(const ty_pile* pile, uint8_t* at)
{
    for (int i = 0; i < pile->near.pair_count; i++)
    {
        const pair* p = &pile->near.pairs[pile->near.places[i]];
        for (int k = p->first; k < p->first + p->count; k++)
        {
            const touch* t = &pile->near.touches[k];
            saved_touch s = {t->a, t->b, {0, 0}, t->normal_impulse, t->tangent_impulse};
            if (is_kept(t))
                at = put(at, &s, sizeof s);
        }
    }
    return at;
}

ty_status ty_pile_save(const ty_pile* pile, ty_bytes* out, ty_error* error)
{
    saved_head h = head_of(pile);
    size_t size = saved_size(&h);
    *out = (ty_bytes){TY_TRY_ALLOC(uint8_t, size + 1), size};
    if (!out->data)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for the state of %d bodies", pile->count);
    uint8_t* at = put(out->data, &h, sizeof h);
    at = bodies_put(pile, at);
    for (int i = 0; i < h.bend_count; i++) // whole: of an unbent body it is not what an identity would be made into
        at = put(at, &pile->bends[i], sizeof(bend));
    at = pairs_put(pile, at);
    at = touches_put(pile, at);
    for (int w = 0; w < h.wall_count; w++)
    {
        saved_wall s = {pile->walls[w].seen, pile->walls[w].farthest};
        at = put(at, &s, sizeof s);
    }
    TY_ASSERT(at == out->data + size);
    return TY_OK;
}

// --- restoring ---

typedef struct restorer
{
    ty_pile* pile;
    ty_workers* workers;
    saved_head head;
    const uint8_t *bodies, *bends, *pairs, *touches, *walls;
    ty_error* error;
} restorer;

static ty_status damaged(const restorer* r, const char* what, int index)
{
    return ty_error_set(r->error, TY_BAD_FILE, "the state of the pile is damaged: %s %d", what, index);
}

static void take(const uint8_t* from, int index, void* out, size_t size)
{
    memcpy(out, from + (size_t)index * size, size);
}

static bool is_unit(ty_quat q)
{
    return fabsf(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1.0f) < 1e-3f; // false for NaN
}

static bool is_near(ty_vec3 p)
{
    return ty_length_sqr(p) < 1e8f;
}

static ty_status bodies_check(const restorer* r)
{
    for (int i = 0; i < r->head.body_count; i++)
    {
        saved_body b;
        take(r->bodies, i, &b, sizeof b);
        bool good = b.body.grain < (uint32_t)r->pile->def.grain_count && b.body.scale > 0.01f && b.body.scale <= 100.0f;
        good = good && is_near(b.body.position) && is_near(b.seen) && is_unit(b.body.rotation);
        good = good && is_unit(b.seen_rotation) && ty_length_sqr(b.body.velocity) < 1e6f &&
               ty_length_sqr(b.body.spin) < 1e10f;
        good = good && ty_length_sqr(b.roll) < 1.0f;
        // As pile_detect bounds it: candidates grow with its cube.
        float farthest = good ? r->pile->margin + r->pile->def.grains[b.body.grain].radius : 0.0f;
        good = good && b.reach >= 0.0f && b.reach <= 1.001f * farthest && b.asleep <= 1 && b.slept <= 1;
        if (!good)
            return damaged(r, "body", i);
    }
    return TY_OK;
}

static ty_status bends_check(const restorer* r)
{
    for (int i = 0; i < r->head.bend_count; i++)
    {
        bend b;
        take(r->bends, i, &b, sizeof b);
        const ty_affine* m = &b.map;
        float size = ty_length_sqr(m->x) + ty_length_sqr(m->y) + ty_length_sqr(m->z) + ty_length_sqr(m->t);
        bool good = ty_affine_determinant(m) > 1e-3f && size < 1e3f && b.mean > 0.0f && b.mean < 100.0f;
        good = good && b.most >= b.mean && b.most < 100.0f;
        for (int k = 0; k < 6; k++)
            good = good && fabsf(b.inverse_inertia[k]) < 1e18f;
        if (!good)
            return damaged(r, "bent body", i);
    }
    return TY_OK;
}

// Ascending, walls last, and the touches within each as well.
static ty_status pairs_check(const restorer* r)
{
    saved_pair last = {-1, -1, 0, 0};
    int at = 0, walls = r->pile->def.container ? ty_container_wall_count(r->pile->def.container) : 0;
    for (int i = 0; i < r->head.pair_count; i++)
    {
        saved_pair p;
        take(r->pairs, i, &p, sizeof p);
        bool wall = i >= r->head.wall_first, first = i == 0 || i == r->head.wall_first;
        bool good = p.a >= 0 && p.a < r->head.body_count && (wall ? p.b == PILE_WALL : p.b > p.a);
        good = good && p.b < r->head.body_count && p.bridged <= 1 && p.count <= r->head.touch_count - at;
        if (!good || (!first && (p.a < last.a || (p.a == last.a && p.b <= last.b))))
            return damaged(r, "pair", i);
        saved_body a, b = {0};
        take(r->bodies, p.a, &a, sizeof a);
        if (!wall)
            take(r->bodies, p.b, &b, sizeof b);
        int of_a = r->pile->def.grains[a.body.grain].ball_count;
        int of_b = wall ? walls : r->pile->def.grains[b.body.grain].ball_count, before = -1;
        for (int end = at + p.count; at < end; at++)
        {
            saved_touch t;
            take(r->touches, at, &t, sizeof t);
            int order = t.a * 256 + t.b;
            bool sane = fabsf(t.normal_impulse) < 1e4f && ty_length_sqr(t.tangent_impulse) < 1e8f;
            if (!sane || t.a >= of_a || t.b >= of_b || order <= before)
                return damaged(r, "contact", at);
            before = order;
        }
        last = p;
    }
    return at == r->head.touch_count ? TY_OK : damaged(r, "contacts beyond", at);
}

static ty_status head_check(restorer* r, const void* bytes, size_t size)
{
    saved_head* h = &r->head;
    if (size < sizeof *h)
        return ty_error_set(r->error, TY_BAD_FILE, "the state of the pile is cut off");
    memcpy(h, bytes, sizeof *h);
    if (memcmp(h->magic, magic, sizeof magic) != 0)
        return ty_error_set(r->error, TY_BAD_FILE, "the state of the pile is one of another program");
    bool good = h->body_count >= 0 && (h->bend_count == 0 || h->bend_count == h->body_count) && h->pair_count >= 0 &&
                h->touch_count >= 0 && h->wall_first >= 0 && h->wall_first <= h->pair_count && h->flags < FLAGS &&
                h->settled >= 0 && h->substeps >= 0;
    good = good && h->calm >= 0 && h->calm < 1000 && h->time >= 0.0f && h->time < 1e6f;
    good = good && h->max_radius >= 0.0f && h->max_radius < 1e3f;
    if (!good)
        return damaged(r, "head", 0);
    if (h->wall_count != pile_moving_walls(r->pile))
        return ty_error_set(r->error, TY_BAD_FILE, "the state of the pile has %d moving walls, not %d", h->wall_count,
                            pile_moving_walls(r->pile));
    if (saved_size(h) != size)
        return ty_error_set(r->error, TY_BAD_FILE, "the state of the pile is cut off");
    const uint8_t* at = (const uint8_t*)bytes + sizeof *h;
    r->bodies = at;
    r->bends = at + (size_t)h->body_count * sizeof(saved_body);
    r->pairs = r->bends + (size_t)h->bend_count * sizeof(bend);
    r->touches = r->pairs + (size_t)h->pair_count * sizeof(saved_pair);
    r->walls = r->touches + (size_t)h->touch_count * sizeof(saved_touch);
    return TY_OK;
}

static void pairs_take(const restorer* r)
{
    candidates* near = &r->pile->near;
    list_reserve((void**)&near->pairs, &near->pair_capacity, r->head.pair_count, sizeof(pair));
    list_reserve((void**)&near->places, &near->place_capacity, r->head.pair_count, sizeof(int));
    list_reserve((void**)&near->touches, &near->touch_capacity, r->head.touch_count, sizeof(touch));
    int first = 0;
    for (int i = 0; i < r->head.pair_count; i++)
    {
        saved_pair s;
        take(r->pairs, i, &s, sizeof s);
        near->pairs[i] = (pair){.a = s.a, .b = s.b, .first = first, .count = s.count, .bridged = s.bridged};
        near->pairs[i].loaded = s.count > 0;
        near->places[i] = i;
        first += s.count;
    }
    for (int i = 0; i < r->head.touch_count; i++)
    {
        saved_touch s;
        take(r->touches, i, &s, sizeof s);
        near->touches[i] =
            (touch){.a = s.a, .b = s.b, .normal_impulse = s.normal_impulse, .tangent_impulse = s.tangent_impulse};
    }
    near->pair_count = r->head.pair_count;
    near->wall_first = r->head.wall_first;
    near->touch_count = r->head.touch_count;
}

// The lists as they were: found from where all stood then.
static void candidates_restore(const restorer* r, const ty_body* now)
{
    ty_pile* pile = r->pile;
    ty_body* then = TY_ALLOC(ty_body, pile->count);
    for (int i = 0; i < pile->count; i++)
    {
        saved_body s;
        take(r->bodies, i, &s, sizeof s);
        then[i] = s.body;
        then[i].position = s.seen;
        then[i].rotation = s.seen_rotation;
    }
    ty_pile_set_bodies(pile, then);
    for (int i = 0; i < pile->count; i++)
    {
        saved_body s;
        take(r->bodies, i, &s, sizeof s);
        pile->poses[i].reach = s.reach;
    }
    pile_detect_again(pile, r->workers);
    ty_pile_set_bodies(pile, now);
    ty_free(then);
}

static void bodies_take(const restorer* r)
{
    ty_pile* pile = r->pile;
    ty_body* now = TY_ALLOC(ty_body, r->head.body_count);
    for (int i = 0; i < r->head.body_count; i++)
    {
        saved_body s;
        take(r->bodies, i, &s, sizeof s);
        now[i] = s.body;
    }
    ty_pile_add(pile, now, r->head.body_count);
    for (int i = 0; i < r->head.bend_count; i++)
    {
        bend b;
        take(r->bends, i, &b, sizeof b);
        ty_pile_bend(pile, i, &b.map);
        pile->bends[i] = b;
        pile_refresh(pile, i);
    }
    for (int w = 0; w < r->head.wall_count; w++)
    {
        saved_wall s;
        take(r->walls, w, &s, sizeof s);
        pile->walls[w] = (moving_wall){s.seen, s.seen, s.farthest};
    }
    pairs_take(r);
    if (!(r->head.flags & STALE))
        candidates_restore(r, now);
    for (int i = 0; i < pile->count; i++)
    {
        saved_body s;
        take(r->bodies, i, &s, sizeof s);
        pile->poses[i].seen = s.seen;
        pile->poses[i].seen_rotation = s.seen_rotation;
        pile->poses[i].reach = s.reach;
        pile->rolls[i] = s.roll;
        pile->motions[i].quiet = s.quiet;
        pile->motions[i].slept = s.slept;
        if (s.asleep)
            pile_body_sleep(&pile->motions[i]);
    }
    ty_free(now);
}

ty_status ty_pile_restore(ty_pile* pile, const void* bytes, size_t size, ty_workers* workers, ty_error* error)
{
    restorer r = {.pile = pile, .workers = workers, .error = error};
    TY_ASSERT(pile->count == 0);
    ty_status status = head_check(&r, bytes, size);
    if (status == TY_OK)
        status = bodies_check(&r);
    if (status == TY_OK)
        status = bends_check(&r);
    if (status == TY_OK)
        status = pairs_check(&r);
    if (status != TY_OK)
        return status;
    pile->max_radius = r.head.max_radius;
    bodies_take(&r);
    pile->time = r.head.time;
    pile->substeps = r.head.substeps;
    pile->may_sleep = r.head.flags & MAY_SLEEP;
    pile->stale = r.head.flags & STALE;
    pile->pause = (pile_pause){r.head.flags & HELD, r.head.flags & RESTED, r.head.flags & PAUSE_MAY_SLEEP,
                               r.head.settled, r.head.calm};
    pile_walls_place(pile);
    return TY_OK;
}
