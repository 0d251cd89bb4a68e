// SPDX-License-Identifier: Apache-2.0
// Solids as signed distances on a regular grid: made of a closed mesh, joined with balls and cut by them, swollen,
// smoothed, and made a mesh again at any other resolution.
#pragma once
#include <tsuya/base/workers.h>
#include <tsuya/geometry/mesh.h>

// Owned by who made it. values[(k * size[1] + j) * size[0] + i] is the distance at origin + step * (i, j, k), metres,
// negative inside.
typedef struct ty_voxels
{
    int size[3];
    ty_vec3 origin; // m
    float step;     // m
    float* values;
} ty_voxels;

// The field at a point: cubic B-splines over the nodes, twice continuously differentiable. They smooth: the value is
// that of the distance averaged over about a step, for a ball of radius r larger by step^2 / (3 r).
typedef struct ty_voxel_sample
{
    float value;      // m
    ty_vec3 gradient; // 1
    float hessian[6]; // 1/m: xx yy zz xy xz yz
} ty_voxel_sample;

// The distance from a closed, outward mesh, on a grid of that step that reaches margin beyond its bounds. The sign is
// that of the winding number, counted along the rows of nodes: inside where it is above 0, so that bodies of one mesh
// may overlap. The nearest triangle of nodes next to the surface goes to all others by the exact Euclidean distance
// transform of their grid (Felzenszwalb and Huttenlocher 2012), and its own distance is taken. Up to four steps from
// the surface that is within a tenth of a step of the distance from the mesh, beyond within half a step. TY_BAD_INPUT
// for an empty mesh or more than 2^27 nodes, TY_NO_MEMORY; *out is zeroed then. Any thread.
TY_CHECKED ty_status ty_voxels_from_mesh(const ty_mesh* mesh, float step, float margin, ty_voxels* out,
                                         ty_error* error);
// The same about any mesh with welds: within a twentieth of a step next to the surface, a tenth up to four steps, half
// a step beyond. Closed parts hold a space in where rows of nodes wind about them at all, turned inside out or not.
// Open ones do where their generalised winding number (Barill et al. 2018) is above one half: a lid closes their
// opening. Sheets, about which it is nowhere clearly more, have two outsides. Where parts overlap, the distance inside
// counts from what is outside of all of them, for some 16 steps down and within three quarters of a step. nearest,
// where it is not NULL: the triangle nearest to each node, which the caller frees with ty_free. The same bits for any
// number of workers.
#define TY_VOXELS_AROUND_MESH_BUILD "around mesh 2" // changes when the same mesh would give other values
TY_CHECKED ty_status ty_voxels_around_mesh(const ty_mesh* mesh, float step, float margin, ty_workers* workers,
                                           ty_voxels* out, int32_t** nearest, ty_error* error);
void ty_voxels_term(ty_voxels* voxels); // a zeroed one is allowed

// Union with a ball, and what a ball leaves of the solid. reach (m): how far from its surface nodes are looked at;
// beyond, values keep what they were. Where the ball is the nearest surface, the distance is exact.
void ty_voxels_add_ball(ty_voxels* voxels, ty_vec3 center, float radius, float reach);
void ty_voxels_take_ball(ty_voxels* voxels, ty_vec3 center, float radius, float reach);
// What lies on the near side of the plane dot(unit_normal, x) = height.
void ty_voxels_cut(ty_voxels* voxels, ty_vec3 unit_normal, float height);
// Every surface moves outwards by that much, m; inwards below 0.
void ty_voxels_offset(ty_voxels* voxels, float by);
// The whole grows about its origin of coordinates; distances with it.
void ty_voxels_scale(ty_voxels* voxels, float factor);
// Moves the surface by its mean curvature (the sum of the principal ones) for `time` (m^2) in as many steps as are
// stable, 6 time / step^2 at least: a ball of radius r becomes one of sqrt(r^2 - 4 time). Osher and Sethian 1988.
// Nodes farther than four steps from the surface stay as they are.
TY_CHECKED ty_status ty_voxels_smooth(ty_voxels* voxels, float time, ty_error* error);

// p may lie anywhere; outside of the grid it is that of the nearest point in it.
ty_voxel_sample ty_voxels_sample(const ty_voxels* voxels, ty_vec3 p);
float ty_voxels_value(const ty_voxels* voxels, ty_vec3 p); // its value alone
// Principal curvatures of the level set through the sample, convex positive, k1 >= k2, and the direction of k1.
void ty_voxel_curvature(const ty_voxel_sample* sample, float* k1, float* k2, ty_vec3* direction);

typedef struct ty_voxel_net_def
{
    float cell;  // m, of the grid that the surface is found on; need not be the field's
    int relax;   // rounds in which vertices move to the middle of their neighbours and back to the surface
    bool hollow; // keep the walls of cavities and all pieces; else only the outside of the largest piece
} ty_voxel_net_def;

// The surface as a mesh: surface nets (Gibson 1998), one vertex for each cell that the surface passes through, moved
// onto the zero of the field. Where the cells are so coarse that two sheets would meet in an edge or a corner, what is
// between them is filled (as in Latecki 1997), so that the mesh is closed and two-manifold whatever the field. Outward,
// with welds, bounds, and normals and curvature of the field. TY_BAD_INPUT when there is no surface or the cells are
// too many, TY_NO_MEMORY; *out is NULL then.
TY_CHECKED ty_status ty_voxels_net(const ty_voxels* voxels, const ty_voxel_net_def* def, ty_mesh** out,
                                   ty_error* error);
