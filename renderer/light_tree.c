// SPDX-License-Identifier: Apache-2.0
// Building the tree of lights by the surface area orientation heuristic, and choosing by it.
#include "light_tree.h"
#include <stdlib.h>
#include <tsuya/base/memory.h>

enum
{
    BUCKETS = 12,
    DEEPEST = 64
};

// --- cones of directions ---

static float sine_of(float cosine)
{
    return ty_safe_sqrt(1.0f - cosine * cosine);
}

// cos(max(0, a - b)) and its sine.
static float cos_sub_clamped(float sin_a, float cos_a, float sin_b, float cos_b)
{
    return cos_a > cos_b ? 1.0f : cos_a * cos_b + sin_a * sin_b;
}

static float sin_sub_clamped(float sin_a, float cos_a, float sin_b, float cos_b)
{
    return cos_a > cos_b ? 0.0f : sin_a * cos_b - cos_a * sin_b;
}

// Rotation of v about a unit axis.
static ty_vec3 rotate(ty_vec3 v, ty_vec3 axis, float angle)
{
    float s, c;
    ty_sincos(angle, &s, &c);
    ty_vec3 turned = ty_mad(ty_mul(v, c), ty_cross(axis, v), s);
    return ty_mad(turned, axis, ty_dot(axis, v) * (1.0f - c));
}

// The cone that holds both.
static void join_cones(const ty_light_node* a, const ty_light_node* b, ty_light_node* out)
{
    const ty_light_node* wide = a->cos_o <= b->cos_o ? a : b;
    const ty_light_node* slim = wide == a ? b : a;
    out->axis = wide->axis;
    out->cos_o = wide->cos_o;
    out->cos_e = ty_min(a->cos_e, b->cos_e);
    if (wide->cos_o <= -1.0f)
        return;
    float between = ty_acos(ty_dot(a->axis, b->axis)), wide_o = ty_acos(wide->cos_o), slim_o = ty_acos(slim->cos_o);
    if (between + slim_o <= wide_o)
        return;
    float half = 0.5f * (wide_o + between + slim_o);
    ty_vec3 about = ty_cross(wide->axis, slim->axis);
    if (half >= TY_PI || ty_length_sqr(about) < 1e-12f)
    {
        out->cos_o = -1.0f;
        return;
    }
    out->axis = ty_normalize(rotate(wide->axis, ty_normalize(about), half - wide_o));
    out->cos_o = ty_max(-1.0f, ty_cos(half) - 1e-6f); // rounding must not narrow it
}

static ty_light_node join(const ty_light_node* a, const ty_light_node* b)
{
    if (a->energy < 0.0f)
        return *b;
    if (b->energy < 0.0f)
        return *a;
    ty_light_node out = {
        .low = ty_min3(a->low, b->low), .high = ty_max3(a->high, b->high), .energy = a->energy + b->energy};
    float share = out.energy > 0.0f ? a->energy / out.energy : 0.5f;
    out.even = ty_lerp(b->even, a->even, share);
    out.mean = ty_lerp3(b->mean, a->mean, share);
    join_cones(a, b, &out);
    return out;
}

// --- building ---

static float along(ty_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static float middle(const ty_light_node* node, int axis)
{
    return 0.5f * (along(node->low, axis) + along(node->high, axis));
}

// Integral of the bounding cone's measure (Conty Estevez & Kulla 2018, equation 1).
static float cone_measure(const ty_light_node* node)
{
    float o = ty_acos(node->cos_o), e = ty_acos(node->cos_e), w = ty_min(o + e, TY_PI);
    float sin_o = sine_of(node->cos_o);
    return 2.0f * TY_PI * (1.0f - node->cos_o) +
           0.5f * TY_PI * (2.0f * w * sin_o - ty_cos(o - 2.0f * w) - 2.0f * o * sin_o + node->cos_o);
}

static float cost(const ty_light_node* node)
{
    ty_vec3 d = ty_sub(node->high, node->low);
    float area = 2.0f * (d.x * d.y + d.y * d.z + d.z * d.x);
    // A floor for what lies on a line or in a point: its length still counts.
    float size = area + 1e-3f * ty_length_sqr(d);
    return node->energy * cone_measure(node) * ty_max(size, 1e-20f);
}

static int bucket_of(const ty_light_node* leaf, int axis, float low, float scale)
{
    int b = (int)((middle(leaf, axis) - low) * scale);
    return b < 0 ? 0 : b >= BUCKETS ? BUCKETS - 1 : b;
}

typedef struct split
{
    int axis, bucket; // leaves up to this bucket go first; -1 = no split
    float low, scale, cost;
} split;

static void try_axis(const ty_light_node* leaves, int count, int axis, float low, float high, float stretch,
                     split* best)
{
    const ty_light_node none = {.energy = -1.0f};
    ty_light_node buckets[BUCKETS], after[BUCKETS];
    float scale = (float)BUCKETS / (high - low);
    for (int i = 0; i < BUCKETS; ++i)
        buckets[i] = none;
    for (int i = 0; i < count; ++i)
    {
        ty_light_node* bucket = &buckets[bucket_of(&leaves[i], axis, low, scale)];
        *bucket = join(bucket, &leaves[i]);
    }
    after[BUCKETS - 1] = buckets[BUCKETS - 1];
    for (int i = BUCKETS - 2; i >= 0; --i)
        after[i] = join(&buckets[i], &after[i + 1]);
    ty_light_node before = none;
    for (int i = 0; i < BUCKETS - 1; ++i)
    {
        before = join(&before, &buckets[i]);
        if (before.energy < 0.0f || after[i + 1].energy < 0.0f)
            continue;
        float c = stretch * (cost(&before) + cost(&after[i + 1]));
        if (best->bucket < 0 || c < best->cost)
            *best = (split){axis, i, low, scale, c};
    }
}

static int partition(ty_light_node* leaves, int count, const split* s)
{
    int first = 0;
    for (int i = 0; i < count; ++i)
        if (bucket_of(&leaves[i], s->axis, s->low, s->scale) <= s->bucket)
        {
            ty_light_node swap = leaves[first];
            leaves[first++] = leaves[i];
            leaves[i] = swap;
        }
    return first;
}

// How many leaves go first. Equal places, and levels that could grow too deep, are halved.
static int divide(ty_light_node* leaves, int count, int depth)
{
    if (depth >= DEEPEST / 2)
        return count / 2;
    ty_bounds middles = ty_bounds_empty();
    for (int i = 0; i < count; ++i)
        middles = ty_bounds_add(middles, ty_mul(ty_add(leaves[i].low, leaves[i].high), 0.5f));
    ty_vec3 size = ty_sub(middles.high, middles.low);
    float longest = ty_max(size.x, ty_max(size.y, size.z));
    split best = {.bucket = -1};
    for (int axis = 0; axis < 3; ++axis)
        if (along(size, axis) > 1e-6f * longest)
            try_axis(leaves, count, axis, along(middles.low, axis), along(middles.high, axis),
                     longest / along(size, axis), &best);
    return best.bucket < 0 ? count / 2 : partition(leaves, count, &best);
}

// Depth first; the trail's bit at a depth says which child.
static uint32_t build(ty_light_tree* tree, ty_light_node* leaves, int count, uint64_t trail, int depth, uint32_t* next)
{
    uint32_t index = (*next)++;
    if (count == 1)
    {
        uint32_t item = leaves[0].child;
        tree->nodes[index] = leaves[0];
        tree->nodes[index].child = item | TY_LIGHT_LEAF;
        tree->trails[item] = trail;
        tree->depths[item] = (uint8_t)depth;
        return index;
    }
    TY_ASSERT(depth < DEEPEST);
    int first = divide(leaves, count, depth);
    uint32_t a = build(tree, leaves, first, trail, depth + 1, next);
    uint32_t b = build(tree, leaves + first, count - first, trail | (uint64_t)1 << depth, depth + 1, next);
    tree->nodes[index] = join(&tree->nodes[a], &tree->nodes[b]);
    tree->nodes[index].child = b;
    return index;
}

ty_light_tree* ty_light_tree_create(ty_light_node* leaves, int count, int item_count)
{
    if (count <= 0)
        return NULL;
    ty_light_tree* tree = TY_ALLOC(ty_light_tree, 1);
    tree->nodes = TY_ALLOC(ty_light_node, 2 * (size_t)count - 1);
    tree->trails = TY_ALLOC(uint64_t, item_count);
    tree->depths = TY_ALLOC(uint8_t, item_count);
    tree->count = count;
    tree->item_count = item_count;
    for (int i = 0; i < item_count; ++i)
        tree->depths[i] = 255;
    uint32_t next = 0;
    (void)build(tree, leaves, count, 0, 0, &next);
    return tree;
}

void ty_light_tree_destroy(ty_light_tree* tree)
{
    if (!tree)
        return;
    ty_free(tree->nodes);
    ty_free(tree->trails);
    ty_free(tree->depths);
    ty_free(tree);
}

// --- choosing ---

// Mean of max(0, c) over what is spread around c.
static float mean_positive(float c, float spread_sqr)
{
    return 0.5f * (c + sqrtf(c * c + spread_sqr));
}

// Whether a node whose box fills the half angle b may send light along w, and a surface take it.
static bool may_shine(const ty_light_node* node, ty_vec3 w, ty_vec3 normal, float sin_b, float cos_b)
{
    float cos_i = -ty_dot(normal, w);
    if (ty_length_sqr(normal) > 0.0f && !(cos_sub_clamped(sine_of(cos_i), cos_i, sin_b, cos_b) > 0.0f))
        return false;
    if (node->cos_o <= -1.0f)
        return true;
    // Least angle between a direction to p and a normal: the angle to the axis less both half angles.
    float cos_w = ty_dot(node->axis, w), sin_w = sine_of(cos_w), sin_o = sine_of(node->cos_o);
    float cos_x = cos_sub_clamped(sin_w, cos_w, sin_o, node->cos_o);
    float sin_x = sin_sub_clamped(sin_w, cos_w, sin_o, node->cos_o);
    return cos_sub_clamped(sin_x, cos_x, sin_b, cos_b) > node->cos_e;
}

float ty_light_node_importance(const ty_light_node* node, ty_vec3 p, ty_vec3 normal)
{
    ty_vec3 to = ty_sub(p, ty_mul(ty_add(node->low, node->high), 0.5f));
    float d_sqr = ty_length_sqr(to), r_sqr = 0.25f * ty_length_sqr(ty_sub(node->high, node->low));
    ty_vec3 w = ty_mul(to, 1.0f / sqrtf(ty_max(d_sqr, 1e-30f)));
    float sin_b_sqr = d_sqr > r_sqr ? r_sqr / d_sqr : 1.0f;
    if (d_sqr > r_sqr * 1.0001f && !may_shine(node, w, normal, sqrtf(sin_b_sqr), sqrtf(1.0f - sin_b_sqr)))
        return 0.0f;
    // Normals all over the sphere have a mean of zero and a quarter of them shines; those of one side, their cosine.
    float rest = 1.0f - node->even, along = ty_dot(node->mean, w);
    float facing = node->even + mean_positive(along, 0.25f * ty_max(rest * rest - ty_length_sqr(node->mean), 0.0f));
    float taken = ty_length_sqr(normal) > 0.0f ? mean_positive(-ty_dot(normal, w), 0.25f * sin_b_sqr) : 1.0f;
    // Never nothing where something may come: a spread as wide as rounding.
    return node->energy * ty_max(facing, 1e-3f) * ty_max(taken, 1e-3f) / ty_max(ty_max(d_sqr, 0.2f * r_sqr), 1e-12f);
}

int ty_light_tree_sample(const ty_light_tree* tree, ty_vec3 p, ty_vec3 normal, double* u, float* probability)
{
    uint32_t index = 0;
    *probability = 1.0f;
    while (!(tree->nodes[index].child & TY_LIGHT_LEAF))
    {
        uint32_t second = tree->nodes[index].child;
        float a = ty_light_node_importance(&tree->nodes[index + 1], p, normal);
        float b = ty_light_node_importance(&tree->nodes[second], p, normal);
        if (!(a + b > 0.0f))
            return -1;
        float share = a / (a + b);
        bool first = *u < (double)share;
        *u = first ? *u / (double)share : (*u - (double)share) / (1.0 - (double)share);
        *probability *= first ? share : 1.0f - share;
        index = first ? index + 1 : second;
    }
    return *probability > 0.0f ? (int)(tree->nodes[index].child & ~TY_LIGHT_LEAF) : -1;
}

float ty_light_tree_probability(const ty_light_tree* tree, ty_vec3 p, ty_vec3 normal, int item)
{
    if (tree->depths[item] == 255)
        return 0.0f;
    uint32_t index = 0;
    float probability = 1.0f;
    uint64_t trail = tree->trails[item];
    for (int depth = 0; depth < tree->depths[item] && probability > 0.0f; ++depth, trail >>= 1)
    {
        uint32_t second = tree->nodes[index].child;
        float a = ty_light_node_importance(&tree->nodes[index + 1], p, normal);
        float b = ty_light_node_importance(&tree->nodes[second], p, normal);
        if (!(a + b > 0.0f))
            return 0.0f;
        float share = a / (a + b);
        probability *= trail & 1u ? 1.0f - share : share;
        index = trail & 1u ? second : index + 1;
    }
    return probability;
}
