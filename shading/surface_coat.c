// SPDX-License-Identifier: Apache-2.0
// `surface`: coat and fuzz at a point, and what they do to the base's colours and to the light it emits.
#include "fresnel.h"
#include "material_private.h"
#include "microfacet.h"
#include "surface_private.h"

// The frame's t is along the texture and turned with the base: the coat is turned by what is left.
static void stretch_coat(const ty_surface_def* s, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_point* p = &b->point;
    float turn = ty_input_float(&s->coat_rotation, context, p) - ty_input_float(&s->specular_rotation, context, p);
    b->coat_stretch =
        ty_ggx_alpha_stretched(b->coat_roughness, ty_unit_input(&s->coat_roughness_anisotropy, context, p));
    b->coat_stretched = b->coat_stretch.x != b->coat_stretch.y;
    ty_sincos(b->entering ? turn : -turn, &b->coat_sine, &b->coat_cosine);
}

static void prepare_coat(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_def* s = &material->surface;
    b->coat_weight = ty_unit_input(&s->coat_weight, context, &b->point);
    if (b->coat_weight <= 0.0f)
        return;
    float roughness = ty_unit_input(&s->coat_roughness, context, &b->point);
    b->coat_roughness = roughness;
    b->coat_alpha = ty_ggx_alpha(roughness);
    b->coat_eta = s->coat_ior;
    if (!ty_input_is_zero(&s->coat_roughness_anisotropy))
        stretch_coat(s, context, b);
    b->coat_row = ty_albedo_table_row(material->coat, roughness, s->coat_ior);
    if (b->fuzz_weight > 0.0f)
        b->coat_under_fuzz = ty_albedo_table_row(material->coat_under_fuzz, roughness, b->fuzz_roughness);
    const float blackest = 1e-4f;
    ty_rgb c = ty_input_color(&s->coat_color, context, &b->point);
    b->coat_log = ty_rgb_make(ty_ln(ty_clamp(c.r, blackest, 1.0f)), ty_ln(ty_clamp(c.g, blackest, 1.0f)),
                              ty_ln(ty_clamp(c.b, blackest, 1.0f)));
    b->tinted = !ty_rgb_is_black(b->coat_log);
}

static void prepare_fuzz(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_def* s = &material->surface;
    b->fuzz_weight = ty_unit_input(&s->fuzz_weight, context, &b->point);
    if (b->fuzz_weight <= 0.0f)
        return;
    b->fuzz_roughness = ty_unit_input(&s->fuzz_roughness, context, &b->point);
    b->fuzz_color = ty_clamp_color(ty_input_color(&s->fuzz_color, context, &b->point));
    b->fuzz_row = ty_albedo_table_row(material->fuzz, b->fuzz_roughness, 1.0f);
}

void ty_surface_prepare_layers(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    if (material->fuzz)
        prepare_fuzz(material, context, b);
    if (material->coat)
        prepare_coat(material, context, b);
    b->layered = !b->inside && (b->coat_weight > 0.0f || b->fuzz_weight > 0.0f);
}

// What goes back and forth between base and coat meets the base's colour again (OpenPBR Surface 1.1, "Darkening").
// returned: share of the light from the base that the coat sends back.
static ty_rgb darkened(ty_rgb color, float returned, float weight)
{
    float left = 1.0f - returned;
    ty_rgb once = {color.r * left / (1.0f - color.r * returned), color.g * left / (1.0f - color.g * returned),
                   color.b * left / (1.0f - color.b * returned)};
    return ty_rgb_lerp(color, once, weight);
}

void ty_surface_prepare_darkening(const ty_surface_def* s, const ty_shading_context* context, float roughness,
                                  ty_bsdf* b)
{
    float weight = b->coat_weight * ty_unit_input(&s->coat_darkening, context, &b->point), n = b->coat_eta;
    if (!(weight > 0.0f) || !(n > 1.0f))
        return;
    float diffuse = 1.0f - (1.0f - ty_fresnel_average(n)) / (n * n), mirror = ty_sqr((n - 1.0f) / (n + 1.0f));
    b->diffuse = darkened(b->diffuse, diffuse, weight);
    b->body_color = darkened(b->body_color, diffuse, weight);
    b->diffuse_below = darkened(b->diffuse_below, diffuse, weight);
    ty_rgb metal = darkened(b->color, ty_lerp(mirror, diffuse, roughness), weight);
    const float least = 1e-6f;
    ty_rgb shade = {metal.r / ty_max(b->color.r, least), metal.g / ty_max(b->color.g, least),
                    metal.b / ty_max(b->color.b, least)};
    b->metal = ty_rgb_mul(b->metal, shade);
    b->conductor_gain = ty_rgb_mul(b->conductor_gain, shade);
}

// Light that the base emits comes out through the layers.
ty_rgb ty_material_emission_towards(const ty_material* material, const ty_shading_context* context,
                                    const ty_surface_point* point, ty_vec3 wo)
{
    ty_rgb emission = ty_material_emission(material, context, point);
    if (ty_rgb_is_black(emission) || !(material->coat || material->fuzz))
        return emission;
    ty_bsdf b = {.material = material, .point = *point, .wo = wo, .outside = 1.0f};
    ty_shading_frame_prepare(material, context, &b);
    ty_surface_prepare_layers(material, context, &b);
    float mu = ty_dot(wo, b.frame.n);
    return ty_rgb_mul(emission, ty_layers_across(&b, mu, mu));
}
