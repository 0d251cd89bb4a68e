// SPDX-License-Identifier: Apache-2.0
// Queries against a committed world: nearest hit, occlusion, one instance, closest point, inside.
#include "trace_wide.h"

// --- which hits a ray passes through ---

// By Embree's numbers of a hit: of the instance and of what is below it, or of a mesh that is no instance.
static void find_object(const ty_world* world, uint32_t outer, uint32_t inner, uint32_t* object, uint32_t* instance)
{
    if (world->path == TY_TRACE_REFERENCE)
    {
        const ty_trace_object* found = ty_trace_object_of(world, outer);
        *object = found->index;
        *instance = outer - found->first;
        return;
    }
    bool is_mesh = outer == RTC_INVALID_GEOMETRY_ID;
    *object = is_mesh ? inner : outer;
    // Our own levels leave the instance as the geometry; a prototype's only geometry is 0.
    *instance = is_mesh ? 0 : inner;
}

// A triangle's own slot counts: an aggregate may hold translucent bodies beside clear ones, whose backs must be met.
static bool is_one_sided(const ty_world* world, uint32_t object, uint32_t instance, uint32_t triangle)
{
    const uint16_t* slots = ty_world_mesh(world, object, instance)->slots;
    return (world->objects[object].one_sided & ty_slot_bit(slots ? slots[triangle] : 0)) != 0;
}

void ty_trace_filter(const struct RTCFilterFunctionNArguments* args)
{
    if (!args->valid[0])
        return;
    const ty_trace_context* context = (const ty_trace_context*)args->context;
    const struct RTCRay* local = (const struct RTCRay*)args->ray;
    const struct RTCHit* hit = (const struct RTCHit*)args->hit;
    const ty_ray* ray = context->ray;
    uint32_t object = context->object, instance = context->instance;
    if (object == TY_NONE)
        find_object(context->world, context->embree.instID[0], hit->geomID, &object, &instance);
    if (ray->skip_object == object && ray->skip_instance == instance && local->tfar < ray->skip_distance)
        args->valid[0] = 0;
    // In the prototype's space: the sign of n.d is that of the world's, for any map, since n goes by the inverse
    // transpose and stays outward under a mirror.
    float facing = hit->Ng_x * local->dir_x + hit->Ng_y * local->dir_y + hit->Ng_z * local->dir_z;
    if ((ray->flags & TY_RAY_FRONT_ONLY) && facing > 0.0f &&
        is_one_sided(context->world, object, instance, hit->primID))
        args->valid[0] = 0;
}

RTCFilterFunctionN ty_trace_needed_filter(const ty_trace_object* object, const ty_ray* ray, uint32_t instance)
{
    bool front_only = (ray->flags & TY_RAY_FRONT_ONLY) && object->one_sided;
    bool skip = ray->skip_object == object->index && ray->skip_instance == instance;
    return front_only || skip ? ty_trace_filter : NULL;
}

// On the fast path the filters of aggregates are set below; this one serves Embree's instances, which are plain
// objects.
static RTCFilterFunctionN top_filter(const ty_world* world, const ty_ray* ray)
{
    bool front_only = (ray->flags & TY_RAY_FRONT_ONLY) && world->filters_rest;
    bool skip = ray->skip_object != TY_NONE && ray->skip_instance != TY_NONE;
    if (skip && world->path == TY_TRACE_FAST)
        skip = !world->objects[ray->skip_object].aggregate;
    return front_only || skip ? ty_trace_filter : NULL;
}

// --- rays ---

static struct RTCRay make_ray(ty_vec3 origin, float t_min, ty_vec3 direction, float t_max)
{
    return (struct RTCRay){.org_x = origin.x,
                           .org_y = origin.y,
                           .org_z = origin.z,
                           .tnear = ty_max(t_min, 0.0f),
                           .dir_x = direction.x,
                           .dir_y = direction.y,
                           .dir_z = direction.z,
                           .tfar = t_max,
                           .mask = 0xffffffffu};
}

static ty_trace_context make_context(const ty_world* world, const ty_ray* ray)
{
    ty_trace_context context = {.world = world, .ray = ray, .object = TY_NONE, .instance = TY_NONE};
    ty_embree_context_init(&context.embree);
    return context;
}

static ty_wide_query wide_query(const ty_world* world, const ty_trace_wide* wide, const ty_ray* ray)
{
    bool skips = ray->skip_object != TY_NONE && ray->skip_instance != TY_NONE;
    bool whole = ray->skip_distance >= TY_FLOAT_MAX;
    uint32_t skipped = skips ? world->objects[ray->skip_object].first + ray->skip_instance : TY_NONE;
    return (ty_wide_query){.origin = ray->origin,
                           .direction = ray->direction,
                           .t_min = ty_max(ray->t_min, 0.0f),
                           .t_max = ray->t_max,
                           .ray = ray,
                           .pass = whole ? skipped : TY_NONE,
                           .skip = whole ? TY_NONE : skipped,
                           .meets_all = (whole || !skips) && (ray->mask & wide->common_mask) != 0 &&
                                        !(wide->has_subsurface && (ray->flags & TY_RAY_FRONT_ONLY))};
}

// The same for a ray of another space.
static ty_wide_query moved_query(const ty_world* world, const ty_trace_wide* wide, const ty_ray* ray,
                                 const struct RTCRay* r)
{
    ty_wide_query q = wide_query(world, wide, ray);
    q.origin = ty_vec3_make(r->org_x, r->org_y, r->org_z);
    q.direction = ty_vec3_make(r->dir_x, r->dir_y, r->dir_z);
    q.t_min = r->tnear;
    q.t_max = r->tfar;
    return q;
}

static bool intersect_wide(const ty_world* world, const ty_trace_wide* wide, ty_wide_query* q)
{
    return world->use_avx512 ? ty_wide_intersect_avx512(world, wide, q) : ty_wide_intersect_base(world, wide, q);
}

static bool occluded_wide(const ty_world* world, const ty_trace_wide* wide, const ty_wide_query* q)
{
    return world->use_avx512 ? ty_wide_occluded_avx512(world, wide, q) : ty_wide_occluded_base(world, wide, q);
}

void ty_trace_wide_intersect(const ty_world* world, const ty_trace_wide* wide, const ty_ray* ray,
                             struct RTCRayHit* ray_hit)
{
    ty_wide_query q = moved_query(world, wide, ray, &ray_hit->ray);
    if (!intersect_wide(world, wide, &q))
        return;
    const ty_trace_object* object = ty_trace_object_of(world, q.instance);
    ray_hit->ray.tfar = q.t_max;
    ray_hit->hit.u = q.u;
    ray_hit->hit.v = q.v;
    ray_hit->hit.primID = q.triangle;
    ray_hit->hit.geomID = q.instance - object->first;
    ray_hit->hit.instID[0] = object->index;
}

bool ty_trace_wide_occluded(const ty_world* world, const ty_trace_wide* wide, const ty_ray* ray,
                            const struct RTCRay* embree_ray)
{
    ty_wide_query q = moved_query(world, wide, ray, embree_ray);
    return occluded_wide(world, wide, &q);
}

static void fill_hit(const struct RTCRayHit* ray_hit, uint32_t object, uint32_t instance, float time, ty_hit* hit)
{
    *hit = (ty_hit){.t = ray_hit->ray.tfar,
                    .u = ray_hit->hit.u,
                    .v = ray_hit->hit.v,
                    .object = object,
                    .instance = instance,
                    .triangle = ray_hit->hit.primID,
                    .time = time};
}

// What Embree holds of the world, before t_max.
static bool intersect_rest(const ty_world* world, const ty_ray* ray, float t_max, ty_hit* hit)
{
    struct RTCRayHit ray_hit;
    ray_hit.ray = make_ray(ray->origin, ray->t_min, ray->direction, t_max);
    ray_hit.ray.mask = ray->mask;
    ray_hit.ray.time = ray->time;
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    ty_trace_context context = make_context(world, ray);
    ty_embree_intersect(world->scene, &context.embree, top_filter(world, ray), &ray_hit);
    if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    uint32_t object, instance;
    find_object(world, ray_hit.hit.instID[0], ray_hit.hit.geomID, &object, &instance);
    fill_hit(&ray_hit, object, instance, ray->time, hit);
    return true;
}

bool ty_world_intersect(const ty_world* world, const ty_ray* ray, ty_hit* hit)
{
    if (!world->wide)
        return world->has_rest && intersect_rest(world, ray, ray->t_max, hit);
    ty_wide_query q = wide_query(world, world->wide, ray);
    bool found = intersect_wide(world, world->wide, &q);
    if (world->has_rest && intersect_rest(world, ray, q.t_max, hit))
        return true;
    if (!found)
        return false;
    const ty_trace_object* object = ty_trace_object_of(world, q.instance);
    *hit = (ty_hit){.t = q.t_max,
                    .u = q.u,
                    .v = q.v,
                    .object = object->index,
                    .instance = q.instance - object->first,
                    .triangle = q.triangle,
                    .time = ray->time};
    return true;
}

bool ty_world_occluded(const ty_world* world, const ty_ray* ray)
{
    if (world->wide)
    {
        ty_wide_query q = wide_query(world, world->wide, ray);
        if (occluded_wide(world, world->wide, &q))
            return true;
    }
    if (!world->has_rest)
        return false;
    struct RTCRay r = make_ray(ray->origin, ray->t_min, ray->direction, ray->t_max);
    r.mask = ray->mask;
    r.time = ray->time;
    ty_trace_context context = make_context(world, ray);
    ty_embree_occluded(world->scene, &context.embree, top_filter(world, ray), &r);
    return r.tfar < 0.0f;
}

static bool intersect_scene(const ty_world* world, RTCScene scene, float time, ty_vec3 origin, float t_min,
                            ty_vec3 direction, float t_max, struct RTCRayHit* ray_hit)
{
    ray_hit->ray = make_ray(origin, t_min, direction, t_max);
    ray_hit->ray.time = time;
    ray_hit->hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ty_trace_context context = make_context(world, NULL);
    ty_embree_intersect(scene, &context.embree, NULL, ray_hit);
    return ray_hit->hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

static bool intersect_mesh(const ty_world* world, uint32_t prototype, ty_vec3 origin, float t_min, ty_vec3 direction,
                           float t_max, struct RTCRayHit* ray_hit)
{
    return intersect_scene(world, world->prototypes[prototype].scene, 0.0f, origin, t_min, direction, t_max, ray_hit);
}

bool ty_world_intersect_instance(const ty_world* world, uint32_t object, uint32_t instance, float time, ty_vec3 origin,
                                 ty_vec3 direction, float t_max, ty_hit* hit)
{
    const ty_trace_object* o = &world->objects[object];
    uint32_t prototype = ty_trace_prototype_of(o, instance);
    ty_affine map;
    bool drifts = o->drifts && o->drifts[instance];
    if (o->step_count > 1 && !drifts)
    {
        ty_affine outer = ty_trace_map_at(o->steps, o->step_count, time);
        if (!ty_affine_invert(&outer, &map))
            return false;
        origin = ty_map_point(&map, origin);
        direction = ty_map_vector(&map, direction);
    }
    // Where the wide level holds the instance, by way of the sphere as there: the same bits.
    if (world->path == TY_TRACE_FAST && o->aggregate && !drifts)
    {
        const ty_affine* back = &world->prototypes[prototype].from_sphere;
        if (!ty_trace_sphere_map(world, o, instance, &map))
            return false;
        ty_wide_to_sphere(&map, &origin, &direction);
        origin = ty_map_point(back, origin);
        direction = ty_map_vector(back, direction);
    }
    else if (o->step_count == 1 || drifts)
    {
        map = ty_world_to_local(world, object, instance, time);
        origin = ty_map_point(&map, origin);
        direction = ty_map_vector(&map, direction);
    }
    struct RTCRayHit ray_hit;
    const ty_trace_prototype* entered = &world->prototypes[prototype];
    if (!intersect_scene(world, o->aggregate ? entered->scene : ty_trace_scene_of(entered), time, origin, 0.0f,
                         direction, t_max, &ray_hit))
        return false;
    fill_hit(&ray_hit, object, instance, time, hit);
    return true;
}

bool ty_world_intersect_prototype(const ty_world* world, uint32_t prototype, ty_vec3 origin, ty_vec3 direction,
                                  float t_max, ty_hit* hit, bool* behind)
{
    struct RTCRayHit ray_hit;
    if (!intersect_mesh(world, prototype, origin, 0.0f, direction, t_max, &ray_hit))
        return false;
    if (behind)
        *behind = ty_dot(ty_vec3_make(ray_hit.hit.Ng_x, ray_hit.hit.Ng_y, ray_hit.hit.Ng_z), direction) >= 0.0f;
    fill_hit(&ray_hit, TY_NONE, TY_NONE, 0.0f, hit);
    return true;
}

// --- inside ---

// Parity of the crossings along one direction, each found as the nearest hit beyond the last.
static bool odd_crossings(const ty_world* world, uint32_t prototype, ty_vec3 p, ty_vec3 direction)
{
    uint32_t limit = world->prototypes[prototype].mesh->triangle_count;
    bool odd = false;
    float t = 0.0f;
    struct RTCRayHit ray_hit;
    for (uint32_t i = 0; i < limit && intersect_mesh(world, prototype, p, t, direction, TY_FLOAT_MAX, &ray_hit); i++)
    {
        odd = !odd;
        t = nextafterf(ray_hit.ray.tfar, TY_FLOAT_MAX);
    }
    return odd;
}

bool ty_world_inside(const ty_world* world, uint32_t prototype, ty_vec3 p)
{
    // Directions that no modelled edge or axis follows.
    static const ty_vec3 directions[3] = {
        {0.5377f, 0.8339f, -0.1249f}, {-0.7273f, 0.2519f, 0.6384f}, {0.3041f, -0.6113f, 0.7307f}};
    ty_bounds box = world->prototypes[prototype].bounds;
    if (p.x < box.low.x || p.y < box.low.y || p.z < box.low.z || p.x > box.high.x || p.y > box.high.y ||
        p.z > box.high.z)
        return false;
    int votes = 0;
    for (int i = 0; i < 3; i++)
        votes += odd_crossings(world, prototype, p, directions[i]);
    return votes >= 2;
}
