// SPDX-License-Identifier: Apache-2.0
// Materials: creation from definitions, and the preparation of lobes at a point.
#include "fresnel.h"
#include "material_private.h"
#include "microfacet.h"
#include "surface_private.h"
#include <tsuya/base/memory.h>
#include <tsuya/shading/cdrf.h>

static ty_status check_range(const char* name, float value, float low, float high, ty_error* error)
{
    if (value >= low && value <= high)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "%s is %g: it must be %g..%g", name, (double)value, (double)low,
                        (double)high);
}

static bool has_map(const ty_input* normal, const ty_input* bump)
{
    return normal->texture_index >= 0 || normal->attribute_index >= 0 || bump->texture_index >= 0;
}

static ty_status check_maps(float strength, const ty_input* bump, ty_error* error)
{
    ty_status status = check_range("normal_strength", strength, 0.0f, TY_FLOAT_MAX, error);
    if (status == TY_OK && bump->attribute_index >= 0)
        status = ty_error_set(error, TY_BAD_INPUT, "bump: an attribute has no slope; use a texture");
    return status;
}

// Constant values out of a scene file are in range already; those of programs need not be.
static ty_status check_surface(const ty_surface_def* def, ty_error* error)
{
    ty_status status = check_range("coat_ior", def->coat_ior, 1.0f, 3.0f, error);
    if (status == TY_OK)
        status = check_range("transmission_depth", def->transmission_depth, 0.0f, TY_FLOAT_MAX, error);
    if (status == TY_OK)
        status =
            check_range("transmission_scatter_anisotropy", def->transmission_scatter_anisotropy, -0.99f, 0.99f, error);
    if (status == TY_OK && !ty_input_is_zero(&def->transmission_scatter) &&
        (def->transmission_depth <= 0.0f || def->thin_walled))
        return ty_error_set(
            error, TY_BAD_INPUT,
            "transmission_scatter: counts scatterings in `transmission_depth`, which must be above 0 in "
            "a body that is not thin_walled");
    if (status == TY_OK)
        status = check_range("thin_film_ior", def->thin_film_ior, 1.0f, 3.0f, error);
    if (status == TY_OK && ty_input_is_constant(&def->specular_ior))
        status = check_range("specular_ior", def->specular_ior.value.r, 1.0f, 3.0f, error);
    if (status == TY_OK && ty_input_is_constant(&def->opacity))
        status = check_range("opacity", def->opacity.value.r, 0.0f, 1.0f, error);
    if (status == TY_OK && ty_input_is_constant(&def->specular_roughness_anisotropy))
        status =
            check_range("specular_roughness_anisotropy", def->specular_roughness_anisotropy.value.r, 0.0f, 1.0f, error);
    if (status == TY_OK)
        status = check_maps(def->normal_strength, &def->bump, error);
    float most = def->thin_walled ? 1.0f : 0.99f;
    if (status == TY_OK)
        status = check_range("subsurface_anisotropy", def->subsurface_anisotropy, -most, most, error);
    if (status == TY_OK && !(def->subsurface_radius.value.r > 0.0f))
        return ty_error_set(error, TY_BAD_INPUT, "subsurface_radius is %g mm: it must be above 0",
                            1e3 * (double)def->subsurface_radius.value.r);
    if (status == TY_OK && def->thin_walled && def->priority != 0)
        return ty_error_set(error, TY_BAD_INPUT, "priority: a thin_walled surface encloses nothing");
    return status;
}

static unsigned surface_traits(const ty_surface_def* s)
{
    bool clear = !ty_input_is_zero(&s->transmission_weight);
    bool smooth = !ty_input_is_constant(&s->specular_roughness) || s->specular_roughness.value.r < TY_SMOOTH_ROUGHNESS;
    bool passes =
        !ty_input_is_constant(&s->opacity) || s->opacity.value.r < 1.0f || (clear && s->thin_walled && smooth);
    unsigned within =
        ty_input_is_zero(&s->transmission_scatter) ? TY_TRAIT_MEDIUM : TY_TRAIT_MEDIUM | TY_TRAIT_SCATTERING;
    return (passes ? TY_TRAIT_TRANSPARENT : 0u) | (clear && !s->thin_walled ? within : 0u);
}

ty_status ty_material_create_surface(const ty_surface_def* def, ty_material** out, ty_error* error)
{
    *out = NULL;
    ty_status status = check_surface(def, error);
    if (status != TY_OK)
        return status;
    ty_material* m = TY_ALLOC(ty_material, 1);
    m->model = TY_MODEL_SURFACE;
    m->surface = *def;
    m->bent = has_map(&def->normal, &def->bump);
    m->matte = ty_input_is_zero(&def->specular_weight) && ty_input_is_zero(&def->base_metalness) &&
               ty_input_is_zero(&def->transmission_weight) && ty_input_is_zero(&def->coat_weight) &&
               ty_input_is_zero(&def->fuzz_weight) && ty_input_is_zero(&def->thin_film_weight) &&
               ty_input_is_zero(&def->base_diffuse_roughness) && ty_input_is_zero(&def->subsurface_weight) &&
               !def->thin_walled;
    m->body = !def->thin_walled && !ty_input_is_zero(&def->subsurface_weight);
    m->cdrf = ty_cdrf_def_default(); // how light goes through the body
    m->anisotropic =
        !m->matte && (!ty_input_is_zero(&def->specular_roughness_anisotropy) ||
                      (!ty_input_is_zero(&def->coat_weight) && !ty_input_is_zero(&def->coat_roughness_anisotropy)));
    m->base_is_constant = ty_input_is_constant(&def->base_color) && ty_input_is_constant(&def->base_weight);
    m->base_color = ty_rgb_scale(ty_clamp_color(def->base_color.value), ty_clamp(def->base_weight.value.r, 0.0f, 1.0f));
    m->emissive = !ty_input_is_zero(&def->emission_luminance) && !ty_input_is_zero(&def->emission_color);
    m->traits = surface_traits(def);
    ty_surface_make_tables(m);
    if (m->body && def->subsurface_evaluate != TY_SUBSURFACE_WALK)
        m->spread = ty_spread_table_create(TY_CDRF_POISSON);
    *out = m;
    return TY_OK;
}

ty_status ty_material_create_cdrf(const ty_cdrf_def* def, ty_material** out, ty_error* error)
{
    *out = NULL;
    if (def->evaluate == TY_CDRF_DEPTH && def->kernel != TY_CDRF_POISSON)
        return ty_error_set(
            error, TY_BAD_INPUT,
            "kernel: `evaluate: depth` knows `poisson` alone; use `evaluate: probe` or `local` with the "
            "Gaussian kernels");
    ty_status status = check_range("specular_ior", def->specular_ior, 1.0f, 3.0f, error);
    if (status == TY_OK)
        status = check_range("cooked", def->cooked, -1.0f, 1.0f, error);
    if (status == TY_OK)
        status = check_maps(def->normal_strength, &def->bump, error);
    if (status == TY_OK && def->evaluate == TY_CDRF_LOCAL && has_map(&def->normal, &def->bump))
        status = ty_error_set(error, TY_BAD_INPUT,
                              "evaluate: `local` has no reflection of its own for `normal` and `bump`; use `depth` or "
                              "`probe`");
    if (status != TY_OK)
        return status;
    ty_material* m = TY_ALLOC(ty_material, 1);
    m->model = TY_MODEL_CDRF;
    m->cdrf = *def;
    const float eta[2] = {def->specular_ior, def->specular_ior};
    m->coat = ty_material_make_table(&def->specular_weight, &def->specular_roughness, eta);
    if (def->cooked >= 0.0f && def->moisture.cooked.value.r < 0.0f)
        m->cdrf.moisture.cooked = ty_input_scalar(def->cooked);
    m->optics_are_constant = ty_moisture_inputs_are_constant(&def->moisture);
    if (m->optics_are_constant)
        m->optics = ty_moisture_law_at(&def->calibration, ty_moisture_at(&m->cdrf.moisture, NULL, NULL));
    m->bent = has_map(&def->normal, &def->bump);
    m->cdrf_is_constant = m->optics_are_constant && ty_input_is_constant(&def->color) &&
                          ty_input_is_constant(&def->mean_free_path) &&
                          ty_input_is_constant(&def->mean_free_path_scale) &&
                          ty_input_is_constant(&def->specular_weight) && ty_input_is_constant(&def->specular_roughness);
    ty_cdrf_begin(m);
    *out = m;
    return TY_OK;
}

// What is within is said in one way; the least white is for measured matter to say.
static ty_status check_walk(const ty_walk_def* d, ty_error* error)
{
    bool scattering = ty_walk_is_given(&d->scattering), color = ty_walk_is_given(&d->subsurface_color);
    ty_status status = check_range("anisotropy", d->anisotropy, -0.99f, 0.99f, error);
    if (status == TY_OK && d->preset > 0 && scattering)
        return ty_error_set(error, TY_BAD_INPUT, "preset: says what `scattering` says; leave out one of them");
    if (status == TY_OK && d->preset > 0 && color)
        return ty_error_set(error, TY_BAD_INPUT, "preset: says what `subsurface_color` says; leave out one of them");
    if (status == TY_OK && scattering && color)
        return ty_error_set(error, TY_BAD_INPUT,
                            "subsurface_color: `scattering` says what is within already; leave out one of them");
    return status;
}

// Mean reflectance of diffuse light on the inner side of a dielectric: F_i = 1 - (1 - F_e) / eta^2.
static float inner_reflection(float eta)
{
    enum
    {
        STEPS = 256
    };
    float outer = 0.0f;
    for (int i = 0; i < STEPS; i++)
    {
        float mu = ((float)i + 0.5f) / STEPS;
        outer += 2.0f * mu * ty_fresnel(mu, eta) / STEPS;
    }
    return 1.0f - (1.0f - outer) / (eta * eta);
}

// The boundary is that of a clear `surface`, what is within stays. Replaces *material.
static ty_status put_in_glass(const ty_walk_def* def, ty_material** material, ty_error* error)
{
    ty_surface_def s = ty_surface_def_default();
    ty_material *matter = *material, *glass;
    s.transmission_weight = ty_input_scalar(1.0f);
    s.specular_ior = ty_input_scalar(def->common.specular_ior);
    s.specular_weight = def->common.specular_weight;
    s.specular_roughness = def->common.specular_roughness;
    s.normal = def->common.normal;
    s.normal_strength = def->common.normal_strength;
    s.bump = def->common.bump;
    if (ty_input_is_constant(&s.specular_roughness) && s.specular_roughness.value.r < 0.0f)
        s.specular_roughness =
            ty_input_scalar(ty_moisture_optics_make(ty_moisture_at(&matter->cdrf.moisture, NULL, NULL)).roughness);
    *material = NULL;
    ty_status status = ty_material_create_surface(&s, &glass, error);
    if (status == TY_OK)
    {
        glass->cdrf = matter->cdrf;
        glass->optics_are_constant = matter->optics_are_constant;
        glass->optics = matter->optics;
        glass->inner_reflection = inner_reflection(def->common.specular_ior);
        *material = glass;
    }
    ty_material_destroy(matter);
    return status;
}

ty_status ty_material_create_walk(const ty_walk_def* def, ty_material** out, ty_error* error)
{
    *out = NULL;
    ty_status status = check_walk(def, error);
    if (status != TY_OK)
        return status;
    ty_cdrf_def common = def->common;
    common.kernel = TY_CDRF_POISSON;
    common.evaluate = TY_CDRF_DEPTH;
    status = ty_material_create_cdrf(&common, out, error);
    if (status != TY_OK)
        return status;
    if (def->boundary == TY_WALK_DIELECTRIC)
        status = put_in_glass(def, out, error);
    if (status != TY_OK)
        return status;
    (*out)->model = TY_MODEL_WALK;
    (*out)->walk = *def;
    return TY_OK;
}

void ty_material_destroy(ty_material* material)
{
    if (!material)
        return;
    ty_albedo_table_destroy(material->specular);
    ty_albedo_table_destroy(material->coat);
    ty_albedo_table_destroy(material->fuzz);
    ty_albedo_table_destroy(material->coat_under_fuzz);
    ty_albedo_table_destroy(material->base_under_coat);
    ty_albedo_table_destroy(material->base_under_fuzz);
    ty_thin_film_bands_destroy(material->film_bands);
    ty_thin_film_table_destroy(material->film);
    ty_loss_table_destroy(material->conductor);
    ty_loss_table_destroy(material->dielectric);
    ty_poisson_table_destroy(material->poisson);
    ty_spread_table_destroy(material->spread);
    ty_free(material);
}

bool ty_material_is_subsurface(const ty_material* material)
{
    // Of what is clear besides, the far side is seen from within.
    return material->model != TY_MODEL_SURFACE || (material->body && !(material->traits & TY_TRAIT_MEDIUM));
}

bool ty_material_needs_depth(const ty_material* material)
{
    if (material->model == TY_MODEL_SURFACE)
        return material->body && material->surface.subsurface_evaluate == TY_SUBSURFACE_DEPTH;
    return material->model == TY_MODEL_CDRF && material->cdrf.evaluate == TY_CDRF_DEPTH;
}

bool ty_material_is_emissive(const ty_material* material)
{
    return material->emissive;
}

ty_rgb ty_material_emission(const ty_material* material, const ty_shading_context* context,
                            const ty_surface_point* point)
{
    const ty_surface_def* s = &material->surface;
    if (!material->emissive)
        return ty_rgb_grey(0.0f);
    return ty_rgb_scale(ty_input_color(&s->emission_color, context, point),
                        ty_max(ty_input_float(&s->emission_luminance, context, point), 0.0f));
}

unsigned ty_material_traits(const ty_material* material)
{
    return material->traits;
}

// A smooth sheet lets light through unbent: the path must not take it for a new direction, or what shadow rays carry
// through would be counted twice.
static ty_rgb through_sheet(const ty_material* material, const ty_shading_context* context,
                            const ty_surface_point* point, ty_vec3 wo)
{
    ty_bsdf b;
    ty_material_prepare(material, context, point, wo, &b);
    if (b.alpha.x > 0.0f || b.transmission_weight <= 0.0f)
        return ty_rgb_grey(0.0f);
    float mu = ty_dot(b.wo, b.frame.n);
    return ty_rgb_mul(ty_surface_transmittance(&b, mu), ty_layers_across(&b, mu, mu));
}

ty_transparency ty_material_transparency(const ty_material* material, const ty_shading_context* context,
                                         const ty_surface_point* point, ty_vec3 wo)
{
    if (!(material->traits & TY_TRAIT_TRANSPARENT))
        return (ty_transparency){.opacity = 1.0f};
    const ty_surface_def* s = &material->surface;
    float opacity = ty_clamp(ty_input_float(&s->opacity, context, point), 0.0f, 1.0f);
    ty_transparency t = {ty_rgb_grey(1.0f - opacity), opacity};
    if (s->thin_walled && opacity > 0.0f && !ty_input_is_zero(&s->transmission_weight))
        t.through = ty_rgb_add(t.through, ty_rgb_scale(through_sheet(material, context, point, wo), opacity));
    return t;
}

void ty_material_prepare(const ty_material* material, const ty_shading_context* context, const ty_surface_point* point,
                         ty_vec3 wo, ty_bsdf* out)
{
    ty_material_prepare_within(material, context, point, wo, 1.0f, out);
}

// What is not set is not read of a Lambert surface.
static void prepare_matte(const ty_material* material, const ty_shading_context* context, const ty_surface_point* point,
                          ty_vec3 wo, ty_bsdf* out)
{
    if (point != &out->point)
        out->point = *point;
    out->kind = TY_BSDF_MATTE;
    out->material = material;
    out->wo = wo;
    ty_shading_frame_prepare(material, context, out);
    out->color =
        material->base_is_constant ? material->base_color : ty_surface_base_color(&material->surface, context, point);
    out->emission = ty_rgb_grey(0.0f);
    if (material->emissive && out->entering)
        out->emission = ty_material_emission(material, context, point);
}

static void prepare_cdrf(const ty_material* material, const ty_shading_context* context, const ty_surface_point* point,
                         ty_vec3 wo, ty_bsdf* out)
{
    if (point != &out->point)
        out->point = *point;
    out->material = material;
    out->wo = wo;
    out->emission = ty_rgb_grey(0.0f);
    ty_shading_frame_prepare(material, context, out);
    ty_cdrf_prepare(material, context, out);
}

static void prepare_layers(const ty_material* material, const ty_shading_context* context,
                           const ty_surface_point* point, ty_vec3 wo, float outside, ty_bsdf* out)
{
    *out = (ty_bsdf){.material = material, .point = *point, .wo = wo, .outside = outside};
    ty_shading_frame_prepare(material, context, out);
    if (material->model == TY_MODEL_SURFACE)
        ty_surface_prepare(material, context, out);
    else if (material->walk.boundary == TY_WALK_DIELECTRIC)
        ty_walk_prepare_boundary(material, context, out);
    else
        ty_walk_prepare(material, context, out);
}

void ty_material_prepare_within(const ty_material* material, const ty_shading_context* context,
                                const ty_surface_point* point, ty_vec3 wo, float outside, ty_bsdf* out)
{
    if (material->matte)
        prepare_matte(material, context, point, wo, out);
    else if (material->model == TY_MODEL_CDRF)
        prepare_cdrf(material, context, point, wo, out);
    else
        prepare_layers(material, context, point, wo, outside, out);
}
