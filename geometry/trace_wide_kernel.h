// SPDX-License-Identifier: Apache-2.0
// Traversal of the wide top level. Included by one file an instruction set; KERNEL names the set.
#include "trace_wide_boxes.h"
#include <string.h>

#define JOIN(a, b) a##_##b
#define NAME(a, b) JOIN(a, b)

// --- ellipsoids ---

typedef struct sphere_hits
{
    _Alignas(64) float entry[TY_LANES];
    _Alignas(64) float origin[3][TY_LANES];
    _Alignas(64) float direction[3][TY_LANES];
    _Alignas(64) float nearest_sqr[TY_LANES]; // squared distance of the line from the centre
    _Alignas(64) float middle[TY_LANES];      // where that is
    _Alignas(64) float per_length_sqr[TY_LANES];
} sphere_hits;

// Lanes whose ellipsoid the ray comes near between t_min and t_max. Conservative: the tree below is traced with this
// very mapped ray, so that little more than the rounding of the test itself counts.
static inline uint32_t meet_spheres(const ty_wide_leaf* leaf, const ty_wide_query* q, sphere_hits* hits)
{
    const ty_f16 px = ty_f16_set(q->origin.x), py = ty_f16_set(q->origin.y), pz = ty_f16_set(q->origin.z);
    const ty_f16 wx = ty_f16_set(q->direction.x), wy = ty_f16_set(q->direction.y), wz = ty_f16_set(q->direction.z);
    ty_f16 o[3], d[3];
    for (int i = 0; i < 3; i++)
    {
        ty_f16 x = ty_f16_load(leaf->map[4 * i]), y = ty_f16_load(leaf->map[4 * i + 1]);
        ty_f16 z = ty_f16_load(leaf->map[4 * i + 2]);
        o[i] = ty_f16_fma(x, px, ty_f16_fma(y, py, ty_f16_fma(z, pz, ty_f16_load(leaf->map[4 * i + 3]))));
        d[i] = ty_f16_dot3(x, wx, y, wy, z, wz);
    }
    // By the line's moment o x d, so that no division stands before the first answer and only one beside the root.
    ty_f16 moment[3];
    for (int i = 0; i < 3; i++)
    {
        int k = i == 2 ? 0 : i + 1, l = k == 2 ? 0 : k + 1;
        moment[i] = ty_f16_fms(o[k], d[l], ty_f16_mul(o[l], d[k]));
    }
    const ty_f16 one = ty_f16_set(1.0f);
    ty_f16 length_sqr = ty_f16_dot3(d[0], d[0], d[1], d[1], d[2], d[2]);
    ty_f16 moment_sqr = ty_f16_dot3(moment[0], moment[0], moment[1], moment[1], moment[2], moment[2]);
    ty_f16 far = ty_f16_add(ty_f16_add(ty_f16_abs(o[0]), ty_f16_abs(o[1])), ty_f16_abs(o[2]));
    ty_f16 limit = ty_f16_fma(ty_f16_set(2e-6f), far, ty_f16_set(1.0f + 2e-6f));
    ty_f16 rest = ty_f16_fms(limit, length_sqr, moment_sqr);
    uint32_t mask = ty_f16_lt(ty_f16_set(0.0f), rest) & ~ty_u32_equal16(leaf->instance, q->pass);
    if (!mask)
        return 0;
    ty_f16 inverse = ty_f16_div(one, length_sqr);
    ty_f16 along = ty_f16_dot3(o[0], d[0], o[1], d[1], o[2], d[2]);
    ty_f16 middle = ty_f16_mul(ty_f16_sub(ty_f16_set(0.0f), along), inverse);
    ty_f16 half = ty_f16_fma(ty_f16_set(2e-6f), ty_f16_abs(middle), ty_f16_mul(ty_f16_sqrt(rest), inverse));
    ty_f16 entry = ty_f16_sub(middle, half);
    mask &= ty_f16_le(ty_f16_set(q->t_min), ty_f16_add(middle, half)) & ty_f16_le(entry, ty_f16_set(q->t_max));
    ty_f16_store(hits->entry, entry);
    ty_f16_store(hits->nearest_sqr, ty_f16_mul(moment_sqr, inverse));
    ty_f16_store(hits->middle, middle);
    ty_f16_store(hits->per_length_sqr, inverse);
    for (int i = 0; i < 3; i++)
    {
        ty_f16_store(hits->origin[i], o[i]);
        ty_f16_store(hits->direction[i], d[i]);
    }
    return mask;
}

// --- below: the prototypes ---

// Whether the ray sees the instance at all, and which of its hits must be looked at one by one.
static inline bool may_visit(const ty_world* world, const ty_trace_wide* wide, const ty_wide_query* q,
                             uint32_t instance, bool outside, ty_trace_context* context, RTCFilterFunctionN* filter)
{
    *filter = NULL;
    if (q->meets_all)
        return true;
    bool skip = instance == q->skip, all_see = (q->ray->mask & wide->common_mask) != 0;
    // What comes from outside a closed surface meets its front first.
    bool one_sided = wide->has_subsurface && (q->ray->flags & TY_RAY_FRONT_ONLY) && !outside;
    if (!skip && all_see && !one_sided)
        return true;
    const ty_trace_object* object = ty_trace_object_of(world, instance);
    if (!(q->ray->mask & object->mask))
        return false;
    if (skip || (one_sided && object->one_sided))
    {
        context->object = object->index;
        context->instance = instance - object->first;
        *filter = ty_trace_filter;
    }
    return true;
}

// The lane's ray in its prototype's space.
static inline struct RTCRay lane_ray(const ty_trace_prototype* prototype, const sphere_hits* hits, int lane,
                                     const ty_wide_query* q)
{
    ty_vec3 o = {hits->origin[0][lane], hits->origin[1][lane], hits->origin[2][lane]};
    ty_vec3 d = {hits->direction[0][lane], hits->direction[1][lane], hits->direction[2][lane]};
    o = ty_map_point(&prototype->from_sphere, o);
    d = ty_map_vector(&prototype->from_sphere, d);
    return (struct RTCRay){.org_x = o.x,
                           .org_y = o.y,
                           .org_z = o.z,
                           .tnear = q->t_min,
                           .dir_x = d.x,
                           .dir_y = d.y,
                           .dir_z = d.z,
                           .tfar = q->t_max,
                           .mask = 0xffffffffu};
}

static bool intersect_leaf(const ty_world* world, const ty_trace_wide* wide, const ty_wide_leaf* leaf,
                           ty_trace_context* context, ty_wide_query* q)
{
    sphere_hits hits;
    uint32_t mask = meet_spheres(leaf, q, &hits);
    bool found = false;
    while (mask)
    {
        int lane = __builtin_ctz(mask);
        for (uint32_t rest = mask & (mask - 1); rest; rest &= rest - 1)
            lane = hits.entry[__builtin_ctz(rest)] < hits.entry[lane] ? __builtin_ctz(rest) : lane;
        mask &= ~(1u << lane);
        if (hits.entry[lane] > q->t_max)
            break;
        RTCFilterFunctionN filter;
        if (!may_visit(world, wide, q, leaf->instance[lane], hits.entry[lane] > q->t_min, context, &filter))
            continue;
        const ty_trace_prototype* prototype = &world->prototypes[leaf->prototype[lane]];
        struct RTCRayHit below = {.ray = lane_ray(prototype, &hits, lane, q)};
        below.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        ty_embree_intersect(prototype->scene, &context->embree, filter, &below);
        if (below.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            continue;
        q->t_max = below.ray.tfar;
        q->u = below.hit.u;
        q->v = below.hit.v;
        q->triangle = below.hit.primID;
        q->instance = leaf->instance[lane];
        found = true;
    }
    return found;
}

// A ray from outside the bounding ellipsoid that reaches into the inscribed one has crossed the closed surface between.
static inline bool crosses_inner(const ty_trace_prototype* prototype, const sphere_hits* hits, int lane, float t_max)
{
    float rest = prototype->inner_radius_sqr - hits->nearest_sqr[lane];
    return rest > 0.0f && hits->middle[lane] - sqrtf(rest * hits->per_length_sqr[lane]) < t_max;
}

static bool occluded_leaf(const ty_world* world, const ty_trace_wide* wide, const ty_wide_leaf* leaf,
                          ty_trace_context* context, const ty_wide_query* q)
{
    sphere_hits hits;
    for (uint32_t mask = meet_spheres(leaf, q, &hits); mask; mask &= mask - 1)
    {
        int lane = __builtin_ctz(mask);
        bool outside = hits.entry[lane] > q->t_min;
        RTCFilterFunctionN filter;
        if (!may_visit(world, wide, q, leaf->instance[lane], outside, context, &filter))
            continue;
        const ty_trace_prototype* prototype = &world->prototypes[leaf->prototype[lane]];
        if (outside && !filter && crosses_inner(prototype, &hits, lane, q->t_max))
            return true;
        struct RTCRay below = lane_ray(prototype, &hits, lane, q);
        ty_embree_occluded(prototype->scene, &context->embree, filter, &below);
        if (below.tfar < 0.0f)
            return true;
    }
    return false;
}

// --- the way down ---

// A child that waits: where the ray enters it above its number, in one register. Entries are not negative, so that they
// have the order of their bits.
typedef uint64_t waiting;

static inline waiting make_waiting(uint32_t child, float entry)
{
    uint32_t bits;
    memcpy(&bits, &entry, sizeof bits);
    return (waiting)bits << 32 | child;
}

static inline float waiting_entry(waiting w)
{
    uint32_t bits = (uint32_t)(w >> 32);
    float entry;
    memcpy(&entry, &bits, sizeof entry);
    return entry;
}

// Pushes the children met but for the nearest, which is given back; sorted, the nearer on top. The mask is not empty.
static inline waiting push_children(const ty_wide_node* node, uint32_t mask, const float* entry, waiting* stack,
                                    int* count)
{
    int lane = __builtin_ctz(mask), base = *count, top = base;
    waiting nearest = make_waiting(node->child[lane], entry[lane]);
    for (mask &= mask - 1; mask; mask &= mask - 1)
    {
        lane = __builtin_ctz(mask);
        waiting next = make_waiting(node->child[lane], entry[lane]);
        waiting farther = next < nearest ? nearest : next;
        nearest = next < nearest ? next : nearest;
        int i = top++;
        for (; i > base && stack[i - 1] < farther; i--)
            stack[i] = stack[i - 1];
        stack[i] = farther;
    }
    *count = top;
    return nearest;
}

static inline ty_trace_context make_context(const ty_world* world, const ty_ray* ray)
{
    ty_trace_context context = {.world = world, .ray = ray, .object = TY_NONE, .instance = TY_NONE};
    ty_embree_context_init(&context.embree);
    return context;
}

bool NAME(ty_wide_intersect, KERNEL)(const ty_world* world, const ty_trace_wide* wide, ty_wide_query* q)
{
    ty_trace_context context = make_context(world, q->ray);
    const ty_box_ray ray = ty_box_ray_make(q->origin, q->direction);
    _Alignas(64) float entry[TY_LANES];
    waiting stack[TY_WIDE_STACK];
    waiting next = make_waiting(wide->root, q->t_min);
    int count = 0;
    bool found = false;
    for (;;)
    {
        uint32_t child = (uint32_t)next;
        if (child & TY_WIDE_LEAF)
            found |= intersect_leaf(world, wide, &wide->leaves[child & ~TY_WIDE_LEAF], &context, q);
        else
        {
            const ty_wide_node* node = &wide->nodes[child];
            uint32_t mask = ty_meet_boxes(node, &ray, q->t_min, q->t_max, entry);
            if (mask)
            {
                next = push_children(node, mask, entry, stack, &count);
                continue;
            }
        }
        do
        {
            if (count == 0)
                return found;
            next = stack[--count];
        } while (waiting_entry(next) > q->t_max);
    }
}

bool NAME(ty_wide_occluded, KERNEL)(const ty_world* world, const ty_trace_wide* wide, const ty_wide_query* q)
{
    ty_trace_context context = make_context(world, q->ray);
    const ty_box_ray ray = ty_box_ray_make(q->origin, q->direction);
    _Alignas(64) float entry[TY_LANES];
    waiting stack[TY_WIDE_STACK];
    waiting next = make_waiting(wide->root, q->t_min);
    int count = 0;
    for (;;)
    {
        uint32_t child = (uint32_t)next, mask = 0;
        if (child & TY_WIDE_LEAF)
        {
            if (occluded_leaf(world, wide, &wide->leaves[child & ~TY_WIDE_LEAF], &context, q))
                return true;
        }
        else
            mask = ty_meet_boxes(&wide->nodes[child], &ray, q->t_min, q->t_max, entry);
        if (mask)
            next = push_children(&wide->nodes[child], mask, entry, stack, &count);
        else if (count > 0)
            next = stack[--count];
        else
            return false;
    }
}
