// SPDX-License-Identifier: Apache-2.0
// `tsuya calibrate`: the law of moisture fitted to random walks in spheres, as a file that materials name.
#include "cli.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/scene/calibration.h>

// The law's own states: what is fitted to them should be the law again.
static const ty_moisture usual[] = {{0.145f, 1}, {0.2f, 1},   {0.31f, 1}, {0.45f, 1},
                                    {0.62f, 1},  {0.145f, 0}, {0.31f, 0}};

typedef struct job
{
    ty_calibration_def def;
    ty_optical_state* states; // owned
    float radii[TY_CALIBRATION_MOST_RADII];
    ty_workers* workers;
    ty_calibration_fit fit;
} job;

static ty_status read_states(const ty_arguments* arguments, job* j)
{
    if (arguments->positional_count)
    {
        ty_error_list errors = {0};
        ty_status status = ty_optical_states_load(arguments->positional[0], &j->states, &j->def.state_count, &errors);
        ty_errors_log(&errors);
        return status;
    }
    j->def.state_count = (int)(sizeof usual / sizeof usual[0]);
    j->states = TY_ALLOC(ty_optical_state, j->def.state_count);
    for (int i = 0; i < j->def.state_count; i++)
    {
        ty_moisture_optics optics = ty_moisture_optics_make(usual[i]);
        j->states[i] = (ty_optical_state){usual[i].wet_basis, usual[i].cooked, optics.mean_free_path, 1, 0, 1};
    }
    return TY_OK;
}

// What is said for all states: numbers of their table, under the same names.
static ty_status read_common(const ty_arguments* arguments, job* j)
{
    const ty_param_table* table = ty_optical_states_params()->params[0].group;
    for (int k = 0; k < table->count; k++)
    {
        const ty_param* row = &table->params[k];
        double value;
        if (!ty_argument_has(arguments, row->name))
            continue;
        ty_status status = ty_argument_float(arguments, row->name, row->minimum, row->maximum, &value);
        if (status != TY_OK)
            return status;
        for (int i = 0; i < j->def.state_count; i++)
            *(float*)((char*)&j->states[i] + row->offset) = (float)value;
    }
    return TY_OK;
}

static ty_status read_walks(const ty_arguments* arguments, job* j)
{
    double radii[TY_CALIBRATION_MOST_RADII] = {0.5, 1, 1.5, 2, 4};
    long walks = 100000, seed = 1;
    int count = 5;
    ty_status status = TY_OK;
    if (ty_argument_has(arguments, "radius"))
        status = ty_argument_numbers(arguments, "radius", 0.01, 100, TY_CALIBRATION_MOST_RADII, radii, &count);
    if (status == TY_OK && ty_argument_has(arguments, "walks"))
        status = ty_argument_int(arguments, "walks", 100, 100000000, &walks);
    if (status == TY_OK && ty_argument_has(arguments, "seed"))
        status = ty_argument_int(arguments, "seed", 0, 2147483647, &seed);
    j->def.seed.value = (uint64_t)seed;
    for (int i = 0; i < count; i++)
        j->radii[i] = (float)(radii[i] * 1e-3);
    j->def.radii = j->radii;
    j->def.radius_count = count;
    j->def.walk_count = (int)walks;
    return status;
}

static ty_status read_all(const ty_arguments* arguments, job* j)
{
    long threads = 0;
    ty_error error = {0};
    ty_status status = read_walks(arguments, j);
    if (status == TY_OK)
        status = read_states(arguments, j);
    if (status == TY_OK)
        status = read_common(arguments, j);
    if (status == TY_OK && ty_argument_has(arguments, "threads"))
        status = ty_argument_int(arguments, "threads", 1, 256, &threads);
    if (status != TY_OK)
        return status;
    j->def.states = j->states;
    status = ty_workers_create((int)threads, &j->workers, &error);
    const char* output = ty_argument_text(arguments, "output", NULL);
    const char* extension = output ? ty_path_extension(output) : "yaml";
    if (status == TY_OK && strcmp(extension, "yaml") != 0 && strcmp(extension, "yml") != 0)
        return ty_usage(arguments->command, "the output '%s' must end in .yaml", output);
    if (status == TY_OK && output)
        status = ty_output_probe(output, &error);
    if (status != TY_OK)
        ty_log_error(&error);
    return status;
}

// --- results ---

static double mm(float metres)
{
    return 1e3 * (double)metres;
}

static void put_rows(FILE* file, const job* j, const char* lead)
{
    fprintf(file, "%s%6s %6s %6s %6s %6s %7s %7s %7s %8s | %7s %7s %7s %7s %9s\n", lead, "w", "cooked", "l mm", "R mm",
            "l/R", "albedo", "scatter", "t", "sigma", "matte", "gauss", "poisson", "law", "published");
    for (int s = 0; s < j->def.state_count; s++)
        for (int r = 0; r < j->def.radius_count; r++)
        {
            const ty_calibration_row* row = &j->fit.rows[s][r];
            fprintf(file, "%s%6.3f %6.2f %6.3f %6.2f %6.3f %7.4f %7.2f %7.4f %8.4f | %7.4f %7.4f %7.4f %7.4f %9.4f\n",
                    lead, (double)j->states[s].wet_basis, (double)j->states[s].cooked, mm(j->states[s].mean_free_path),
                    mm(j->radii[r]), (double)row->x, (double)row->albedo, (double)row->mean_scatterings, (double)row->t,
                    (double)row->sigma, (double)row->rms_matte, (double)row->rms_gaussian, (double)row->rms_poisson,
                    (double)row->rms_law, (double)row->rms_published);
        }
}

static void put_states(FILE* file, const job* j, const char* lead)
{
    fprintf(file, "%s%6s %6s %9s %12s %10s\n", lead, "w", "cooked", "l mm", "fitted l mm", "sigma0 mm");
    for (int s = 0; s < j->def.state_count; s++)
        fprintf(file, "%s%6.3f %6.2f %9.4f %12.4f %10.4f\n", lead, (double)j->states[s].wet_basis,
                (double)j->states[s].cooked, mm(j->states[s].mean_free_path), mm(j->fit.mean_free_path[s]),
                mm(j->fit.sigma_0[s]));
}

static void put_law(FILE* file, const job* j, const char* lead)
{
    const ty_moisture_law* law = &j->fit.law;
    fprintf(file, "%scooked l = exp(%.4f + %.4f ln w) mm, raw l = %.4f mm, soaked l = %.4f mm: rms %.4f\n", lead,
            (double)law->cooked_constant, (double)law->cooked_exponent, mm(law->raw_length), mm(law->soaked_length),
            (double)law->rms);
    fprintf(file, "%spublished sigma0 = exp(%.4f + %.4f ln w) mm: rms %.4f\n", lead, (double)law->sigma_constant,
            (double)law->sigma_exponent, (double)j->fit.rms_published);
    fprintf(file, "%st = %.4f x / (1 + %.4f x), x = l / R: relative rms %.4f\n", lead, (double)j->fit.slope,
            (double)j->fit.bend, (double)j->fit.rms_t);
}

static ty_status put_file(FILE* file, const void* context, ty_error* error)
{
    (void)error;
    const job* j = context;
    const ty_moisture_law* law = &j->fit.law;
    fputs("# Written by tsuya calibrate. A material of model cdrf names it: calibration: FILE\n", file);
    fprintf(file, "# %d walks in each sphere, seed %llu.\n#\n", j->def.walk_count,
            (unsigned long long)j->def.seed.value);
    put_law(file, j, "# ");
    fputs("#\n", file);
    put_states(file, j, "# ");
    fputs("#\n", file);
    put_rows(file, j, "# ");
    fprintf(file, "tsuya: 1\ncooked_constant: %.6g\ncooked_exponent: %.6g\n", (double)law->cooked_constant,
            (double)law->cooked_exponent);
    fprintf(file, "raw_length: %.6g\nsoaked_length: %.6g\n", mm(law->raw_length), mm(law->soaked_length));
    fprintf(file, "sigma_constant: %.6g\nsigma_exponent: %.6g\nrms: %.6g\n", (double)law->sigma_constant,
            (double)law->sigma_exponent, (double)law->rms);
    return TY_OK;
}

static json_t* rows_json(const job* j, int s)
{
    json_t* rows = json_array();
    for (int r = 0; r < j->def.radius_count; r++)
    {
        const ty_calibration_row* row = &j->fit.rows[s][r];
        json_array_append_new(rows,
                              json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "radius_mm",
                                        mm(j->radii[r]), "x", (double)row->x, "albedo", (double)row->albedo,
                                        "mean_scatterings", (double)row->mean_scatterings, "t", (double)row->t, "sigma",
                                        (double)row->sigma, "rms_matte", (double)row->rms_matte, "rms_gaussian",
                                        (double)row->rms_gaussian, "rms_poisson", (double)row->rms_poisson, "rms_law",
                                        (double)row->rms_law, "rms_published", (double)row->rms_published));
    }
    return rows;
}

static ty_status print_json(const job* j)
{
    const ty_moisture_law* law = &j->fit.law;
    json_t* states = json_array();
    for (int s = 0; s < j->def.state_count; s++)
        json_array_append_new(states, json_pack("{s:f, s:f, s:f, s:f, s:f, s:o}", "wet_basis",
                                                (double)j->states[s].wet_basis, "cooked", (double)j->states[s].cooked,
                                                "mean_free_path_mm", mm(j->states[s].mean_free_path),
                                                "fitted_mean_free_path_mm", mm(j->fit.mean_free_path[s]), "sigma0_mm",
                                                mm(j->fit.sigma_0[s]), "spheres", rows_json(j, s)));
    json_t* constants = json_pack(
        "{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "cooked_constant", (double)law->cooked_constant, "cooked_exponent",
        (double)law->cooked_exponent, "raw_length_mm", mm(law->raw_length), "soaked_length_mm", mm(law->soaked_length),
        "sigma_constant", (double)law->sigma_constant, "sigma_exponent", (double)law->sigma_exponent, "rms",
        (double)law->rms, "rms_published", (double)j->fit.rms_published);
    return ty_json_print(json_pack("{s:i, s:o, s:{s:f, s:f, s:f}, s:o}", "walks", j->def.walk_count, "law", constants,
                                   "t", "slope", (double)j->fit.slope, "bend", (double)j->fit.bend, "rms",
                                   (double)j->fit.rms_t, "states", states));
}

static ty_status report(const ty_arguments* arguments, const job* j)
{
    const char* output = ty_argument_text(arguments, "output", NULL);
    ty_error error = {0};
    if (output && ty_output_write(output, put_file, j, &error) != TY_OK)
    {
        ty_log_error(&error);
        return error.status;
    }
    if (ty_argument_has(arguments, "json"))
        return print_json(j);
    put_rows(stdout, j, "");
    printf("(right of the bar: errors against the walk, a fully lit matte point being 1)\n\n");
    put_states(stdout, j, "");
    printf("\n");
    put_law(stdout, j, "");
    return ty_output_finish();
}

static ty_status run(const ty_arguments* arguments)
{
    static job j; // 60 kB
    j = (job){0};
    ty_status status = read_all(arguments, &j);
    if (status == TY_OK && !ty_calibration_run(&j.def, j.workers, &j.fit))
        status = TY_INTERRUPTED;
    if (status == TY_OK)
        status = report(arguments, &j);
    ty_workers_destroy(j.workers);
    ty_free(j.states);
    return status;
}

static const ty_option options[] = {
    {"output", 'o', "OUT.yaml", "the law, for materials to name as calibration"},
    {"radius", 'r', "LIST", "of the spheres in mm (default 0.5,1,1.5,2,4)"},
    {"albedo", 0, "A", "of one scattering, for all states (0.5..1)"},
    {"anisotropy", 0, "G", "of the phase function, for all states (-0.95..0.95)"},
    {"ior", 0, "N", "refractive index, for all states (1..2; 1: light leaves freely)"},
    {"walks", 'n', "N", "in each sphere (default 100000)"},
    {"seed", 0, "N", "of the walks (default 1)"},
    {"json", 0, NULL, "as JSON"},
    {"threads", 't', "N", "worker threads (default: all cores); the numbers are the same"},
};

const ty_command ty_command_calibrate = {
    "calibrate",
    "[MEASURED.yaml] [-o OUT.yaml]",
    "fit the law of moisture to random walks in spheres of measured matter (default: of the law's own states)",
    "tsuya calibrate --ior 1.38 -o rice_in_air.yaml",
    0,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
