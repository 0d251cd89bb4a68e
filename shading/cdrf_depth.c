// SPDX-License-Identifier: Apache-2.0
// `evaluate: depth`: a random line through a point at diffusion depth beneath x, in the prototype's space. On a sphere
// the exits follow the Poisson kernel exactly. Where a body is thin a true walk takes its place.
#include "curvature_at.h"
#include "depth_field.h"
#include "lobes.h"
#include "material_private.h"
#include "prototype_point.h"
#include "spheroid_exit.h"
#include <tsuya/shading/cdrf.h>
#include <tsuya/shading/sampling.h>
#include <tsuya/shading/walk.h>

#define MAX_STEPS 64

// Mean free path over thickness from which on some of the light walks, and from which on all of it does: where it
// scatters a few times alone it has no diffusion depth, and a walk costs little more than a line.
#define WALK_FROM 0.15f
#define WALK_ALONE 0.5f

// The osculating spheroid at x and the space it is in: that of the prototype where the instance is similar to it, else
// the world's. Lengths are in units of that space.
typedef struct interior
{
    const ty_world* world;
    const ty_mesh* mesh;
    uint32_t prototype;
    ty_vec3 x;       // prototype's space
    ty_frame frame;  // of the space about the outward normal, as vectors of the prototype's
    float thickness; // D
    float curvature; // H
    ty_form form;    // instead of H towards each side, for `directional`
    bool directional;
    float unit;     // of the space, m
    float depth[3]; // by channel
} interior;

typedef enum crossing
{
    CROSSING_NONE,
    CROSSING_EXIT,
    CROSSING_ENTRY, // a front face: the ray began outside
} crossing;

static float interpolate(const ty_mesh* mesh, const ty_surface_point* x, const float* field)
{
    const uint32_t* v = mesh->triangles[x->triangle];
    return field[v[0]] * (1.0f - x->u - x->v) + field[v[1]] * x->u + field[v[2]] * x->v;
}

// --- the space ---

// The spheroid under a map that keeps no angles is an ellipsoid: its chord along the new normal, and its curvature
// there. n is unit, of the prototype; closer = |M^-T n|^-1.
static void deform(interior* in, ty_vec3 n, ty_form form, float closer)
{
    float a = 0.5f * in->thickness, straight = ty_dot(in->frame.n, n), vt, vb;
    ty_frame f = ty_frame_from_normal(n);
    vt = ty_dot(in->frame.n, f.t);
    vb = ty_dot(in->frame.n, f.b);
    float bent = ty_max(form.tt * vt * vt + 2.0f * form.tb * vt * vb + form.bb * vb * vb, 0.0f);
    in->thickness = 2.0f * straight / (straight * straight / a + bent);
    // The form at tangents of the world, which as vectors of the prototype's space lie in its tangent plane.
    float tt = ty_dot(in->frame.t, f.t), tb = ty_dot(in->frame.t, f.b), bt = ty_dot(in->frame.b, f.t),
          bb = ty_dot(in->frame.b, f.b);
    in->form = (ty_form){closer * (form.tt * tt * tt + 2.0f * form.tb * tt * tb + form.bb * tb * tb),
                         closer * (form.tt * tt * bt + form.tb * (tt * bb + tb * bt) + form.bb * tb * bb),
                         closer * (form.tt * bt * bt + 2.0f * form.tb * bt * bb + form.bb * bb * bb)};
    in->curvature = ty_max(ty_form_mean(in->form), 0.0f);
}

// The form as it is, with the mean curvature of the field, which is smoothed and not negative.
static ty_form smoothed_form(const interior* in, const ty_surface_point* x, ty_vec3 n)
{
    ty_frame f = ty_frame_from_normal(n);
    ty_form form = ty_form_local(in->mesh, x, f.t, f.b);
    float change = in->curvature - ty_form_mean(form);
    return (ty_form){form.tt + change, form.tb, form.bb + change};
}

static void interior_begin(const ty_bsdf* b, const ty_world* world, const ty_depth_field* field, uint32_t prototype,
                           interior* in)
{
    const ty_surface_point* x = &b->point;
    ty_affine to_world = ty_world_to_world(world, x->object, x->instance, x->time);
    in->world = world;
    in->prototype = prototype;
    in->mesh = ty_world_prototype_mesh(world, prototype);
    in->x = ty_prototype_point(in->mesh, x);
    in->thickness = interpolate(in->mesh, x, field->depth);
    in->curvature = interpolate(in->mesh, x, field->curvature);
    int which = b->material->cdrf.curvature;
    in->directional = which == TY_CDRF_CURVATURE_DIRECTIONAL;
    bool formed = in->directional || which == TY_CDRF_CURVATURE_MAXIMAL;
    float stretch_sqr;
    ty_vec3 n = ty_map_transpose(&to_world, x->ns);
    if (ty_keeps_angles(&to_world, &stretch_sqr))
    {
        in->unit = sqrtf(stretch_sqr);
        n = ty_normalize(n);
        in->frame = ty_frame_from_normal(n);
        if (formed)
            in->form = smoothed_form(in, x, n);
    }
    else
    {
        float closer = ty_length(n);
        ty_affine to_local = ty_world_to_local(world, x->object, x->instance, x->time);
        ty_frame f = ty_frame_from_normal(x->ns);
        n = ty_mul(n, 1.0f / closer);
        in->unit = 1.0f;
        in->frame =
            (ty_frame){ty_map_vector(&to_local, f.t), ty_map_vector(&to_local, f.b), ty_map_vector(&to_local, f.n)};
        deform(in, n, smoothed_form(in, x, n), closer);
    }
    if (which == TY_CDRF_CURVATURE_MAXIMAL)
        in->curvature = ty_max(ty_form_maximum(in->form), 0.0f);
}

// Diffusion depth by channel. False = one for all.
static bool find_depths(const ty_bsdf* b, interior* in)
{
    float k = 0.5f * in->curvature + 1.0f / in->thickness, drop[3];
    bool alike = ty_cdrf_spreads(b, k / in->unit, drop);
    for (int i = 0; i < (alike ? 1 : 3); i++)
        in->depth[i] = ty_min(drop[i] / k, 0.95f * in->thickness);
    return !alike;
}

// --- the line ---

// Seen from a depth, in the plane of the normal and a direction.
static ty_spheroid_exit spheroid_at(const interior* in, float depth, float x, float y)
{
    float h = in->directional ? ty_max(ty_form_towards(in->form, x, y), 0.0f) : in->curvature;
    return ty_spheroid_exit_make(depth, in->thickness, h);
}

static crossing trace(const interior* in, ty_vec3 p, ty_vec3 w, ty_hit* hit)
{
    bool behind;
    if (!ty_world_intersect_prototype(in->world, in->prototype, p, w, in->thickness, hit, &behind))
        return CROSSING_NONE;
    return behind ? CROSSING_EXIT : CROSSING_ENTRY;
}

// The walk goes on where nothing was met within D.
static crossing walk_on(const interior* in, ty_vec3 p, ty_vec3 w, ty_rng* extra, ty_hit* hit)
{
    crossing c = CROSSING_NONE;
    for (int i = 1; i < MAX_STEPS && c == CROSSING_NONE; i++)
    {
        p = ty_mad(p, w, in->thickness);
        float u = ty_rng_float(extra);
        w = ty_to_world(in->frame, ty_sample_sphere((ty_vec2){u, ty_rng_float(extra)}));
        c = trace(in, p, w, hit);
    }
    return c;
}

// --- channels ---

static bool sees(const interior* in, ty_vec3 p, ty_vec3 way)
{
    ty_hit hit;
    return !ty_world_intersect_prototype(in->world, in->prototype, p, way, 0.999f, &hit, NULL);
}

// What an exit that channel `chosen` found at once is worth to each: its density for the channel over the mean of all
// by their odds, with (1 + B / S) cos / rho^2 for a point at distance rho within D that sees the exit. exit: from x, in
// the frame.
static ty_rgb channel_weights(const interior* in, ty_vec3 exit, ty_vec3 normal, int chosen, const float odds[3],
                              bool convex)
{
    float p[3], sum = 0.0f;
    for (int i = 0; i < 3; i++)
    {
        ty_vec3 v = ty_vec3_make(exit.x, exit.y, exit.z + in->depth[i]);
        float rho = ty_length(v), cosine = ty_dot(v, normal);
        p[i] = 0.0f;
        if (i == chosen || (rho < in->thickness && cosine > 0.0f))
            p[i] = ty_spheroid_exit_density(spheroid_at(in, in->depth[i], v.x, v.y), v.z / rho) * fabsf(cosine) /
                   (rho * rho * rho);
        if (i != chosen && !convex && p[i] > 0.0f &&
            !sees(in, ty_mad(in->x, in->frame.n, -in->depth[i]), ty_to_world(in->frame, v)))
            p[i] = 0.0f;
        sum += odds[i] * p[i];
    }
    return sum > 0.0f ? ty_rgb_scale(ty_rgb_make(p[0], p[1], p[2]), 1.0f / sum) : ty_rgb_grey(1.0f);
}

static int choose_channel(const float odds[3], float u)
{
    int i = 0;
    for (; i < 2 && u >= odds[i]; i++)
        u -= odds[i];
    while (i > 0 && odds[i] == 0.0f)
        i--;
    return i;
}

static ty_rgb one_channel(int i, const float odds[3])
{
    float w = 1.0f / odds[i];
    return ty_rgb_make(i == 0 ? w : 0.0f, i == 1 ? w : 0.0f, i == 2 ? w : 0.0f);
}

// The end of a random line that gambler's ruin chooses, of two numbers alone: so their net is one over the exits.
static ty_vec3 line_direction(const interior* in, float depth, const float u[2])
{
    float sine, cosine;
    ty_sincos(2.0f * TY_PI * u[1], &sine, &cosine);
    float z = ty_spheroid_exit_height(spheroid_at(in, depth, cosine, sine), u[0]), s = ty_safe_sqrt(1.0f - z * z);
    return (ty_vec3){s * cosine, s * sine, z};
}

// --- the walk ---

// By channel, and their mean.
static float walk_shares(const ty_bsdf* b, float thickness, float shares[3])
{
    for (int i = 0; i < (b->grey ? 1 : 3); i++)
    {
        float s = ty_clamp((b->mean_free_path[i] / thickness - WALK_FROM) * (1.0f / (WALK_ALONE - WALK_FROM)), 0, 1);
        shares[i] = ty_smoothstep(s);
    }
    if (!b->grey)
        return (shares[0] + shares[1] + shares[2]) * (1.0f / 3.0f);
    shares[1] = shares[2] = shares[0];
    return shares[0];
}

// Whether light walks, by chance; worth: what either choice is worth to each channel. u is as good as new.
static bool choose_walk(const ty_bsdf* b, const interior* in, float* u, float worth[3])
{
    float mean = walk_shares(b, in->thickness * in->unit, worth);
    bool walks = *u < mean;
    float chance = walks ? mean : 1.0f - mean;
    *u = ty_min((walks ? *u : *u - mean) / chance, TY_ONE_MINUS_EPSILON);
    for (int i = 0; i < 3; i++)
        worth[i] = (walks ? worth[i] : 1.0f - worth[i]) / chance;
    return walks;
}

// White within, as the material `walk` is that has the same colour and mean free path. Channels that do not walk do
// not decide about flights either.
static bool walk_out(const ty_shading_context* context, ty_bsdf* b, const float u[3], const float worth[3],
                     ty_rng* extra, ty_rgb* weight, ty_surface_point* exit)
{
    const float* l = b->mean_free_path;
    float longest = b->grey ? l[0] : ty_max(l[0], ty_max(l[1], l[2])), extinction[3];
    for (int i = 0; i < 3; i++)
        extinction[i] = 1.0f / (b->grey || worth[i] == 0.0f ? longest : l[i]);
    ty_scattering matter = {{extinction[0], extinction[1], extinction[2]}, {1.0f, 1.0f, 1.0f}, 0.0f};
    ty_walk walk;
    b->walk_end = ty_walk_through(context->world, &b->point, &matter, ty_walk_entry(&b->point, u), u[2], extra, &walk);
    b->flights = walk.scatterings + 1;
    if (b->walk_end == TY_WALK_LOST)
        return false;
    *weight = ty_rgb_mul(*weight, walk.beta);
    *exit = walk.exit;
    return true;
}

bool ty_cdrf_depth_exit(const ty_shading_context* context, ty_bsdf* b, const float numbers[3], ty_rng* extra,
                        ty_rgb* weight, ty_surface_point* exit)
{
    const ty_surface_point* x = &b->point;
    uint32_t prototype = ty_world_prototype(context->world, x->object, x->instance);
    const ty_depth_field* field = context->depth_fields ? context->depth_fields[prototype] : NULL;
    if (!field)
        return false;
    interior in;
    float u[3] = {numbers[0], numbers[1], numbers[2]}, worth[3];
    interior_begin(b, context->world, field, prototype, &in);
    bool walks = choose_walk(b, &in, &u[2], worth);
    *weight = ty_rgb_mul(*weight, ty_rgb_make(worth[0], worth[1], worth[2]));
    if (walks)
        return walk_out(context, b, u, worth, extra, weight, exit);
    // Channels have the more of the lines the less of their light walks.
    const float odds[3] = {worth[0] * (1.0f / 3.0f), worth[1] * (1.0f / 3.0f), worth[2] * (1.0f / 3.0f)};
    bool coloured = find_depths(b, &in);
    int chosen = coloured ? choose_channel(odds, u[2]) : 0;
    float depth = in.depth[chosen];
    ty_rgb alone = coloured ? one_channel(chosen, odds) : ty_rgb_grey(1.0f), factor = alone;
    ty_vec3 start = ty_mad(in.x, in.frame.n, -depth), w = line_direction(&in, depth, u);
    ty_vec3 way = ty_to_world(in.frame, w);
    ty_hit hit;
    crossing c = CROSSING_ENTRY;
    // Too shallow for the coordinates to tell p from x: the light leaves where it entered.
    if (depth * ty_length(in.frame.n) >= 1e-6f * (fabsf(start.x) + fabsf(start.y) + fabsf(start.z)) && depth > 0.0f)
    {
        c = trace(&in, start, way, &hit);
        if (c == CROSSING_NONE)
            c = walk_on(&in, start, way, extra, &hit);
        else if (c == CROSSING_EXIT && coloured)
        {
            ty_vec3 n = ty_prototype_normal(in.mesh, hit.triangle), v = ty_mul(w, hit.t);
            v.z -= depth;
            n = ty_vec3_make(ty_dot(n, in.frame.t), ty_dot(n, in.frame.b), ty_dot(n, in.frame.n));
            factor = channel_weights(&in, v, n, chosen, odds, x->convex);
        }
    }
    *weight = ty_rgb_mul(*weight, factor);
    if (c != CROSSING_EXIT)
        return false;
    hit.object = x->object;
    hit.instance = x->instance;
    hit.time = x->time;
    ty_world_surface(context->world, &hit, exit);
    return true;
}
