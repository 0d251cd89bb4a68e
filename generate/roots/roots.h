// SPDX-License-Identifier: Apache-2.0
// The parts of the root generator: the host's distance, growth to a network of centre lines, the surface around them.
#pragma once
#include <tsuya/base/rng.h>
#include <tsuya/generate/roots_recipe.h>
#include <tsuya/geometry/surface_net.h>
#include <tsuya/geometry/trace.h>
#include <tsuya/geometry/voxels.h>

// roots_check.c
TY_CHECKED ty_status roots_recipe_check(const ty_roots_recipe* recipe, ty_error* error);

// --- host ---

typedef enum roots_mask
{
    ROOTS_AVOID,
    ROOTS_ATTRACT,
    ROOTS_MASKS,
} roots_mask;

typedef struct roots_host
{
    ty_mesh* mesh; // all objects as one
    ty_world* world;
    uint32_t prototype;
    ty_voxels field;             // signed distance
    uint8_t* masks[ROOTS_MASKS]; // at the nodes of the field, 255 = 1; NULL: nothing is painted
    ty_voxels obstacles;         // signed distance; no values: there are none
    bool has_floor;
    float floor; // y
} roots_host;

// cache: where fields are kept from one run to the next, NULL = nowhere. On failure *out is zeroed. The same bits for
// any workers, which may be NULL.
TY_CHECKED ty_status roots_host_init(const ty_roots_recipe* recipe, const char* cache, ty_workers* workers,
                                     roots_host* out, ty_error* error);
void roots_host_term(roots_host* host);
// Signed distance to host and floor from the field, with its gradient, which is not quite unit (NULL is allowed). Any
// thread.
float roots_host_value(const roots_host* host, ty_vec3 p, ty_vec3* gradient);
// The closest point of the mesh itself, where it lies within reach, or of the floor; else the field. *normal is unit
// and points away. Any thread.
float roots_host_exact(const roots_host* host, ty_vec3 p, float reach, ty_vec3* normal);
// p moved to a height over the host, by the field. *normal is unit, away from it.
ty_vec3 roots_host_project(const roots_host* host, ty_vec3 p, float height, ty_vec3* normal);
// Moves p, where it lies deeper in the host than that, up to it, by the mesh itself. True where p lies near the host.
// Any thread.
bool roots_host_keep(const roots_host* host, float depth, ty_vec3* p);
// What is painted on the host where it is nearest to p, 0..1, with its gradient, 1/m (NULL is allowed); 0 farther from
// it than a few steps, or where nothing is. Any thread.
float roots_host_mask(const roots_host* host, roots_mask which, ty_vec3 p, ty_vec3* gradient);
// Signed distance to obstacles from a field like the host's, with its gradient; TY_FLOAT_MAX and 0: there are none.
// Any thread.
float roots_host_clear(const roots_host* host, ty_vec3 p, ty_vec3* gradient);

typedef struct roots_start
{
    ty_vec3 p, n; // on the host's surface; unit, away from it
} roots_start;

// Where the recipe lets main roots start: its points, each once, then painted places as far apart as `most` in all
// allow. The caller frees *out with ty_free. *count is 0, *out NULL when the recipe says neither.
TY_CHECKED ty_status roots_host_starts(const roots_host* host, const ty_roots_recipe* recipe, int most,
                                       roots_start** out, int* count, ty_error* error);

// --- the network ---

typedef enum roots_kind
{
    ROOTS_TRUNK,  // what main roots run down along
    ROOTS_MAIN,   // from the trunk or a start point, over the host and down
    ROOTS_AERIAL, // hangs from the host until it finds ground
    ROOTS_FIRST,  // a branch, from a main root to another where it closes a mesh
    ROOTS_SECOND, // the same between first branches
    ROOTS_FINE,   // covers what is left
    ROOTS_KINDS,
} roots_kind;

// 0 = what bears the others, 3 = fine.
static inline int roots_level(roots_kind kind)
{
    return kind == ROOTS_FINE ? 3 : kind == ROOTS_SECOND ? 2 : kind == ROOTS_FIRST ? 1 : 0;
}

// Of a centre line.
typedef struct roots_point
{
    ty_vec3 p;   // m
    ty_vec3 n;   // unit, across the line, away from the host
    float r;     // m, half the width of the section when fully grown
    float flat;  // height of the section against its width, 0.3..1
    float sink;  // how deep the section may reach under the host, of r; 0 where it hangs free
    float s;     // m from the trunk along the network
    float birth; // 0..1 of the time of growth, when the tip passes here
} roots_point;

// Points are ordered away from the trunk; neighbours lie no more than 0.6 r apart on average. The first point of a
// branch is, bit for bit in place, one of its parent, its last one of the root that it grows into. A main root begins
// beside its parent, if it has one: the trunk, or the first that sets out from the same place.
typedef struct roots_line
{
    int first, count; // in points
    roots_kind kind;
    int parent, parent_point; // the line that it leaves, and where, an index into points; -1 = none
    int end, end_point;       // the line that it grows into; -1 = it ends in a tip
    uint64_t key;             // of its random numbers
} roots_line;

// Why branches of the thesis' method fail.
typedef enum roots_failure
{
    ROOTS_NO_ANGLE,   // no angle about the vertical is free of the host
    ROOTS_RESTARTS,   // too many new curves
    ROOTS_POINTS,     // too many points
    ROOTS_NO_PARTNER, // what it should grow into is not there
    ROOTS_FAILURES,
} roots_failure;

typedef struct roots_network
{
    roots_point* points;
    int point_count, point_capacity;
    roots_line* lines;
    int line_count, line_capacity;
    float top;                                      // y, where the trunk is cut
    int requested[ROOTS_KINDS], grown[ROOTS_KINDS]; // lines of a kind
    int failed[ROOTS_FAILURES];                     // branches
    int stuck;                                      // main roots that cannot move on
} roots_network;

void roots_network_term(roots_network* network);
// Appends; the network is the owner.
int roots_network_add_line(roots_network* network, const roots_line* line);
void roots_network_add_point(roots_network* network, const roots_point* point);

TY_CHECKED ty_status roots_grow(const ty_roots_recipe* recipe, const roots_host* host, ty_workers* workers,
                                roots_network* out, ty_error* error);

// --- surface ---

// Where a point of the surface belongs.
typedef struct roots_sample
{
    float distance; // m, negative inside
    int segment;    // the nearest, of the skin; -1 = none near
    int line;       // its line
    float at;       // 0..1 along it
    float join;     // 0..1, how much its root runs together with others
} roots_sample;

typedef struct roots_skin roots_skin; // opaque: blocks of a grid with the segments near each

// host may be NULL: then nothing is cut.
TY_CHECKED ty_status roots_skin_create(const ty_roots_recipe* recipe, const roots_network* network,
                                       const roots_host* host, roots_skin** out, ty_error* error);
void roots_skin_destroy(roots_skin* skin); // NULL is allowed
// Any thread. The distance of roots without the relief of their bark. Far from all roots it is TY_FLOAT_MAX and segment
// -1.
roots_sample roots_skin_at(const roots_skin* skin, ty_vec3 p);
// The same with the direction of its gradient, unit (up where there is none), and the height of the bark over it, m,
// where the distance is `within` of 0 (NULL: not asked for).
roots_sample roots_skin_look(const roots_skin* skin, ty_vec3 p, ty_vec3* normal, float within, float* relief);
// Moves p up to the depth under the host that its root may have. True where p lies near the host.
bool roots_skin_keep(const roots_skin* skin, roots_sample sample, ty_vec3* p);
// What the line holds there; segment is not -1.
roots_point roots_skin_point(const roots_skin* skin, roots_sample sample);
// uv of p on the surface of one segment's root, about the given place.
ty_vec2 roots_skin_uv(const roots_skin* skin, ty_vec3 p, roots_sample sample);
// The same as roots_skin_at, but of one root alone.
roots_sample roots_skin_line_at(const roots_skin* skin, ty_vec3 p, int line);
// Positions and triangles of the surface: one closed shell without sharp corners.
TY_CHECKED ty_status roots_skin_mesh(const roots_skin* skin, ty_workers* workers, ty_mesh** out, ty_error* error);
