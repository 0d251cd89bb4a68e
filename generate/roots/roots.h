// SPDX-License-Identifier: Apache-2.0
// The parts of the root generator: the host's distance, growth to centre lines, the surface around them.
#pragma once
#include <tsuya/base/rng.h>
#include <tsuya/generate/roots_recipe.h>
#include <tsuya/geometry/trace.h>

// --- host ---

typedef struct roots_host
{
    ty_mesh* mesh;
    ty_world* world;
    uint32_t prototype;
    bool has_floor;
    float floor; // y
} roots_host;

// On failure *out is zeroed.
TY_CHECKED ty_status roots_host_init(const ty_roots_host_def* def, roots_host* out, ty_error* error);
void roots_host_term(roots_host* host);
// Signed distance to host and floor, run together over `blend` metres, no farther than `reach` (then reach and up), and
// its gradient.
float roots_host_distance(const roots_host* host, ty_vec3 p, float reach, float blend, ty_vec3* normal);

// --- centre lines ---

typedef struct roots_point
{
    ty_vec3 p;
    ty_vec3 n;  // unit, away from the host
    float r;    // m
    float flat; // height of the section against its width
    float s;    // m from the trunk
} roots_point;

typedef struct roots_segment
{
    roots_point a, b;
    int root, level;
} roots_segment;

// Segments of a root follow each other; roots are in the order of their numbers.
typedef struct roots_lines
{
    roots_segment* segments;
    int count, capacity, root_count;
    float top; // y, where the trunk is cut
} roots_lines;

TY_CHECKED ty_status roots_grow(const ty_roots_recipe* recipe, const roots_host* host, roots_lines* out,
                                ty_error* error);
void roots_lines_term(roots_lines* lines);

// --- surface ---

typedef struct roots_sample
{
    float distance; // m, negative inside
    int segment;    // the nearest
    float at;       // 0..1 along it
    float join;     // 0..1, how much its root runs together with others
} roots_sample;

typedef struct roots_skin roots_skin; // opaque: blocks of a grid with the segments near each

TY_CHECKED ty_status roots_skin_create(const ty_roots_recipe* recipe, const roots_lines* lines, roots_skin** out,
                                       ty_error* error);
void roots_skin_destroy(roots_skin* skin); // NULL is allowed
// Any thread. Far from all roots the distance is TY_FLOAT_MAX and segment -1.
roots_sample roots_skin_at(const roots_skin* skin, ty_vec3 p);
ty_vec3 roots_skin_normal(const roots_skin* skin, ty_vec3 p);
// uv of p on the surface of one segment's root, about the given place.
ty_vec2 roots_skin_uv(const roots_skin* skin, ty_vec3 p, roots_sample sample);
// The same as roots_skin_at, but of one root alone.
roots_sample roots_skin_root_at(const roots_skin* skin, ty_vec3 p, int root);

typedef struct roots_grid
{
    ty_vec3 origin;
    float step;
    int size[3];
    float* values; // [size[2]][size[1]][size[0]]
} roots_grid;

// Distances at the corners of the cells, all that is needed for the surface. false when cancelled.
TY_CHECKED ty_status roots_skin_grid(const roots_skin* skin, ty_workers* workers, roots_grid* out, ty_error* error);

// The surface where values change sign: closed and oriented, without repeated vertices. Positions and triangles only.
TY_CHECKED ty_status roots_march(const roots_grid* grid, ty_mesh** out, ty_error* error);
