// SPDX-License-Identifier: Apache-2.0
// One shape as a triangle mesh in a world of its own, and materials evaluated on it with the renderer's own functions.
// A unit of the shape is a millimetre.
#pragma once
#include "implicit.h"
#include <tsuya/shading/cdrf.h>
#include <tsuya/shading/material.h>

#define MILLIMETRE 1e-3f

typedef struct subject
{
    ty_mesh* mesh;
    ty_world* world;
    ty_depth_field* field;
    const ty_depth_field* fields[1];
    ty_shading_context context;
} subject;

// divisions: of the mesh around. Never fails: the shapes are known.
void subject_init(subject* s, const implicit_shape* shape, int divisions);
void subject_term(subject* s);

// The mesh at a point of the shape.
ty_surface_point subject_point(const subject* s, vec x, vec n);

// White, uncoated; mean free path in millimetres.
ty_material* subject_cdrf(ty_cdrf_evaluate evaluate, ty_cdrf_kernel kernel, double mean_free_path);

ty_material* subject_walk(double mean_free_path); // white, by the material `walk`

// Light of some directions that a point sends out, where a lit Lambert point facing one shows 1. Adds to light[i].
void subject_light(const subject* s, const ty_material* material, const ty_surface_point* p, const float u[4],
                   ty_rng* rng, const vec* directions, int count, double* light);

// Element k of Roberts' sequence R4 (2018), turned.
void roberts_sequence(int k, const double turn[4], float u[4]);

static inline ty_vec3 vec_float(vec a)
{
    return ty_vec3_make((float)a.x, (float)a.y, (float)a.z);
}
