// SPDX-License-Identifier: Apache-2.0
// The recipe of roots that come down over a host, hold on to it, branch, taper and grow together. `kind: roots`.
#pragma once
#include <tsuya/base/rng.h>
#include <tsuya/generate/asset.h>
#include <tsuya/geometry/shape.h>

typedef enum ty_roots_host_kind
{
    TY_ROOTS_HOST_SPHERE,
    TY_ROOTS_HOST_ELLIPSOID,
    TY_ROOTS_HOST_BOX,
    TY_ROOTS_HOST_CYLINDER,
    TY_ROOTS_HOST_STONE,
    TY_ROOTS_HOST_BLOCK,
    TY_ROOTS_HOST_MESH, // any mesh with normals, open ones too
} ty_roots_host_kind;

// What is painted on a host, 0..1: one of the two, or nothing.
typedef struct ty_roots_mask_def
{
    const char* attribute; // of the vertices, or a channel of it as color.g; NULL = none
    const char* texture;   // path, looked up at the uv; NULL = none
    const char* channel;   // of the texture: r, g, b, a, luminance, or a further one of the file by its name
} ty_roots_mask_def;

// Part of a host, or an obstacle. The fields of shape that apply are those of the scene's shape of the same name, with
// the same defaults.
typedef struct ty_roots_object_def
{
    int kind;           // ty_roots_host_kind
    const char* mesh;   // path
    ty_shape_def shape; // its kind is set from kind
    ty_vec3 translate;  // m
    ty_vec3 rotate;     // rad, about x, then y, then z
    ty_vec3 scale;      // none is 0
    // Of parts of a host alone, in place of the host's.
    ty_roots_mask_def avoid, attract;
} ty_roots_object_def;

typedef struct ty_roots_host_def
{
    int kind;                  // as of an object, the three
    const char* mesh;          //
    ty_shape_def shape;        //
    ty_param_list objects;     // of ty_roots_object_def: these in place of the above
    bool floor;                // it stands on a plane, over which the roots go on
    float floor_height;        // m, of the plane above the host's lowest point
    int resolution;            // steps of the field along the longest side
    ty_roots_mask_def avoid;   // roots keep from where it is 1
    ty_roots_mask_def attract; // they are drawn to
} ty_roots_host_def;

// Where main roots start, in place of the trunk; on the host.
typedef struct ty_roots_start_def
{
    ty_param_list points;  // of ty_vec3, m
    const char* attribute; // of the host's vertices, or NULL: starts are where it is above 1/2
} ty_roots_start_def;

typedef struct ty_roots_trunk_def
{
    float height; // m, above the host's highest point
    float radius; // m
    ty_vec3 lean; // m, where the middle of its top stands against the middle of the host
} ty_roots_trunk_def;

typedef struct ty_roots_growth_def
{
    float gravity;   // weights of what turns a tip: down,
    float wander;    // chance,
    float repel;     // other main roots, away from them (below 0: towards them),
    float keep;      // and its own side of the host, back to it
    float stiffness; // length in which a root turns, of its radius
    float wave;      // length in which chance changes, of the radius
    float distance;  // how far other roots are felt, of the radius
    float hold;      // how far from the host a root still takes to it, of its radius
    float overhang;  // rad, from the horizontal: steeper undersides are let go
    float sink;      // depth under the host's surface, of the radius, 0..0.9
    float flatten;   // height of a section that lies on the host against its width, 0.3..1
    float avoid;     // weights of what is painted on the host: away from it,
    float attract;   // towards it
    float clear;     // how far from obstacles roots keep, of the radius
} ty_roots_growth_def;

// Branches that grow from one root into another.
typedef struct ty_roots_link_def
{
    float spacing;                   // m, mean along the parent; 0 = none
    ty_param_list density_by_height; // of ty_vec2: height on the host, 0..1, and the share of branches there, 0..1
    float reach;                     // m, to the farthest partner
    float slant;                     // how much farther down the partner they end, of the way across
    float share[2];                  // radius against the thinner of both: from, to
    float wander;                    // how far they swing to the side, of the way across
} ty_roots_link_def;

typedef struct ty_roots_aerial_def
{
    int count;
    float share[2]; // radius against the main roots'
} ty_roots_aerial_def;

typedef struct ty_roots_cover_def
{
    float spacing; // m, between the places that fine roots grow towards; 0 = none
    float radius;  // m
} ty_roots_cover_def;

// By what roots find their way over the host.
typedef enum ty_roots_method
{
    TY_ROOTS_WRAP, // tips led by the field, branches drawn tight over it
    TY_ROOTS_SEED, // as in Homma's thesis of 2011, with what fails there
} ty_roots_method;

// Of the thesis' method alone.
typedef struct ty_roots_thesis_def
{
    float unit; // of the radius: the unit of the thesis' lengths, which are plain numbers
    float fall; // weight of down in a main root's way, 1 as printed
} ty_roots_thesis_def;

typedef enum ty_roots_mesh
{
    TY_ROOTS_SURFACE, // one closed surface
    TY_ROOTS_TUBES,   // one closed tube for each line, not welded
} ty_roots_mesh;

typedef struct ty_roots_tubes_def
{
    int divisions;  // sides of a section
    ty_rgb color;   // of the vertices
    float junction; // how far branches spread where they meet other roots, 1 as in the thesis; 0 = not at all
} ty_roots_tubes_def;

// The same roots as they come about, as frames.
typedef struct ty_roots_grow_def
{
    int frames;  // 1..100000
    bool remesh; // a surface of its own for each; else one topology, drawn in towards the centre lines
} ty_roots_grow_def;

typedef struct ty_roots_recipe
{
    int method; // ty_roots_method
    ty_roots_thesis_def thesis;
    ty_roots_host_def host;
    ty_param_list obstacles; // of ty_roots_object_def: what roots keep clear of
    ty_roots_start_def start;
    ty_roots_trunk_def trunk;
    int count;                      // main roots, 1..500
    float radius;                   // m, of a main root where it leaves the trunk
    float variation;                // of the radii, relative
    float tip;                      // m, radius where a root ends
    float taper;                    // m, length over which a radius falls to 1/e
    float length;                   // m, of a main root at most
    ty_param_list radius_by_length; // of ty_vec2: length, of `length`, and a factor to radii of main and aerial roots
    ty_roots_growth_def growth;
    ty_roots_link_def first, second; // between main roots, and between first branches
    ty_roots_aerial_def aerial;
    ty_roots_cover_def cover;
    float exponent; // of the pipe model: r^n = sum of r_i^n
    float flare;    // how much thicker branches begin, of their radius
    float join;     // how far from each other roots begin to run together, of the thinner radius, 0..2
    float bark;     // depth of the relief, of the radius, 0..0.5
    float detail;   // m, size of a cell of the surface
    int mesh;       // ty_roots_mesh
    ty_roots_tubes_def tubes;
    int levels;         // of detail, the mesh itself among them
    const char* curves; // path of centre lines in place of those that would grow, or NULL
    ty_roots_grow_def grow;
    ty_seed seed;
} ty_roots_recipe;

ty_roots_recipe ty_roots_recipe_default(void); // eleven main roots on a ball of 4 cm radius
const ty_param_table* ty_roots_recipe_params(void);
// def is a ty_roots_recipe. The mesh is one closed surface, smooth, with uv (turns about the root from the side that is
// away from the host; metres along it, from the trunk) and the attributes `radius` (m), `level` (0 = main root), `join`
// (0..1, how much roots run together there), `sink` (depth that it may reach under the host, of the radius), `root`
// (its number), `along` (m from the trunk), `age` (0..1, when the tip passed) and `curvature` (mean, 1/m). On
// failure *out is NULL, else as ty_generator's make.
TY_CHECKED ty_status ty_roots_make(const void* def, ty_workers* workers, ty_mesh** out, ty_error* error);
// The same, with what else is wanted in out.
TY_CHECKED ty_status ty_roots_make_all(const void* def, ty_workers* workers, ty_made* out, ty_error* error);
extern const ty_generator ty_roots_generator;
