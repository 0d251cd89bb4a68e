// SPDX-License-Identifier: Apache-2.0
// Indexed triangle meshes with normals, uv, welded topology, curvature and named vertex attributes.
#pragma once
#include <stdint.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/status.h>

// What the numbers of a vertex attribute are; colours are brought to the scene's space by who uses the mesh.
typedef enum ty_attribute_space
{
    TY_ATTRIBUTE_NUMBERS,     // as they are, scene-linear colours among them
    TY_ATTRIBUTE_SRGB,        // colours encoded as in 8-bit images
    TY_ATTRIBUTE_LINEAR_SRGB, // linear, Rec.709 primaries
} ty_attribute_space;

typedef struct ty_mesh_attribute
{
    char name[32];
    int components;           // 1..4
    ty_attribute_space space; // of the first three components when there are three or four
    float* values;            // [vertex_count][components]
} ty_mesh_attribute;

// Arrays are owned and freed by ty_mesh_destroy; optional ones are NULL when absent. Const once in use by the tracer.
typedef struct ty_mesh
{
    uint32_t vertex_count, triangle_count;
    ty_vec3* positions;       // [vertex_count]
    ty_vec3* normals;         // [vertex_count], unit, outward
    ty_vec2* uvs;             // optional
    uint32_t (*triangles)[3]; // counter-clockwise seen from outside
    uint32_t* welds;          // [vertex_count] smallest index of the vertices at the same position (optional)
    float* curvature_1;       // [vertex_count] larger principal curvature, 1/m, convex positive (optional)
    float* curvature_2;       // smaller
    ty_vec3* direction_1;     // unit tangent of curvature_1
    ty_mesh_attribute* attributes;
    int attribute_count;
    // Where the vertices stand while the shutter is open (optional): at even steps, the first when it opens, the last
    // when it closes. Between steps each goes straight on. For plain objects: in aggregates `positions` alone count.
    int step_count;          // 0 = `positions` all the time; else 2..TY_MESH_MAX_STEPS
    ty_vec3* step_positions; // [step_count][vertex_count]
    ty_vec3* step_normals;   // the same, unit
    uint16_t* slots;         // [triangle_count] material slot, below slot_count (NULL = all 0)
    char** slot_names;       // [slot_count], as the file names its materials; no two equal
    int slot_count;          // 0 = the file names none
    char* recipe;            // the text that made it, or NULL
    char* hash;              // hex, or NULL
    ty_bounds bounds;
} ty_mesh;

typedef struct ty_mesh_topology
{
    uint32_t welded_vertices, edges, boundary_edges, nonmanifold_edges, misoriented_edges, components;
    double area;   // m^2
    double volume; // m^3, signed; positive when closed and outward
    bool closed;   // no boundary, no non-manifold, no misoriented edge, positive volume
    bool convex;   // closed, one component, every edge convex within 1e-4 rad
} ty_mesh_topology;

// Zeroed arrays of positions, normals and triangles. For sizes from input: NULL when memory does not suffice.
TY_CHECKED ty_mesh* ty_mesh_create(uint32_t vertex_count, uint32_t triangle_count);
void ty_mesh_destroy(ty_mesh* mesh); // NULL is allowed
ty_mesh* ty_mesh_copy(const ty_mesh* mesh);

// Finite positions, indices in range, some area: else TY_BAD_FILE naming the first offender (name = the file, for
// messages).
TY_CHECKED ty_status ty_mesh_validate(const ty_mesh* mesh, const char* name, ty_error* error);
void ty_mesh_compute_bounds(ty_mesh* mesh);
void ty_mesh_compute_welds(ty_mesh* mesh); // exact equality of positions
// Angle-weighted vertex normals over welded vertices; edges sharper than crease (radians; pi = all smooth) are split:
// vertices may be added.
void ty_mesh_compute_normals(ty_mesh* mesh, float crease);
// Principal curvatures and direction per vertex (Rusinkiewicz 2004 over welded vertices), then `smoothing` Gaussian
// passes.
void ty_mesh_compute_curvature(ty_mesh* mesh, int smoothing);
// Positions, normals, curvature (exactly) and bounds; triangles are turned round under a mirror. Welds stay as they
// are.
void ty_mesh_transform(ty_mesh* mesh, const ty_affine* m);
void ty_mesh_analyse(const ty_mesh* mesh, ty_mesh_topology* out); // needs welds

// Gaussian average of a per-vertex field over the surface: weight exp(-|d|^2 / (2 width^2)) * vertex area, cut at 3
// width.
void ty_mesh_smooth_field(const ty_mesh* mesh, float* field, float width);
// One or two fields at once, for little more than one: the same bits.
void ty_mesh_smooth_fields(const ty_mesh* mesh, float* const* fields, int field_count, float width);
// A third of the area of the triangles about each vertex, m^2: [vertex_count], the caller frees it.
double* ty_mesh_vertex_areas(const ty_mesh* mesh);

// NULL if there is none.
const ty_mesh_attribute* ty_mesh_find_attribute(const ty_mesh* mesh, const char* name);
// Adds (or finds) an attribute of zeros; the values are owned by the mesh.
float* ty_mesh_add_attribute(ty_mesh* mesh, const char* name, int components);

#define TY_MESH_MAX_STEPS 33

// Makes room for steps, of zeros; those there were are freed. False, with none, when memory does not suffice.
TY_CHECKED bool ty_mesh_make_steps(ty_mesh* mesh, int step_count);
void ty_mesh_forget_steps(ty_mesh* mesh);

// Two triangles from number first on: corners counter-clockwise seen from outside, cut along the shorter diagonal.
void ty_mesh_set_quad(ty_mesh* mesh, uint32_t first, const uint32_t corners[4]);

#define TY_MESH_MAX_SLOTS 4096

// The index of a slot of that name, added when there is none. -1 when there are TY_MESH_MAX_SLOTS already.
int ty_mesh_add_slot(ty_mesh* mesh, const char* name);
// Gives meshes one list of slots: equal names share a number, triangles are renumbered. A mesh that names no slot gets
// one of the empty name where others name some. False when they are too many together; then nothing has changed.
bool ty_mesh_share_slots(ty_mesh* const* meshes, int count);
