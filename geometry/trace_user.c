// SPDX-License-Identifier: Apache-2.0
// An aggregate as one Embree user geometry over its instances, with an ellipsoid test before the prototype's tree.
#include "trace_world.h"
#include <tsuya/base/memory.h>

// World box of an instance: the mapped ellipsoid's box cut by the mapped bounding box, whichever is tighter on each
// side.
static ty_bounds instance_bounds(const ty_trace_prototype* prototype, const ty_affine* to_world)
{
    ty_bounds box = ty_bounds_map(to_world, prototype->bounds);
    if (prototype->has_ellipsoid)
    {
        ty_affine m = ty_affine_multiply(to_world, &prototype->from_sphere);
        ty_vec3 half = {sqrtf(m.x.x * m.x.x + m.y.x * m.y.x + m.z.x * m.z.x),
                        sqrtf(m.x.y * m.x.y + m.y.y * m.y.y + m.z.y * m.z.y),
                        sqrtf(m.x.z * m.x.z + m.y.z * m.y.z + m.z.z * m.z.z)};
        box.low = ty_max3(box.low, ty_sub(m.t, half));
        box.high = ty_min3(box.high, ty_add(m.t, half));
    }
    // Mapping rays and mapping points round differently: a few units in the last place of the largest coordinate.
    ty_vec3 reach = ty_max3(ty_max3(box.high, ty_neg(box.high)), ty_max3(box.low, ty_neg(box.low)));
    float pad = 1e-6f * ty_max(reach.x, ty_max(reach.y, reach.z));
    ty_vec3 pad3 = {pad, pad, pad};
    return (ty_bounds){ty_sub(box.low, pad3), ty_add(box.high, pad3)};
}

static const ty_trace_prototype* prototype_at(const ty_trace_object* object, uint32_t instance)
{
    return &object->world->prototypes[ty_trace_prototype_of(object, instance)];
}

// To the world; for a moving object to its own space.
static ty_affine placed(const ty_trace_object* object, uint32_t instance)
{
    ty_affine inner = ty_trace_inner_map(object, instance);
    return object->step_count > 1 ? inner : ty_affine_multiply(&object->steps[0], &inner);
}

static void write_bounds(const struct RTCBoundsFunctionArguments* args)
{
    const ty_trace_object* object = args->geometryUserPtr;
    ty_affine map = placed(object, args->primID);
    ty_bounds box = instance_bounds(prototype_at(object, args->primID), &map);
    *args->bounds_o =
        (struct RTCBounds){box.low.x, box.low.y, box.low.z, 0.0f, box.high.x, box.high.y, box.high.z, 0.0f};
}

static float sum_abs(ty_vec3 v)
{
    return fabsf(v.x) + fabsf(v.y) + fabsf(v.z);
}

// Whether the ray (prototype space) comes near enough to the bounding ellipsoid between t_min and t_max. Conservative:
// the limit grows with the rounding error of the two maps, which is a few 1e-7 of the largest coordinates in them.
static bool may_meet_ellipsoid(const ty_trace_prototype* prototype, const ty_affine* to_local, ty_vec3 origin,
                               ty_vec3 direction, float t_min, float t_max)
{
    ty_vec3 o = ty_map_point(&prototype->to_sphere, origin), d = ty_map_vector(&prototype->to_sphere, direction);
    float inverse = 1.0f / ty_dot(d, d);
    float middle = -ty_dot(o, d) * inverse;
    ty_vec3 p = ty_mad(o, d, middle);
    float limit = 1.0f + 4e-6f * (1.0f + sum_abs(o) + prototype->sphere_scale * sum_abs(to_local->t));
    float rest = limit - ty_dot(p, p);
    if (!(rest >= 0.0f))
        return false;
    float half = sqrtf(rest * inverse) + 2e-6f * fabsf(middle);
    return middle + half >= t_min && middle - half <= t_max;
}

// The ray in the prototype's space; the direction keeps its length in world space, so t means the same in both.
static bool enter_instance(const ty_trace_object* object, const ty_trace_context* outer, uint32_t primitive,
                           const struct RTCRay* ray, struct RTCRay* local)
{
    const ty_ray* r = outer->ray;
    if (r->skip_object == object->index && r->skip_instance == primitive && r->skip_distance >= TY_FLOAT_MAX)
        return false;
    const ty_trace_prototype* prototype = prototype_at(object, primitive);
    const ty_affine* to_local = &object->to_local[primitive];
    ty_vec3 o = ty_map_point(to_local, ty_vec3_make(ray->org_x, ray->org_y, ray->org_z));
    ty_vec3 d = ty_map_vector(to_local, ty_vec3_make(ray->dir_x, ray->dir_y, ray->dir_z));
    if (prototype->has_ellipsoid && !may_meet_ellipsoid(prototype, to_local, o, d, ray->tnear, ray->tfar))
        return false;
    *local = *ray;
    local->org_x = o.x;
    local->org_y = o.y;
    local->org_z = o.z;
    local->dir_x = d.x;
    local->dir_y = d.y;
    local->dir_z = d.z;
    return true;
}

static void intersect_instance(const struct RTCIntersectFunctionNArguments* args)
{
    if (!args->valid[0])
        return;
    const ty_trace_object* object = args->geometryUserPtr;
    const ty_trace_context* outer = (const ty_trace_context*)args->context;
    struct RTCRayHit* ray_hit = (struct RTCRayHit*)args->rayhit;
    struct RTCRayHit local;
    if (!enter_instance(object, outer, args->primID, &ray_hit->ray, &local.ray))
        return;
    local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    local.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    ty_trace_context inner = {
        .world = object->world, .ray = outer->ray, .object = object->index, .instance = args->primID};
    ty_embree_context_init(&inner.embree);
    RTCScene scene = prototype_at(object, args->primID)->scene;
    ty_embree_intersect(scene, &inner.embree, ty_trace_needed_filter(object, outer->ray, args->primID), &local);
    if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return;
    ray_hit->ray.tfar = local.ray.tfar;
    ray_hit->hit = local.hit;
    // As an Embree instance of a plain object leaves it: the object as instance id; here the geometry tells the
    // instance.
    ray_hit->hit.instID[0] = args->geomID;
    ray_hit->hit.geomID = args->primID;
}

static void occlude_instance(const struct RTCOccludedFunctionNArguments* args)
{
    if (!args->valid[0])
        return;
    const ty_trace_object* object = args->geometryUserPtr;
    const ty_trace_context* outer = (const ty_trace_context*)args->context;
    struct RTCRay* ray = (struct RTCRay*)args->ray;
    struct RTCRay local;
    if (!enter_instance(object, outer, args->primID, ray, &local))
        return;
    ty_trace_context inner = {
        .world = object->world, .ray = outer->ray, .object = object->index, .instance = args->primID};
    ty_embree_context_init(&inner.embree);
    RTCScene scene = prototype_at(object, args->primID)->scene;
    ty_embree_occluded(scene, &inner.embree, ty_trace_needed_filter(object, outer->ray, args->primID), &local);
    if (local.tfar < 0.0f)
        ray->tfar = local.tfar;
}

RTCGeometry ty_trace_create_user_geometry(const ty_world* world, ty_trace_object* object)
{
    RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_USER);
    if (!geometry)
        return NULL;
    object->to_local = TY_ALLOC(ty_affine, object->count);
    for (uint32_t i = 0; i < object->count; i++)
    {
        ty_affine map = placed(object, i);
        if (!ty_affine_invert(&map, &object->to_local[i]))
            object->to_local[i] = ty_affine_identity();
    }
    rtcSetGeometryUserPrimitiveCount(geometry, object->count);
    rtcSetGeometryUserData(geometry, object);
    rtcSetGeometryBoundsFunction(geometry, write_bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, intersect_instance);
    rtcSetGeometryOccludedFunction(geometry, occlude_instance);
    return geometry;
}
