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
// The same as an instance under a map.
void subject_init_mapped(subject* s, const implicit_shape* shape, int divisions, const ty_affine* map);
void subject_term(subject* s);

// The mesh at a point of the shape.
ty_surface_point subject_point(const subject* s, vec x, vec n);

// Uncoated; mean free path in millimetres, color 1 unless told.
ty_material* subject_cdrf(ty_cdrf_evaluate evaluate, ty_cdrf_kernel kernel, double mean_free_path);
ty_material* subject_depth_colored(const double mean_free_path[3], const double color[3]);

// The colour of a thick piece of matter of this albedo of one scattering.
double subject_color_of(double albedo);

// The material `walk`: what is absorbed, is within. albedo: of one scattering; 1 = white.
ty_material* subject_walk(double mean_free_path, double albedo);

// Where light that is seen from a point has come in, with what the way there leaves of it; false = nothing.
bool subject_leave(const subject* s, const ty_material* material, const ty_surface_point* p, const float u[4],
                   ty_rng* rng, ty_bsdf* b, ty_rgb* weight);

// Light of some directions that such a place gathers, its own shadows in it, where a lit Lambert point facing one
// shows 1. Adds weight times that to light[i].
void subject_light(const subject* s, const ty_bsdf* b, double weight, ty_rng* rng, const vec* directions, int count,
                   double* light);

// Element k of Roberts' sequence R4 (2018), turned.
void roberts_sequence(int k, const double turn[4], float u[4]);

static inline ty_vec3 vec_float(vec a)
{
    return ty_vec3_make((float)a.x, (float)a.y, (float)a.z);
}
