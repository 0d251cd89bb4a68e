// SPDX-License-Identifier: Apache-2.0
// Building the wide top level: a binary tree by surface area whose leaves hold sixteen instances each but for the last,
// opened into nodes of sixteen. One thread, ties by number: the same input gives the same tree.
#include "trace_wide.h"
#include <string.h>
#include <tsuya/base/memory.h>

#define BINS 32
#define EXACT 256u // this many and fewer are sorted, and every split tried
#define DEEPEST 40 // below, halves: keeps the stack of the traversal bounded
#define NO_CHILD TY_NONE

// A node of the binary tree; left is the next one.
typedef struct binary
{
    ty_bounds bounds;
    uint32_t right; // NO_CHILD = a leaf
    uint32_t first; // leaf: of its instances in the order
    uint32_t leaves;
} binary;

typedef struct builder
{
    ty_world* world;
    ty_trace_wide* wide;
    uint32_t* number; // [count] instances in the world's numbering
    ty_bounds* box;   // [count]
    uint32_t* order;  // [count] into the two above
    uint64_t* key;    // [count] scratch
    uint32_t* spare;  // [count] scratch
    uint32_t count;
    binary* tree;
    uint32_t tree_count;
} builder;

// --- boxes of instances ---

ty_affine ty_trace_placed(const ty_trace_object* object, uint32_t instance)
{
    if (object->step_count > 1) // the wide level of a moving aggregate lies in its own space
        return ty_trace_inner_map(object, instance);
    if (!object->aggregate)
        return object->steps[0];
    return ty_affine_multiply(&object->steps[0], &object->aggregate->transforms[instance]);
}

// World box of an instance: the mapped ellipsoid's box cut by the mapped bounding box, whichever is tighter on each
// side.
static ty_bounds instance_bounds(const ty_trace_prototype* prototype, const ty_affine* placed)
{
    ty_bounds box = ty_bounds_map(placed, prototype->bounds);
    ty_affine m = ty_affine_multiply(placed, &prototype->from_sphere);
    ty_vec3 half = {sqrtf(m.x.x * m.x.x + m.y.x * m.y.x + m.z.x * m.z.x),
                    sqrtf(m.x.y * m.x.y + m.y.y * m.y.y + m.z.y * m.z.y),
                    sqrtf(m.x.z * m.x.z + m.y.z * m.y.z + m.z.z * m.z.z)};
    box.low = ty_max3(box.low, ty_sub(m.t, half));
    box.high = ty_min3(box.high, ty_add(m.t, half));
    return ty_wide_padded(box);
}

static float half_area(ty_bounds b)
{
    ty_vec3 d = ty_sub(b.high, b.low);
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

static float coordinate(ty_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

// Twice the centre.
static float center2(ty_bounds b, int axis)
{
    return coordinate(b.low, axis) + coordinate(b.high, axis);
}

static ty_bounds bounds_of(const builder* b, uint32_t first, uint32_t count)
{
    ty_bounds box = ty_bounds_empty();
    for (uint32_t i = first; i < first + count; i++)
        box = ty_bounds_union(box, b->box[b->order[i]]);
    return box;
}

// --- order along an axis ---

// Floats as integers of the same order, ties by number.
static uint64_t make_key(float x, uint32_t i)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits = bits & 0x80000000u ? ~bits : bits | 0x80000000u;
    return (uint64_t)bits << 32 | i;
}

static void fill_keys(builder* b, uint32_t first, uint32_t count, int axis)
{
    for (uint32_t i = 0; i < count; i++)
        b->key[i] = make_key(center2(b->box[b->order[first + i]], axis), b->order[first + i]);
}

// D. L. Shell 1959, in the gaps of M. Ciura 2001.
static void sort_keys(uint64_t* key, uint32_t count)
{
    static const uint32_t gaps[] = {132, 57, 23, 10, 4, 1};
    for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; g++)
        for (uint32_t i = gaps[g]; i < count; i++)
        {
            uint64_t moved = key[i];
            uint32_t k = i;
            for (; k >= gaps[g] && key[k - gaps[g]] > moved; k -= gaps[g])
                key[k] = key[k - gaps[g]];
            key[k] = moved;
        }
}

// The key of rank k (C. A. R. Hoare 1961, "Find"). Reorders the keys.
static uint64_t select_key(uint64_t* key, uint32_t count, uint32_t k)
{
    uint32_t low = 0, high = count - 1;
    while (low < high)
    {
        uint64_t pivot = key[low + (high - low) / 2];
        uint32_t i = low, j = high;
        for (;; i++, j--)
        {
            while (key[i] < pivot)
                i++;
            while (key[j] > pivot)
                j--;
            if (i >= j)
                break;
            uint64_t swapped = key[i];
            key[i] = key[j];
            key[j] = swapped;
        }
        if (k <= j)
            high = j;
        else
            low = j + 1;
    }
    return key[k];
}

// The first `left` along the axis come first; both sides keep their order.
static void partition(builder* b, uint32_t first, uint32_t count, int axis, uint32_t left)
{
    fill_keys(b, first, count, axis);
    uint64_t limit = select_key(b->key, count, left);
    uint32_t low = first, high = 0;
    for (uint32_t i = first; i < first + count; i++)
    {
        uint32_t k = b->order[i];
        if (make_key(center2(b->box[k], axis), k) < limit)
            b->order[low++] = k;
        else
            b->spare[high++] = k;
    }
    memcpy(b->order + low, b->spare, high * sizeof b->spare[0]);
}

// --- where to split ---

typedef struct split
{
    float cost;
    int axis;
    uint32_t left;
} split;

static float leaves(uint32_t count)
{
    return (float)((count + TY_LANES - 1) / TY_LANES);
}

// Few instances: sorted along each axis, every multiple of a leaf.
static void try_exact(builder* b, uint32_t first, uint32_t count, int axis, split* best)
{
    float right[EXACT / TY_LANES];
    fill_keys(b, first, count, axis);
    sort_keys(b->key, count);
    ty_bounds box = ty_bounds_empty();
    for (uint32_t i = count; i-- > TY_LANES;)
    {
        box = ty_bounds_union(box, b->box[(uint32_t)b->key[i]]);
        if (i % TY_LANES == 0)
            right[i / TY_LANES - 1] = half_area(box);
    }
    box = ty_bounds_empty();
    for (uint32_t i = 1; i < count; i++)
    {
        box = ty_bounds_union(box, b->box[(uint32_t)b->key[i - 1]]);
        if (i % TY_LANES != 0)
            continue;
        float cost = half_area(box) * leaves(i) + right[i / TY_LANES - 1] * leaves(count - i);
        if (cost < best->cost)
            *best = (split){cost, axis, i};
    }
}

// Many: by bins (I. Wald 2007, "On fast construction of SAH-based bounding volume hierarchies").
static void try_bins(const builder* b, uint32_t first, uint32_t count, int axis, split* best)
{
    ty_bounds box[BINS];
    uint32_t members[BINS] = {0};
    float low = TY_FLOAT_MAX, high = -TY_FLOAT_MAX, right[BINS];
    for (uint32_t i = first; i < first + count; i++)
    {
        float c = center2(b->box[b->order[i]], axis);
        low = ty_min(low, c);
        high = ty_max(high, c);
    }
    if (!(high > low))
        return;
    float scale = (float)BINS * 0.9999f / (high - low);
    for (int k = 0; k < BINS; k++)
        box[k] = ty_bounds_empty();
    for (uint32_t i = first; i < first + count; i++)
    {
        const ty_bounds* p = &b->box[b->order[i]];
        int k = (int)((center2(*p, axis) - low) * scale);
        members[k]++;
        box[k] = ty_bounds_union(box[k], *p);
    }
    ty_bounds sum = ty_bounds_empty();
    for (int k = BINS - 1; k > 0; k--)
    {
        sum = ty_bounds_union(sum, box[k]);
        right[k] = half_area(sum);
    }
    sum = ty_bounds_empty();
    uint32_t left = 0;
    for (int k = 1; k < BINS; k++)
    {
        sum = ty_bounds_union(sum, box[k - 1]);
        left += members[k - 1];
        if (left == 0 || left == count)
            continue;
        float cost = half_area(sum) * leaves(left) + right[k] * leaves(count - left);
        if (cost < best->cost)
            *best = (split){cost, axis, left};
    }
}

static split choose(builder* b, uint32_t first, uint32_t count, int depth)
{
    split best = {TY_FLOAT_MAX, 0, count / 2};
    for (int axis = 0; axis < 3 && depth < DEEPEST; axis++)
        if (count <= EXACT)
            try_exact(b, first, count, axis, &best);
        else
            try_bins(b, first, count, axis, &best);
    // Whole leaves on the left: all are full but one.
    best.left = (best.left + TY_LANES / 2) / TY_LANES * TY_LANES;
    uint32_t most = (count - 1) / TY_LANES * TY_LANES;
    best.left = best.left < TY_LANES ? TY_LANES : best.left > most ? most : best.left;
    return best;
}

static uint32_t grow(builder* b, uint32_t first, uint32_t count, int depth)
{
    uint32_t node = b->tree_count++;
    b->tree[node] = (binary){bounds_of(b, first, count), NO_CHILD, first, (count + TY_LANES - 1) / TY_LANES};
    if (count <= TY_LANES)
        return node;
    split s = choose(b, first, count, depth);
    partition(b, first, count, s.axis, s.left);
    grow(b, first, s.left, depth + 1);
    b->tree[node].right = grow(b, first + s.left, count - s.left, depth + 1);
    return node;
}

// --- leaves and nodes ---

bool ty_trace_sphere_map(const ty_world* world, const ty_trace_object* object, uint32_t instance, ty_affine* out)
{
    ty_affine placed = ty_trace_placed(object, instance), to_local;
    if (!ty_affine_invert(&placed, &to_local))
        return false;
    *out = ty_affine_multiply(&world->prototypes[ty_trace_prototype_of(object, instance)].to_sphere, &to_local);
    return true;
}

static void set_lane(const ty_world* world, ty_wide_leaf* leaf, int lane, uint32_t number)
{
    const ty_trace_object* object = ty_trace_object_of(world, number);
    uint32_t instance = number - object->first;
    ty_affine m;
    // A map that cannot be inverted leaves zeros, which no ray meets.
    if (!ty_trace_sphere_map(world, object, instance, &m))
        return;
    const float rows[12] = {m.x.x, m.y.x, m.z.x, m.t.x, m.x.y, m.y.y, m.z.y, m.t.y, m.x.z, m.y.z, m.z.z, m.t.z};
    for (int i = 0; i < 12; i++)
        leaf->map[i][lane] = rows[i];
    leaf->instance[lane] = number;
    leaf->prototype[lane] = ty_trace_prototype_of(object, instance);
}

static uint32_t make_leaf(builder* b, const binary* node)
{
    uint32_t index = b->wide->leaf_count++;
    ty_wide_leaf* leaf = &b->wide->leaves[index];
    memset(leaf, 0, sizeof *leaf);
    for (uint32_t lane = 0; lane < TY_LANES; lane++)
    {
        leaf->instance[lane] = TY_NONE;
        if (node->first + lane < b->count && lane < TY_LANES)
            set_lane(b->world, leaf, (int)lane, b->number[b->order[node->first + lane]]);
    }
    return index | TY_WIDE_LEAF;
}

static void set_child(ty_wide_node* node, int lane, ty_bounds box, uint32_t child)
{
    const float planes[6] = {box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z};
    for (int i = 0; i < 6; i++)
        node->plane[i][lane] = planes[i];
    node->child[lane] = child;
}

// The widest of the candidates whose leaves number from..to, or -1.
static int widest(const builder* b, const uint32_t* candidates, int count, uint32_t from, uint32_t to)
{
    int best = -1;
    float area = -1.0f;
    for (int i = 0; i < count; i++)
    {
        const binary* c = &b->tree[candidates[i]];
        if (c->leaves >= from && c->leaves <= to && half_area(c->bounds) > area)
        {
            area = half_area(c->bounds);
            best = i;
        }
    }
    return best;
}

static int open_candidate(const builder* b, uint32_t* candidates, int count, int open)
{
    uint32_t opened = candidates[open];
    candidates[open] = opened + 1;
    candidates[count] = b->tree[opened].right;
    return count + 1;
}

// Puts all leaves below a candidate in its place.
static int open_whole(const builder* b, uint32_t* candidates, int count, int open)
{
    while (b->tree[candidates[open]].right != NO_CHILD)
    {
        int added = count;
        count = open_candidate(b, candidates, count, open);
        count = open_whole(b, candidates, count, added);
    }
    return count;
}

// Up to sixteen children of a binary node. What fits into a node of its own stays whole unless all of it fits into this
// one: opened in part it would leave nodes of two or three children.
static int choose_children(const builder* b, uint32_t from, uint32_t candidates[TY_LANES])
{
    int count = 1, open;
    candidates[0] = from;
    while (count < TY_LANES && (open = widest(b, candidates, count, TY_LANES + 1, UINT32_MAX)) >= 0)
        count = open_candidate(b, candidates, count, open);
    while ((open = widest(b, candidates, count, 2, (uint32_t)(TY_LANES - count + 1))) >= 0)
        count = open_whole(b, candidates, count, open);
    return count;
}

// The binary node with up to sixteen children.
static uint32_t make_node(builder* b, uint32_t from)
{
    if (b->tree[from].right == NO_CHILD)
        return make_leaf(b, &b->tree[from]);
    uint32_t candidates[TY_LANES], index = b->wide->node_count++;
    int count = choose_children(b, from, candidates);
    for (int i = 0; i < TY_LANES; i++)
        set_child(&b->wide->nodes[index], i, ty_bounds_empty(), 0);
    for (int i = 0; i < count; i++)
    {
        uint32_t child = make_node(b, candidates[i]); // the nodes do not move: they are allocated for the worst case
        set_child(&b->wide->nodes[index], i, b->tree[candidates[i]].bounds, child);
    }
    return index;
}

// Ellipsoids, where the prototypes have none yet.
static void fit_prototypes(ty_world* world, const ty_trace_object* object)
{
    int count = object->aggregate ? object->aggregate->prototype_count : 1;
    for (int k = 0; k < count; k++)
    {
        ty_trace_prototype* prototype = &world->prototypes[object->prototypes[k]];
        if (prototype->has_ellipsoid)
            continue;
        ty_trace_fit_ellipsoid(prototype);
        if (prototype->topology.closed)
            ty_trace_fit_inner(world, object->prototypes[k]);
    }
}

static void measure(builder* b, const ty_trace_object* object, uint32_t* next)
{
    fit_prototypes(b->world, object);
    b->wide->common_mask &= object->mask;
    b->wide->has_subsurface = b->wide->has_subsurface || object->one_sided;
    for (uint32_t i = 0; i < object->count; i++)
    {
        if (object->drifts && object->drifts[i])
            continue;
        ty_affine placed = ty_trace_placed(object, i);
        b->number[*next] = object->first + i;
        b->box[*next] = instance_bounds(&b->world->prototypes[ty_trace_prototype_of(object, i)], &placed);
        b->order[*next] = *next;
        (*next)++;
    }
}

static bool allocate(builder* b, uint32_t count)
{
    uint32_t most = 2 * ((count + TY_LANES - 1) / TY_LANES);
    b->count = count;
    b->number = TY_TRY_ALLOC(uint32_t, count);
    b->box = TY_TRY_ALLOC(ty_bounds, count);
    b->order = TY_TRY_ALLOC(uint32_t, count);
    b->key = TY_TRY_ALLOC(uint64_t, count);
    b->spare = TY_TRY_ALLOC(uint32_t, count);
    b->tree = TY_TRY_ALLOC(binary, most);
    return b->number && b->box && b->order && b->key && b->spare && b->tree;
}

static void release(builder* b)
{
    ty_free(b->number);
    ty_free(b->box);
    ty_free(b->order);
    ty_free(b->key);
    ty_free(b->spare);
    ty_free(b->tree);
}

// Leaves and nodes, of which there is one in fifteen leaves and the incomplete ones.
static bool fill(builder* b)
{
    ty_trace_wide* wide = b->wide;
    uint32_t leaf_count = (b->count + TY_LANES - 1) / TY_LANES;
    ty_free(b->key);
    ty_free(b->spare);
    ty_free(b->box);
    b->key = NULL;
    b->spare = NULL;
    b->box = NULL;
    wide->leaves = TY_TRY_ALLOC(ty_wide_leaf, leaf_count);
    wide->nodes = TY_TRY_ALLOC(ty_wide_node, leaf_count);
    if (!wide->leaves || !wide->nodes)
        return false;
    wide->root = make_node(b, 0);
    ty_wide_node* fitted =
        ty_try_grow(wide->nodes, leaf_count, wide->node_count ? wide->node_count : 1, sizeof(ty_wide_node));
    wide->nodes = fitted ? fitted : wide->nodes;
    return true;
}

ty_status ty_trace_wide_create(ty_world* world, const uint32_t* objects, uint32_t object_count, ty_trace_wide** out,
                               ty_error* error)
{
    *out = NULL;
    uint64_t count = 0;
    for (uint32_t i = 0; i < object_count; i++)
        count += world->objects[objects[i]].count - world->objects[objects[i]].drift_count;
    if (count == 0)
        return TY_OK;
    builder b = {.world = world, .wide = TY_ALLOC(ty_trace_wide, 1)};
    b.wide->common_mask = TY_MASK_ALL;
    bool built = allocate(&b, (uint32_t)count);
    if (built)
    {
        uint32_t next = 0;
        for (uint32_t i = 0; i < object_count; i++)
            measure(&b, &world->objects[objects[i]], &next);
        grow(&b, 0, b.count, 0);
        built = fill(&b);
    }
    release(&b);
    if (!built)
    {
        ty_trace_wide_destroy(b.wide);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for the tree over %llu instances",
                            (unsigned long long)count);
    }
    *out = b.wide;
    return TY_OK;
}

void ty_trace_wide_destroy(ty_trace_wide* wide)
{
    if (!wide)
        return;
    ty_free(wide->nodes);
    ty_free(wide->leaves);
    ty_free(wide);
}

uint64_t ty_trace_wide_memory(const ty_trace_wide* wide)
{
    if (!wide)
        return 0;
    return sizeof *wide + (uint64_t)wide->node_count * sizeof(ty_wide_node) +
           (uint64_t)wide->leaf_count * sizeof(ty_wide_leaf);
}
