// SPDX-License-Identifier: Apache-2.0
// A moving object as one Embree user primitive: the ray goes to its space as it stands at the ray's time, and on from
// there as through a thing at rest.
#include "trace_world.h"

ty_bounds ty_trace_step_bounds(const ty_trace_object* object, int step)
{
    ty_bounds box = ty_bounds_empty();
    for (uint32_t i = 0; i < object->count; i++)
    {
        ty_affine inner = ty_trace_inner_map(object, i);
        ty_affine map = object->aggregate ? ty_affine_multiply(&object->steps[step], &inner) : object->steps[step];
        const ty_trace_prototype* prototype = &object->world->prototypes[ty_trace_prototype_of(object, i)];
        box = ty_bounds_union(box, ty_bounds_map(&map, prototype->bounds));
    }
    return box;
}

// A point moves linearly between two steps, and so lies within the linear blend of their boxes, as Embree takes it.
static void write_bounds(const struct RTCBoundsFunctionArguments* args)
{
    ty_bounds box = ty_trace_step_bounds(args->geometryUserPtr, (int)args->timeStep);
    ty_vec3 reach = ty_max3(ty_max3(box.high, ty_neg(box.high)), ty_max3(box.low, ty_neg(box.low)));
    float pad = 2e-6f * ty_max(reach.x, ty_max(reach.y, reach.z));
    *args->bounds_o = (struct RTCBounds){box.low.x - pad,  box.low.y - pad,  box.low.z - pad,  0.0f,
                                         box.high.x + pad, box.high.y + pad, box.high.z + pad, 0.0f};
}

static void set_ray(struct RTCRay* ray, ty_vec3 origin, ty_vec3 direction)
{
    ray->org_x = origin.x;
    ray->org_y = origin.y;
    ray->org_z = origin.z;
    ray->dir_x = direction.x;
    ray->dir_y = direction.y;
    ray->dir_z = direction.z;
}

// The ray in the object's space; the direction keeps its length in world space, so t means the same in both.
static bool enter(const ty_trace_object* object, const struct RTCRay* ray, struct RTCRay* local)
{
    ty_affine map = ty_trace_map_at(object->steps, object->step_count, ray->time), to_local;
    if (!ty_affine_invert(&map, &to_local))
        return false;
    ty_vec3 o = ty_map_point(&to_local, ty_vec3_make(ray->org_x, ray->org_y, ray->org_z));
    ty_vec3 d = ty_map_vector(&to_local, ty_vec3_make(ray->dir_x, ray->dir_y, ray->dir_z));
    *local = *ray;
    set_ray(local, o, d);
    return true;
}

static bool is_skipped(const ty_trace_object* object, const ty_ray* ray)
{
    return !object->aggregate && ray->skip_object == object->index && ray->skip_instance == 0 &&
           ray->skip_distance >= TY_FLOAT_MAX;
}

static void intersect_moving(const struct RTCIntersectFunctionNArguments* args)
{
    const ty_trace_object* object = args->geometryUserPtr;
    const ty_world* world = object->world;
    const ty_ray* ray = ((const ty_trace_context*)args->context)->ray;
    struct RTCRayHit *ray_hit = (struct RTCRayHit*)args->rayhit, local;
    if (!args->valid[0] || is_skipped(object, ray) || !enter(object, &ray_hit->ray, &local.ray))
        return;
    local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    local.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (object->aggregate)
        ty_trace_wide_intersect(world, object->wide, ray, &local);
    else
    {
        const ty_trace_prototype* prototype = &world->prototypes[object->prototypes[0]];
        ty_trace_context inner = {.world = world, .ray = ray, .object = object->index, .instance = 0};
        ty_embree_context_init(&inner.embree);
        ty_embree_intersect(ty_trace_scene_of(prototype), &inner.embree, ty_trace_needed_filter(object, ray, 0),
                            &local);
    }
    if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return;
    ray_hit->ray.tfar = local.ray.tfar;
    ray_hit->hit = local.hit;
    // As an Embree instance of a plain object leaves it: the object as instance id; the geometry tells the instance.
    ray_hit->hit.instID[0] = args->geomID;
}

static void occlude_moving(const struct RTCOccludedFunctionNArguments* args)
{
    const ty_trace_object* object = args->geometryUserPtr;
    const ty_world* world = object->world;
    const ty_ray* ray = ((const ty_trace_context*)args->context)->ray;
    struct RTCRay *outer = (struct RTCRay*)args->ray, local;
    if (!args->valid[0] || is_skipped(object, ray) || !enter(object, outer, &local))
        return;
    if (object->aggregate)
    {
        if (ty_trace_wide_occluded(world, object->wide, ray, &local))
            outer->tfar = -INFINITY;
        return;
    }
    const ty_trace_prototype* prototype = &world->prototypes[object->prototypes[0]];
    ty_trace_context inner = {.world = world, .ray = ray, .object = object->index, .instance = 0};
    ty_embree_context_init(&inner.embree);
    ty_embree_occluded(ty_trace_scene_of(prototype), &inner.embree, ty_trace_needed_filter(object, ray, 0), &local);
    if (local.tfar < 0.0f)
        outer->tfar = local.tfar;
}

RTCGeometry ty_trace_create_moving_geometry(const ty_world* world, ty_trace_object* object)
{
    RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_USER);
    if (!geometry)
        return NULL;
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryTimeStepCount(geometry, (unsigned)object->step_count);
    rtcSetGeometryUserData(geometry, object);
    rtcSetGeometryBoundsFunction(geometry, write_bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, intersect_moving);
    rtcSetGeometryOccludedFunction(geometry, occlude_moving);
    return geometry;
}
