// SPDX-License-Identifier: Apache-2.0
// Walks from points all over a shape, and how far from them a material on its mesh is, area-weighted and without noise.
#pragma once
#include "report.h"
#include "subject.h"
#include <tsuya/base/workers.h>

// Lights along z, x and the diagonal, shadowed by the shape itself; a half sky about z whose shadows are left out, so
// that it is (1 + n.z) / 2; and light from everywhere, which shows what is left of it.
#define LAMPS 3
enum
{
    HALF_SKY = LAMPS,
    EVERYWHERE,
    LIGHTS
};

// Albedos of one scattering that the walks are known for: the same walks, weighted.
#define ALBEDOS 4
extern const double truth_albedos[ALBEDOS]; // 1, .995, .98, .9

// Two halves of everything that is random: the mean of their product is free of noise.
typedef double halves[2][LIGHTS];

typedef struct truth
{
    const implicit_shape* shape;
    double path, radius; // mean free path; 3 V / S
    int points, walks;   // walks: of a half
    vec *x, *n;
    halves* light[ALBEDOS]; // by point
    double kept[ALBEDOS];   // of all light that enters
} truth;

typedef enum model
{
    LAMBERT,
    LOCAL,
    PROBE,
    DEPTH,
    WALK, // the material, against the walks of implicit.c
    MODELS
} model;

// What a material shows at the points of a truth, over the share of light that it keeps.
typedef struct shown
{
    const truth* t;
    halves* light;
    double kept;
} shown;

typedef struct figures
{
    double rms[LIGHTS], pooled; // pooled: of the lamps
    double flux[LIGHTS];        // what the whole surface shows over the truth, minus 1
} figures;

// path: in millimetres, or negative: times 3 V / S. quick_walks: of a half, in the quick form. Kept in the folder.
truth truth_make(const implicit_shape* shape, double path, const bench_options* options, int quick_walks,
                 ty_workers* workers);
void truth_drop(truth* t);

// channel: 0 = red. samples: of a half; 0 = as many as the form of the suite has. NULL material: Lambert.
shown show(const truth* t, const subject* s, const ty_material* material, int channel, int samples,
           const bench_options* options, ty_workers* workers);
shown show_model(const truth* t, const subject* s, model m, const bench_options* options, ty_workers* workers);
void shown_drop(shown* s);

figures judge(const shown* s, int albedo);               // against the walks of an albedo, shape by shape of the light
double shown_difference(const shown* a, const shown* b); // pooled
figures measure(const truth* t, const subject* s, model m, const bench_options* options, ty_workers* workers);
double worst_flux(const figures* f); // of the lamps
