// SPDX-License-Identifier: Apache-2.0
// Clear bodies along a path: where the camera begins, what they absorb, what shadow rays see of transparent things.
#include "path.h"
#include <tsuya/shading/walk.h>

bool ty_path_meet_own(const ty_world* world, const ty_medium* body, const ty_ray* ray, ty_hit* hit)
{
    if (!ty_world_intersect_instance(world, body->object, body->instance, ray->time, ray->origin, ray->direction,
                                     TY_FLOAT_MAX, hit))
        return false;
    hit->object = body->object;
    hit->instance = body->instance;
    hit->time = ray->time;
    return true;
}

// No light is sampled where the path is scattered: boundaries that bend light stand between. What it meets counts full.
static void turn(ty_path* p, ty_vec3 origin, ty_vec3 direction)
{
    p->ray = ty_ray_make(origin, direction, TY_FLOAT_MAX);
    p->ray.flags = TY_RAY_FRONT_ONLY;
    p->ray.mask = TY_MASK_TRANSMISSION;
    p->view.full = true;
    p->view.done = false;
    p->view.seen = TY_MASK_TRANSMISSION;
    p->indirect = p->soft;
    p->soft = true;
}

// Cosine between the ray and the way into the medium, kept off zero.
static float steepness(const ty_path* p)
{
    const float grazing = 1e-3f;
    float cosine = ty_dot(p->ray.direction, p->inward);
    return fabsf(cosine) > grazing ? cosine : cosine < 0.0f ? -grazing : grazing;
}

// How far the end of a flight lies above the plane that rays begin in; 0 = beneath. Up there the ray begins in the
// plane all the same, and lead is what that changes of its way: were it moved down, mean free paths as short as
// rounding would begin too deep and lose too much light.
static float height(const ty_path* p, float flight)
{
    return p->lead == 0.0f ? 0.0f : ty_max((p->lead - flight) * steepness(p), 0.0f);
}

ty_path_flight ty_path_scatter(const ty_scattering* matter, float distance, ty_path* p, ty_counters* counters)
{
    // The bound on scatterings: straight out from here, so that what is white stays white.
    if (p->scatterings >= TY_PATH_MAX_SCATTERINGS)
    {
        counters->walks_cut += p->scatterings++ == TY_PATH_MAX_SCATTERINGS;
        return TY_PATH_PASSED;
    }
    float u = ty_rng_float(&p->rng), flight = ty_flight_sample(matter, &p->beta, u, ty_rng_float(&p->rng));
    if (!(flight < distance + p->lead))
        return TY_PATH_PASSED;
    counters->interior_rays++;
    if (p->entered == 0.0f)
        p->entered = ty_rgb_max(p->beta);
    ty_flight_scatter(matter, flight, &p->beta);
    if (!ty_flight_survives(p->entered, &p->beta, &p->rng))
        return TY_PATH_ENDED;
    p->scatterings++;
    float time = p->ray.time, above = height(p, flight);
    ty_vec3 origin = above > 0.0f ? p->ray.origin : ty_mad(p->ray.origin, p->ray.direction, flight - p->lead);
    u = ty_rng_float(&p->rng);
    turn(p, origin, ty_phase_sample(matter->anisotropy, p->ray.direction, (ty_vec2){u, ty_rng_float(&p->rng)}));
    p->lead = above > 0.0f ? above / steepness(p) : 0.0f;
    p->ray.time = time;
    return TY_PATH_SCATTERED;
}

static bool encloses(const ty_world* world, uint32_t object, uint32_t instance, ty_vec3 p)
{
    uint32_t prototype = ty_world_prototype(world, object, instance);
    ty_affine to_local = ty_world_to_local(world, object, instance, 0.0f);
    return ty_world_topology(world, prototype)->closed && ty_world_inside(world, prototype, ty_map_point(&to_local, p));
}

// The surface of the body that a ray from within meets, for the values of its medium.
static bool find_wall(const ty_scene* scene, uint32_t object, uint32_t instance, ty_vec3 p, ty_surface_point* wall,
                      ty_hit* hit)
{
    static const ty_vec3 direction = {0.5377f, 0.8339f, -0.1249f};
    if (!ty_world_intersect_instance(scene->world, object, instance, 0.0f, p, direction, TY_FLOAT_MAX, hit))
        return false;
    ty_world_surface(scene->world, hit, wall);
    return true;
}

static bool may_bound(const ty_scene* scene, uint32_t object)
{
    const ty_scene_object* o = &scene->objects[object];
    for (uint32_t k = 0; k < ty_scene_material_count(o); ++k)
        if (ty_material_traits(scene->materials[ty_scene_material_at(o, k)]) & TY_TRAIT_MEDIUM)
            return true;
    return false;
}

// The body whose wall is nearer is taken to lie within the other: of equal priority it is there.
void ty_path_find_media(const ty_scene* scene, ty_vec3 p, ty_media* out)
{
    ty_medium found[TY_MEDIA_MAX];
    float distance[TY_MEDIA_MAX];
    int count = 0;
    for (uint32_t object = 0; object < (uint32_t)scene->object_count; ++object)
        for (uint32_t i = 0; i < scene->objects[object].instance_count && may_bound(scene, object); ++i)
        {
            ty_surface_point wall;
            ty_hit hit;
            if (count == TY_MEDIA_MAX || !encloses(scene->world, object, i, p) ||
                !find_wall(scene, object, i, p, &wall, &hit))
                continue;
            const ty_material* material = ty_scene_material(scene, object, i, hit.triangle);
            if (!(ty_material_traits(material) & TY_TRAIT_MEDIUM))
                continue;
            int k = count++;
            for (; k > 0 && distance[k - 1] < hit.t; --k)
            {
                found[k] = found[k - 1];
                distance[k] = distance[k - 1];
            }
            found[k] = ty_medium_make(material, &scene->shading, &wall);
            distance[k] = hit.t;
        }
    out->count = 0;
    for (int k = 0; k < count; ++k)
        ty_media_cross(out, &found[k], true);
}

// On through a surface as if it were not there.
void ty_path_pass(const ty_surface_point* point, float t, ty_ray* ray)
{
    ray->origin = ty_offset_origin(point, ty_dot(ray->direction, point->ng) >= 0.0f ? point->ng : ty_neg(point->ng));
    ray->t_min = 0.0f;
    if (ray->t_max < TY_FLOAT_MAX)
        ray->t_max -= t;
    if (ray->skip_distance < TY_FLOAT_MAX)
        ray->skip_distance -= t;
}

// Off the surface by as much as a ray that begins beside it, but without shifting the line: over a steep chord that
// would change the way through a body by several times as much.
void ty_path_keep_way(const ty_surface_point* point, ty_path* p)
{
    const float grazing = 0.1f; // lower rays begin beside the surface
    float cosine = fabsf(ty_dot(p->ray.direction, point->ng));
    p->inward = ty_dot(p->ray.direction, point->ng) < 0.0f ? ty_neg(point->ng) : point->ng;
    p->lead = p->media.count > 0 ? ty_offset_distance(point) / ty_max(cosine, grazing) : 0.0f;
    if (p->media.count > 0 && cosine > grazing)
        p->ray.origin = ty_mad(point->position, p->ray.direction, p->lead);
}

static bool leaves(const ty_material* material, const ty_surface_point* point, ty_vec3 direction)
{
    return (ty_material_traits(material) & TY_TRAIT_MEDIUM) && ty_dot(direction, point->ng) >= 0.0f;
}

void ty_path_leave(const ty_scene* scene, const ty_material* material, const ty_surface_point* point, ty_vec3 direction,
                   ty_media* media)
{
    if (!leaves(material, point, direction))
        return;
    ty_medium body = ty_medium_make(material, &scene->shading, point);
    ty_media_cross(media, &body, false);
}

// The way through what lets pass on its own. *inside: how far it goes through the medium in which it begins.
static ty_rgb through_surfaces(const ty_integrator* in, ty_ray* ray, float* inside, ty_counters* counters)
{
    const ty_scene* scene = in->scene;
    ty_rgb through = ty_rgb_grey(1.0f);
    float way = 0.0f;
    ray->mask = TY_MASK_SHADOW_TRANSPARENT;
    for (int i = 0; i < TY_PATH_MAX_PASSED; ++i)
    {
        ty_hit hit;
        ty_surface_point point;
        counters->shadow_rays++;
        if (!ty_world_intersect(scene->world, ray, &hit))
            return through;
        ty_world_surface(scene->world, &hit, &point);
        const ty_material* material = ty_scene_material(scene, hit.object, hit.instance, hit.triangle);
        ty_transparency t = ty_material_transparency(material, &scene->shading, &point, ty_neg(ray->direction));
        through = ty_rgb_mul(through, t.through);
        if (ty_rgb_is_black(through))
            return through;
        way += hit.t;
        if (leaves(material, &point, ray->direction))
            *inside = ty_min(*inside, way);
        ty_path_pass(&point, hit.t, ray);
    }
    return ty_rgb_grey(0.0f);
}

ty_rgb ty_path_transmittance(const ty_integrator* in, ty_ray* ray, ty_rgb absorption, float distance,
                             ty_counters* counters)
{
    ray->mask = TY_MASK_SHADOW;
    counters->shadow_rays++;
    if (ty_world_occluded(in->scene->world, ray))
        return ty_rgb_grey(0.0f);
    ty_rgb through = in->has_transparent ? through_surfaces(in, ray, &distance, counters) : ty_rgb_grey(1.0f);
    return ty_rgb_mul(through, ty_flight_transmittance(absorption, distance));
}
