// SPDX-License-Identifier: Apache-2.0
// The layers of `bark` at a point: what its colour, its height and its wetness come from.
#pragma once
#include <tsuya/shading/material.h>

// Where the pattern is looked up, in repetitions of its size.
typedef struct ty_bark_place
{
    ty_vec3 space; // in the object's space: the same on whatever root
    ty_vec3 root;  // about the root and along it: no seam where u comes round
    float join;    // 0..1: how much the latter does not count, because roots meet
    float age;     // 0..1
    float seen;    // length that a lookup averages over
} ty_bark_place;

typedef struct ty_bark_layers
{
    float mottle;             // -1..1, patches
    float crease, ring, pore; // 0..1: dark fissures along the root, wrinkles and lenticels across it
    float grain;              // -1..1
    float lichen;             // 0..1, where it would grow
    float run;                // 0..1, where water runs down
} ty_bark_layers;

ty_bark_place ty_bark_place_at(const ty_bark_def* def, const ty_shading_context* context,
                               const ty_surface_point* point);
ty_bark_layers ty_bark_layers_at(const ty_bark_place* place);
// Relief along the normal, in units of the depth: creases go down, wrinkles, lenticels and lichen up.
float ty_bark_height(const ty_bark_def* def, const ty_bark_layers* layers, float age);

// What a point looks like.
typedef struct ty_bark_look
{
    ty_rgb color;
    float roughness;
} ty_bark_look;
ty_bark_look ty_bark_look_at(const ty_bark_def* def, const ty_shading_context* context, const ty_surface_point* point);

// n bent by the relief. t and b: unit directions across n.
ty_vec3 ty_bark_normal(const ty_bark_def* def, const ty_shading_context* context, const ty_surface_point* point,
                       const ty_frame* frame);
