// SPDX-License-Identifier: Apache-2.0
// Defaults and parameter tables of the materials.
#include "material_private.h"
#include <string.h>

ty_surface_def ty_surface_def_default(void)
{
    return (ty_surface_def){
        .base_weight = ty_input_scalar(1.0f),
        .base_color = ty_input_scalar(0.8f),
        .base_diffuse_roughness = ty_input_scalar(0.0f),
        .base_metalness = ty_input_scalar(0.0f),
        .specular_weight = ty_input_scalar(1.0f),
        .specular_color = ty_input_scalar(1.0f),
        .specular_roughness = ty_input_scalar(0.3f),
        .specular_ior = ty_input_scalar(1.5f),
        .specular_roughness_anisotropy = ty_input_scalar(0.0f),
        .specular_rotation = ty_input_scalar(0.0f),
        .transmission_weight = ty_input_scalar(0.0f),
        .transmission_color = ty_input_scalar(1.0f),
        .transmission_depth = 0.0f,
        .transmission_scatter = ty_input_scalar(0.0f),
        .coat_weight = ty_input_scalar(0.0f),
        .coat_color = ty_input_scalar(1.0f),
        .coat_roughness = ty_input_scalar(0.0f),
        .coat_roughness_anisotropy = ty_input_scalar(0.0f),
        .coat_rotation = ty_input_scalar(0.0f),
        .coat_ior = 1.6f,
        .coat_darkening = ty_input_scalar(1.0f),
        .fuzz_weight = ty_input_scalar(0.0f),
        .fuzz_color = ty_input_scalar(1.0f),
        .fuzz_roughness = ty_input_scalar(0.5f),
        .thin_film_weight = ty_input_scalar(0.0f),
        .thin_film_thickness = ty_input_scalar(0.5f),
        .thin_film_ior = 1.4f,
        .emission_luminance = ty_input_scalar(0.0f),
        .emission_color = ty_input_scalar(1.0f),
        .opacity = ty_input_scalar(1.0f),
        .subsurface_weight = ty_input_scalar(0.0f),
        .subsurface_color = ty_input_scalar(0.8f),
        .subsurface_radius = ty_input_scalar(1e-3f),
        .subsurface_radius_scale = ty_input_make(ty_rgb_make(1.0f, 0.5f, 0.25f)),
        .normal = ty_input_scalar(1.0f),
        .normal_strength = 1.0f,
        .bump = ty_input_scalar(0.0f),
    };
}

// Cooked rice.
ty_cdrf_def ty_cdrf_def_default(void)
{
    return (ty_cdrf_def){
        .color = ty_input_make(ty_rgb_make(0.80f, 0.79f, 0.73f)),
        .moisture = ty_moisture_inputs_default(),
        .cooked = -1.0f,
        .mean_free_path = ty_input_scalar(-1e-3f),
        .mean_free_path_scale = ty_input_scalar(1.0f),
        .kernel = TY_CDRF_POISSON,
        .evaluate = TY_CDRF_DEPTH,
        .specular_weight = ty_input_scalar(1.0f),
        .specular_roughness = ty_input_scalar(-1.0f),
        .specular_ior = 1.38f,
        .normal = ty_input_scalar(1.0f),
        .normal_strength = 1.0f,
        .bump = ty_input_scalar(0.0f),
        .calibration = ty_moisture_law_default(),
    };
}

ty_walk_def ty_walk_def_default(void)
{
    return (ty_walk_def){
        .common = ty_cdrf_def_default(),
        .scattering = ty_input_scalar(-1.0f),
        .absorption = ty_input_scalar(0.0f),
        .subsurface_color = ty_input_scalar(-1.0f),
        .subsurface_radius = ty_input_scalar(1e-3f),
        .subsurface_radius_scale = ty_input_scalar(1.0f),
    };
}

static void walk_default(void* def)
{
    *(ty_walk_def*)def = ty_walk_def_default();
}

static void surface_default(void* def)
{
    *(ty_surface_def*)def = ty_surface_def_default();
}

static void cdrf_default(void* def)
{
    *(ty_cdrf_def*)def = ty_cdrf_def_default();
}

#define ROW(field, kind, unit_, low, high, text)                                                                       \
    {                                                                                                                  \
        .name = #field, .type = kind, .unit = unit_, .minimum = low, .maximum = high, .offset = offsetof(DEF, field),  \
        .help = text                                                                                                   \
    }
#define SCALAR TY_PARAM_SCALAR_INPUT
#define COLOR TY_PARAM_COLOR_INPUT
#define NUMBER TY_PARAM_FLOAT

#define SWITCH TY_PARAM_BOOL
#define NORMAL_ROWS                                                                                                    \
    ROW(normal, TY_PARAM_VECTOR_INPUT, "", -100, 100,                                                                  \
        "normal map in tangent space, +y along v; value [1, -1, 1] for maps with -y"),                                 \
        ROW(normal_strength, NUMBER, "", 0, 100, "factor of the map's x and y"),                                       \
        ROW(bump, SCALAR, "m", -1000, 1000, "height along the normal, from a texture: scale is metres per unit")

static const char* const subsurface_names[] = {"depth", "walk", NULL};

#define DEF ty_surface_def
static const ty_param surface_rows[] = {
    ROW(base_weight, SCALAR, "", 0, 1, "factor of base_color"),
    ROW(base_color, COLOR, "", 0, 1, "albedo of the diffuse base, or reflectance of the metal"),
    ROW(base_diffuse_roughness, SCALAR, "", 0, 1, "0 = Lambert; rougher is flatter, as clay, and deeper in colour"),
    ROW(base_metalness, SCALAR, "", 0, 1, "0 = dielectric, 1 = metal"),
    ROW(specular_weight, SCALAR, "", 0, 1, "factor of the reflectance at normal incidence"),
    ROW(specular_color, COLOR, "", 0, 1, "tint of the dielectric reflection; of a metal at its edge, at 82 degrees"),
    ROW(specular_roughness, SCALAR, "", 0, 1, "GGX alpha is its square; below .02 it is a mirror"),
    ROW(specular_ior, SCALAR, "", 1, 3, "refractive index of the dielectric"),
    ROW(specular_roughness_anisotropy, SCALAR, "", 0, 1, "stretches highlights: smoother along the texture's v than u"),
    ROW(specular_rotation, SCALAR, "deg", -360, 360, "turns that direction about the normal"),
    ROW(transmission_weight, SCALAR, "", 0, 1, "share of the dielectric base that is clear instead of diffuse"),
    ROW(transmission_color, COLOR, "", 0, 1, "tint over transmission_depth, or per surface where that is 0"),
    ROW(transmission_depth, NUMBER, "m", 0, 1000, "way through the body after which transmission_color is reached"),
    ROW(transmission_scatter, COLOR, "", 0, 1000,
        "scatterings in transmission_depth: mist in the body; what colour and it leave lacks absorbs nothing"),
    ROW(transmission_scatter_anisotropy, NUMBER, "", -0.99, 0.99, "their mean cosine: forward positive"),
    ROW(coat_weight, SCALAR, "", 0, 1, "strength of the clear coat"),
    ROW(coat_color, COLOR, "", 0, 1, "what the coat leaves of light that goes straight through it and back"),
    ROW(coat_roughness, SCALAR, "", 0, 1, "roughness of the coat"),
    ROW(coat_roughness_anisotropy, SCALAR, "", 0, 1, "stretches the coat's highlights as those of the base"),
    ROW(coat_rotation, SCALAR, "deg", -360, 360, "turns that direction about the normal"),
    ROW(coat_ior, NUMBER, "", 1, 3, "refractive index of the coat"),
    ROW(coat_darkening, SCALAR, "", 0, 1,
        "how much of the light counts that the coat sends back onto the base: deeper colour"),
    ROW(fuzz_weight, SCALAR, "", 0, 1, "cover of fine fibres or dust over all else"),
    ROW(fuzz_color, COLOR, "", 0, 1, "albedo of the fibres"),
    ROW(fuzz_roughness, SCALAR, "", 0, 1, "0 = upright, seen at edges alone; 1 = as dust, seen all over"),
    ROW(thin_film_weight, SCALAR, "", 0, 1, "cover of a film in which light interferes, over metal or dielectric"),
    ROW(thin_film_thickness, SCALAR, "um", 0, 1000, "its thickness: fringes of colour up to about 2, then none"),
    ROW(thin_film_ior, NUMBER, "", 1, 3, "its refractive index"),
    ROW(emission_luminance, SCALAR, "W/(m^2 sr)", 0, 1e9, "radiance emitted on the outer side, beneath coat and fuzz"),
    ROW(emission_color, COLOR, "", 0, 1000, "colour of the emission"),
    ROW(opacity, SCALAR, "", 0, 1, "0 = light passes as if nothing were there; shadows follow"),
    ROW(thin_walled, SWITCH, "", 0, 0, "a sheet without inside: a pane, a soap film, a leaf"),
    ROW(subsurface_weight, SCALAR, "", 0, 1,
        "share of the diffuse base that light enters, of thin sheets shines through"),
    ROW(subsurface_color, COLOR, "", 0, 1, "albedo of that share, of thin sheets both sides together"),
    ROW(subsurface_radius, SCALAR, "mm", 1e-6, 1e6, "mean free path within a body"),
    ROW(subsurface_radius_scale, COLOR, "", 1e-6, 1e6, "its factor by channel"),
    ROW(subsurface_anisotropy, NUMBER, "", -1, 1,
        "mean cosine of the scattering, up to .99 either way; of thin sheets -1 all back, 0 evenly, 1 all through"),
    {.name = "subsurface_evaluate",
     .type = TY_PARAM_ENUM,
     .unit = "",
     .choices = subsurface_names,
     .offset = offsetof(ty_surface_def, subsurface_evaluate),
     .help = "depth: a short ray inside, as cdrf; walk: a random walk"},
    ROW(priority, TY_PARAM_INT, "", -1000, 1000,
        "where clear bodies overlap the highest is there; of equals the one entered last"),
    NORMAL_ROWS,
};
#undef DEF

static const char* const kernel_names[] = {"poisson", "gaussian", "gaussian_published", NULL};
static const char* const curvature_names[] = {"automatic", "mean", "directional", "maximal", NULL};
static const char* const evaluate_names[] = {"depth", "probe", "local", NULL};

#define DEF ty_cdrf_def
static const ty_param cdrf_rows[] = {
    ROW(color, COLOR, "", 0, 1, "share of the entered light that leaves again"),
    {.name = "moisture",
     .type = TY_PARAM_BRIEF_GROUP,
     .unit = "",
     .group = &ty_moisture_table,
     .offset = offsetof(ty_cdrf_def, moisture),
     .help = "water per total mass: rice is .145 raw, .31 soaked, .62 cooked; or how it got there"},
    ROW(cooked, NUMBER, "", -1, 1, "degree of gelatinisation, unless moisture says it; negative: follows from it"),
    ROW(mean_free_path, SCALAR, "mm", -1, 1000, "transport mean free path; negative: from moisture"),
    ROW(mean_free_path_scale, COLOR, "", 0, 1000, "its factor per channel: red goes farther in skin and fruit"),
    {.name = "kernel",
     .type = TY_PARAM_ENUM,
     .unit = "",
     .choices = kernel_names,
     .offset = offsetof(ty_cdrf_def, kernel),
     .help = "poisson fits random walks best; gaussian as published, normalised or not"},
    {.name = "evaluate",
     .type = TY_PARAM_ENUM,
     .unit = "",
     .choices = evaluate_names,
     .offset = offsetof(ty_cdrf_def, evaluate),
     .help = "depth: a short ray inside; probe: from the osculating sphere; local: no ray"},
    {.name = "curvature",
     .type = TY_PARAM_ENUM,
     .unit = "",
     .choices = curvature_names,
     .offset = offsetof(ty_cdrf_def, curvature),
     .help = "which of a point's curvatures counts; automatic: directional for local, mean for the others"},
    ROW(specular_weight, SCALAR, "", 0, 1, "strength of the reflection at the surface; less where it is dry"),
    ROW(specular_roughness, SCALAR, "", -1, 1, "roughness of the reflection; negative: from moisture"),
    ROW(specular_ior, NUMBER, "", 1, 3, "refractive index of the surface"),
    NORMAL_ROWS,
    {.name = "calibration",
     .type = TY_PARAM_GROUP,
     .unit = "",
     .group = &ty_moisture_law_table,
     .offset = offsetof(ty_cdrf_def, calibration),
     .help = "what moisture means in optics: a file that `tsuya calibrate` wrote, or its mapping"},
};
#undef DEF

static const char* const boundary_names[] = {"diffuse", "dielectric", NULL};
const char* const ty_walk_preset_names[] = {"none",      "apple", "chicken",  "cream",      "marble", "potato",
                                            "skim_milk", "skin",  "soy_milk", "whole_milk", NULL};

#define DEF ty_walk_def
static const ty_param walk_rows[] = {
    {.name = "boundary",
     .type = TY_PARAM_ENUM,
     .unit = "",
     .choices = boundary_names,
     .offset = offsetof(ty_walk_def, boundary),
     .help = "diffuse: light enters and leaves by the cosine, as cdrf means it; dielectric: refracted and reflected"},
    {.name = "preset",
     .type = TY_PARAM_ENUM,
     .unit = "",
     .choices = ty_walk_preset_names,
     .offset = offsetof(ty_walk_def, preset),
     .help = "measured scattering and absorption of a substance"},
    ROW(scattering, COLOR, "1/mm", -1, 1e6, "reduced scattering coefficient; negative: not given"),
    ROW(absorption, COLOR, "1/mm", 0, 1e6, "absorption coefficient, beside scattering"),
    ROW(anisotropy, NUMBER, "", -0.99, 0.99,
        "of the Henyey-Greenstein phase function: mean cosine; transport lengths stay, subsurface_radius is unreduced"),
    ROW(subsurface_color, COLOR, "", -1, 1, "diffuse reflectance of a thick body; negative: not given"),
    ROW(subsurface_radius, SCALAR, "mm", 1e-6, 1e6, "mean free path, beside subsurface_color"),
    ROW(subsurface_radius_scale, COLOR, "", 1e-6, 1e6, "its factor by channel"),
};
#undef DEF

const ty_param_table* ty_surface_params(void)
{
    static const ty_param_table table = {
        .name = "material.surface",
        .help = "Layered surface with the names of OpenPBR: fuzz over a coat over metal, diffuse or clear dielectric.",
        .size = sizeof(ty_surface_def),
        .set_default = surface_default,
        .params = surface_rows,
        .count = TY_PARAM_COUNT(surface_rows),
    };
    return &table;
}

const ty_param_table* ty_cdrf_params(void)
{
    static const ty_param_table table = {
        .name = "material.cdrf",
        .help = "Translucent matter by curvature reflectance, driven by moisture; for closed objects.",
        .size = sizeof(ty_cdrf_def),
        .set_default = cdrf_default,
        .params = cdrf_rows,
        .count = TY_PARAM_COUNT(cdrf_rows),
    };
    return &table;
}

// The rows of `cdrf` first, but for those that only its kernels have.
static int fill_walk_rows(ty_param* rows)
{
    int count = 0;
    for (int i = 0; i < TY_PARAM_COUNT(cdrf_rows); ++i)
    {
        if (strcmp(cdrf_rows[i].name, "kernel") == 0 || strcmp(cdrf_rows[i].name, "evaluate") == 0 ||
            strcmp(cdrf_rows[i].name, "curvature") == 0)
            continue;
        rows[count] = cdrf_rows[i];
        rows[count++].offset += offsetof(ty_walk_def, common);
    }
    for (int i = 0; i < TY_PARAM_COUNT(walk_rows); ++i)
        rows[count++] = walk_rows[i];
    return count;
}

const ty_param_table* ty_walk_params(void)
{
    static ty_param rows[TY_PARAM_COUNT(cdrf_rows) + TY_PARAM_COUNT(walk_rows)];
    static ty_param_table table = {
        .name = "material.walk",
        .help =
            "Translucent matter by random walks within each closed object: what cdrf is measured by. Keys that only "
            "cdrf has are read over, so that `model` alone changes one into the other.",
        .size = sizeof(ty_walk_def),
        .set_default = walk_default,
        .params = rows,
    };
    table.count = fill_walk_rows(rows); // the same values at each call
    return &table;
}
