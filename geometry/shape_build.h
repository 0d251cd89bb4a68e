// SPDX-License-Identifier: Apache-2.0
// What the built-in shapes share: a growing mesh, profiles, surfaces turned about y, and the shapes themselves.
#pragma once
#include <tsuya/geometry/shape.h>

// --- a mesh that grows ---

typedef struct ty_shape_vertex
{
    ty_vec3 position, normal, direction; // direction of curvature_1
    ty_vec2 uv;
    float curvature_1, curvature_2;
} ty_shape_vertex;

// Zeroed to begin with. Sizes come from the user: when memory ends, further vertices and triangles are dropped and
// finish reports it.
typedef struct ty_shape_build
{
    ty_shape_vertex* vertices;
    uint32_t (*triangles)[3];
    size_t vertex_count, vertex_capacity, triangle_count, triangle_capacity;
    bool failed;
} ty_shape_build;

uint32_t ty_shape_add_vertex(ty_shape_build* build, const ty_shape_vertex* vertex);
void ty_shape_add_triangle(ty_shape_build* build, uint32_t a, uint32_t b, uint32_t c);
// Corners in counter-clockwise order, cut along the shorter diagonal.
void ty_shape_add_quad(ty_shape_build* build, uint32_t a, uint32_t b, uint32_t c, uint32_t d);
// Makes the mesh with bounds and welds. The build is empty afterwards, also on failure.
TY_CHECKED ty_status ty_shape_finish(ty_shape_build* build, ty_mesh** out, ty_error* error);
void ty_shape_build_term(ty_shape_build* build);

// k_u along u and k_v across it, set in order.
void ty_shape_set_curvature(ty_shape_vertex* vertex, double k_u, double k_v, ty_vec3 u, ty_vec3 v);

// --- profiles: curves in the (r, y) half-plane, walked with the solid to the left, so that (dy, -dr) is outward ---

typedef struct ty_profile_point
{
    double r, y;
    double nr, ny;    // unit outward normal
    double curvature; // along the profile, 1/m, convex positive; the flatter side's where it jumps
    bool crease;      // the same place as the point before, with another normal
} ty_profile_point;

typedef struct ty_profile
{
    ty_profile_point* points;
    size_t count, capacity;
    double spacing; // m, about how far apart points lie on curves; lines may be coarser
    int limit;      // most points a piece
    bool failed;    // memory
} ty_profile;

void ty_profile_term(ty_profile* profile);
// Appends a point; one that coincides with the last is merged with it where the normals agree and a crease otherwise.
void ty_profile_add(ty_profile* profile, ty_profile_point point);
// A straight piece in steps of at most four spacings (one when fine).
void ty_profile_line(ty_profile* profile, double r0, double y0, double r1, double y1, bool fine);
// An arc whose outward normal turns from angle a0 to a1 (radians from +r towards +y). side 1: convex, about its centre;
// -1: concave, the normal points to the centre.
void ty_profile_arc(ty_profile* profile, double r, double y, double radius, double a0, double a1, int side);

// A curve in steps of the spacing, shorter where it bends, walked from t0 to t1; at gives the point at t.
typedef ty_profile_point ty_profile_curve_fn(const void* context, double t);
void ty_profile_curve(ty_profile* profile, ty_profile_curve_fn* at, const void* context, double t0, double t1);

// --- turned surfaces ---

typedef enum ty_turned_rule
{
    TY_TURNED_EVEN,         // as many segments at any radius
    TY_TURNED_PROPORTIONAL, // segments in proportion to the radius, so that triangles keep their size
} ty_turned_rule;

// Turns the profile about y with `divisions` segments at its largest radius. u runs round from -z, v along the profile.
void ty_shape_turn(ty_shape_build* build, const ty_profile* profile, int divisions, ty_turned_rule rule);

// --- the shapes; sizes are valid ---

void ty_shape_build_ball(ty_shape_build* build, int divisions);   // unit sphere
void ty_shape_bend_stone(const ty_shape_def* def, ty_mesh* mesh); // the finished unit sphere
void ty_shape_bend_block(const ty_shape_def* def, ty_mesh* mesh);
void ty_shape_build_box(ty_shape_build* build, const ty_shape_def* def);
void ty_shape_build_plane(ty_shape_build* build, const ty_shape_def* def);
void ty_shape_build_sweep(ty_shape_build* build, const ty_shape_def* def);
void ty_shape_build_cylinder(ty_shape_build* build, const ty_shape_def* def);
void ty_shape_build_torus(ty_shape_build* build, const ty_shape_def* def);
void ty_shape_build_disc(ty_shape_build* build, const ty_shape_def* def);
void ty_shape_build_dome(ty_shape_build* build, const ty_shape_def* def);
void ty_shape_build_bowl(ty_shape_build* build, const ty_shape_def* def);
void ty_shape_build_lathe(ty_shape_build* build, const ty_shape_def* def);
void ty_shape_build_tube(ty_shape_build* build, const ty_shape_def* def);

TY_CHECKED ty_status ty_shape_check_bowl(const ty_shape_def* def, ty_error* error);
TY_CHECKED ty_status ty_shape_check_lathe(const ty_shape_def* def, ty_error* error);
TY_CHECKED ty_status ty_shape_check_tube(const ty_shape_def* def, ty_error* error);
float ty_shape_bowl_distance(const ty_shape_def* def, ty_vec3 p);
