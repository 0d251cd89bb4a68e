// SPDX-License-Identifier: Apache-2.0
// Random walks within one closed instance, traced in its prototype's space; distances are those of the world under any
// map, because directions are carried over with their length.
#include "guide.h"
#include "prototype_point.h"

typedef struct body
{
    const ty_world* world;
    const ty_mesh* mesh;
    uint32_t prototype;
    ty_affine to_local;
    int layers; // closed shells of the mesh that the walk is in
} body;

static body body_make(const ty_world* world, uint32_t object, uint32_t instance, float time)
{
    uint32_t prototype = ty_world_prototype(world, object, instance);
    return (body){world, ty_world_prototype_mesh(world, prototype), prototype,
                  ty_world_to_local(world, object, instance, time), 1};
}

static float rounding(ty_vec3 p)
{
    return (fabsf(p.x) + fabsf(p.y) + fabsf(p.z)) * 0x1p-20f;
}

// Just beneath a point of the surface, in the prototype's space.
static ty_vec3 beneath(const ty_mesh* mesh, const ty_surface_point* x)
{
    ty_vec3 p = ty_prototype_point(mesh, x);
    return ty_mad(p, ty_normalize(ty_prototype_normal(mesh, x->triangle)), -rounding(p));
}

typedef enum crossing
{
    CROSSING_NONE, // within the flight
    CROSSING_OUT,
    CROSSING_LOST,
} crossing;

// The end of the body along a flight. Shells that overlap within a mesh are one body: those entered have to be left.
static crossing find_end(body* b, ty_vec3 p, ty_vec3 direction, float length, ty_hit* hit)
{
    float way = 0.0f;
    for (;;)
    {
        if (!ty_world_intersect_prototype(b->world, b->prototype, p, direction, length - way, hit, NULL))
            return length < TY_FLOAT_MAX ? CROSSING_NONE : CROSSING_LOST;
        bool out = ty_dot(ty_prototype_normal(b->mesh, hit->triangle), direction) >= 0.0f;
        b->layers += out ? -1 : 1;
        way += hit->t;
        if (b->layers == 0)
        {
            hit->t = way;
            return CROSSING_OUT;
        }
        ty_vec3 beyond = ty_mad(p, direction, hit->t);
        // On by what rounding may have taken; a step of no length would meet the same triangle for ever.
        float step = ty_max(rounding(beyond) / ty_length(direction), way * 0x1p-22f);
        p = ty_mad(beyond, direction, step);
        way += step;
    }
}

static bool is_within(const ty_bounds* box, ty_vec3 p)
{
    return p.x >= box->low.x && p.y >= box->low.y && p.z >= box->low.z && p.x <= box->high.x && p.y <= box->high.y &&
           p.z <= box->high.z;
}

// p in the prototype's space, direction in the world. Sets of the exit what a hit says.
static ty_walk_end walk_on(body* b, ty_vec3 p, float u, const ty_scattering* matter, const ty_guide* guide, ty_rng* rng,
                           ty_walk* walk, ty_hit* hit)
{
    ty_guided way = ty_guide_first(guide, walk->direction, rng);
    for (uint32_t i = 0; i < TY_WALK_MAX_FLIGHTS; ++i)
    {
        float u_channel = ty_rng_float(rng);
        float length = ty_flight_sample(matter, &walk->beta, u_channel, i == 0 ? u : ty_rng_float(rng));
        if (way.guided)
            length /= way.stretch;
        ty_vec3 direction = ty_map_vector(&b->to_local, way.direction);
        walk->direction = way.direction;
        switch (find_end(b, p, direction, length, hit))
        {
        case CROSSING_OUT:
            ty_guide_weigh(guide, matter, &way, hit->t, false, &walk->beta);
            return TY_WALK_LEFT;
        case CROSSING_LOST:
            return TY_WALK_LOST;
        case CROSSING_NONE:
            break;
        }
        ty_guide_weigh(guide, matter, &way, length, true, &walk->beta);
        walk->scatterings++;
        if (!ty_flight_survives(1.0f, &walk->beta, rng))
            return TY_WALK_ABSORBED;
        p = ty_mad(p, direction, length);
        if (!is_within(&b->mesh->bounds, p))
            return TY_WALK_LOST;
        way = ty_guide_next(guide, matter, walk->direction, rng);
    }
    // Straight out from here, so that what is white stays white.
    bool out = find_end(b, p, ty_map_vector(&b->to_local, walk->direction), TY_FLOAT_MAX, hit) == CROSSING_OUT;
    return out ? TY_WALK_CUT : TY_WALK_LOST;
}

static ty_walk_end run(body* b, uint32_t object, uint32_t instance, float time, ty_vec3 p, float u,
                       const ty_scattering* matter, const ty_guide* guide, ty_vec3 direction, ty_rng* rng,
                       ty_walk* walk)
{
    ty_hit hit;
    walk->beta = ty_rgb_grey(1.0f);
    walk->direction = direction;
    walk->scatterings = 0;
    ty_walk_end end = walk_on(b, p, u, matter, guide, rng, walk, &hit);
    if (end != TY_WALK_LEFT && end != TY_WALK_CUT)
        return end;
    hit.object = object;
    hit.instance = instance;
    hit.time = time;
    ty_world_surface(b->world, &hit, &walk->exit);
    return end;
}

ty_walk_end ty_walk_through(const ty_world* world, const ty_surface_point* x, const ty_scattering* matter,
                            ty_vec3 direction, float u, ty_rng* rng, ty_walk* walk)
{
    body b = body_make(world, x->object, x->instance, x->time);
    ty_guide guide = ty_guide_make(matter, x->ng);
    return run(&b, x->object, x->instance, x->time, beneath(b.mesh, x), u, matter, &guide, direction, rng, walk);
}

ty_walk_end ty_walk_from(const ty_world* world, uint32_t object, uint32_t instance, float time, ty_vec3 origin,
                         const ty_scattering* matter, ty_vec3 direction, ty_rng* rng, ty_walk* walk)
{
    static const ty_guide unguided = {0};
    body b = body_make(world, object, instance, time);
    return run(&b, object, instance, time, ty_map_point(&b.to_local, origin), ty_rng_float(rng), matter, &unguided,
               direction, rng, walk);
}
