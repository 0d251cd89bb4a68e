// SPDX-License-Identifier: Apache-2.0
// The nodes of a sparse surface net: evaluated block by block, then made well-composed.
#include "net.h"
#include <string.h>

// --- nodes ---

static void blocks_fill(void* context, int64_t begin, int64_t end, int worker)
{
    ty_net* net = context;
    (void)worker;
    for (int64_t slot = begin; slot < end; slot++)
    {
        int block[3];
        net_block_of(net, (int)slot, block);
        net->def.fill(net->def.context, block, net->values + slot * TY_NET_NODES);
    }
}

// Inside and outside, both among the nodes of the block's cells?
static void blocks_look(void* context, int64_t begin, int64_t end, int worker)
{
    ty_net* net = context;
    float pad[NET_PAD * NET_PAD * NET_PAD];
    (void)worker;
    for (int64_t slot = begin; slot < end; slot++)
    {
        int inside = 0;
        net_pad_values(net, (int)slot, pad);
        for (int i = 0; i < NET_PAD * NET_PAD * NET_PAD; i++)
            inside += pad[i] < 0.0f;
        net->crossed[slot] = inside > 0 && inside < NET_PAD * NET_PAD * NET_PAD;
    }
}

// --- well-composed ---

#define NECK 0.3f // steps, half the width of the thinnest strands

typedef struct work
{
    uint32_t* items; // slot * TY_NET_NODES + node: cells to be looked at
    size_t count, capacity;
    bool failed;
} work;

static void work_add(work* w, uint32_t item)
{
    if (w->count == w->capacity)
    {
        size_t larger = w->capacity ? 2 * w->capacity : 4096;
        uint32_t* grown = ty_try_grow(w->items, w->capacity, larger, sizeof(uint32_t));
        w->failed |= !grown;
        if (!grown)
            return;
        w->items = grown;
        w->capacity = larger;
    }
    w->items[w->count++] = item;
}

static int32_t slot_at(const ty_net* net, const int at[3])
{
    bool beyond = at[0] < 0 || at[1] < 0 || at[2] < 0;
    return beyond ? NET_OUTSIDE : net_slot(net, at[0] >> 3, at[1] >> 3, at[2] >> 3);
}

// The node as slot * TY_NET_NODES + node; false where the grid holds none.
static bool node_find(const ty_net* net, const int at[3], uint32_t* out)
{
    enum
    {
        MASK = TY_NET_BLOCK - 1
    };
    int32_t slot = slot_at(net, at);
    if (slot < 0)
        return false;
    int node = ((at[2] & MASK) * TY_NET_BLOCK + (at[1] & MASK)) * TY_NET_BLOCK + (at[0] & MASK);
    *out = (uint32_t)slot * TY_NET_NODES + (uint32_t)node;
    return true;
}

static void node_coordinates(const ty_net* net, uint32_t place, int at[3])
{
    int block[3], node = (int)(place % TY_NET_NODES);
    net_block_of(net, (int)(place / TY_NET_NODES), block);
    at[0] = block[0] * TY_NET_BLOCK + node % TY_NET_BLOCK;
    at[1] = block[1] * TY_NET_BLOCK + node / TY_NET_BLOCK % TY_NET_BLOCK;
    at[2] = block[2] * TY_NET_BLOCK + node / TY_NET_BLOCK / TY_NET_BLOCK;
}

// Bits of the eight nodes of a cell that are inside, which have a square or the cube with two diagonal ones in one
// state and all others in the other: the corners of it; else 0.
static int cell_flaw(int inside)
{
    static const int faces[6][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 2, 4, 6}, {1, 3, 5, 7}};
    for (int f = 0; f < 6; f++)
    {
        int a = inside >> faces[f][0] & 1, b = inside >> faces[f][1] & 1;
        int c = inside >> faces[f][2] & 1, d = inside >> faces[f][3] & 1;
        if (a == d && b == c && a != b)
            return 1 << faces[f][0] | 1 << faces[f][1] | 1 << faces[f][2] | 1 << faces[f][3];
    }
    for (int i = 0; i < 4; i++)
    {
        int pair = 1 << i | 1 << (7 - i);
        if (inside == pair || inside == (255 ^ pair))
            return 255;
    }
    return 0;
}

static int pad_inside(const float* pad, int x, int y, int z)
{
    int inside = 0;
    for (int c = 0; c < 8; c++)
        inside |= (pad[((z + (c >> 2)) * NET_PAD + y + (c >> 1 & 1)) * NET_PAD + x + (c & 1)] < 0.0f) << c;
    return inside;
}

typedef struct search
{
    ty_net* net;
    bool* flawed; // [active_count]
} search;

static void blocks_search(void* context, int64_t begin, int64_t end, int worker)
{
    const search* s = context;
    float pad[NET_PAD * NET_PAD * NET_PAD];
    (void)worker;
    for (int64_t slot = begin; slot < end; slot++)
    {
        if (!s->net->crossed[slot])
            continue;
        net_pad_values(s->net, (int)slot, pad);
        for (int z = 0; z < TY_NET_BLOCK; z++)
            for (int y = 0; y < TY_NET_BLOCK; y++)
                for (int x = 0; x < TY_NET_BLOCK && !s->flawed[slot]; x++)
                    s->flawed[slot] = cell_flaw(pad_inside(pad, x, y, z)) != 0;
    }
}

// Fills the corner of the flaw that is least outside, and looks at the cells about it again.
static void cell_mend(ty_net* net, work* w, uint32_t place)
{
    int at[3], inside = 0, best = -1;
    uint32_t nodes[8];
    float values[8];
    node_coordinates(net, place, at);
    for (int c = 0; c < 8; c++)
    {
        const int corner[3] = {at[0] + (c & 1), at[1] + (c >> 1 & 1), at[2] + (c >> 2)};
        bool held = node_find(net, corner, &nodes[c]);
        values[c] = held ? net->values[nodes[c]] : slot_at(net, corner) == NET_SOLID ? -1.0f : TY_FLOAT_MAX;
        inside |= (values[c] < 0.0f) << c;
    }
    int flaw = cell_flaw(inside);
    for (int c = 0; c < 8; c++)
        if (flaw >> c & 1 && values[c] >= 0.0f && values[c] < TY_FLOAT_MAX && (best < 0 || values[c] < values[best]))
            best = c;
    if (best < 0)
        return;
    net->values[nodes[best]] = -NECK * net->def.step;
    for (int c = 0; c < 8; c++)
    {
        uint32_t cell;
        const int low[3] = {at[0] + (best & 1) - (c & 1), at[1] + (best >> 1 & 1) - (c >> 1 & 1),
                            at[2] + (best >> 2) - (c >> 2)};
        if (node_find(net, low, &cell))
            work_add(w, cell);
    }
}

// Strands of single nodes get a width that has room for triangles with corners: without it nothing could mend them, as
// they may be handles.
static void strands_widen(ty_net* net)
{
    static const int around[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    float thin = -NECK * net->def.step;
    for (int slot = 0; slot < net->def.active_count; slot++)
        for (uint32_t node = 0; net->crossed[slot] && node < TY_NET_NODES; node++)
        {
            uint32_t place = (uint32_t)slot * TY_NET_NODES + node, other;
            int at[3], inside = 0, corner[3];
            if (net->values[place] >= 0.0f || net->values[place] <= thin)
                continue;
            node_coordinates(net, place, at);
            memcpy(corner, at, sizeof corner);
            for (int i = 0; i < 6; i++)
            {
                const int next[3] = {at[0] + around[i][0], at[1] + around[i][1], at[2] + around[i][2]};
                bool in = node_find(net, next, &other) && net->values[other] < 0.0f;
                inside += in;
                for (int k = 0; k < 3; k++)
                    corner[k] += in ? around[i][k] : 0;
            }
            // Straight on it is the node itself that the two neighbours' steps lead to; else the fourth of a square.
            bool straight = memcmp(corner, at, sizeof at) == 0;
            if (inside == 2 && (straight || !node_find(net, corner, &other) || net->values[other] >= 0.0f))
                net->values[place] = thin;
        }
}

bool net_compose(ty_net* net, ty_workers* workers)
{
    work w = {0};
    search s = {net, TY_ALLOC(bool, net->def.active_count)};
    ty_parallel_all(workers, net->def.active_count, 64, blocks_search, &s);
    for (int slot = 0; slot < net->def.active_count; slot++)
        for (uint32_t node = 0; s.flawed[slot] && node < TY_NET_NODES; node++)
            work_add(&w, (uint32_t)slot * TY_NET_NODES + node);
    for (size_t i = 0; i < w.count && !w.failed; i++) // each mending adds a node to the inside, so that it ends
        cell_mend(net, &w, w.items[i]);
    strands_widen(net);
    ty_free(w.items);
    ty_free(s.flawed);
    return !w.failed;
}

// --- all of it ---

static bool net_allocate(ty_net* net, const ty_net_def* def)
{
    int64_t blocks = (int64_t)def->blocks[0] * def->blocks[1] * def->blocks[2];
    int32_t* active = TY_TRY_ALLOC(int32_t, def->active_count);
    net->def.active = active;
    net->slots = TY_TRY_ALLOC(int32_t, blocks);
    net->values = TY_TRY_ALLOC(float, (int64_t)def->active_count* TY_NET_NODES);
    net->cells = TY_TRY_ALLOC(int32_t, (int64_t)def->active_count * TY_NET_NODES);
    net->crossed = TY_TRY_ALLOC(bool, def->active_count);
    if (!active || !net->slots || !net->values || !net->cells || !net->crossed)
        return false;
    memcpy(active, def->active, (size_t)def->active_count * sizeof(int32_t));
    memset(net->slots, 0xff, (size_t)blocks * sizeof(int32_t));
    for (int i = 0; i < def->active_count; i++)
        net->slots[active[i]] = i;
    for (int i = 0; i < def->solid_count; i++)
        net->slots[def->solid[i]] = NET_SOLID;
    net->def.solid = NULL; // the caller's
    return true;
}

ty_status ty_net_create(const ty_net_def* def, ty_workers* workers, ty_net** out, ty_error* error)
{
    *out = NULL;
    if (def->active_count > (int)(UINT32_MAX / TY_NET_NODES))
        return ty_error_set(error, TY_BAD_INPUT, "a surface net of %d blocks; there may be %u", def->active_count,
                            UINT32_MAX / TY_NET_NODES);
    ty_net* net = TY_ALLOC(ty_net, 1);
    net->def = *def;
    ty_status status = TY_OK;
    if (!net_allocate(net, def))
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for a surface net of %d blocks", def->active_count);
    else if (!ty_parallel_for(workers, def->active_count, 16, blocks_fill, net))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while a surface was made");
    else
    {
        ty_parallel_all(workers, def->active_count, 64, blocks_look, net);
        if (!net_compose(net, workers))
            status = ty_error_set(error, TY_NO_MEMORY, "no memory for a surface net of %d blocks", def->active_count);
    }
    if (status == TY_OK)
    {
        ty_parallel_all(workers, def->active_count, 64, blocks_look, net); // what was filled may reach into others
        status = net_connect(net, workers, error);
    }
    if (status == TY_OK)
        *out = net;
    else
        ty_net_destroy(net);
    return status;
}

void ty_net_destroy(ty_net* net)
{
    if (!net)
        return;
    ty_free((void*)net->def.active);
    ty_free(net->slots);
    ty_free(net->values);
    ty_free(net->crossed);
    ty_free(net->cells);
    ty_free(net->places);
    ty_free(net->positions);
    ty_free(net->neighbours);
    ty_free(net->quads);
    ty_free(net);
}
