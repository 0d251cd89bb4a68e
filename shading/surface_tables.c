// SPDX-License-Identifier: Apache-2.0
// `surface`: what is integrated once for its lobes and layers.
#include "fresnel.h"
#include "material_private.h"
#include "microfacet.h"

// The range of an input on which a table depends: one value, or all there are.
static void table_range(const ty_input* input, float low, float high, float range[2])
{
    bool one = ty_input_is_constant(input) && input->value.r >= low;
    range[0] = one ? ty_min(input->value.r, high) : low;
    range[1] = one ? range[0] : high;
}

ty_albedo_table* ty_material_make_table(const ty_input* weight, const ty_input* roughness, const float eta[2])
{
    float range[2];
    if (ty_input_is_zero(weight) || eta[1] <= 1.0f)
        return NULL;
    table_range(roughness, 0.0f, 1.0f, range);
    return ty_albedo_table_create(range, eta);
}

// Between which indices the base reflects, by weight and coat.
static void shine_range(const ty_surface_def* s, const float ior[2], const float weight[2], const float coat[2],
                        float range[2])
{
    range[0] = 3.0f;
    range[1] = 1.0f;
    for (int i = 0; i < 8; i++)
    {
        float shine = ty_shine(ior[i & 1], weight[i >> 1 & 1], ty_lerp(1.0f, s->coat_ior, coat[i >> 2]));
        range[0] = ty_min(range[0], shine);
        range[1] = ty_max(range[1], shine);
    }
    if (coat[0] < coat[1]) // the coat may match the base in between
        range[0] = 1.0f;
}

static void make_layers(ty_material* m, const float roughness[2], float shine)
{
    const ty_surface_def* s = &m->surface;
    const float coat_eta[2] = {s->coat_ior, s->coat_ior};
    float coat[2], fuzz[2];
    table_range(&s->coat_roughness, 0.0f, 1.0f, coat);
    table_range(&s->fuzz_roughness, 0.0f, 1.0f, fuzz);
    m->coat = ty_material_make_table(&s->coat_weight, &s->coat_roughness, coat_eta);
    if (!ty_input_is_zero(&s->fuzz_weight))
        m->fuzz = ty_albedo_table_create_fuzz(fuzz);
    ty_lower_layer lower = {.roughness = {roughness[0], roughness[1]}};
    if (ty_input_is_zero(&s->base_metalness) && shine > 1.0f)
        lower.eta = shine;
    m->base_under_coat = ty_albedo_table_create_joint(&lower, m->coat, coat, s->coat_ior);
    lower.coat = m->coat;
    lower.coat_roughness = 0.5f * (coat[0] + coat[1]);
    lower.coat_eta = s->coat_ior;
    lower.coat_weight = s->coat_weight.value.r;
    m->base_under_fuzz = ty_albedo_table_create_joint(&lower, m->fuzz, fuzz, 1.0f);
    if (!m->coat)
        return;
    lower = (ty_lower_layer){.roughness = {coat[0], coat[1]}, .eta = s->coat_ior};
    m->coat_under_fuzz = ty_albedo_table_create_joint(&lower, m->fuzz, fuzz, 1.0f);
}

// Where index, weight or coat vary, what the film adds is that of their middle.
static void make_film(ty_material* m, const float roughness[2], const float ior[2], const float weight[2],
                      const float coat[2])
{
    const ty_surface_def* s = &m->surface;
    float thickness[2];
    table_range(&s->thin_film_thickness, 0.0f, 1000.0f, thickness);
    if (!ty_input_is_constant(&s->thin_film_thickness))
        thickness[1] = ty_min(thickness[1], s->thin_film_thickness.value.r * (fabsf(s->thin_film_thickness.offset) +
                                                                              fabsf(s->thin_film_thickness.scale)));
    if (ty_input_is_zero(&s->thin_film_weight) || !(thickness[1] > 0.0f))
        return;
    m->film_bands = ty_thin_film_bands_create();
    if (ty_input_is_constant(&s->base_metalness) && s->base_metalness.value.r >= 1.0f)
        return;
    float index = 0.5f * (ior[0] + ior[1]), cover = ty_lerp(1.0f, s->coat_ior, 0.5f * (coat[0] + coat[1]));
    ty_thin_film film = ty_thin_film_make(m->film_bands, 1.0f, 1.0f, s->thin_film_ior, 1.0f, cover, index);
    m->film =
        ty_thin_film_table_create(&film, roughness, thickness, ty_shine(index, 0.5f * (weight[0] + weight[1]), cover));
}

void ty_surface_make_tables(ty_material* m)
{
    const ty_surface_def* s = &m->surface;
    float roughness[2], ior[2], weight[2], coat[2], shine[2];
    if (m->matte)
        return;
    table_range(&s->specular_roughness, 0.0f, 1.0f, roughness);
    table_range(&s->specular_ior, 1.0f, 3.0f, ior);
    table_range(&s->specular_weight, 0.0f, 1.0f, weight);
    coat[0] = coat[1] = 0.0f;
    if (!ty_input_is_zero(&s->coat_weight))
        table_range(&s->coat_weight, 0.0f, 1.0f, coat);
    shine_range(s, ior, weight, coat, shine);
    m->specular = ty_material_make_table(&s->specular_weight, &s->specular_roughness, shine);
    make_layers(m, roughness, shine[1]);
    make_film(m, roughness, ior, weight, coat);
    if (roughness[1] < TY_SMOOTH_ROUGHNESS)
        return;
    bool metal = !ty_input_is_zero(&s->base_metalness) && !ty_input_is_zero(&s->specular_weight),
         clear = !ty_input_is_zero(&s->transmission_weight);
    if (metal || (clear && s->thin_walled))
        m->conductor = ty_loss_table_create_conductor(roughness[0], roughness[1]);
    if (clear && !s->thin_walled)
        m->dielectric = ty_loss_table_create_dielectric(roughness[0], roughness[1], ior[0], ior[1], weight[1],
                                                        ty_lerp(1.0f, s->coat_ior, coat[1]));
}
