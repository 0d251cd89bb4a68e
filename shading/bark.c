// SPDX-License-Identifier: Apache-2.0
// `bark`: layers of noise about a root and along it, their colour and their relief.
#include "bark.h"
#include "curvature_at.h"
#include "material_private.h"
#include <tsuya/base/noise.h>

// What each layer draws its noise with.
enum
{
    SEED_MOTTLE = 0x62a1u,
    SEED_WARP = 0x31f7u,
    SEED_CREASE = 0x9c35u,
    SEED_RING = 0x47b9u,
    SEED_PORE = 0xd813u,
    SEED_GRAIN = 0x5e6du,
    SEED_LICHEN = 0xa4c1u,
    SEED_RUN = 0x7f2bu,
};

// What is left of a wave where a lookup averages over `seen`: nothing where it is shorter than that.
static float left_of(float frequency, float seen)
{
    return ty_clamp(2.0f - 2.0f * seen * frequency, 0.0f, 1.0f);
}

static float faded(ty_vec3 p, float frequency, float seen, uint32_t seed)
{
    float left = left_of(frequency, seen);
    return left > 0.0f ? left * ty_value_noise(ty_mul(p, frequency), seed) : 0.0f;
}

// Mean over a root of what thresholds make of noise: what is seen from afar.
#define CREASE_MEAN 0.085f
#define RING_MEAN 0.306f
#define PORE_MEAN 0.076f

static float between(float low, float high, float x)
{
    return ty_smoothstep(ty_clamp((x - low) / (high - low), 0.0f, 1.0f));
}

// --- where ---

// The part of a place that moves with the point.
static void place_move(ty_bark_place* place, const ty_bark_def* def, float radius, ty_vec3 local, ty_vec2 uv)
{
    float sine, cosine;
    ty_sincos(2.0f * TY_PI * uv.x, &sine, &cosine);
    place->space = ty_mul(local, 1.0f / def->size);
    place->root = ty_mul(ty_vec3_make(radius * cosine, radius * sine, uv.y), 1.0f / def->size);
}

// From the world to the object's space, in which patterns are as large as the scene says, however large the instance
// is.
static ty_affine local_of(const ty_shading_context* context, const ty_surface_point* point)
{
    if (!context || !context->world)
        return ty_affine_identity();
    ty_affine world = ty_world_to_world(context->world, point->object, point->instance, point->time);
    ty_affine local = ty_world_to_local(context->world, point->object, point->instance, point->time);
    float scale = ty_instance_scale(&world);
    local.x = ty_mul(local.x, scale);
    local.y = ty_mul(local.y, scale);
    local.z = ty_mul(local.z, scale);
    local.t = ty_mul(local.t, scale);
    return local;
}

ty_bark_place ty_bark_place_at(const ty_bark_def* def, const ty_shading_context* context, const ty_surface_point* point)
{
    ty_bark_place place;
    ty_affine local = local_of(context, point);
    place.join = ty_unit_input(&def->join, context, point);
    place.age = ty_unit_input(&def->age, context, point);
    float wide = ty_max(ty_length_sqr(point->footprint[0]), ty_length_sqr(point->footprint[1]));
    place.seen = 2.0f * sqrtf(wide) / def->size;
    place_move(&place, def, ty_max(ty_input_float(&def->radius, context, point), 0.0f),
               ty_map_point(&local, point->position), point->uv);
    return place;
}

// --- layers ---

// A layer whose scale is one about the root and another along it; where roots meet, it has the mean of both.
static float along_root(const ty_bark_place* p, float about, float along, uint32_t seed)
{
    float root = 0.0f, space = 0.0f;
    if (p->join < 1.0f)
        root = left_of(ty_max(about, along), p->seen) *
               ty_value_noise(ty_mul3(p->root, ty_vec3_make(about, about, along)), seed);
    if (p->join > 0.0f)
        space = faded(p->space, sqrtf(about * along), p->seen, seed);
    return ty_lerp(root, space, p->join);
}

ty_bark_layers ty_bark_layers_at(const ty_bark_place* p)
{
    ty_bark_layers l;
    float s = p->seen;
    l.mottle = 0.58f * faded(p->space, 0.9f, s, SEED_MOTTLE) + 0.28f * faded(p->space, 2.3f, s, SEED_MOTTLE + 1) +
               0.14f * faded(p->space, 5.1f, s, SEED_MOTTLE + 2);
    l.grain = 0.6f * faded(p->space, 13.0f, s, SEED_GRAIN) + 0.4f * faded(p->space, 29.0f, s, SEED_GRAIN + 1);
    // Fissures run along, and wander: the zero lines of a noise that is stretched.
    float warp = 0.32f * faded(p->space, 3.7f, s, SEED_WARP);
    float fissure = along_root(p, 2.6f, 0.55f, SEED_CREASE) + warp;
    l.crease = between(0.80f, 0.99f, 1.0f - fabsf(fissure)) * between(-0.35f, 0.45f, l.mottle);
    l.crease = ty_lerp(CREASE_MEAN, l.crease, left_of(5.0f, s));
    // Wrinkles run round: two scales of them, broken where the warp says.
    float ring = along_root(p, 1.3f, 7.5f, SEED_RING) + 0.5f * along_root(p, 2.1f, 17.0f, SEED_RING + 1);
    l.ring = between(0.45f, 1.0f, 1.0f - fabsf(ring)) * between(-0.5f, 0.3f, warp + 0.4f * l.mottle);
    l.ring = ty_lerp(RING_MEAN, l.ring, left_of(17.0f, s));
    l.pore = between(0.42f, 0.66f, along_root(p, 7.0f, 19.0f, SEED_PORE));
    l.pore = ty_lerp(PORE_MEAN, l.pore, left_of(19.0f, s));
    float patch = 0.65f * faded(p->space, 0.55f, s, SEED_LICHEN) + 0.35f * faded(p->space, 1.7f, s, SEED_LICHEN + 1);
    l.lichen = patch + 0.12f * l.grain;
    l.run = between(-0.15f, 0.4f, along_root(p, 2.2f, 0.12f, SEED_RUN) + 0.25f * l.mottle);
    return l;
}

float ty_bark_height(const ty_bark_def* def, const ty_bark_layers* l, float age)
{
    float old = 0.3f + 0.7f * age;
    float h = 0.45f * l->mottle + 0.12f * old * l->grain;
    h += 0.3f * def->wrinkles * l->ring + 0.22f * def->lenticels * l->pore;
    return h - def->creases * old * l->crease;
}

// --- looks ---

// Lichen covers what is older, first where the patches are, not the creases.
static ty_rgb lichen_over(ty_rgb color, const ty_bark_def* def, const ty_bark_layers* l, float age,
                          const ty_shading_context* context, const ty_surface_point* point)
{
    float cover = ty_unit_input(&def->lichen, context, point);
    if (!(cover > 0.0f))
        return color;
    float edge = 0.75f - 1.1f * cover * (0.45f + 0.55f * age);
    float share = between(edge, edge + 0.12f, l->lichen) * (1.0f - 0.8f * l->crease);
    if (!(share > 0.0f))
        return color;
    ty_rgb lichen = ty_clamp_color(ty_input_color(&def->lichen_color, context, point));
    return ty_rgb_lerp(color, ty_rgb_scale(lichen, 1.0f + 0.15f * l->grain), 0.92f * share);
}

// Water fills the pores of what it wets: light goes on farther in it, and dark colours gain most (Lekner & Dorf 1988,
// "Why some things are darker when wet", as the curve a (1 - w s (1 - a)) through what they measured).
static float wetted(float a, float w)
{
    return a * (1.0f - 0.62f * w * (1.0f - a));
}

ty_bark_look ty_bark_look_at(const ty_bark_def* def, const ty_shading_context* context, const ty_surface_point* point)
{
    ty_bark_place place = ty_bark_place_at(def, context, point);
    ty_bark_layers l = ty_bark_layers_at(&place);
    float age = ty_clamp(place.age + 0.45f * l.mottle, 0.0f, 1.0f), old = 0.3f + 0.7f * place.age;
    ty_rgb color = ty_rgb_lerp(ty_input_color(&def->young_color, context, point),
                               ty_input_color(&def->old_color, context, point), age);
    color = ty_rgb_scale(color, 1.0f + 0.16f * l.mottle + 0.16f * old * l.grain - 0.2f * def->wrinkles * l.ring);
    ty_rgb pore = ty_rgb_scale(ty_input_color(&def->young_color, context, point), 1.3f);
    color = ty_rgb_lerp(color, pore, 0.6f * def->lenticels * l.pore);
    ty_rgb crease = ty_input_color(&def->crease_color, context, point);
    color = ty_rgb_lerp(color, crease, ty_min(0.85f * def->creases * old * l.crease, 1.0f));
    color = ty_clamp_color(lichen_over(color, def, &l, place.age, context, point));
    // Half of the water soaks in everywhere, the rest stands in the runs.
    float water = ty_unit_input(&def->moisture, context, point), wet = water * (0.4f + 0.6f * l.run);
    float film = ty_clamp(2.0f * water * l.run, 0.0f, 1.0f) * water;
    color = ty_rgb_make(wetted(color.r, wet), wetted(color.g, wet), wetted(color.b, wet));
    float rough = ty_unit_input(&def->specular_roughness, context, point);
    return (ty_bark_look){color, ty_lerp(rough, ty_min(rough, 0.16f), film)};
}

// --- relief ---

// Differences over half of what a lookup averages, at least a 500th of the pattern.
ty_vec3 ty_bark_normal(const ty_bark_def* def, const ty_shading_context* context, const ty_surface_point* point,
                       const ty_frame* frame)
{
    ty_bark_place here = ty_bark_place_at(def, context, point);
    float step = ty_max(0.25f * here.seen, 2e-3f) * def->size, height[3];
    const ty_vec3 d[3] = {{0.0f, 0.0f, 0.0f}, ty_mul(frame->t, step), ty_mul(frame->b, step)};
    ty_vec3 n = frame->n, along[2];
    bool mapped = context && context->world && ty_world_tangents(context->world, point, &along[0], &along[1]);
    float radius = ty_max(ty_input_float(&def->radius, context, point), 0.0f);
    ty_affine local = local_of(context, point);
    for (int i = 0; i < 3; i++)
    {
        ty_vec2 uv = point->uv;
        if (mapped)
        {
            ty_vec3 across = ty_cross(along[0], along[1]);
            float area = ty_length_sqr(across);
            uv.x += ty_dot(ty_cross(d[i], along[1]), across) / area;
            uv.y += ty_dot(ty_cross(along[0], d[i]), across) / area;
        }
        place_move(&here, def, radius, ty_map_point(&local, ty_add(point->position, d[i])), uv);
        ty_bark_layers l = ty_bark_layers_at(&here);
        height[i] = def->depth * ty_bark_height(def, &l, here.age);
    }
    n = ty_mad(n, frame->t, (height[0] - height[1]) / step);
    return ty_normalize(ty_mad(n, frame->b, (height[0] - height[2]) / step));
}
