// SPDX-License-Identifier: Apache-2.0
// Built-in shapes as meshes. All closed ones are outward and watertight; y is up.
#pragma once
#include <tsuya/base/params.h>
#include <tsuya/geometry/mesh.h>

typedef enum ty_shape_kind
{
    TY_SHAPE_SPHERE,    // radius
    TY_SHAPE_ELLIPSOID, // size = semi-axes
    TY_SHAPE_BOX,       // size = half extents, rounding = edge radius
    TY_SHAPE_CYLINDER,  // radius, height, rounding; capped
    TY_SHAPE_TORUS,     // radius (to the tube's centre), tube
    TY_SHAPE_PLANE,     // size x, z half extents; open, normal +y
    TY_SHAPE_DISC,      // radius; open, normal +y
    TY_SHAPE_BOWL,      // radius (rim, outside), height, thickness, foot radius, foot height, curve: a turned solid
    TY_SHAPE_DOME,      // radius, height: closed half ellipsoid standing on y = 0
    TY_SHAPE_SWEEP,     // size: a floor that curves up into a wall behind (photographer's sweep); open
    TY_SHAPE_STONE,     // size = semi-axes, relief, variant: a weathered stone
    TY_SHAPE_LATHE,     // profile: a solid turned about y, or a surface where the profile is open
    TY_SHAPE_BLOCK,     // size = half extents, relief, variant: a hewn stone with worn edges
    TY_SHAPE_TUBE,      // radius, points: a round tube with round ends along a smooth curve through points
} ty_shape_kind;

typedef struct ty_shape_point
{
    float at[2];    // m, radius and height
    float rounding; // m, radius of an arc in place of the corner
    bool smooth;    // no corner: the profile is a curve through the point
} ty_shape_point;

typedef struct ty_shape_def
{
    int kind;              // ty_shape_kind
    float radius;          // m
    ty_vec3 size;          // m
    float height;          // m; 0 = the radius
    float tube;            // m
    float thickness;       // m, wall of a bowl; 0 = of its size, as the two below
    float foot_radius;     // m
    float foot_height;     // m
    float curve;           // bowl profile: 1 = cone, 2 = parabola, higher = fuller
    float rounding;        // m
    float relief;          // of a stone or block, against its size, 0..0.5
    int variant;           // which stone
    ty_param_list profile; // of ty_shape_point, borrowed: from the axis to the axis, or back to the first, it is closed
    ty_param_list points;  // of ty_vec3, m, borrowed
    int divisions;         // around; the other direction follows the shape, 8..4096
} ty_shape_def;

ty_shape_def ty_shape_def_default(void);
// Lengths that are 0 follow others: height the radius, those of a bowl its radius and height. Whatever takes a def does
// it itself.
ty_shape_def ty_shape_def_complete(const ty_shape_def* def);
const ty_param_table* ty_shape_params(void);

// Welds, normals, uv, bounds and curvature (by the shape's formula; of stones and blocks as measured) are filled in.
// Where curvature jumps, the border has that of the flatter side. divisions is the number of segments around the
// equator, rounded up to a multiple of 8 for spheres, ellipsoids and round boxes: a sphere has 0.75 divisions^2
// triangles. Impossible sizes are TY_BAD_INPUT naming the field.
TY_CHECKED ty_status ty_shape_create(const ty_shape_def* def, ty_mesh** out, ty_error* error);

// Signed distance (negative inside) to the *interior* of a vessel: the space to be filled. For BOWL the hollow below
// the rim; for the closed solids the solid itself; open shapes, stones, blocks, lathes and tubes have none:
// TY_FLOAT_MAX. Exact or a lower bound of the distance inside, 1-Lipschitz. A bowl has no wall above its rim: there the
// distance is to the lip, negative within the rim's radius and positive beyond, and jumps between. def must be one that
// ty_shape_create accepts. Any thread.
float ty_shape_interior_distance(const ty_shape_def* def, ty_vec3 p);
