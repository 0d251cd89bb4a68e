// SPDX-License-Identifier: Apache-2.0
// `walk`: what is within a body, and the way of light through it.
#include "lobes.h"
#include "material_private.h"
#include <tsuya/shading/walk.h>

typedef struct preset
{
    ty_rgb scattering, absorption; // 1/mm, the first reduced
} preset;

// As in ty_walk_preset_names. Measured: Jensen et al. 2001 ("A practical model for subsurface light transport", table
// 1), of cream and soy milk Narasimhan et al. 2006 ("Acquiring scattering properties of participating media by
// dilution").
static const preset presets[] = {
    {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}},
    {{2.29f, 2.39f, 1.97f}, {0.0030f, 0.0034f, 0.046f}},  // apple
    {{0.15f, 0.21f, 0.38f}, {0.015f, 0.077f, 0.19f}},     // chicken
    {{7.38f, 5.47f, 3.15f}, {0.0002f, 0.0028f, 0.0163f}}, // cream
    {{2.19f, 2.62f, 3.00f}, {0.0021f, 0.0041f, 0.0071f}}, // marble
    {{0.68f, 0.70f, 0.55f}, {0.0024f, 0.0090f, 0.12f}},   // potato
    {{0.70f, 1.22f, 1.90f}, {0.0014f, 0.0025f, 0.0142f}}, // skim_milk
    {{0.74f, 0.88f, 1.01f}, {0.032f, 0.17f, 0.48f}},      // skin
    {{0.59f, 0.74f, 1.47f}, {0.0019f, 0.0096f, 0.065f}},  // soy_milk
    {{2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f}},  // whole_milk
};

// A channel out of its reduced scattering and its absorption, 1/mm.
static void channel_from_coefficients(float scattering, float absorption, float g, float* extinction, float* albedo)
{
    float s = ty_max(scattering, 0.0f) / (1.0f - g), sum = s + ty_max(absorption, 0.0f);
    *extinction = 1e3f * sum;
    *albedo = sum > 0.0f ? s / sum : 0.0f;
}

static ty_scattering from_coefficients(ty_rgb scattering, ty_rgb absorption, float g)
{
    ty_scattering m = {.anisotropy = g};
    channel_from_coefficients(scattering.r, absorption.r, g, &m.extinction.r, &m.albedo.r);
    channel_from_coefficients(scattering.g, absorption.g, g, &m.extinction.g, &m.albedo.g);
    channel_from_coefficients(scattering.b, absorption.b, g, &m.extinction.b, &m.albedo.b);
    return m;
}

// What an index-matched body must reflect for one with inner reflection F_i to let c of the entered light out again:
// c / (1 - F_i + F_i c), were it diffuse within. Refracted light enters more steeply; the factor for that is a fit of
// ours to walks in half-spaces, good to .005 for indices of 1 to 1.5.
static float matched_color(float c, float inner_reflection)
{
    float f = inner_reflection, diffuse = c / (1.0f - f + f * c);
    return diffuse * (1.0f + f * (0.79f - 0.48f * f) * ty_sqr(1.0f - diffuse));
}

ty_scattering ty_walk_matter(ty_rgb color, float radius, ty_rgb scale, float g)
{
    const float shortest = 1e-9f;
    return (ty_scattering){
        .extinction = {1.0f / ty_max(radius * scale.r, shortest), 1.0f / ty_max(radius * scale.g, shortest),
                       1.0f / ty_max(radius * scale.b, shortest)},
        .albedo = {ty_walk_albedo(color.r, g), ty_walk_albedo(color.g, g), ty_walk_albedo(color.b, g)},
        .anisotropy = g};
}

static ty_scattering from_color(const ty_material* material, const ty_shading_context* context,
                                const ty_surface_point* p)
{
    const ty_walk_def* d = &material->walk;
    ty_rgb color = ty_clamp_color(ty_input_color(&d->subsurface_color, context, p));
    color.r = matched_color(color.r, material->inner_reflection);
    color.g = matched_color(color.g, material->inner_reflection);
    color.b = matched_color(color.b, material->inner_reflection);
    return ty_walk_matter(color, ty_input_float(&d->subsurface_radius, context, p),
                          ty_input_color(&d->subsurface_radius_scale, context, p), d->anisotropy);
}

void ty_walk_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_walk_def* d = &material->walk;
    const ty_surface_point* p = &b->point;
    float g = d->anisotropy;
    ty_cdrf_prepare(material, context, b);
    if (d->preset > 0)
        b->matter = from_coefficients(presets[d->preset].scattering, presets[d->preset].absorption, g);
    else if (ty_walk_is_given(&d->scattering))
        b->matter = from_coefficients(ty_input_color(&d->scattering, context, p),
                                      ty_input_color(&d->absorption, context, p), g);
    else if (ty_walk_is_given(&d->subsurface_color))
        b->matter = from_color(material, context, p);
    else if (b->mean_free_path[0] > 0.0f)
    {
        // White within; the colour is what the body keeps of the light, as for `cdrf`.
        const float* l = b->mean_free_path;
        ty_rgb extinction = ty_rgb_make(1.0f / l[0], 1.0f / ty_max(l[1], 1e-9f), 1.0f / ty_max(l[2], 1e-9f));
        b->matter = (ty_scattering){ty_rgb_scale(extinction, 1.0f / (1.0f - g)), ty_rgb_grey(1.0f), g};
        return;
    }
    else
        return;
    b->color = ty_rgb_grey(1.0f);
}

void ty_walk_prepare_boundary(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    ty_bsdf within = {.material = material, .point = b->point};
    ty_walk_prepare(material, context, &within);
    ty_surface_prepare(material, context, b);
    // Its square is what the body keeps of light on its way in and out.
    b->transmission = ty_rgb_make(sqrtf(within.color.r), sqrtf(within.color.g), sqrtf(within.color.b));
    b->alone = true;
}

ty_rgb ty_walk_reflectance(const ty_scattering* m)
{
    if (ty_rgb_is_black(m->extinction))
        return ty_rgb_grey(1.0f);
    return ty_rgb_make(ty_walk_color(m->albedo.r, m->anisotropy), ty_walk_color(m->albedo.g, m->anisotropy),
                       ty_walk_color(m->albedo.b, m->anisotropy));
}

// Light enters by the cosine about the shading normal; what that sends out of the surface is mirrored in it.
ty_vec3 ty_walk_entry(const ty_surface_point* x, const float u[2])
{
    ty_frame frame = ty_frame_from_normal(ty_neg(x->ns));
    ty_vec3 w = ty_normalize(ty_to_world(frame, ty_sample_cosine((ty_vec2){u[0], u[1]})));
    float out = ty_dot(w, x->ng);
    return out > 0.0f ? ty_mad(w, x->ng, -2.0f * out) : w;
}

bool ty_walk_exit(const ty_shading_context* context, ty_bsdf* b, const float u[3], ty_rng* extra, ty_rgb* weight,
                  ty_surface_point* exit)
{
    if (ty_rgb_is_black(b->matter.extinction))
        return false;
    ty_walk walk;
    const ty_surface_point* x = &b->point;
    if (!b->entering && b->way > 0.0f)
        b->walk_end = ty_walk_from(context->world, x->object, x->instance, x->time, ty_mad(x->position, b->wo, b->way),
                                   &b->matter, ty_neg(b->wo), extra, &walk);
    else
        b->walk_end = ty_walk_through(context->world, x, &b->matter, ty_walk_entry(x, u), u[2], extra, &walk);
    b->flights = walk.scatterings + 1;
    switch (b->walk_end)
    {
    case TY_WALK_LEFT:
    case TY_WALK_CUT:
        *weight = ty_rgb_mul(*weight, walk.beta);
        *exit = walk.exit;
        return true;
    case TY_WALK_LOST: // leaves where it entered
        break;
    case TY_WALK_ABSORBED:
        *weight = ty_rgb_grey(0.0f);
        break;
    }
    return false;
}
