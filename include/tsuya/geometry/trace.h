// SPDX-License-Identifier: Apache-2.0
// Ray queries. The only door to Embree. A world is built once, then const: any thread may query it.
#pragma once
#include <tsuya/base/workers.h>
#include <tsuya/geometry/aggregate.h>
#include <tsuya/geometry/mesh.h>

typedef struct ty_world ty_world; // opaque

#define TY_NONE 0xffffffffu

typedef enum ty_ray_flags
{
    TY_RAY_PLAIN = 0,
    TY_RAY_FRONT_ONLY = 1, // surfaces that are one_sided are seen from outside only: back-face hits are passed through
} ty_ray_flags;

// Who sees what: a ray meets an object only if their masks share a bit. A ray carries the bits of its own kind, an
// object those of the rays that may see it.
typedef enum ty_mask
{
    TY_MASK_CAMERA = 1,
    TY_MASK_DIFFUSE = 2,
    TY_MASK_GLOSSY = 4,
    TY_MASK_TRANSMISSION = 8,
    TY_MASK_SHADOW = 16,             // objects that stop light altogether
    TY_MASK_SHADOW_TRANSPARENT = 32, // objects with opacity: shadow rays meet them only when they ask
    TY_MASK_OPAQUE = 31,             // an ordinary object
    TY_MASK_ALL = 63,
} ty_mask;

typedef struct ty_ray
{
    ty_vec3 origin;
    float t_min;
    ty_vec3 direction; // unit
    float t_max;
    uint32_t flags;         // ty_ray_flags
    uint32_t skip_object;   // with skip_instance: hits on this instance nearer than skip_distance are passed through
    uint32_t skip_instance; // TY_NONE = skip nothing
    float skip_distance;    // TY_FLOAT_MAX = the whole instance
    uint32_t mask;          // ty_mask; 0 meets nothing
    float time;             // within the shutter: 0 = it opens, 1 = it closes
} ty_ray;

// A ray that skips nothing, meets every object, at time 0.
static inline ty_ray ty_ray_make(ty_vec3 origin, ty_vec3 direction, float t_max)
{
    return (ty_ray){.origin = origin,
                    .direction = direction,
                    .t_max = t_max,
                    .skip_object = TY_NONE,
                    .skip_instance = TY_NONE,
                    .mask = TY_MASK_ALL};
}

typedef struct ty_hit
{
    float t;
    float u, v;                          // barycentric weights of vertices 1 and 2
    uint32_t object, instance, triangle; // instance is the index within the object (0 for a plain object)
    float time;                          // the ray's
} ty_hit;

typedef enum ty_trace_path
{
    TY_TRACE_FAST,      // aggregates as one user geometry over the instance array, ellipsoid test in front
    TY_TRACE_REFERENCE, // plain Embree instances
} ty_trace_path;

typedef struct ty_world_def
{
    ty_trace_path path;
    const char* isa;     // NULL = the best of this CPU; "avx2", "sse4.2", "avx512" ... pins Embree's kernels
    ty_workers* workers; // for commit; borrowed, NULL = the caller alone
} ty_world_def;

ty_world_def ty_world_def_default(void);
TY_CHECKED ty_status ty_world_create(const ty_world_def* def, ty_world** out, ty_error* error);
void ty_world_destroy(ty_world* world); // NULL is allowed

typedef struct ty_object_flags
{
    uint64_t one_sided; // ty_slot_bit of each material slot that honours TY_RAY_FRONT_ONLY
    uint32_t mask;      // ty_mask: the rays that may meet it
} ty_object_flags;

// The last bit stands for all slots from 63 on.
static inline uint64_t ty_slot_bit(uint32_t slot)
{
    return 1ull << (slot < 63 ? slot : 63);
}

// Where an object stands while the shutter is open: maps at even steps, the first at time 0 and the last at time 1;
// one step = at rest. Between steps the rotation is interpolated on the sphere and the rest linearly, in substeps of at
// most 4 degrees that are linear themselves, so that every query finds the object at the same place. Copied.
typedef struct ty_motion
{
    const ty_affine* steps;
    int step_count; // 1 .. TY_MOTION_MAX_STEPS
    // Of an aggregate with velocities or spins: s from the moment of its transforms to time 0 and to time 1. In its own
    // space the instances go straight on and turn about their origins. Equal: they stand where the transforms put them.
    float open, close;
} ty_motion;

#define TY_MOTION_MAX_STEPS 33

static inline ty_motion ty_motion_at_rest(const ty_affine* map)
{
    return (ty_motion){.steps = map, .step_count = 1};
}

// Adds a prototype; the mesh is borrowed and must outlive the world, or its removal. Equal pointers give the same
// index: its BVH is built once. Rays meet a mesh with steps as it stands at their time; questions without a time are
// about its `positions`.
TY_CHECKED ty_status ty_world_add_prototype(ty_world* world, const ty_mesh* mesh, uint32_t* prototype, ty_error* error);
// A plain object: one prototype in one place. Objects are numbered in order of addition, from 0.
TY_CHECKED ty_status ty_world_add_object(ty_world* world, uint32_t prototype, ty_motion motion, ty_object_flags flags,
                                         uint32_t* object, ty_error* error);
// An aggregate in one place, moving as a whole. Borrowed until the objects are cleared or the world is destroyed: its
// transforms and prototype_index stay in use.
TY_CHECKED ty_status ty_world_add_aggregate(ty_world* world, const ty_aggregate* aggregate, ty_motion motion,
                                            ty_object_flags flags, uint32_t* object, ty_error* error);
// Builds. Deterministic: the same input gives the same tree. After this the world is const until it is cleared.
TY_CHECKED ty_status ty_world_commit(ty_world* world, ty_error* error);
// Takes all objects away; prototypes and their trees stay. For the next frame: add objects and commit again.
void ty_world_clear_objects(ty_world* world);
// Takes a prototype away that no object uses (a mesh that deforms: remove the last frame's, add this one's). The
// indices of others stay; its own is given to a later addition.
void ty_world_remove_prototype(ty_world* world, uint32_t prototype);

bool ty_world_intersect(const ty_world* world, const ty_ray* ray, ty_hit* hit); // nearest; false = none, *hit untouched
bool ty_world_occluded(const ty_world* world, const ty_ray* ray);

// Against one instance alone, world space, as it stands at a time. Used for interior rays and probes.
bool ty_world_intersect_instance(const ty_world* world, uint32_t object, uint32_t instance, float time, ty_vec3 origin,
                                 ty_vec3 direction, float t_max, ty_hit* hit);
// The same against a prototype in its own space; direction need not be unit, t in its units. *behind: whether the
// triangle was met from its inner side; NULL is allowed.
bool ty_world_intersect_prototype(const ty_world* world, uint32_t prototype, ty_vec3 origin, ty_vec3 direction,
                                  float t_max, ty_hit* hit, bool* behind);

typedef struct ty_closest
{
    ty_vec3 position;
    float distance;
    uint32_t triangle;
    float u, v;
} ty_closest;

// Closest point of a prototype within max_distance, in its space; false = none.
bool ty_world_closest(const ty_world* world, uint32_t prototype, ty_vec3 p, float max_distance, ty_closest* out);
// Whether p lies inside a closed prototype: majority of three rays' crossing parity.
bool ty_world_inside(const ty_world* world, uint32_t prototype, ty_vec3 p);

// What a hit refers to.
const ty_mesh* ty_world_mesh(const ty_world* world, uint32_t object, uint32_t instance);
uint32_t ty_world_prototype(const ty_world* world, uint32_t object, uint32_t instance);
const ty_mesh_topology* ty_world_topology(const ty_world* world, uint32_t prototype);
uint32_t ty_world_prototype_count(const ty_world* world); // one more than the largest index in use
const ty_mesh* ty_world_prototype_mesh(const ty_world* world, uint32_t prototype); // NULL = removed
// Prototype to world at a time, and back. Not stored but made: keep the result where it is needed twice.
ty_affine ty_world_to_world(const ty_world* world, uint32_t object, uint32_t instance, float time);
ty_affine ty_world_to_local(const ty_world* world, uint32_t object, uint32_t instance, float time);
bool ty_world_is_moving(const ty_world* world, uint32_t object); // or some of its instances or vertices are
// The kernels in use, as `isa` names them: with the build, what the bits of a picture depend on.
const char* ty_world_isa(const ty_world* world);
ty_bounds ty_world_bounds(const ty_world* world); // over the whole shutter
uint64_t ty_world_memory(const ty_world* world);  // bytes, Embree's and ours

// Surface at a hit.
typedef struct ty_surface_point
{
    ty_vec3 position; // on the triangle, by barycentric interpolation (exact to rounding, whatever the ray's length)
    ty_vec3 ng;       // unit geometric normal, outward (as the triangle winds)
    ty_vec3 ns;       // unit shading normal, on the same side as ng
    float reach;      // m: bounds the coordinates that position was computed from
    ty_vec2 uv;       // (0,0) without uv
    uint32_t object, instance, triangle;
    float u, v;           // barycentric
    ty_vec3 footprint[2]; // half axes of what a lookup averages over, along the triangle, world; zero = the point alone
    float time;           // within the shutter
    float horizon;        // a ray whose direction has more than this of ng cannot meet the instance again; 1 = no such
    bool convex;          // the instance is: rays that leave it cannot meet it again
} ty_surface_point;

void ty_world_surface(const ty_world* world, const ty_hit* hit, ty_surface_point* out);
// A mesh field interpolated at the hit (per-vertex array of the instance's prototype).
float ty_world_interpolate(const ty_world* world, const ty_surface_point* point, const float* vertex_field);
// The same of an attribute; components that it lacks are 0.
void ty_world_interpolate_attribute(const ty_world* world, const ty_surface_point* point,
                                    const ty_mesh_attribute* attribute, float out[4]);

// How the position moves with uv, in world space and the triangle's plane. False (and zeros) without uv, or where the
// triangle has no area on the surface or in uv.
bool ty_world_tangents(const ty_world* world, const ty_surface_point* point, ty_vec3* dpdu, ty_vec3* dpdv);
// The ellipse that a cone about the unit direction, as wide (m, diameter) as `width` there, cuts out of the surface
// (Akenine-Moeller et al. 2021, "Improved shader and texture level of detail using ray cones", eq. 8 to 12).
void ty_surface_set_footprint(ty_surface_point* point, ty_vec3 direction, float width);

// How far off the surface a ray has to begin: a bound of the rounding errors. Units in the last place as in C. Waechter
// and N. Binder 2019, "A fast and robust method for avoiding self-intersection", Ray Tracing Gems ch. 6, but of all
// that went into the position: under a rotated instance and on a large triangle the error of every axis comes from
// there. 32 of them; rays begin to fail at 2. The floor is set for scenes of millimetres (half a micrometre).
static inline float ty_offset_distance(const ty_surface_point* p)
{
    return ty_max(p->reach * 0x1p-18f, 0x1p-21f);
}

// An origin for a ray that leaves p towards the side of the unit n.
static inline ty_vec3 ty_offset_origin(const ty_surface_point* p, ty_vec3 n)
{
    return ty_mad(p->position, n, ty_offset_distance(p));
}
