// SPDX-License-Identifier: Apache-2.0
// What the making of contact facets hands from stage to stage.
#pragma once
#include <tsuya/base/memory.h>
#include <tsuya/base/workers.h>
#include <tsuya/geometry/aggregate_export.h>
#include <tsuya/geometry/trace.h>

// A vertex of a body within another, or near it.
typedef struct facet_hit
{
    uint32_t vertex, other;
    float depth;        // m; below 0 a gap
    ty_vec3 surface;    // the other's nearest point
    ty_closest closest; // the same in the other's own space
} facet_hit;

typedef struct facet_body
{
    const ty_mesh* shape; // its prototype
    const double* areas;  // of its vertices
    uint32_t prototype;   // in the world
    uint32_t first;       // of its vertices in the mesh
    ty_affine place, back;
    ty_bounds box;
    bool inner; // lies within another altogether: the white of an egg
    float left; // m, how far a vertex of it still lies within another
    facet_hit* hits;
    int hit_count, hit_capacity;
} facet_body;

typedef struct facet_order
{
    float low; // of the box, along x
    uint32_t body;
} facet_order;

typedef struct facet_scene
{
    const ty_aggregate* aggregate;
    ty_facet_def def;
    ty_world* world; // of the prototypes
    ty_mesh* mesh;   // all bodies
    ty_vec3* before; // positions as they were
    ty_vec3* from;   // positions at the beginning of a round
    facet_body* bodies;
    uint32_t count;
    double** areas;     // [prototypes][vertices], a third of the triangles about each, in the prototype's space
    facet_order* order; // ascending
    float widest;       // of the boxes, along x
    bool lower_moves;
} facet_scene;

// aggregate_facets_find.c: mesh, world and hits. On failure end frees what there is.
TY_CHECKED ty_status facets_begin(facet_scene* f, ty_workers* workers, ty_error* error);
void facets_end(facet_scene* f);

// aggregate_facets_shade.c: normals where the surface changed, no curvature where it is flat now.
void facets_shade(facet_scene* f, ty_workers* workers);
