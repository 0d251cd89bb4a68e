// SPDX-License-Identifier: Apache-2.0
// A film as it is made.
#pragma once
#include "kit.h"

// Grains that take up water.
typedef struct film_rice
{
    float *sizes, *grown;  // [count] scales at first, and by now
    float* exposed;        // [count] 1 at the surface of the heap as it comes off the fire, 0 deep in it
    const float* moisture; // of f->first
    float raw;             // swelling with which the elements were made
    bool stands;           // it has come off
} film_rice;

typedef struct film
{
    kit* k;
    ty_aggregate* first; // the fill before it moves: prototypes, ids and attributes of every frame
    int count;           // of bodies, those that wait too
    ty_body* bodies;     // [count] of the frame
    ty_affine* frames;   // [count] the same, of a pile that is bent
    ty_yolk* yolks;      // [count]
    ty_vec3* before;     // [count] velocities a substep ago
    float* poured;       // the attribute, of a film of pouring; else NULL
    ty_xpbd* soft;       // while it is pressed; else NULL
    film_rice rice;      // of a film of cooking
    int64_t step;
    double moment; // in frames from the first
    float haste;   // seconds of the pile that pass in one of the film
    int calm;      // looks in a row
} film;

// film_cooking.c
void film_rice_init(film* f);
// Substeps from one frame to the next, of at least so many, in which the pile can follow its growing grains.
int64_t film_rice_steps(const film* f, int frame, int64_t least);
void film_rice_term(film* f);
void film_cook(film* f);      // grains as large as their water makes them by now
void film_rice_show(film* f); // attributes of the moment
