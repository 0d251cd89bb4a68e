// SPDX-License-Identifier: Apache-2.0
// Moisture as scenes write it: its table, and the state at a point.
#include "material_private.h"

ty_moisture_inputs ty_moisture_inputs_default(void)
{
    return (ty_moisture_inputs){
        .wet_basis = ty_input_scalar(0.62f),
        .uptake = ty_input_scalar(0.0f),
        .soak = {.minutes = ty_input_scalar(60.0f), .celsius = ty_input_scalar(10.0f)},
        .cooked = ty_input_scalar(-1.0f),
        .gradient = ty_input_scalar(0.0f),
        .source = TY_MOISTURE_WET_BASIS,
    };
}

static bool is_constant(const ty_input* input)
{
    return input->texture_index < 0 && input->attribute_index < 0;
}

bool ty_moisture_inputs_are_constant(const ty_moisture_inputs* m)
{
    return is_constant(&m->wet_basis) && is_constant(&m->uptake) && is_constant(&m->soak.minutes) &&
           is_constant(&m->soak.celsius) && is_constant(&m->cooked) && is_constant(&m->gradient);
}

// What a gradient adds goes no further than its value: an attribute that runs on, as depth does, has its end in it.
static float gradient_at(const ty_input* gradient, const ty_shading_context* context, const ty_surface_point* point)
{
    float full = gradient->value.r, added = ty_input_float(gradient, context, point);
    if (is_constant(gradient))
        return full;
    return ty_clamp(added, ty_min(full, 0.0f), ty_max(full, 0.0f));
}

ty_moisture ty_moisture_at(const ty_moisture_inputs* m, const ty_shading_context* context,
                           const ty_surface_point* point)
{
    ty_moisture_def def = ty_moisture_def_default();
    switch ((ty_moisture_source)m->source)
    {
    case TY_MOISTURE_WET_BASIS:
        def.wet_basis = ty_clamp(ty_input_float(&m->wet_basis, context, point), 0.0f, 1.0f);
        break;
    case TY_MOISTURE_UPTAKE:
        def.wet_basis = ty_moisture_wet_basis(ty_max(ty_input_float(&m->uptake, context, point), 0.0f));
        break;
    case TY_MOISTURE_SOAK:
        def.wet_basis = -1.0f;
        def.soak_minutes = ty_input_float(&m->soak.minutes, context, point);
        def.soak_celsius = ty_clamp(ty_input_float(&m->soak.celsius, context, point), 0.0f, 60.0f);
        break;
    }
    def.cooked = ty_input_float(&m->cooked, context, point);
    ty_moisture state = ty_moisture_make(&def);
    float wet = state.wet_basis + gradient_at(&m->gradient, context, point);
    state.wet_basis = ty_clamp(wet, ty_moisture_wet_basis(-1.0f), 1.0f);
    return state;
}

static void moisture_default(void* def)
{
    *(ty_moisture_inputs*)def = ty_moisture_inputs_default();
}

static void soak_default(void* def)
{
    *(ty_soak_inputs*)def = ty_moisture_inputs_default().soak;
}

#define ROW(field, unit_, low, high, text)                                                                             \
    {                                                                                                                  \
        .name = #field, .type = TY_PARAM_SCALAR_INPUT, .unit = unit_, .minimum = low, .maximum = high,                 \
        .offset = offsetof(DEF, field), .help = text                                                                   \
    }

#define DEF ty_soak_inputs
static const ty_param soak_rows[] = {
    ROW(minutes, "min", 0, 1e6, "time in water: at 10 degrees 69 % of all it takes up in 20, 97 % in 60"),
    ROW(celsius, "C", 0, 60, "temperature of the water: ten degrees warmer is 1.45 times as fast"),
};
#undef DEF

static const ty_param_table soak_table = {
    .name = "moisture.soak",
    .help = "Raw grains in water, with the uptake of rice: .24 of the raw mass at most.",
    .size = sizeof(ty_soak_inputs),
    .set_default = soak_default,
    .params = soak_rows,
    .count = TY_PARAM_COUNT(soak_rows),
};

#define DEF ty_moisture_inputs
static const ty_param moisture_rows[] = {
    ROW(wet_basis, "", 0, 1, "water per total mass: rice is .145 raw, .31 soaked, .62 cooked; below .05 is .05"),
    ROW(uptake, "", 0, 10, "instead: water taken up per raw mass; 0 raw, .24 soaked, 1.25 cooked"),
    {.name = "soak",
     .type = TY_PARAM_GROUP,
     .unit = "",
     .group = &soak_table,
     .offset = offsetof(ty_moisture_inputs, soak),
     .help = "instead: by time and temperature; what is cooked then takes up water to .62"},
    ROW(cooked, "", -1, 1,
        "degree of gelatinisation; negative: of soaked grains 0, else 0 below .31 to 1 above .45 of wet basis"),
    ROW(gradient, "", -1, 1,
        "added to the wet basis, from 0 to its value: { value: -0.2, attribute: height } is drier on top"),
};
#undef DEF

const ty_param_table ty_moisture_table = {
    .name = "moisture",
    .help = "How wet and how cooked: one of wet_basis, uptake and soak, each also by instance, vertex or texture.",
    .size = sizeof(ty_moisture_inputs),
    .set_default = moisture_default,
    .params = moisture_rows,
    .count = TY_PARAM_COUNT(moisture_rows),
};

const ty_param_table* ty_soak_params(void)
{
    return &soak_table;
}

const ty_param_table* ty_moisture_params(void)
{
    return &ty_moisture_table;
}

// --- the law, as calibration writes it ---

static void law_default(void* def)
{
    *(ty_moisture_law*)def = ty_moisture_law_default();
}

#define LAW(field, unit_, low, high, text)                                                                             \
    {                                                                                                                  \
        .name = #field, .type = TY_PARAM_FLOAT, .unit = unit_, .minimum = low, .maximum = high,                        \
        .offset = offsetof(ty_moisture_law, field), .help = text                                                       \
    }

static const ty_param law_rows[] = {
    LAW(cooked_constant, "", -10, 10, "of cooked matter: ln(mean free path / mm) = constant + exponent ln(wet basis)"),
    LAW(cooked_exponent, "", -10, 10, "likewise"),
    LAW(raw_length, "mm", 0.0001, 1000, "mean free path of raw grains, wet basis .145"),
    LAW(soaked_length, "mm", 0.0001, 1000, "the same soaked, wet basis .31; by the logarithm between"),
    LAW(sigma_constant, "", -10, 10, "of gaussian_published: ln(sigma_0 / mm) = constant + exponent ln(wet basis)"),
    LAW(sigma_exponent, "", -10, 10, "likewise"),
    LAW(rms, "", 0, 10, "error of the fit, a fully lit matte point being 1; changes nothing"),
};

const ty_param_table ty_moisture_law_table = {
    .name = "calibration",
    .help = "From moisture to optics. What a file of `tsuya calibrate` does not say is as in the law of rice.",
    .size = sizeof(ty_moisture_law),
    .set_default = law_default,
    .params = law_rows,
    .count = TY_PARAM_COUNT(law_rows),
};

const ty_param_table* ty_moisture_law_params(void)
{
    return &ty_moisture_law_table;
}
