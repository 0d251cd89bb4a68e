// SPDX-License-Identifier: Apache-2.0
// The aperiodic filling of Gan 2023: each element moves inwards to where a cost of overlap is least, or is taken out.
#include "start.h"
#include <string.h>

enum
{
    STEPS = 24, // along the way, before the last one is halved
    HALVINGS = 6,
};

typedef struct thesis
{
    const ty_container* container;
    const ty_element* grains;
    const ty_thesis_def* def;
    float way; // r C_refine, m
    ty_body* bodies;
    bool* gone;
    int count;
    ty_vec3 low;
    float cell, reach; // reach: of the largest element about its position
    int size[3];
    int *first, *next, *at; // bucket chains; the bucket of each body
    ty_ball* balls;         // of the elements about one
    int ball_count, ball_capacity;
    ty_ball own[TY_ELEMENT_MAX_BALLS];
    int own_count;
} thesis;

// --- where elements are ---

static int bucket(const thesis* s, ty_vec3 p, int c[3])
{
    float q[3] = {p.x - s->low.x, p.y - s->low.y, p.z - s->low.z};
    for (int a = 0; a < 3; a++)
        c[a] = (int)ty_clamp(q[a] / s->cell, 0.0f, (float)(s->size[a] - 1));
    return (c[2] * s->size[1] + c[1]) * s->size[0] + c[0];
}

static void body_link(thesis* s, int i)
{
    int c[3], at = bucket(s, s->bodies[i].position, c);
    s->at[i] = at;
    s->next[i] = s->first[at];
    s->first[at] = i;
}

static void body_unlink(thesis* s, int i)
{
    int* link = &s->first[s->at[i]];
    while (*link != i)
        link = &s->next[*link];
    *link = s->next[i];
}

static void buckets_make(thesis* s, int grain_count)
{
    ty_bounds box = ty_bounds_empty();
    for (int i = 0; i < grain_count; i++)
        s->reach = ty_max(s->reach, s->grains[i].radius);
    float scale = 0.0f;
    for (int i = 0; i < s->count; i++)
    {
        box = ty_bounds_add(box, s->bodies[i].position);
        scale = ty_max(scale, s->bodies[i].scale);
    }
    s->reach *= scale;
    s->low = box.low;
    ty_vec3 size = ty_sub(box.high, box.low);
    s->cell = ty_max(2.0f * s->reach, ty_max(size.x, ty_max(size.y, size.z)) / 255.0f);
    s->size[0] = (int)(size.x / s->cell) + 1, s->size[1] = (int)(size.y / s->cell) + 1;
    s->size[2] = (int)(size.z / s->cell) + 1;
    size_t cells = (size_t)s->size[0] * (size_t)s->size[1] * (size_t)s->size[2];
    s->first = TY_ALLOC(int, cells);
    memset(s->first, 0xff, cells * sizeof(int));
    s->next = TY_ALLOC(int, s->count);
    s->at = TY_ALLOC(int, s->count);
    for (int i = s->count - 1; i >= 0; i--)
        body_link(s, i);
}

static ty_affine body_frame(const ty_body* b)
{
    return ty_affine_from_trs(b->position, b->rotation, ty_vec3_make(b->scale, b->scale, b->scale));
}

static void balls_add(thesis* s, const ty_body* b)
{
    const ty_element* grain = &s->grains[b->grain];
    if (s->ball_count + grain->ball_count > s->ball_capacity)
    {
        int grown = 2 * (s->ball_count + grain->ball_count);
        s->balls = ty_grow(s->balls, (size_t)s->ball_capacity, (size_t)grown, sizeof *s->balls);
        s->ball_capacity = grown;
    }
    ty_affine frame = body_frame(b);
    for (int k = 0; k < grain->ball_count; k++)
        s->balls[s->ball_count++] =
            (ty_ball){ty_map_point(&frame, grain->balls[k].center), grain->balls[k].radius * b->scale};
}

// Balls of all elements that body i can meet on its way, but its own.
static void balls_gather(thesis* s, int i)
{
    const ty_body* body = &s->bodies[i];
    float own = s->grains[body->grain].radius * body->scale + s->way;
    int c[3], span = (int)((own + s->reach) / s->cell) + 1;
    bucket(s, body->position, c);
    s->ball_count = 0;
    for (int z = c[2] - span; z <= c[2] + span; z++)
        for (int y = c[1] - span; y <= c[1] + span; y++)
            for (int x = c[0] - span; x <= c[0] + span; x++)
            {
                if (x < 0 || y < 0 || z < 0 || x >= s->size[0] || y >= s->size[1] || z >= s->size[2])
                    continue;
                for (int j = s->first[(z * s->size[1] + y) * s->size[0] + x]; j >= 0; j = s->next[j])
                {
                    const ty_body* other = &s->bodies[j];
                    float near = own + s->grains[other->grain].radius * other->scale;
                    if (j != i && ty_length_sqr(ty_sub(other->position, body->position)) < ty_sqr(near))
                        balls_add(s, other);
                }
            }
}

static void own_gather(thesis* s, const ty_body* b)
{
    const ty_element* grain = &s->grains[b->grain];
    ty_affine frame = body_frame(b);
    s->own_count = grain->ball_count;
    for (int k = 0; k < grain->ball_count; k++)
        s->own[k] = (ty_ball){ty_map_point(&frame, grain->balls[k].center), grain->balls[k].radius * b->scale};
}

// --- the cost ---

// The largest f of equation 2 on a ball of the element itself that is moved to x: how deep it lies in the balls of
// others, or behind a wall. Vertices, as the equation has them, miss the tip of another element between them.
static float depth_at(const thesis* s, ty_vec3 x, float radius)
{
    float most = 0.0f;
    ty_vec3 n;
    for (int k = 0; k < s->ball_count; k++)
    {
        const ty_ball* b = &s->balls[k];
        float square = ty_length_sqr(ty_sub(x, b->center)), sum = b->radius + radius, least = sum - most;
        if (least > 0.0f && square < ty_sqr(least))
            most = sum - sqrtf(square);
    }
    for (int w = 0; w < ty_container_wall_count(s->container); w++)
        most = ty_max(most, radius - ty_container_wall(s->container, w, x, &n));
    return most - s->def->offset;
}

// c of equation 1.
static float cost(const thesis* s, ty_vec3 n, float t)
{
    float h = -TY_FLOAT_MAX;
    for (int i = 0; i < s->own_count; i++)
        h = ty_max(h, depth_at(s, ty_mad(s->own[i].center, n, t), s->own[i].radius));
    return (h > 0.0f ? h + s->way : 0.0f) + t;
}

// The least cost on the way and where it is; the first free place is found to a small part of a step.
static float cost_least(const thesis* s, ty_vec3 n, float* where)
{
    float best = cost(s, n, 0.0f), step = s->way / (float)STEPS;
    *where = 0.0f;
    for (int i = 1; i <= STEPS && best > s->way; i++)
    {
        float t = step * (float)i, c = cost(s, n, t);
        if (c < best)
        {
            best = c;
            *where = t;
        }
    }
    if (*where == 0.0f || best > s->way)
        return best;
    float low = *where - step, high = *where;
    for (int i = 0; i < HALVINGS; i++)
    {
        float middle = 0.5f * (low + high), c = cost(s, n, middle);
        bool is_free = c <= s->way;
        *(is_free ? &high : &low) = middle;
        best = is_free ? c : best;
    }
    *where = high;
    return best;
}

// Away from the nearest wall.
static ty_vec3 inward(const ty_container* c, ty_vec3 p)
{
    ty_vec3 best = {0.0f, 1.0f, 0.0f}, n;
    float least = TY_FLOAT_MAX;
    for (int w = 0; w < ty_container_wall_count(c); w++)
    {
        float gap = ty_container_wall(c, w, p, &n);
        if (gap < least)
        {
            least = gap;
            best = n;
        }
    }
    return best;
}

static float body_refine(thesis* s, int i)
{
    ty_body* b = &s->bodies[i];
    ty_vec3 n = inward(s->container, b->position);
    float t;
    balls_gather(s, i);
    own_gather(s, b);
    float c = cost_least(s, n, &t);
    b->position = ty_mad(b->position, n, t);
    return c;
}

int ty_fill_thesis(const ty_container* container, const ty_element* grains, int grain_count, const ty_thesis_def* def,
                   float spacing, ty_body* bodies, int count, bool* gone)
{
    thesis* s = TY_ALLOC(thesis, 1);
    *s = (thesis){.container = container,
                  .grains = grains,
                  .def = def,
                  .way = spacing * def->refine,
                  .bodies = bodies,
                  .gone = gone,
                  .count = count};
    buckets_make(s, grain_count);
    for (int i = 0; i < count; i++)
    {
        body_unlink(s, i);
        body_refine(s, i);
        body_link(s, i);
    }
    for (int i = 0; i < count; i++)
        body_unlink(s, i);
    int removed = 0;
    // The second pass puts them back one by one: each has to do with those that stayed before it, so none goes for the
    // sake of one that goes later.
    for (int i = 0; i < count; i++)
    {
        gone[i] = body_refine(s, i) > def->remove * s->way;
        removed += gone[i];
        if (!gone[i])
            body_link(s, i);
    }
    ty_free(s->first);
    ty_free(s->next);
    ty_free(s->at);
    ty_free(s->balls);
    ty_free(s);
    return removed;
}
