// SPDX-License-Identifier: Apache-2.0
// Files of `tsuya calibrate`: the law it writes, and the states it is told.
#include "loader.h"
#include <string.h>
#include <tsuya/scene/calibration.h>
#include <tsuya/shading/material.h>

static void state_default(void* def)
{
    *(ty_optical_state*)def = (ty_optical_state){
        .wet_basis = 0.62f, .cooked = 1.0f, .mean_free_path = 0.7e-3f, .albedo = 1.0f, .anisotropy = 0.0f, .ior = 1.0f};
}

#define ROW(field, unit_, low, high, must, text)                                                                       \
    {                                                                                                                  \
        .name = #field, .type = TY_PARAM_FLOAT, .unit = unit_, .minimum = low, .maximum = high,                        \
        .offset = offsetof(ty_optical_state, field), .required = must, .help = text                                    \
    }

static const ty_param state_rows[] = {
    ROW(wet_basis, "", 0.05, 1, true, "water per total mass"),
    ROW(cooked, "", 0, 1, false, "degree of gelatinisation"),
    ROW(mean_free_path, "mm", 0.001, 100, true, "transport mean free path, 1 / (mu_s' + mu_a)"),
    ROW(albedo, "", 0.5, 1, false, "mu_s' / (mu_s' + mu_a)"),
    ROW(anisotropy, "", -0.95, 0.95, false, "g of the phase function"),
    ROW(ior, "", 1, 2, false, "refractive index; 1: light leaves freely, as the law of cdrf has it"),
};

static const ty_param_table state_table = {
    .name = "measured.state",
    .help = "Optics at one moisture.",
    .size = sizeof(ty_optical_state),
    .set_default = state_default,
    .params = state_rows,
    .count = TY_PARAM_COUNT(state_rows),
};

typedef struct measured_def
{
    ty_param_list states;
} measured_def;

static void measured_default(void* def)
{
    *(measured_def*)def = (measured_def){0};
}

static const ty_param measured_rows[] = {
    {.name = "states",
     .type = TY_PARAM_LIST,
     .unit = "",
     .group = &state_table,
     .offset = offsetof(measured_def, states),
     .help = "at most 64",
     .required = true},
};

static const ty_param_table measured_table = {
    .name = "measured",
    .help = "A file for `tsuya calibrate`: what was measured of matter at some moistures.",
    .size = sizeof(measured_def),
    .set_default = measured_default,
    .params = measured_rows,
    .count = TY_PARAM_COUNT(measured_rows),
};

const ty_param_table* ty_optical_states_params(void)
{
    return &measured_table;
}

// A file of one table; what out lists is in arena. Its tree, NULL after a report.
static const ty_node* read_file(const char* path, const ty_param_table* table, void* out, ty_arena* arena,
                                ty_error_list* errors)
{
    char folder[TY_PATH_MAX];
    ty_path_folder(path, folder);
    ty_tree tree = {.arena = arena, .errors = errors};
    ty_files files = {.arena = arena, .errors = errors, .folder = ty_arena_string(arena, folder)};
    ty_reader reader = {.arena = arena, .errors = errors, .files = &files};
    ty_node* root = ty_document_load(&tree, &files, path, "", NULL);
    int first = errors->count;
    if (!root)
        return NULL;
    ty_document_take_version(&tree, root);
    return ty_params_read(&reader, root, table, out, NULL) && errors->count == first ? root : NULL;
}

static bool check_count(const ty_node* root, int count, ty_error_list* errors)
{
    if (count >= 1 && count <= TY_CALIBRATION_MOST_STATES)
        return true;
    ty_report(errors, ty_node_get(root, "states")->place, TY_BAD_INPUT, "'states': expected 1..%d of them, got %d",
              TY_CALIBRATION_MOST_STATES, count);
    return false;
}

ty_status ty_calibration_load(const char* path, ty_moisture_law* out, ty_error_list* errors)
{
    ty_arena* arena = ty_arena_create(0);
    int first = errors->count;
    bool good = read_file(path, ty_moisture_law_params(), out, arena, errors);
    ty_arena_destroy(arena);
    return good ? TY_OK : ty_loader_status(errors, first);
}

ty_status ty_optical_states_load(const char* path, ty_optical_state** out, int* count, ty_error_list* errors)
{
    ty_arena* arena = ty_arena_create(0);
    measured_def def = {0};
    int first = errors->count;
    const ty_node* root = read_file(path, &measured_table, &def, arena, errors);
    bool good = root && check_count(root, def.states.count, errors);
    *out = NULL;
    *count = 0;
    if (good)
    {
        *count = def.states.count;
        *out = TY_ALLOC(ty_optical_state, *count);
        memcpy(*out, def.states.items, (size_t)*count * sizeof(ty_optical_state));
    }
    ty_arena_destroy(arena);
    return good ? TY_OK : ty_loader_status(errors, first);
}
