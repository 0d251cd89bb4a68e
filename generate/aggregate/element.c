// SPDX-License-Identifier: Apache-2.0
// Elements of every kind: the sizes that a kind has, its mesh and balls, and what the solid weighs.
#include "balls.h"
#include "element_kinds.h"
#include "roe.h"
#include <string.h>

ty_element_def ty_element_def_default(void)
{
    return (ty_element_def){.kind = TY_ELEMENT_RICE,
                            .ratio = 1.0f,
                            .variation = 0.06f,
                            .variants = 16,
                            .notch = 0.15f,
                            .grain = ty_grain_def_default(),
                            .roe = {.lean = TY_PI / 4.0f, .buoyancy = 110.0f, .viscosity = 0.02f, .press = 0.012f}};
}

// --- sizes ---

// Cooked grains. Lengths of indica and aromatic rice stand to japonica's as 1.8 and .7, swollen by 1.2 and 1.5 of the
// volume against 1.5: (1.2 / 1.5)^(1/3) of every size of indica.
static const ty_vec3 rice_sizes[] = {
    [TY_CULTIVAR_JAPONICA] = {7.2e-3f, 3.0e-3f, 2.5e-3f},
    [TY_CULTIVAR_INDICA] = {12.0e-3f, 2.78e-3f, 2.32e-3f},
    [TY_CULTIVAR_AROMATIC] = {5.04e-3f, 3.0e-3f, 2.5e-3f},
    [TY_CULTIVAR_GLUTINOUS] = {6.6e-3f, 3.2e-3f, 2.75e-3f},
};

static const ty_vec3 bean_sizes[] = {
    [TY_BEAN_RED] = {16.0e-3f, 8.2e-3f, 6.6e-3f},
    [TY_BEAN_BLACK] = {10.0e-3f, 6.6e-3f, 5.0e-3f},
    [TY_BEAN_WHITE] = {8.5e-3f, 6.0e-3f, 5.4e-3f},
};

static const ty_vec3 other_sizes[] = {
    [TY_ELEMENT_BALL] = {10.0e-3f, 10.0e-3f, 10.0e-3f},  [TY_ELEMENT_ICE] = {3.0e-3f, 2.4e-3f, 1.1e-3f},
    [TY_ELEMENT_GRAPE] = {24.0e-3f, 20.5e-3f, 20.5e-3f}, [TY_ELEMENT_TOFU] = {12.0e-3f, 12.0e-3f, 12.0e-3f},
    [TY_ELEMENT_PEBBLE] = {14.0e-3f, 10.5e-3f, 7.0e-3f}, [TY_ELEMENT_MESH] = {10.0e-3f, 10.0e-3f, 10.0e-3f},
};

static ty_vec3 kind_size(const ty_element_def* def)
{
    if (def->kind == TY_ELEMENT_RICE)
        return rice_sizes[def->cultivar];
    return def->kind == TY_ELEMENT_BEAN ? bean_sizes[def->bean] : other_sizes[def->kind];
}

static ty_status sizes_check(const ty_element_def* e, const char* name, ty_error* error)
{
    const double mm = 1e3;
    double length = (double)e->length * mm, width = (double)e->width * mm, thickness = (double)e->thickness * mm;
    double thinnest = e->kind == TY_ELEMENT_RICE ? 0.5 : 0.2;
    if (!(width >= 0.1 && length >= width && length <= 12.0 * width))
        return ty_error_set(error, TY_BAD_INPUT, "%s.length: %g mm; with a width of %g mm it lies in %g..%g", name,
                            length, width, width, 12.0 * width);
    if (!(thickness >= thinnest * width && thickness <= width))
        return ty_error_set(error, TY_BAD_INPUT, "%s.thickness: %g mm; with a width of %g mm it lies in %g..%g", name,
                            thickness, width, thinnest * width, width);
    float swelling = e->grain.swelling;
    if (swelling != 0.0f && !(swelling >= 1.0f && swelling <= 1.5f))
        return ty_error_set(error, TY_BAD_INPUT, "%s.grain.swelling: %g; it is 0 or lies in 1..1.5", name,
                            (double)swelling);
    if (e->fit > 0.0f && !(e->fit >= 0.01f))
        return ty_error_set(error, TY_BAD_INPUT, "%s.fit: %g; it is 0 or lies in 0.01..0.2", name, (double)e->fit);
    if (e->divisions < 4 || e->divisions > 64)
        return ty_error_set(error, TY_BAD_INPUT, "%s.divisions: %d; it is 0 or lies in 4..64", name, e->divisions);
    if (e->variants < 1 || e->variants > TY_ELEMENT_MAX_VARIANTS)
        return ty_error_set(error, TY_BAD_INPUT, "%s.variants: %d; it lies in 1..%d", name, e->variants,
                            TY_ELEMENT_MAX_VARIANTS);
    return TY_OK;
}

// Sizes that are not said follow those that are; of rice they are the cultivar's.
static void sizes_complete(ty_element_def* def)
{
    ty_vec3 size = kind_size(def);
    float share = def->length > 0.0f  ? def->length / size.x
                  : def->width > 0.0f ? def->width / size.y
                                      : def->thickness / size.z;
    if (share <= 0.0f || def->kind == TY_ELEMENT_RICE)
        share = 1.0f;
    def->length = def->length > 0.0f ? def->length : share * size.x;
    def->width = def->width > 0.0f ? def->width : share * size.y;
    def->thickness = def->thickness > 0.0f ? def->thickness : share * size.z;
}

// Ten balls are within 5 % of the width of a grain of japonica, and a bowl of them takes .6 of the time of one within
// 3 %; all other elements are met within 3 %.
static float kind_fit(const ty_element_def* def)
{
    bool ten = def->kind == TY_ELEMENT_RICE && def->cultivar == TY_CULTIVAR_JAPONICA && def->model == TY_RICE_FORMULA;
    return ten ? 0.0f : 0.03f;
}

ty_status ty_element_complete(ty_element_def* def, const char* name, ty_error* error)
{
    def->fit = def->fit > 0.0f ? def->fit : kind_fit(def);
    if (def->divisions == 0) // pores of a field are fine
        def->divisions = def->kind == TY_ELEMENT_RICE && def->model == TY_RICE_FIELD ? 24 : 9;
    if (def->kind == TY_ELEMENT_ROE)
        return ty_roe_complete(def, error);
    if (def->kind == TY_ELEMENT_MESH)
        return ty_solid_complete(def, name, error);
    sizes_complete(def);
    if (def->kind == TY_ELEMENT_BALL)
    {
        def->width = def->thickness = def->length;
        def->variants = 1;
    }
    return sizes_check(def, name, error);
}

// --- making ---

ty_status ty_element_init(const ty_element_def* def, ty_seed seed, int variant, ty_element* out, ty_error* error)
{
    memset(out, 0, sizeof *out);
    ty_element_def complete = *def;
    ty_status status = ty_element_complete(&complete, "element", error);
    if (status != TY_OK)
        return status;
    if (complete.kind == TY_ELEMENT_ROE)
        return ty_roe_init(&complete, out, error);
    if (complete.kind == TY_ELEMENT_RICE)
        return (complete.model == TY_RICE_FIELD ? ty_rice_field_init : ty_rice_init)(&complete, seed, variant, out,
                                                                                     error);
    status = complete.kind == TY_ELEMENT_ICE ? ty_ice_mesh(&complete, seed, variant, &out->mesh, error)
                                             : ty_solid_mesh(&complete, seed, variant, &out->mesh, error);
    if (status == TY_OK)
    {
        (void)ty_element_weigh(out);
        ty_mesh_compute_bounds(out->mesh);
        status = ty_element_fit(out, complete.fit, error);
    }
    if (status != TY_OK)
    {
        ty_element_term(out);
        return status;
    }
    ty_element_enclose(out);
    return TY_OK;
}
