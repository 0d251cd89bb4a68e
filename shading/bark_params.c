// SPDX-License-Identifier: Apache-2.0
// The material `bark`: defaults, table, and the surface that it becomes.
#include "material_private.h"

ty_bark_def ty_bark_def_default(void)
{
    return (ty_bark_def){
        .young_color = ty_input_make(ty_rgb_make(0.33f, 0.275f, 0.205f)),
        .old_color = ty_input_make(ty_rgb_make(0.215f, 0.2f, 0.178f)),
        .crease_color = ty_input_make(ty_rgb_make(0.062f, 0.046f, 0.034f)),
        .size = 0.012f,
        .depth = 4e-4f,
        .wrinkles = 0.7f,
        .lenticels = 0.6f,
        .creases = 0.7f,
        .age = ty_input_scalar(0.5f),
        .radius = ty_input_scalar(5e-3f),
        .join = ty_input_scalar(0.0f),
        .lichen = ty_input_scalar(0.0f),
        .lichen_color = ty_input_make(ty_rgb_make(0.36f, 0.4f, 0.31f)),
        .moisture = ty_input_scalar(0.0f),
        .specular_roughness = ty_input_scalar(0.62f),
        .specular_weight = ty_input_scalar(0.8f),
    };
}

static void bark_default(void* def)
{
    *(ty_bark_def*)def = ty_bark_def_default();
}

#define ROW(field, kind, unit_, low, high, text)                                                                       \
    {                                                                                                                  \
        .name = #field, .type = kind, .unit = unit_, .minimum = low, .maximum = high,                                  \
        .offset = offsetof(ty_bark_def, field), .help = text                                                           \
    }
#define SCALAR TY_PARAM_SCALAR_INPUT
#define COLOR TY_PARAM_COLOR_INPUT
#define NUMBER TY_PARAM_FLOAT

static const ty_param rows[] = {
    ROW(young_color, COLOR, "", 0, 1, "of young, smooth bark"),
    ROW(old_color, COLOR, "", 0, 1, "of old bark"),
    ROW(crease_color, COLOR, "", 0, 1, "at the bottom of fissures"),
    ROW(size, NUMBER, "mm", 1e-3, 1e6, "of a patch; fissures, wrinkles and lenticels are in proportion"),
    ROW(depth, NUMBER, "mm", 0, 1e6, "of the relief; 0 = smooth"),
    ROW(wrinkles, NUMBER, "", 0, 1, "fine rings across the root"),
    ROW(lenticels, NUMBER, "", 0, 1, "pale pores, wider than high"),
    ROW(creases, NUMBER, "", 0, 1, "dark fissures along the root; the older the deeper"),
    ROW(age, SCALAR, "", 0, 1, "0 young .. 1 old: { attribute: radius, scale: 100 } is old where it is thick"),
    ROW(radius, SCALAR, "mm", 0, 1e6, "of the root, for patterns about it: { value: 1000, attribute: radius }"),
    ROW(join, SCALAR, "", 0, 1, "where roots meet: 1 = patterns lie in space, not along one of them"),
    ROW(lichen, SCALAR, "", 0, 1, "how much of old bark it covers"),
    ROW(lichen_color, COLOR, "", 0, 1, "its colour, most often a fill along three axes"),
    ROW(moisture, SCALAR, "", 0, 1, "0 dry .. 1 dripping: darker, and glossy in runs along the root"),
    ROW(specular_roughness, SCALAR, "", 0, 1, "of dry bark"),
    ROW(specular_weight, SCALAR, "", 0, 1, "factor of the reflectance at normal incidence"),
};

const ty_param_table* ty_bark_params(void)
{
    static const ty_param_table table = {
        .name = "material.bark",
        .help = "Layered bark along roots and stems by their uv (turns about, metres along): patches, fissures, "
                "wrinkles, lenticels, lichen and water.",
        .size = sizeof(ty_bark_def),
        .set_default = bark_default,
        .params = rows,
        .count = TY_PARAM_COUNT(rows),
    };
    return &table;
}

ty_status ty_material_create_bark(const ty_bark_def* def, ty_material** out, ty_error* error)
{
    *out = NULL;
    if (!(def->size > 0.0f))
        return ty_error_set(error, TY_BAD_INPUT, "size is %g mm: it must be above 0", 1e3 * (double)def->size);
    if (!(def->depth >= 0.0f))
        return ty_error_set(error, TY_BAD_INPUT, "depth is %g mm: it must not be below 0", 1e3 * (double)def->depth);
    ty_surface_def surface = ty_surface_def_default();
    surface.specular_ior = ty_input_scalar(1.45f);
    surface.specular_weight = def->specular_weight;
    surface.specular_roughness = def->specular_roughness;
    // Water makes it smoother from place to place: as if it were an attribute, so that tables hold all of the range.
    if (!ty_input_is_zero(&def->moisture))
        surface.specular_roughness.attribute_index = 0;
    ty_status status = ty_material_create_surface(&surface, out, error);
    if (status != TY_OK)
        return status;
    (*out)->bark = *def;
    (*out)->is_bark = true;
    (*out)->matte = false;
    (*out)->bent = def->depth > 0.0f;
    (*out)->base_is_constant = false;
    return TY_OK;
}
