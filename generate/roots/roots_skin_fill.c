// SPDX-License-Identifier: Apache-2.0
// The distance of roots at the nodes of a block: what is near the block, root by root, all nodes at a time.
#include "roots_skin.h"

enum
{
    NODES = TY_NET_NODES,
};

// Nodes of a block, and the nearest of one root or of all.
typedef struct nodes
{
    float x[NODES], y[NODES], z[NODES];
} nodes;

typedef struct nearest
{
    float distance[NODES], t[NODES];
    int32_t segment[NODES];
} nearest;

static void nodes_place(const roots_skin* skin, const int block[3], nodes* out)
{
    for (int i = 0; i < NODES; i++)
    {
        int x = i % TY_NET_BLOCK, y = i / TY_NET_BLOCK % TY_NET_BLOCK, z = i / TY_NET_BLOCK / TY_NET_BLOCK;
        out->x[i] = skin->origin.x + skin->step * (float)(block[0] * TY_NET_BLOCK + x);
        out->y[i] = skin->origin.y + skin->step * (float)(block[1] * TY_NET_BLOCK + y);
        out->z[i] = skin->origin.z + skin->step * (float)(block[2] * TY_NET_BLOCK + z);
    }
}

// In plain loops that become vectors: clamps that share one with arithmetic would be branches.
static void segment_meet(const roots_segment* restrict s, int32_t number, const nodes* restrict at,
                         nearest* restrict best)
{
    float t[NODES], d[NODES], h[NODES], up[NODES];
    for (int i = 0; i < NODES; i++)
    {
        float px = at->x[i] - s->a.x, py = at->y[i] - s->a.y, pz = at->z[i] - s->a.z;
        float u = (px * s->d.x + py * s->d.y + pz * s->d.z) * s->length_1;
        t[i] = u < 0.0f ? 0.0f : u;
    }
    for (int i = 0; i < NODES; i++)
        t[i] = t[i] > 1.0f ? 1.0f : t[i];
    for (int i = 0; i < NODES; i++)
    {
        float px = at->x[i] - s->a.x, py = at->y[i] - s->a.y, pz = at->z[i] - s->a.z;
        float qx = px - t[i] * s->d.x, qy = py - t[i] * s->d.y, qz = pz - t[i] * s->d.z;
        float nx = s->na.x + t[i] * s->nd.x, ny = s->na.y + t[i] * s->nd.y, nz = s->na.z + t[i] * s->nd.z;
        h[i] = qx * nx + qy * ny + qz * nz;
        up[i] = h[i] + (s->fill_a + t[i] * s->fill_d);
        d[i] = qx * qx + qy * qy + qz * qz - h[i] * h[i];
    }
    for (int i = 0; i < NODES; i++)
        up[i] = up[i] > 0.0f ? 0.0f : up[i];
    for (int i = 0; i < NODES; i++)
        up[i] = h[i] > up[i] ? h[i] : up[i];
    for (int i = 0; i < NODES; i++)
        d[i] = d[i] < 0.0f ? 0.0f : d[i];
    for (int i = 0; i < NODES; i++)
        d[i] = sqrtf(d[i] + up[i] * up[i] * (1.0f + s->ea + t[i] * s->ed)) - (s->ra + t[i] * s->rd);
    for (int i = 0; i < NODES; i++)
    {
        bool nearer = d[i] < best->distance[i];
        best->t[i] = nearer ? t[i] : best->t[i];
        best->segment[i] = nearer ? number : best->segment[i];
        best->distance[i] = nearer ? d[i] : best->distance[i];
    }
}

// --- what is near ---

typedef struct range
{
    float least, most; // bounds of a distance over a block
} range;

// Half the diagonal of a block, m.
static float block_half(const roots_skin* skin)
{
    return 0.5f * 1.7321f * (TY_NET_BLOCK - 1) * skin->step;
}

static range segment_range(const roots_segment* s, ty_vec3 middle, float half)
{
    float t = ty_clamp(ty_dot(ty_sub(middle, s->a), s->d) * s->length_1, 0.0f, 1.0f);
    float q = ty_length(ty_sub(middle, ty_mad(s->a, s->d, t)));
    float stretch = sqrtf(1.0f + ty_max(s->ea, s->ea + s->ed)) * 1.05f; // normals between points are a bit off unit
    float most = ty_max(s->ra, s->ra + s->rd), least = ty_min(s->ra, s->ra + s->rd);
    float fill = ty_max(s->fill_a, s->fill_a + s->fill_d);
    return (range){q - half - most - fill, (q + half) * stretch - least};
}

// --- roots together ---

typedef struct together
{
    float distance[NODES], radius[NODES], depth[NODES], open[NODES];
    bool any;
} together;

static void together_take(const roots_skin* skin, together* all, const nearest* one)
{
    for (int i = 0; i < NODES; i++)
    {
        const roots_segment* s = &skin->segments[one->segment[i]];
        float r = roots_segment_radius(s, one->t[i]), d = one->distance[i], depth = roots_segment_depth(s, one->t[i]);
        float open = roots_segment_open(s, one->t[i]);
        if (!all->any)
        {
            all->distance[i] = d;
            all->radius[i] = r;
            all->depth[i] = depth;
            all->open[i] = open;
            continue;
        }
        float k = roots_join_width(skin->recipe->join, all->radius[i], r, all->open[i], open);
        float h = ty_clamp(0.5f + 0.5f * (all->distance[i] - d) / k, 0.0f, 1.0f);
        all->distance[i] = ty_lerp(all->distance[i], d, h) - k * h * (1.0f - h);
        all->radius[i] = ty_lerp(all->radius[i], r, h);
        all->depth[i] = ty_lerp(all->depth[i], depth, h);
        all->open[i] = ty_lerp(all->open[i], open, h);
    }
    all->any = true;
}

// Where the block may reach under the host.
static void host_cut(const roots_skin* skin, const nodes* at, ty_vec3 middle, together* all)
{
    if (!skin->host || roots_host_value(skin->host, middle, NULL) > 1.2f * block_half(skin) + 2.0f * skin->step)
        return;
    for (int i = 0; i < NODES; i++)
    {
        float part;
        ty_vec3 p = {at->x[i], at->y[i], at->z[i]};
        if (all->distance[i] < all->radius[i])
            all->distance[i] = roots_skin_hold(skin, all->distance[i], all->depth[i], all->radius[i], p, &part);
    }
}

static void top_cut(const roots_skin* skin, const nodes* at, const together* all, float values[NODES])
{
    float part;
    for (int i = 0; i < NODES; i++)
        values[i] = roots_skin_top(skin, all->distance[i], at->y[i], &part);
}

static void block_fill(const roots_skin* skin, const int block[3], int32_t begin, int32_t end, float nearby,
                       ty_vec3 middle, float values[NODES])
{
    nodes at;
    nearest one;
    together all = {.any = false};
    float half = block_half(skin);
    nodes_place(skin, block, &at);
    for (int32_t i = begin; i < end;)
    {
        int line = skin->segments[skin->list[i]].line;
        bool met = false;
        float most = nearby; // what is farther than another segment of its root at every node is nowhere the nearest
        for (int32_t k = i; k < end && skin->segments[skin->list[k]].line == line; k++)
            most = ty_min(most, segment_range(&skin->segments[skin->list[k]], middle, half).most);
        for (; i < end && skin->segments[skin->list[i]].line == line; i++)
        {
            const roots_segment* s = &skin->segments[skin->list[i]];
            if (segment_range(s, middle, half).least > most)
                continue;
            for (int k = 0; !met && k < NODES; k++)
                one.distance[k] = TY_FLOAT_MAX;
            met = true;
            segment_meet(s, skin->list[i], &at, &one);
        }
        if (!met)
            continue;
        together_take(skin, &all, &one);
    }
    host_cut(skin, &at, middle, &all);
    top_cut(skin, &at, &all, values);
}

// What is known of a block from its segments alone.
typedef struct block_look
{
    ty_vec3 middle;
    range all;  // of the distance to the nearest root, each by itself
    float join; // how much nearer than that the surface may be
    roots_block kind;
} block_look;

static block_look block_look_at(const roots_skin* skin, const int block[3], int number)
{
    const float middle = 0.5f * (TY_NET_BLOCK - 1), half = block_half(skin);
    ty_vec3 at = {(float)(block[0] * TY_NET_BLOCK) + middle, (float)(block[1] * TY_NET_BLOCK) + middle,
                  (float)(block[2] * TY_NET_BLOCK) + middle};
    block_look look = {ty_mad(skin->origin, at, skin->step), {TY_FLOAT_MAX, TY_FLOAT_MAX}, 0.0f, ROOTS_BLOCK_MIXED};
    for (int32_t i = skin->begin[number]; i < skin->begin[number + 1]; i++)
    {
        const roots_segment* s = &skin->segments[skin->list[i]];
        range one = segment_range(s, look.middle, half);
        look.all = (range){ty_min(look.all.least, one.least), ty_min(look.all.most, one.most)};
        look.join = ty_max(look.join, skin->recipe->join * ty_max(s->ra, s->ra + s->rd));
    }
    float reach = 2.0f * skin->step;
    float under = skin->host ? roots_host_value(skin->host, look.middle, NULL) : TY_FLOAT_MAX;
    bool cut = look.middle.y + half > skin->network->top - reach || under < 1.2f * half + reach;
    if (look.all.least > reach + look.join)
        look.kind = ROOTS_BLOCK_OUTSIDE;
    else if (look.all.most < -2.0f * reach && !cut)
        look.kind = ROOTS_BLOCK_INSIDE;
    return look;
}

static void block_of(const roots_skin* skin, int number, int block[3])
{
    block[0] = number % skin->blocks[0];
    block[1] = number / skin->blocks[0] % skin->blocks[1];
    block[2] = number / skin->blocks[0] / skin->blocks[1];
}

roots_block roots_skin_block(const roots_skin* skin, int number)
{
    int block[3];
    block_of(skin, number, block);
    return block_look_at(skin, block, number).kind;
}

void roots_skin_fill(void* context, const int block[3], float values[NODES])
{
    const roots_skin* skin = context;
    int number = (block[2] * skin->blocks[1] + block[1]) * skin->blocks[0] + block[0];
    block_look look = block_look_at(skin, block, number);
    float reach = 2.0f * skin->step, nearby = ty_max(look.all.most, reach) + look.join + reach;
    block_fill(skin, block, skin->begin[number], skin->begin[number + 1], nearby, look.middle, values);
}
