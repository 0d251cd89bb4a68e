// SPDX-License-Identifier: Apache-2.0
// Materials: creation from definitions, and the preparation of lobes at a point.
#include "material_private.h"
#include "microfacet.h"
#include <tsuya/base/memory.h>
#include <tsuya/shading/cdrf.h>

static bool is_constant(const ty_input* input)
{
    return input->texture_index < 0 && input->attribute_index < 0;
}

static bool is_zero(const ty_input* input)
{
    // A texture or attribute only scales the value.
    return ty_rgb_is_black(input->value);
}

static ty_albedo_table* make_table(const ty_input* weight, const ty_input* roughness, float eta_low, float eta_high)
{
    if (is_zero(weight) || eta_high <= 1.0f)
        return NULL;
    float r = ty_clamp(roughness->value.r, 0.0f, 1.0f);
    bool constant = is_constant(roughness) && roughness->value.r >= 0.0f;
    return ty_albedo_table_create(constant ? r : 0.0f, constant ? r : 1.0f, eta_low, eta_high);
}

static ty_status check_range(const char* name, float value, float low, float high, ty_error* error)
{
    if (value >= low && value <= high)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "%s is %g: it must be %g..%g", name, (double)value, (double)low,
                        (double)high);
}

// The range of an input on which a table depends: one value, or all there are.
static void table_range(const ty_input* input, float low, float high, float range[2])
{
    float value = ty_clamp(input->value.r, low, high);
    range[0] = is_constant(input) ? value : low;
    range[1] = is_constant(input) ? value : high;
}

static void make_loss_tables(ty_material* m)
{
    const ty_surface_def* s = &m->surface;
    float roughness[2], ior[2], weight[2];
    table_range(&s->specular_roughness, 0.0f, 1.0f, roughness);
    table_range(&s->specular_ior, 1.0f, 3.0f, ior);
    table_range(&s->specular_weight, 0.0f, 1.0f, weight);
    if (roughness[1] < TY_SMOOTH_ROUGHNESS)
        return;
    if (!is_zero(&s->base_metalness) && !is_zero(&s->specular_weight))
        m->conductor = ty_loss_table_create_conductor(roughness[0], roughness[1]);
    if (!is_zero(&s->transmission_weight))
        m->dielectric = ty_loss_table_create_dielectric(roughness[0], roughness[1], ior[0], ior[1], weight[1]);
}

ty_status ty_material_create_surface(const ty_surface_def* def, ty_material** out, ty_error* error)
{
    *out = NULL;
    ty_status status = check_range("coat_ior", def->coat_ior, 1.0f, 3.0f, error);
    if (status == TY_OK)
        status = check_range("transmission_depth", def->transmission_depth, 0.0f, TY_FLOAT_MAX, error);
    if (status == TY_OK && is_constant(&def->specular_ior))
        status = check_range("specular_ior", def->specular_ior.value.r, 1.0f, 3.0f, error);
    if (status != TY_OK)
        return status;
    ty_material* m = TY_ALLOC(ty_material, 1);
    m->model = TY_MODEL_SURFACE;
    m->surface = *def;
    bool fixed = is_constant(&def->specular_ior);
    float ior = def->specular_ior.value.r;
    m->specular = make_table(&def->specular_weight, &def->specular_roughness, fixed ? ior : 1.0f, fixed ? ior : 3.0f);
    m->coat = make_table(&def->coat_weight, &def->coat_roughness, def->coat_ior, def->coat_ior);
    make_loss_tables(m);
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
    if (status != TY_OK)
        return status;
    ty_material* m = TY_ALLOC(ty_material, 1);
    m->model = TY_MODEL_CDRF;
    m->cdrf = *def;
    m->coat = make_table(&def->specular_weight, &def->specular_roughness, def->specular_ior, def->specular_ior);
    if (def->evaluate == TY_CDRF_LOCAL && def->kernel == TY_CDRF_POISSON)
        m->poisson = ty_poisson_table_create();
    *out = m;
    return TY_OK;
}

void ty_material_destroy(ty_material* material)
{
    if (!material)
        return;
    ty_albedo_table_destroy(material->specular);
    ty_albedo_table_destroy(material->coat);
    ty_loss_table_destroy(material->conductor);
    ty_loss_table_destroy(material->dielectric);
    ty_poisson_table_destroy(material->poisson);
    ty_free(material);
}

bool ty_material_is_subsurface(const ty_material* material)
{
    return material->model == TY_MODEL_CDRF;
}

bool ty_material_needs_depth(const ty_material* material)
{
    return material->model == TY_MODEL_CDRF && material->cdrf.evaluate == TY_CDRF_DEPTH;
}

bool ty_material_is_emissive(const ty_material* material)
{
    const ty_surface_def* s = &material->surface;
    return material->model == TY_MODEL_SURFACE && !is_zero(&s->emission_luminance) && !is_zero(&s->emission_color);
}

ty_rgb ty_material_emission(const ty_material* material, const ty_shading_context* context,
                            const ty_surface_point* point)
{
    const ty_surface_def* s = &material->surface;
    if (!ty_material_is_emissive(material))
        return ty_rgb_grey(0.0f);
    return ty_rgb_scale(ty_input_color(&s->emission_color, context, point),
                        ty_max(ty_input_float(&s->emission_luminance, context, point), 0.0f));
}

// Shading normals may turn away from a viewer who sees the triangle: bend them back until they face wo.
static ty_vec3 facing_normal(ty_vec3 ns, ty_vec3 wo)
{
    const float least = 1e-3f;
    float c = ty_dot(ns, wo);
    return c >= least ? ns : ty_normalize(ty_mad(ns, wo, least - c));
}

void ty_material_prepare(const ty_material* material, const ty_shading_context* context, const ty_surface_point* point,
                         ty_vec3 wo, ty_bsdf* out)
{
    *out = (ty_bsdf){.material = material, .point = *point, .wo = wo};
    out->entering = ty_dot(wo, point->ng) > 0.0f;
    out->frame = ty_frame_from_normal(facing_normal(out->entering ? point->ns : ty_neg(point->ns), wo));
    if (context && context->world)
    {
        uint32_t prototype = ty_world_prototype(context->world, point->object, point->instance);
        out->convex = ty_world_topology(context->world, prototype)->convex;
    }
    switch (material->model)
    {
    case TY_MODEL_SURFACE:
        ty_surface_prepare(material, context, out);
        break;
    case TY_MODEL_CDRF:
        ty_cdrf_prepare(material, context, out);
        break;
    }
}
