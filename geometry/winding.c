// SPDX-License-Identifier: Apache-2.0
// The tree of dipoles: triangles in Morton order, eight to a leaf, and above them a full binary tree.
#include "winding.h"

enum
{
    LEAF = 8, // triangles
};

// The triangles below as a dipole and its first derivative about their middle.
typedef struct node
{
    ty_vec3 c, n;    // middle by area, sum of the area vectors
    float moment[6]; // sum of area vector times place against c, symmetric part: xx yy zz xy xz yz
    float radius;    // about c; < 0: there is nothing below
} node;

struct winding
{
    ty_vec3 (*corners)[3]; // [count], in Morton order
    uint32_t count;
    node* nodes; // the root is 1, below i are 2 i and 2 i + 1; leaf l is leaves + l
    uint32_t leaves;
};

// --- order ---

static uint64_t bits_spread(uint64_t x)
{
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

typedef struct keyed
{
    uint32_t key, triangle;
} keyed;

static void keys_sort(keyed* keys, keyed* other, uint32_t count)
{
    for (int shift = 0; shift < 30; shift += 10)
    {
        uint32_t at[1025] = {0};
        for (uint32_t i = 0; i < count; i++)
            at[(keys[i].key >> shift & 1023) + 1]++;
        for (int i = 0; i < 1024; i++)
            at[i + 1] += at[i];
        for (uint32_t i = 0; i < count; i++)
            other[at[keys[i].key >> shift & 1023]++] = keys[i];
        keyed* sorted = other;
        other = keys;
        keys = sorted;
    }
}

static ty_vec3 middle_of(const ty_mesh* mesh, uint32_t triangle)
{
    const uint32_t* c = mesh->triangles[triangle];
    return ty_mul(ty_add(ty_add(mesh->positions[c[0]], mesh->positions[c[1]]), mesh->positions[c[2]]), 1.0f / 3.0f);
}

// Three passes of the sort end in the second array.
static bool order_make(winding* w, const ty_mesh* mesh, const uint32_t* triangles, const int8_t* side)
{
    keyed *keys = TY_TRY_ALLOC(keyed, w->count), *sorted = TY_TRY_ALLOC(keyed, w->count);
    bool held = keys && sorted;
    ty_bounds b = ty_bounds_empty();
    for (uint32_t i = 0; i < w->count && held; i++)
        b = ty_bounds_add(b, middle_of(mesh, triangles[i]));
    ty_vec3 size = ty_sub(b.high, b.low);
    float scale = 1023.0f / ty_max(ty_max(size.x, size.y), ty_max(size.z, 1e-30f));
    for (uint32_t i = 0; i < w->count && held; i++)
    {
        ty_vec3 p = ty_mul(ty_sub(middle_of(mesh, triangles[i]), b.low), scale);
        keys[i].key =
            (uint32_t)(bits_spread((uint64_t)p.x) | bits_spread((uint64_t)p.y) << 1 | bits_spread((uint64_t)p.z) << 2);
        keys[i].triangle = triangles[i];
    }
    if (held)
        keys_sort(keys, sorted, w->count);
    for (uint32_t i = 0; i < w->count && held; i++)
    {
        uint32_t t = sorted[i].triangle;
        bool turned = side && side[t] < 0;
        for (int k = 0; k < 3; k++)
            w->corners[i][k] = mesh->positions[mesh->triangles[t][turned ? 2 - k : k]];
    }
    ty_free(keys);
    ty_free(sorted);
    return held;
}

// --- the tree ---

static ty_vec3 area_vector(ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    return ty_mul(ty_cross(ty_sub(b, a), ty_sub(c, a)), 0.5f);
}

static void moment_add(float moment[6], ty_vec3 n, ty_vec3 d)
{
    moment[0] += n.x * d.x;
    moment[1] += n.y * d.y;
    moment[2] += n.z * d.z;
    moment[3] += 0.5f * (n.x * d.y + n.y * d.x);
    moment[4] += 0.5f * (n.x * d.z + n.z * d.x);
    moment[5] += 0.5f * (n.y * d.z + n.z * d.y);
}

static float reach_of(ty_bounds b, ty_vec3 c)
{
    ty_vec3 low = ty_sub(c, b.low), high = ty_sub(b.high, c);
    return ty_length(ty_vec3_make(ty_max(low.x, high.x), ty_max(low.y, high.y), ty_max(low.z, high.z)));
}

// What the tree is built with, of each node.
typedef struct building
{
    ty_bounds* bounds;
    float* areas;
} building;

static void leaf_build(winding* w, const building* at, uint32_t leaf)
{
    uint32_t i = w->leaves + leaf, first = leaf * LEAF;
    uint32_t end = first + LEAF < w->count ? first + LEAF : w->count;
    node* n = &w->nodes[i];
    at->bounds[i] = ty_bounds_empty();
    n->radius = -1.0f;
    for (uint32_t t = first; t < end; t++)
    {
        const ty_vec3* p = w->corners[t];
        ty_vec3 area = area_vector(p[0], p[1], p[2]);
        float size = ty_length(area);
        at->areas[i] += size;
        n->n = ty_add(n->n, area);
        n->c = ty_mad(n->c, ty_add(ty_add(p[0], p[1]), p[2]), size / 3.0f);
        for (int k = 0; k < 3; k++)
            at->bounds[i] = ty_bounds_add(at->bounds[i], p[k]);
    }
    if (first >= end)
        return;
    ty_vec3 middle = ty_mul(ty_add(at->bounds[i].low, at->bounds[i].high), 0.5f);
    n->c = at->areas[i] > 0.0f ? ty_mul(n->c, 1.0f / at->areas[i]) : middle;
    n->radius = reach_of(at->bounds[i], n->c);
    for (uint32_t t = first; t < end; t++)
    {
        const ty_vec3* p = w->corners[t];
        ty_vec3 own = ty_mul(ty_add(ty_add(p[0], p[1]), p[2]), 1.0f / 3.0f);
        moment_add(n->moment, area_vector(p[0], p[1], p[2]), ty_sub(own, n->c));
    }
}

static void node_build(winding* w, const building* at, uint32_t i)
{
    node *n = &w->nodes[i], *a = &w->nodes[2 * i], *b = a + 1;
    if (b->radius < 0.0f) // leaves fill up from the left
    {
        *n = *a;
        at->bounds[i] = at->bounds[2 * i];
        at->areas[i] = at->areas[2 * i];
        return;
    }
    float area_a = at->areas[2 * i], area_b = at->areas[2 * i + 1];
    at->areas[i] = area_a + area_b;
    at->bounds[i] =
        ty_bounds_add(ty_bounds_add(at->bounds[2 * i], at->bounds[2 * i + 1].low), at->bounds[2 * i + 1].high);
    n->n = ty_add(a->n, b->n);
    n->c = ty_lerp3(a->c, b->c, at->areas[i] > 0.0f ? area_b / at->areas[i] : 0.5f);
    n->radius = reach_of(at->bounds[i], n->c);
    for (int k = 0; k < 6; k++)
        n->moment[k] = a->moment[k] + b->moment[k];
    moment_add(n->moment, a->n, ty_sub(a->c, n->c));
    moment_add(n->moment, b->n, ty_sub(b->c, n->c));
}

winding* winding_create(const ty_mesh* mesh, const uint32_t* triangles, uint32_t count, const int8_t* side)
{
    winding* w = TY_ALLOC(winding, 1);
    w->count = count;
    for (w->leaves = 1; (uint64_t)w->leaves * LEAF < count;)
        w->leaves *= 2;
    uint32_t nodes = 2 * w->leaves;
    w->corners = ty_try_alloc(count, sizeof(*w->corners));
    w->nodes = TY_TRY_ALLOC(node, nodes);
    building at = {TY_TRY_ALLOC(ty_bounds, nodes), TY_TRY_ALLOC(float, nodes)};
    bool held = w->corners && w->nodes && at.bounds && at.areas && order_make(w, mesh, triangles, side);
    for (uint32_t l = 0; l < w->leaves && held; l++)
        leaf_build(w, &at, l);
    for (uint32_t i = w->leaves - 1; i >= 1 && held; i--)
        node_build(w, &at, i);
    ty_free(at.bounds);
    ty_free(at.areas);
    if (held)
        return w;
    winding_destroy(w);
    return NULL;
}

void winding_destroy(winding* w)
{
    if (!w)
        return;
    ty_free(w->corners);
    ty_free(w->nodes);
    ty_free(w);
}

// --- evaluation ---

// The solid angle of a triangle over 4 pi (van Oosterom and Strackee 1983).
static float triangle_share(const ty_vec3 corner[3], ty_vec3 p)
{
    ty_vec3 a = ty_sub(corner[0], p), b = ty_sub(corner[1], p), c = ty_sub(corner[2], p);
    float x = ty_length(a), y = ty_length(b), z = ty_length(c);
    float up = ty_dot(a, ty_cross(b, c));
    float down = x * y * z + ty_dot(a, b) * z + ty_dot(b, c) * x + ty_dot(c, a) * y;
    return up == 0.0f ? 0.0f : ty_atan2(up, down) / (2.0f * TY_PI);
}

static float node_share(const node* n, ty_vec3 r, float square)
{
    const float* m = n->moment;
    float inverse = 1.0f / square, cube = inverse / sqrtf(square);
    float trace = m[0] + m[1] + m[2];
    float along = m[0] * r.x * r.x + m[1] * r.y * r.y + m[2] * r.z * r.z +
                  2.0f * (m[3] * r.x * r.y + m[4] * r.x * r.z + m[5] * r.y * r.z);
    return cube * (ty_dot(n->n, r) + trace - 3.0f * along * inverse) / (4.0f * TY_PI);
}

float winding_at(const winding* w, ty_vec3 p)
{
    uint32_t stack[64];
    int top = 0;
    float sum = 0.0f;
    stack[top++] = 1;
    while (top > 0)
    {
        uint32_t i = stack[--top];
        const node* n = &w->nodes[i];
        ty_vec3 r = ty_sub(n->c, p);
        float square = ty_length_sqr(r);
        if (n->radius < 0.0f)
            continue;
        if (square > ty_sqr(2.0f * n->radius))
            sum += node_share(n, r, square);
        else if (i < w->leaves)
        {
            stack[top++] = 2 * i + 1;
            stack[top++] = 2 * i;
        }
        else
        {
            uint32_t first = (i - w->leaves) * LEAF, end = first + LEAF < w->count ? first + LEAF : w->count;
            for (uint32_t t = first; t < end; t++)
                sum += triangle_share(w->corners[t], p);
        }
    }
    return sum;
}
