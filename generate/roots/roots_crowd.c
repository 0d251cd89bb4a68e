// SPDX-License-Identifier: Apache-2.0
// What of a branch would be seen: roots that are there already, by the cell of a grid in a table by hash.
#include "roots_link.h"

enum
{
    CELLS = 1 << 15,
    LOOKS = 24, // places of a branch that are held against others
};

#define SEEN 0.12f // of its length at least

typedef struct place
{
    ty_vec3 p;
    float r;
    int next;
} place;

struct crowd
{
    float cell; // m
    int heads[CELLS];
    place* places;
    int count, capacity;
};

static int* head_of(crowd* c, int x, int y, int z)
{
    return &c->heads[ty_mix32(ty_mix32(ty_mix32((uint32_t)x) + (uint32_t)y) + (uint32_t)z) % CELLS];
}

static void cell_of(const crowd* c, ty_vec3 p, int cell[3])
{
    ty_vec3 q = ty_mul(p, 1.0f / c->cell);
    cell[0] = (int)floorf(q.x);
    cell[1] = (int)floorf(q.y);
    cell[2] = (int)floorf(q.z);
}

void link_crowd_add(crowd* c, const roots_network* net, const roots_line* l)
{
    const roots_point* last = NULL;
    for (int i = l->first; i < l->first + l->count; i++)
    {
        const roots_point* p = &net->points[i];
        if (last && i < l->first + l->count - 1 && ty_length(ty_sub(p->p, last->p)) < 0.7f * p->r)
            continue;
        last = p;
        int at[3];
        cell_of(c, p->p, at);
        int* head = head_of(c, at[0], at[1], at[2]);
        if (c->count == c->capacity)
        {
            int capacity = c->capacity ? 2 * c->capacity : 4096;
            c->places = ty_grow(c->places, (size_t)c->capacity, (size_t)capacity, sizeof(place));
            c->capacity = capacity;
        }
        c->places[c->count] = (place){p->p, p->r, *head};
        *head = c->count++;
    }
}

crowd* link_crowd_create(const roots_network* net)
{
    crowd* c = TY_ALLOC(crowd, 1);
    *c = (crowd){.cell = 1e-6f};
    for (int i = 0; i < CELLS; i++)
        c->heads[i] = -1;
    for (int line = 0; line < net->line_count; line++)
        for (int i = 0; net->lines[line].kind != ROOTS_TRUNK && i < net->lines[line].count; i++)
            c->cell = ty_max(c->cell, net->points[net->lines[line].first + i].r);
    for (int line = 0; line < net->line_count; line++)
        if (net->lines[line].kind != ROOTS_TRUNK)
            link_crowd_add(c, net, &net->lines[line]);
    return c;
}

void link_crowd_destroy(crowd* c)
{
    ty_free(c->places);
    ty_free(c);
}

static bool is_within(crowd* c, ty_vec3 p)
{
    int at[3];
    cell_of(c, p, at);
    for (int k = 0; k < 27; k++)
        for (int i = *head_of(c, at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1); i >= 0;
             i = c->places[i].next)
            if (ty_length_sqr(ty_sub(c->places[i].p, p)) < ty_sqr(c->places[i].r))
                return true;
    return false;
}

bool link_crowd_hides(crowd* c, const wrap* w)
{
    int seen = 0;
    for (int i = 0; i < LOOKS; i++)
        seen += !is_within(c, w->p[(int)(((float)i + 0.5f) / LOOKS * (float)(w->count - 1))]);
    return (float)seen < SEEN * LOOKS;
}
