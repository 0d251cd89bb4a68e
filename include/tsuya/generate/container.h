// SPDX-License-Identifier: Apache-2.0
// What a pile stands in: a vessel open at the top (bowl, box) or a closed volume (sphere, dome, any closed mesh).
#pragma once
#include <tsuya/base/params.h>
#include <tsuya/base/workers.h>
#include <tsuya/geometry/shape.h>

typedef enum ty_container_kind
{
    TY_CONTAINER_BOWL,    // open; the pile may rise above the rim; a table lies at y = 0
    TY_CONTAINER_BOX,     // open at the top; four walls and a floor, higher than any pile
    TY_CONTAINER_SPHERE,  // closed
    TY_CONTAINER_DOME,    // closed
    TY_CONTAINER_MESH,    // a volume, or the wall of a vessel
    TY_CONTAINER_GROUND,  // the plane y = 0 without walls; radius is that of the heap's foot as it is filled
    TY_CONTAINER_ONIGIRI, // closed: a triangle with round corners that stands on y = 0
} ty_container_kind;

typedef enum ty_container_role
{
    TY_CONTAINER_VOLUME, // the mesh is the surface of the space to be filled
    TY_CONTAINER_VESSEL, // the mesh is the surface of a wall, open at the top; its hollow is filled up to the rim
    TY_CONTAINER_MOULD,  // any closed form, a box too: it shapes what is in it, and is taken away
} ty_container_role;

typedef enum ty_cut_kind
{
    TY_CUT_NONE,
    TY_CUT_SPHERE, // what lies within center and radius
    TY_CUT_PLANE,  // what lies beyond center, where normal points to
} ty_cut_kind;

// A part of the pile that is left out once it is at rest, so that one sees into it.
typedef struct ty_cut_def
{
    int kind; // ty_cut_kind
    ty_vec3 center;
    float radius; // m
    ty_vec3 normal;
} ty_cut_def;

// All in metres.
typedef struct ty_onigiri_def
{
    float side;      // of the triangle, before its corners are rounded
    float thickness; // along z
    float corner;    // radius of the triangle's corners
    float edge;      // radius between faces and sides
} ty_onigiri_def;

// The fields of shape that apply are those of the scene's shape of the same name, with the same defaults.
typedef struct ty_container_def
{
    int kind;         // ty_container_kind
    const char* mesh; // path of a closed mesh, for TY_CONTAINER_MESH
    int role;         // ty_container_role; volume and vessel are of a mesh, the others are what they are
    ty_cut_def cut;
    ty_onigiri_def onigiri;
    ty_shape_def shape; // its kind is set from kind
    float ground;       // m, height of the plane of TY_CONTAINER_GROUND
} ty_container_def;

ty_container_def ty_container_def_default(void); // a rice bowl
const ty_param_table* ty_container_params(void);

typedef struct ty_container ty_container; // opaque; const after creation, any thread may ask

// Samples the distance to the shape's own mesh, so that what is packed against is what is rendered. On failure *out is
// NULL: TY_BAD_INPUT for impossible sizes or an open mesh, TY_BAD_FILE for an unreadable one.
TY_CHECKED ty_status ty_container_create(const ty_container_def* def, ty_workers* workers, ty_container** out,
                                         ty_error* error);
void ty_container_destroy(ty_container* container); // NULL is allowed

// Walls are numbered; each is one smooth surface. The distance from p to wall (negative: behind it), metres, and the
// unit direction away from it. Errors are a few percent of the sampling step (extent / 256 for turned shapes).
int ty_container_wall_count(const ty_container* container);
float ty_container_wall(const ty_container* container, int wall, ty_vec3 p, ty_vec3* normal);

bool ty_cut_takes(const ty_cut_def* cut, ty_vec3 p);      // p lies in the cut
float ty_container_widest(const ty_container* container); // radius of the widest sphere in it; of an open one, sideways
bool ty_container_is_open(const ty_container* container);
bool ty_container_is_turned(const ty_container* container);        // round about the y axis
ty_bounds ty_container_interior(const ty_container* container);    // of the space to be filled, up to the rim
bool ty_container_holds(const ty_container* container, ty_vec3 p); // p lies in that space
bool ty_container_lost(const ty_container* container, ty_vec3 p);  // p lies outside of an open vessel
