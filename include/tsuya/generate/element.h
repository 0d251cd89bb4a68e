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
    TY_ELEMENT_BALL,
    TY_ELEMENT_ICE,    // a flake with flat facets
    TY_ELEMENT_GRAPE,  // a little longer than wide, dented at the stem
    TY_ELEMENT_BEAN,   // bent, dented at the hilum
    TY_ELEMENT_TOFU,   // a cut block with round edges
    TY_ELEMENT_PEBBLE, // the shape `stone`
    TY_ELEMENT_MESH,   // any closed mesh
} ty_element_kind;

typedef enum ty_cultivar
{
    TY_CULTIVAR_JAPONICA,
    TY_CULTIVAR_INDICA,
    TY_CULTIVAR_AROMATIC,
    TY_CULTIVAR_GLUTINOUS,
} ty_cultivar;

typedef enum ty_rice_model
{
    TY_RICE_FORMULA, // a smooth surface from a formula
    TY_RICE_FIELD,   // a solid on a grid of distances: uneven, porous, swollen, and cut if one likes
} ty_rice_model;

typedef enum ty_bean
{
    TY_BEAN_RED, // kidney
    TY_BEAN_BLACK,
    TY_BEAN_WHITE,
} ty_bean;

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
    int preset;      // ty_roe_preset
    float diameter;  // m, mean
    float membrane;  // m, its thickness
    float yolk;      // share of the volume within the membrane, 0..0.5
    float lean;      // rad, largest angle of the yolk off the top, 0..pi
    float buoyancy;  // kg/m^3, by which the white is denser than the yolk, -500..500; below 0 the yolk sinks
    float viscosity; // Pa s, of the white, 1e-4..1e3
    float press; // how much farther eggs reach than they are packed, relative, 0..0.05: they flatten where they touch
} ty_roe_def;

// A grain of rice as a field (Gan 2023, section 3.1.1). Lengths are those of the cooked grain.
typedef struct ty_grain_def
{
    int voxels;        // across the width, 16..128
    float swelling;    // volume over that of the raw grain, 1..1.5, mean; 0 = of the cultivar
    float unevenness;  // standard deviation of the swelling, relative to what it adds, 0..1
    int bumps;         // balls on the surface, 0..1000
    float bump_radius; // m, mean
    float bump_height; // m, how far they rise over the surface at most
    int pores;         // balls that are taken out, 0..2000
    float pore_radius; // m, mean
    float open;        // share of the pores that lie at the surface, 0..1
    float smoothing;   // m: what is rounder than that stays; a ball of this radius just vanishes
    float soak;        // min, in water before cooking, 0..120: how deep pores reach; < 0: not said, 60
    float cut;         // share of the length that is cut off, 0..0.9, to see into it
} ty_grain_def;

// What soaking leaves of the dense tissue of a cooked grain, after Tomita et al. as told by Gan 2023, table 1 and
// section 2.2: microscopic pores, far below a voxel.
typedef struct ty_rice_pores
{
    float area;  // m^2, mean of a pore: 0.02 um^2 unsoaked to 4.72 um^2 after two hours
    float depth; // m, of the porous layer: 0.1 mm unsoaked, 0.2 mm from 20 min on; then to the centre at two hours
} ty_rice_pores;

// seconds in water, clamped to 0..7200; half_thickness (m): of the grain.
ty_rice_pores ty_rice_pores_after(float seconds, float half_thickness);

typedef struct ty_element_def
{
    int kind;         // ty_element_kind
    float ratio;      // how many of this kind against the others of a mixture, >= 0
    int cultivar;     // ty_cultivar, of rice
    int bean;         // ty_bean, of beans
    const char* mesh; // path, with TY_ELEMENT_MESH
    const char* slot; // material slot of a mesh that names none; NULL = of a mixture the kind's name, else none
    float length;     // m, along x; 0 = of the kind, of a mesh its own
    float width;      // m, along y; <= length; 0 = of the kind
    float thickness;  // m, along z; <= width; 0 = of the kind
    float variation;  // standard deviation of the three sizes, relative, 0..0.2
    int variants;     // different meshes, 1..TY_ELEMENT_MAX_VARIANTS; balls, roe and meshes have one
    float notch;      // depth of the dent of germ, stem or hilum, of the width, 0..0.3
    int divisions;    // cells across the width, 4..64, 0 = of the kind; rice: triangles = 4 (2 n d + d^2), n = round(d
                      // length / width)
    float fit;        // largest distance of balls and surface, of the width, 0.01..0.2; 0 = of the kind, see complete
    int model;        // ty_rice_model
    ty_grain_def grain; // of rice with TY_RICE_FIELD
    ty_roe_def roe;
} ty_element_def;

// Names of kind, cultivar, bean and egg as a recipe writes them, e.g. "rice", "red"; of eggs "roe".
const char* ty_element_kind_name(const ty_element_def* def);

ty_element_def ty_element_def_default(void); // cooked japonica rice
const ty_param_table* ty_element_params(void);

// Puts in the sizes and the fit that are 0, those of the kind (the fit stays 0 where a grain has ten balls); what is
// impossible is TY_BAD_INPUT. name: the element's, for messages.
TY_CHECKED ty_status ty_element_complete(ty_element_def* def, const char* name, ty_error* error);

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

// One variant of a kind; each of a seed differs. def is complete. The caller frees with ty_element_term. On failure
// *out is zeroed: TY_BAD_INPUT for a mesh that is not closed, TY_BAD_FILE for one that cannot be read, TY_NO_MEMORY.
TY_CHECKED ty_status ty_element_init(const ty_element_def* def, ty_seed seed, int variant, ty_element* out,
                                     ty_error* error);
void ty_element_term(ty_element* element); // a zeroed one is allowed

// A bell-shaped number, mean 0 and variance 1, within +-2 sqrt(3): the sum of four uniform ones.
float ty_element_bell(ty_rng* rng);
