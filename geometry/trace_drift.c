// SPDX-License-Identifier: Apache-2.0
// Instances of an aggregate that move by velocities of their own while the shutter is open: each goes straight on and
// turns about its origin, and is one Embree user primitive with boxes that move along.
#include "trace_world.h"
#include <tsuya/base/memory.h>

// What moves by less than this share of its own size rests: nobody sees it, and what rests is traced faster.
#define LEAST_PATH 1e-3f
// Over this turn a point leaves its chord by at most 1 - cos(half of it), 1.5 % of its arm.
#define BOX_TURN 0.35f
#define MAX_BOX_STEPS 17
// As ty_trace_refine_motion: what Embree's instances, of the reference path, may turn between two maps.
#define MAP_TURN 0.0698f
#define MAX_MAP_STEPS 129 // Embree's own limit

// --- which ---

static ty_vec3 velocity_of(const ty_aggregate* a, uint32_t i)
{
    return a->velocities ? a->velocities[i] : (ty_vec3){0};
}

static ty_vec3 spin_of(const ty_aggregate* a, uint32_t i)
{
    return a->spins ? a->spins[i] : (ty_vec3){0};
}

// The farthest that anything of the prototype's box is from the instance's origin, before the object's own map.
static float arm_of(const ty_trace_object* object, ty_bounds bounds, uint32_t instance)
{
    ty_affine m = object->aggregate->transforms[instance];
    float most = 0.0f;
    m.t = (ty_vec3){0};
    for (int i = 0; i < 8; i++)
    {
        ty_vec3 corner = {i & 1 ? bounds.high.x : bounds.low.x, i & 2 ? bounds.high.y : bounds.low.y,
                          i & 4 ? bounds.high.z : bounds.low.z};
        most = ty_max(most, ty_length_sqr(ty_map_point(&m, corner)));
    }
    return sqrtf(most);
}

// Length of the longest path of a point of the instance from the aggregate's moment, in arms.
static float path_of(const ty_trace_object* object, uint32_t i, ty_motion motion)
{
    const ty_aggregate* a = object->aggregate;
    float seconds = ty_max(fabsf(motion.open), fabsf(motion.close));
    float arm = arm_of(object, a->prototypes[a->prototype_index[i]]->bounds, i);
    return (ty_length(velocity_of(a, i)) / arm + ty_length(spin_of(a, i))) * seconds;
}

static float turn_of(const ty_trace_object* object, uint32_t instance)
{
    return ty_length(spin_of(object->aggregate, instance)) * fabsf(object->close - object->open);
}

// Intervals of at most `most` radians each, whole parts of the object's own.
static int steps_for(const ty_trace_object* object, float turn, float most, int limit)
{
    int outer = object->step_count > 1 ? object->step_count - 1 : 1;
    int split = 1 + (int)ty_min(turn / (most * (float)outer), (float)limit);
    while (split > 1 && outer * split + 1 > limit)
        split--;
    return outer * split + 1;
}

// Bounds how much longer a map makes a vector, by Gershgorin's bound of m^T m; exact for a similarity.
static float stretch_of(const ty_affine* m)
{
    float xy = fabsf(ty_dot(m->x, m->y)), yz = fabsf(ty_dot(m->y, m->z)), zx = fabsf(ty_dot(m->z, m->x));
    return sqrtf(
        ty_max(ty_length_sqr(m->x) + xy + zx, ty_max(ty_length_sqr(m->y) + xy + yz, ty_length_sqr(m->z) + yz + zx)));
}

static float radius_of(const ty_mesh* mesh)
{
    float most = 0.0f;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        most = ty_max(most, ty_length_sqr(mesh->positions[i]));
    return sqrtf(most);
}

// Balls about the origins that hold the instances however they are turned, a little larger than exact.
static void find_reaches(ty_trace_object* object)
{
    const ty_aggregate* a = object->aggregate;
    float* radii = TY_ALLOC(float, a->prototype_count);
    for (int i = 0; i < a->prototype_count; i++)
        radii[i] = radius_of(a->prototypes[i]);
    for (uint32_t i = 0; i < object->drift_count; i++)
    {
        uint32_t instance = object->drifting[i];
        object->reaches[i] = 1.0001f * radii[a->prototype_index[instance]] * stretch_of(&object->steps[0]) *
                             stretch_of(&a->transforms[instance]);
    }
    ty_free(radii);
}

static void list_drifting(ty_trace_object* object)
{
    float turn = 0.0f;
    for (uint32_t i = 0, k = 0; i < object->count; i++)
        if (object->drifts[i])
        {
            object->drifting[k++] = i;
            turn = ty_max(turn, turn_of(object, i));
        }
    object->drift_steps = steps_for(object, turn, BOX_TURN, MAX_BOX_STEPS);
}

ty_status ty_trace_find_drift(ty_trace_object* object, ty_motion motion, ty_error* error)
{
    const ty_aggregate* a = object->aggregate;
    if (!a || (!a->velocities && !a->spins) || motion.open == motion.close)
        return TY_OK;
    uint32_t count = 0;
    for (uint32_t i = 0; i < object->count; i++)
    {
        float path = path_of(object, i, motion);
        if (!isfinite(path))
            return ty_error_set(error, TY_BAD_INPUT, "instance %u: its velocity or spin is not finite", i);
        count += path > LEAST_PATH;
    }
    if (count == 0)
        return TY_OK;
    bool together = object->step_count > 1; // an object that moves as a whole takes its resting instances along
    object->open = motion.open;
    object->close = motion.close;
    object->drift_count = together ? object->count : count;
    object->drifts = TY_TRY_ALLOC(bool, object->count);
    object->drifting = TY_TRY_ALLOC(uint32_t, object->drift_count);
    object->reaches = TY_TRY_ALLOC(float, object->drift_count);
    if (!object->drifts || !object->drifting || !object->reaches)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %u moving instances", object->drift_count);
    for (uint32_t i = 0; i < object->count; i++)
        object->drifts[i] = together || path_of(object, i, motion) > LEAST_PATH;
    list_drifting(object);
    find_reaches(object);
    return TY_OK;
}

// --- where ---

ty_affine ty_trace_drifted(const ty_trace_object* object, uint32_t instance, float time)
{
    const ty_aggregate* a = object->aggregate;
    float seconds = ty_lerp(object->open, object->close, time);
    ty_affine m = a->transforms[instance];
    ty_vec3 spin = spin_of(a, instance);
    float rate = ty_length(spin);
    if (rate > 0.0f)
    {
        ty_quat turn = ty_quat_axis_angle(ty_mul(spin, 1.0f / rate), rate * seconds);
        m.x = ty_quat_rotate(turn, m.x);
        m.y = ty_quat_rotate(turn, m.y);
        m.z = ty_quat_rotate(turn, m.z);
    }
    m.t = ty_mad(m.t, velocity_of(a, instance), seconds);
    return m;
}

int ty_trace_drift_steps(const ty_trace_object* object, uint32_t instance)
{
    return steps_for(object, turn_of(object, instance), MAP_TURN, MAX_MAP_STEPS);
}

// --- boxes ---

static float columns_length(const ty_affine* m)
{
    return sqrtf(ty_length_sqr(m->x) + ty_length_sqr(m->y) + ty_length_sqr(m->z));
}

// By how much points may leave the straight line between two steps next to this one: a point on a circle its chord, and
// what moves within an object that itself moves, s -> A(s) x(s), by a quarter of |A1 - A0| |x1 - x0|.
static float sag_of(const ty_trace_object* object, uint32_t instance, int step, float arm)
{
    float intervals = (float)(object->drift_steps - 1);
    float half = 0.5f * turn_of(object, instance) / intervals, sine, cosine;
    ty_sincos(ty_min(half, 0.5f * TY_PI), &sine, &cosine);
    float sag = arm * (1.0f - cosine);
    if (object->step_count == 1)
        return sag * columns_length(&object->steps[0]);
    float size = 0.0f, change = 0.0f;
    for (int side = -1; side <= 1; side += 2)
    {
        ty_affine a = ty_trace_map_at(object->steps, object->step_count, (float)step / intervals);
        ty_affine b = ty_trace_map_at(object->steps, object->step_count, (float)(step + side) / intervals);
        ty_affine d = {ty_sub(b.x, a.x), ty_sub(b.y, a.y), ty_sub(b.z, a.z), {0, 0, 0}};
        change = ty_max(change, columns_length(&d));
        size = ty_max(size, columns_length(&b));
    }
    float seconds = fabsf(object->close - object->open) / intervals;
    float path = (ty_length(velocity_of(object->aggregate, instance)) * seconds + 2.0f * half * arm);
    return sag * size + 0.25f * change * path;
}

ty_bounds ty_trace_drift_bounds(const ty_trace_object* object, uint32_t instance, int step)
{
    const ty_trace_prototype* prototype = &object->world->prototypes[ty_trace_prototype_of(object, instance)];
    ty_affine map = ty_trace_made_map(object, instance, (float)step / (float)(object->drift_steps - 1));
    ty_bounds box = ty_bounds_map(&map, prototype->bounds);
    float arm = arm_of(object, prototype->bounds, instance);
    // From half a turn a step on a point may be anywhere about the origin.
    box.low = ty_min3(box.low, map.t);
    box.high = ty_max3(box.high, map.t);
    ty_vec3 reach = ty_max3(ty_max3(box.high, ty_neg(box.high)), ty_max3(box.low, ty_neg(box.low)));
    float pad = sag_of(object, instance, step, arm) + 2e-6f * ty_max(reach.x, ty_max(reach.y, reach.z));
    ty_vec3 pad3 = {pad, pad, pad};
    return (ty_bounds){ty_sub(box.low, pad3), ty_add(box.high, pad3)};
}

static void write_bounds(const struct RTCBoundsFunctionArguments* args)
{
    const ty_trace_object* object = args->geometryUserPtr;
    ty_bounds box = ty_trace_drift_bounds(object, object->drifting[args->primID], (int)args->timeStep);
    *args->bounds_o =
        (struct RTCBounds){box.low.x, box.low.y, box.low.z, 0.0f, box.high.x, box.high.y, box.high.z, 0.0f};
}

// --- rays ---

// Whether the ray passes the instance's ball, before any map is made: most that meet its box do not meet it. Of objects
// at rest.
static inline bool passes_by(const ty_trace_object* object, uint32_t number, const struct RTCRay* r)
{
    if (object->step_count > 1)
        return false;
    const ty_aggregate* a = object->aggregate;
    uint32_t instance = object->drifting[number];
    float seconds = ty_lerp(object->open, object->close, r->time), reach = object->reaches[number];
    ty_vec3 center = ty_mad(a->transforms[instance].t, velocity_of(a, instance), seconds);
    center = ty_map_point(&object->steps[0], center);
    ty_vec3 o = ty_sub(ty_vec3_make(r->org_x, r->org_y, r->org_z), center), d = {r->dir_x, r->dir_y, r->dir_z};
    float along = -ty_dot(o, d), far = ty_length_sqr(o), slack = 4e-6f * far;
    float rest = ty_sqr(reach) + slack - (far - ty_sqr(along));
    if (rest < 0.0f)
        return true;
    float half = sqrtf(rest);
    return along + half < r->tnear || along - half > r->tfar;
}

// The ray in the prototype's space; the direction keeps its length in world space, so t means the same in both.
static bool enter(const ty_trace_object* object, uint32_t instance, const ty_ray* ray, const struct RTCRay* outer,
                  struct RTCRay* local)
{
    if (ray->skip_object == object->index && ray->skip_instance == instance && ray->skip_distance >= TY_FLOAT_MAX)
        return false;
    ty_affine map = ty_trace_made_map(object, instance, outer->time), to_local;
    if (!ty_affine_invert(&map, &to_local))
        return false;
    ty_vec3 o = ty_map_point(&to_local, ty_vec3_make(outer->org_x, outer->org_y, outer->org_z));
    ty_vec3 d = ty_map_vector(&to_local, ty_vec3_make(outer->dir_x, outer->dir_y, outer->dir_z));
    *local = (struct RTCRay){.org_x = o.x,
                             .org_y = o.y,
                             .org_z = o.z,
                             .tnear = outer->tnear,
                             .dir_x = d.x,
                             .dir_y = d.y,
                             .dir_z = d.z,
                             .tfar = outer->tfar,
                             .mask = 0xffffffffu};
    return true;
}

static ty_trace_context context_below(const ty_trace_object* object, uint32_t instance, const ty_ray* ray)
{
    ty_trace_context below = {.world = object->world, .ray = ray, .object = object->index, .instance = instance};
    ty_embree_context_init(&below.embree);
    return below;
}

static void intersect_drifting(const struct RTCIntersectFunctionNArguments* args)
{
    const ty_trace_object* object = args->geometryUserPtr;
    const ty_ray* ray = ((const ty_trace_context*)args->context)->ray;
    uint32_t instance = object->drifting[args->primID];
    struct RTCRayHit *ray_hit = (struct RTCRayHit*)args->rayhit, local;
    if (!args->valid[0] || passes_by(object, args->primID, &ray_hit->ray) ||
        !enter(object, instance, ray, &ray_hit->ray, &local.ray))
        return;
    local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    local.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    ty_trace_context below = context_below(object, instance, ray);
    ty_embree_intersect(object->world->prototypes[ty_trace_prototype_of(object, instance)].scene, &below.embree,
                        ty_trace_needed_filter(object, ray, instance), &local);
    if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return;
    ray_hit->ray.tfar = local.ray.tfar;
    ray_hit->hit = local.hit;
    ray_hit->hit.geomID = instance;
    ray_hit->hit.instID[0] = args->geomID;
}

static void occlude_drifting(const struct RTCOccludedFunctionNArguments* args)
{
    const ty_trace_object* object = args->geometryUserPtr;
    const ty_ray* ray = ((const ty_trace_context*)args->context)->ray;
    uint32_t instance = object->drifting[args->primID];
    struct RTCRay *outer = (struct RTCRay*)args->ray, local;
    if (!args->valid[0] || passes_by(object, args->primID, outer) || !enter(object, instance, ray, outer, &local))
        return;
    ty_trace_context below = context_below(object, instance, ray);
    ty_embree_occluded(object->world->prototypes[ty_trace_prototype_of(object, instance)].scene, &below.embree,
                       ty_trace_needed_filter(object, ray, instance), &local);
    if (local.tfar < 0.0f)
        outer->tfar = local.tfar;
}

RTCGeometry ty_trace_create_drifting_geometry(const ty_world* world, ty_trace_object* object)
{
    RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_USER);
    if (!geometry)
        return NULL;
    rtcSetGeometryUserPrimitiveCount(geometry, object->drift_count);
    rtcSetGeometryTimeStepCount(geometry, (unsigned)object->drift_steps);
    rtcSetGeometryUserData(geometry, object);
    rtcSetGeometryBoundsFunction(geometry, write_bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, intersect_drifting);
    rtcSetGeometryOccludedFunction(geometry, occlude_drifting);
    return geometry;
}
