// SPDX-License-Identifier: Apache-2.0
// Queries against a committed world: nearest hit, occlusion, one instance, closest point, inside.
#include "trace_world.h"

// --- which hits a ray passes through ---

static void find_object(const ty_world* world, uint32_t geometry, uint32_t* object, uint32_t* instance)
{
    *object = geometry;
    *instance = 0;
    if (world->path == TY_TRACE_REFERENCE)
    {
        const ty_trace_object* found = ty_trace_object_of(world, geometry);
        *object = found->index;
        *instance = geometry - found->first;
    }
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
        find_object(context->world, context->embree.instID[0], &object, &instance);
    if (ray->skip_object == object && ray->skip_instance == instance && local->tfar < ray->skip_distance)
        args->valid[0] = 0;
    // In the prototype's space: the sign of n.d is that of the world's, for any map, since n goes by the inverse
    // transpose and stays outward under a mirror.
    float facing = hit->Ng_x * local->dir_x + hit->Ng_y * local->dir_y + hit->Ng_z * local->dir_z;
    if ((ray->flags & TY_RAY_FRONT_ONLY) && context->world->objects[object].closed_subsurface && facing > 0.0f)
        args->valid[0] = 0;
}

RTCFilterFunctionN ty_trace_needed_filter(const ty_trace_object* object, const ty_ray* ray, uint32_t instance)
{
    bool front_only = (ray->flags & TY_RAY_FRONT_ONLY) && object->closed_subsurface;
    bool skip = ray->skip_object == object->index && ray->skip_instance == instance;
    return front_only || skip ? ty_trace_filter : NULL;
}

// On the fast path the filters of aggregates are set below their callbacks; this one serves Embree's instances.
static RTCFilterFunctionN top_filter(const ty_world* world, const ty_ray* ray)
{
    bool front_only = (ray->flags & TY_RAY_FRONT_ONLY) && world->has_subsurface;
    bool skip = ray->skip_object != TY_NONE && ray->skip_instance != TY_NONE;
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

bool ty_world_intersect(const ty_world* world, const ty_ray* ray, ty_hit* hit)
{
    struct RTCRayHit ray_hit = {.ray = make_ray(ray->origin, ray->t_min, ray->direction, ray->t_max)};
    ray_hit.ray.mask = ray->mask;
    ray_hit.ray.time = ray->time;
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    ty_trace_context context = make_context(world, ray);
    ty_embree_intersect(world->scene, &context.embree, top_filter(world, ray), &ray_hit);
    if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    find_object(world, ray_hit.hit.instID[0], &hit->object, &hit->instance);
    // User geometry leaves the instance as the geometry; a prototype's only geometry is 0.
    if (world->path == TY_TRACE_FAST)
        hit->instance = ray_hit.hit.geomID;
    hit->triangle = ray_hit.hit.primID;
    hit->t = ray_hit.ray.tfar;
    hit->u = ray_hit.hit.u;
    hit->v = ray_hit.hit.v;
    hit->time = ray->time;
    return true;
}

bool ty_world_occluded(const ty_world* world, const ty_ray* ray)
{
    struct RTCRay r = make_ray(ray->origin, ray->t_min, ray->direction, ray->t_max);
    r.mask = ray->mask;
    r.time = ray->time;
    ty_trace_context context = make_context(world, ray);
    ty_embree_occluded(world->scene, &context.embree, top_filter(world, ray), &r);
    return r.tfar < 0.0f;
}

static bool intersect_mesh(const ty_world* world, uint32_t prototype, ty_vec3 origin, float t_min, ty_vec3 direction,
                           float t_max, struct RTCRayHit* ray_hit)
{
    *ray_hit = (struct RTCRayHit){.ray = make_ray(origin, t_min, direction, t_max)};
    ray_hit->hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ty_trace_context context = make_context(world, NULL);
    ty_embree_intersect(world->prototypes[prototype].scene, &context.embree, NULL, ray_hit);
    return ray_hit->hit.geomID != RTC_INVALID_GEOMETRY_ID;
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

bool ty_world_intersect_instance(const ty_world* world, uint32_t object, uint32_t instance, float time, ty_vec3 origin,
                                 ty_vec3 direction, float t_max, ty_hit* hit)
{
    ty_affine to_local = ty_world_to_local(world, object, instance, time);
    struct RTCRayHit ray_hit;
    if (!intersect_mesh(world, ty_world_prototype(world, object, instance), ty_map_point(&to_local, origin), 0.0f,
                        ty_map_vector(&to_local, direction), t_max, &ray_hit))
        return false;
    fill_hit(&ray_hit, object, instance, time, hit);
    return true;
}

bool ty_world_intersect_prototype(const ty_world* world, uint32_t prototype, ty_vec3 origin, ty_vec3 direction,
                                  float t_max, ty_hit* hit)
{
    struct RTCRayHit ray_hit;
    if (!intersect_mesh(world, prototype, origin, 0.0f, direction, t_max, &ray_hit))
        return false;
    fill_hit(&ray_hit, TY_NONE, TY_NONE, 0.0f, hit);
    return true;
}

// --- closest point ---

typedef struct closest_query
{
    const ty_mesh* mesh;
    ty_vec3 p;
    ty_closest best;
} closest_query;

// Closest point of a triangle as barycentric weights u, v of b and c (Ericson 2004, Real-Time Collision
// Detection, 5.1.5).
static ty_vec2 closest_on_triangle(ty_vec3 p, ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    ty_vec3 ab = ty_sub(b, a), ac = ty_sub(c, a), ap = ty_sub(p, a), bp = ty_sub(p, b), cp = ty_sub(p, c);
    float d1 = ty_dot(ab, ap), d2 = ty_dot(ac, ap), d3 = ty_dot(ab, bp), d4 = ty_dot(ac, bp);
    float d5 = ty_dot(ab, cp), d6 = ty_dot(ac, cp);
    if (d1 <= 0.0f && d2 <= 0.0f)
        return (ty_vec2){0.0f, 0.0f};
    if (d3 >= 0.0f && d4 <= d3)
        return (ty_vec2){1.0f, 0.0f};
    if (d6 >= 0.0f && d5 <= d6)
        return (ty_vec2){0.0f, 1.0f};
    float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f)
        return (ty_vec2){d1 / (d1 - d3), 0.0f};
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f)
        return (ty_vec2){0.0f, d2 / (d2 - d6)};
    if (va <= 0.0f && d4 >= d3 && d5 >= d6)
    {
        float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (ty_vec2){1.0f - w, w};
    }
    float inverse = 1.0f / (va + vb + vc);
    return (ty_vec2){vb * inverse, vc * inverse};
}

static bool try_triangle(struct RTCPointQueryFunctionArguments* args)
{
    closest_query* query = args->userPtr;
    const ty_mesh* mesh = query->mesh;
    const uint32_t* v = mesh->triangles[args->primID];
    ty_vec3 a = mesh->positions[v[0]], b = mesh->positions[v[1]], c = mesh->positions[v[2]];
    ty_vec2 w = closest_on_triangle(query->p, a, b, c);
    ty_vec3 at = ty_mad(ty_mad(a, ty_sub(b, a), w.x), ty_sub(c, a), w.y);
    float distance = ty_length(ty_sub(at, query->p));
    if (!(distance < query->best.distance))
        return false;
    query->best = (ty_closest){at, distance, args->primID, w.x, w.y};
    args->query->radius = distance;
    return true;
}

bool ty_world_closest(const ty_world* world, uint32_t prototype, ty_vec3 p, float max_distance, ty_closest* out)
{
    closest_query query = {.mesh = world->prototypes[prototype].mesh, .p = p};
    query.best.distance = max_distance;
    query.best.triangle = TY_NONE;
    struct RTCPointQuery point = {p.x, p.y, p.z, 0.0f, max_distance};
    struct RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(world->prototypes[prototype].scene, &point, &context, try_triangle, &query);
    if (query.best.triangle == TY_NONE)
        return false;
    *out = query.best;
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
