// SPDX-License-Identifier: Apache-2.0
// One element of an aggregate: its surface as closed meshes, and the balls that stand for it in packing and contact.
#pragma once
#include <tsuya/base/params.h>
#include <tsuya/base/rng.h>
#include <tsuya/base/status.h>
#include <tsuya/geometry/mesh.h>

enum
{
    TY_ELEMENT_MAX_BALLS = 255,
    TY_ELEMENT_MAX_VARIANTS = 64,
};

typedef enum ty_element_kind
{
    TY_ELEMENT_RICE,
    TY_ELEMENT_ROE, // a fish's egg: membrane, white and yolk, clear bodies in one another
} ty_element_kind;

typedef enum ty_roe_preset
{
    TY_ROE_IKURA,    // salmon
    TY_ROE_TOBIKO,   // flying fish
    TY_ROE_TARAKO,   // pollock
    TY_ROE_KAZUNOKO, // herring
} ty_roe_preset;

// An egg. Sizes of 0 are those of the preset; ty_roe_complete puts them in.
typedef struct ty_roe_def
{
    int preset;     // ty_roe_preset
    float diameter; // m, mean
    float membrane; // m, its thickness
    float yolk;     // share of the volume within the membrane, 0..0.5
    float lean;     // rad, largest angle of the yolk off the top, 0..pi
    float press; // how much farther eggs reach than they are packed, relative, 0..0.05: they flatten where they touch
} ty_roe_def;

typedef struct ty_element_def
{
    int kind;        // ty_element_kind; what follows is of rice, but for the variation
    float length;    // m, along x
    float width;     // m, along y; <= length
    float thickness; // m, along z; half the width .. the width
    float variation; // standard deviation of the three sizes, relative, 0..0.2
    int variants;    // different meshes, 1..TY_ELEMENT_MAX_VARIANTS
    float notch;     // depth of the germ's dent, of the width, 0..0.3
    int divisions;   // cells across the width, 4..64; triangles = 4 (2 n d + d^2), n = round(d length / width)
    ty_roe_def roe;
} ty_element_def;

ty_element_def ty_element_def_default(void); // cooked japonica rice
const ty_param_table* ty_element_params(void);

typedef struct ty_ball
{
    ty_vec3 center; // m
    float radius;   // m
} ty_ball;

// Lengths in metres; the origin is the centre of mass of the solid of even density.
typedef struct ty_element
{
    ty_mesh* mesh; // owned; closed, outward, with welds, normals, curvature and bounds
    ty_ball balls[TY_ELEMENT_MAX_BALLS];
    int ball_count;           // 1..TY_ELEMENT_MAX_BALLS
    float volume;             // m^3, of the mesh
    float inverse_inertia[6]; // per unit mass, 1/m^2: xx yy zz xy xz yz, body frame
    float radius;             // m, about the origin, of mesh and balls
    float capsule;            // m, all balls lie this near to the line from the first ball's centre to the last one's
    float width;              // m, of this variant
    float fit_rms, fit_max;   // m, distance of the mesh without its dent from the union of the balls
} ty_element;

// The blunt ellipsoid |x/a|^3 + (y/b)^2 + (z/c)^2 = 1 with taper, bend, twist, longitudinal ridges and the germ's
// dent; each variant of a seed differs. The caller frees with ty_element_term. On failure *out is zeroed.
TY_CHECKED ty_status ty_rice_init(const ty_element_def* def, ty_seed seed, int variant, ty_element* out,
                                  ty_error* error);
void ty_element_term(ty_element* grain); // a zeroed one is allowed

// A bell-shaped number, mean 0 and variance 1, within +-2 sqrt(3): the sum of four uniform ones.
float ty_element_bell(ty_rng* rng);
