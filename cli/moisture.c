// SPDX-License-Identifier: Apache-2.0
// `tsuya moisture`: what states of rice mean in optics, by the law of the program or of a calibration.
#include "cli.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/scene/calibration.h>
#include <tsuya/shading/cdrf.h>

enum
{
    MOST = 256, // of any list
    MOST_RADII = 16,
};

// A state before it is cooked, as the command line says it.
typedef struct origin
{
    char label[48];
    ty_moisture_def def;
} origin;

typedef struct job
{
    origin origins[3 * MOST];
    int origin_count;
    double cooked[MOST], radii[MOST_RADII], color[3];
    int cooked_count, radius_count, color_count;
    ty_moisture_law law;
} job;

static void add_origin(job* j, ty_moisture_def def, const char* label)
{
    origin* o = &j->origins[j->origin_count++];
    o->def = def;
    snprintf(o->label, sizeof o->label, "%s", label);
}

static ty_status read_wet_bases(const ty_arguments* arguments, job* j, const char* name)
{
    double values[MOST];
    int count = 0;
    char label[48];
    bool is_uptake = strcmp(name, "uptake") == 0;
    if (!ty_argument_has(arguments, name))
        return TY_OK;
    ty_status status = ty_argument_numbers(arguments, name, 0, is_uptake ? 10 : 1, MOST, values, &count);
    for (int i = 0; i < count && status == TY_OK; i++)
    {
        float wet = is_uptake ? ty_moisture_wet_basis((float)values[i]) : (float)values[i];
        snprintf(label, sizeof label, is_uptake ? "uptake %.4g" : "wet basis %.4g", values[i]);
        add_origin(j, (ty_moisture_def){.wet_basis = wet, .cooked = -1}, label);
    }
    return status;
}

// "20@10,60@25": minutes, and degrees of the water (10 if not said).
static ty_status read_soaks(const ty_arguments* arguments, job* j)
{
    const char *given = ty_argument_text(arguments, "soak", ""), *text = given;
    int count = 0;
    while (*text)
    {
        char label[48];
        double minutes = -1, celsius = 10;
        int used = 0;
        bool good = sscanf(text, "%lf%n", &minutes, &used) == 1;
        text += good ? used : 0;
        if (good && *text == '@')
        {
            good = sscanf(text + 1, "%lf%n", &celsius, &used) == 1;
            text += good ? 1 + used : 0;
        }
        good = good && (*text == 0 || (*text == ',' && text[1])) && count++ < MOST;
        if (!good || !(minutes >= 0 && minutes <= 1e6) || !(celsius >= 0 && celsius <= 60))
            return ty_usage(arguments->command,
                            "--soak: '%.100s' is no list of MINUTES@CELSIUS, 0..1000000 and 0..60, as 20@10,60@25",
                            given);
        snprintf(label, sizeof label, "%.4g min at %.3g C", minutes, celsius);
        add_origin(j, (ty_moisture_def){-1, (float)minutes, (float)celsius, -1}, label);
        text += *text == ',';
    }
    return TY_OK;
}

static void add_usual(job* j)
{
    add_origin(j, (ty_moisture_def){-1, 0, 10, -1}, "raw");
    add_origin(j, (ty_moisture_def){-1, 20, 10, -1}, "20 min at 10 C");
    add_origin(j, (ty_moisture_def){-1, 60, 10, -1}, "60 min at 10 C");
    add_origin(j, (ty_moisture_def){-1, 120, 10, -1}, "120 min at 10 C");
    add_origin(j, ty_moisture_def_default(), "cooked");
}

static ty_status read_lists(const ty_arguments* arguments, job* j)
{
    *j = (job){.cooked = {-1}, .cooked_count = 1, .radii = {1}, .radius_count = 1, .color = {0.80, 0.79, 0.73}};
    ty_status status = read_wet_bases(arguments, j, "wet-basis");
    if (status == TY_OK)
        status = read_wet_bases(arguments, j, "uptake");
    if (status == TY_OK)
        status = read_soaks(arguments, j);
    if (status == TY_OK && ty_argument_has(arguments, "cooked"))
        status = ty_argument_numbers(arguments, "cooked", 0, 1, MOST, j->cooked, &j->cooked_count);
    if (status == TY_OK && ty_argument_has(arguments, "radius"))
        status = ty_argument_numbers(arguments, "radius", 0.001, 1000, MOST_RADII, j->radii, &j->radius_count);
    if (status == TY_OK && ty_argument_has(arguments, "color"))
    {
        status = ty_argument_numbers(arguments, "color", 0, 1, 3, j->color, &j->color_count);
        if (status == TY_OK && j->color_count != 3)
            status = ty_usage(arguments->command, "--color: three numbers R,G,B");
    }
    if (j->origin_count == 0)
        add_usual(j);
    return status;
}

static ty_status read_law(const ty_arguments* arguments, job* j)
{
    j->law = ty_moisture_law_default();
    const char* path = ty_argument_text(arguments, "calibration", NULL);
    if (!path)
        return TY_OK;
    ty_error_list errors = {0};
    ty_status status = ty_calibration_load(path, &j->law, &errors);
    ty_errors_log(&errors);
    return status;
}

// --- results ---

typedef struct row
{
    const char* label;
    ty_moisture state;
    double uptake;
    ty_moisture_optics optics;
    float color[3];
    float t[MOST_RADII], sigma[MOST_RADII]; // Poisson kernel, normalised Gaussian
} row;

static row row_of(const job* j, int index)
{
    const origin* o = &j->origins[index / j->cooked_count];
    ty_moisture_def def = o->def;
    float cooked = (float)j->cooked[index % j->cooked_count];
    def.cooked = cooked >= 0.0f ? cooked : def.cooked;
    row r = {.label = o->label, .state = ty_moisture_make(&def)};
    r.uptake = (double)ty_moisture_uptake_of(ty_min(r.state.wet_basis, 0.9999f));
    r.uptake = fabs(r.uptake) < 1e-6 ? 0.0 : r.uptake; // of rounding
    r.optics = ty_moisture_law_at(&j->law, r.state);
    for (int c = 0; c < 3; c++)
        r.color[c] = ty_moisture_color(&r.optics, (float)j->color[c]);
    for (int i = 0; i < j->radius_count; i++)
    {
        float x = r.optics.mean_free_path / (float)(j->radii[i] * 1e-3);
        r.t[i] = ty_cdrf_poisson_t(x, 0.0f);
        r.sigma[i] = ty_cdrf_gaussian_sigma(x, 0.0f);
    }
    return r;
}

static void print_table(const job* j)
{
    printf("%-18s %6s %7s %6s %7s %9s %5s %5s %6s", "state", "w", "uptake", "cooked", "l mm", "sigma0 mm", "film",
           "water", "rough");
    for (int i = 0; i < j->radius_count; i++)
        printf("  t(%.4g mm)", j->radii[i]);
    printf("  colour\n");
    for (int k = 0; k < j->origin_count * j->cooked_count; k++)
    {
        row r = row_of(j, k);
        printf("%-18s %6.4f %7.4f %6.3f %7.4f %9.4f %5.3f %5.3f %6.3f", r.label, (double)r.state.wet_basis, r.uptake,
               (double)r.state.cooked, 1e3 * (double)r.optics.mean_free_path, 1e3 * (double)r.optics.gaussian_sigma,
               (double)r.optics.film, (double)r.optics.water, (double)r.optics.roughness);
        for (int i = 0; i < j->radius_count; i++)
            printf("  %*.4f", snprintf(NULL, 0, "t(%.4g mm)", j->radii[i]), (double)r.t[i]);
        printf("  %.3f %.3f %.3f\n", (double)r.color[0], (double)r.color[1], (double)r.color[2]);
    }
}

static void print_csv(const job* j)
{
    printf("state,wet_basis,uptake,cooked,mean_free_path_mm,sigma0_mm,film,water,roughness,red,green,blue");
    for (int i = 0; i < j->radius_count; i++)
        printf(",t_%.6gmm,sigma_%.6gmm", j->radii[i], j->radii[i]);
    printf("\n");
    for (int k = 0; k < j->origin_count * j->cooked_count; k++)
    {
        row r = row_of(j, k);
        printf("%s,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g", r.label, (double)r.state.wet_basis,
               r.uptake, (double)r.state.cooked, 1e3 * (double)r.optics.mean_free_path,
               1e3 * (double)r.optics.gaussian_sigma, (double)r.optics.film, (double)r.optics.water,
               (double)r.optics.roughness, (double)r.color[0], (double)r.color[1], (double)r.color[2]);
        for (int i = 0; i < j->radius_count; i++)
            printf(",%.6g,%.6g", (double)r.t[i], (double)r.sigma[i]);
        printf("\n");
    }
}

static json_t* row_json(const job* j, const row* r)
{
    json_t* kernels = json_array();
    for (int i = 0; i < j->radius_count; i++)
        json_array_append_new(kernels, json_pack("{s:f, s:f, s:f}", "radius_mm", j->radii[i], "t", (double)r->t[i],
                                                 "sigma", (double)r->sigma[i]));
    return json_pack("{s:s, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:[f, f, f], s:o}", "state", r->label, "wet_basis",
                     (double)r->state.wet_basis, "uptake", r->uptake, "cooked", (double)r->state.cooked,
                     "mean_free_path_mm", 1e3 * (double)r->optics.mean_free_path, "sigma0_mm",
                     1e3 * (double)r->optics.gaussian_sigma, "film", (double)r->optics.film, "water",
                     (double)r->optics.water, "roughness", (double)r->optics.roughness, "color", (double)r->color[0],
                     (double)r->color[1], (double)r->color[2], "spheres", kernels);
}

static ty_status run(const ty_arguments* arguments)
{
    static job j; // 40 kB
    if (ty_argument_has(arguments, "json") && ty_argument_has(arguments, "csv"))
        return ty_usage(arguments->command, "either --json or --csv");
    ty_status status = read_lists(arguments, &j);
    if (status == TY_OK)
        status = read_law(arguments, &j);
    if (status != TY_OK)
        return status;
    if (ty_argument_has(arguments, "json"))
    {
        json_t* rows = json_array();
        for (int k = 0; k < j.origin_count * j.cooked_count; k++)
        {
            row r = row_of(&j, k);
            json_array_append_new(rows, row_json(&j, &r));
        }
        return ty_json_print(json_pack("{s:o}", "states", rows));
    }
    (ty_argument_has(arguments, "csv") ? print_csv : print_table)(&j);
    return ty_output_finish();
}

static const ty_option options[] = {
    {"wet-basis", 'w', "LIST", "water per total mass, as 0.145,0.31 or 0.145:0.62:6"},
    {"uptake", 'u', "LIST", "water taken up per raw mass, as 0:0.24:7"},
    {"soak", 's', "LIST", "minutes in water, with its degrees: 20@10,60@25"},
    {"cooked", 0, "LIST", "degrees of gelatinisation 0..1, for each state (default: as materials take it)"},
    {"radius", 'r', "LIST", "of grains in mm, for the width t of the kernel (default 1)"},
    {"color", 0, "R,G,B", "of the cooked state (default that of rice)"},
    {"calibration", 0, "FILE", "law written by tsuya calibrate"},
    {"json", 0, NULL, "as JSON, with the Gaussian's sigma"},
    {"csv", 0, NULL, "as comma-separated values, likewise"},
};

const ty_command ty_command_moisture = {
    "moisture",
    "[--wet-basis LIST] [--uptake LIST] [--soak LIST] [--cooked LIST]",
    "print what states of moisture mean in optics: mean free path l, sigma0, t, water, colour",
    "tsuya moisture --soak 20@10,60@10 --uptake 0:0.24:7 --radius 1,2.5 --csv",
    0,
    0,
    options,
    TY_PARAM_COUNT(options),
    run,
};
