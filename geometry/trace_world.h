// SPDX-License-Identifier: Apache-2.0
// What a world is made of: shared by the files that build it and those that query it.
#pragma once
#include "embree_compat.h"
#include <stdatomic.h>
#include <tsuya/geometry/trace.h>

typedef struct ty_trace_prototype
{
    const ty_mesh* mesh; // borrowed; NULL = a free slot
    RTCScene scene;
    ty_mesh_topology topology;
    ty_bounds bounds;
    ty_affine to_sphere;   // carries the bounding ellipsoid to the unit sphere
    ty_affine from_sphere; // its inverse
    float sphere_scale;    // largest absolute row sum of to_sphere's linear part: bounds how it magnifies an error
    bool has_ellipsoid;
} ty_trace_prototype;

typedef struct ty_trace_object
{
    const ty_world* world; // the world that holds it, for Embree's callbacks; set on commit
    uint32_t index;
    uint32_t first, count;         // its instances among the world's
    const ty_aggregate* aggregate; // borrowed; NULL = a plain object
    uint32_t* prototypes;          // the world's index of each of the aggregate's; owned; plain: one
    ty_affine* steps;              // owned
    int step_count;                // 1 = at rest
    bool closed_subsurface;
    uint32_t mask;
    ty_affine* to_local; // fast path: by instance, from the object's space where it moves, else from the world's; owned
    RTCScene scene;      // a moving aggregate's instances in its own space
} ty_trace_object;

struct ty_world
{
    char* isa; // kernels in use, owned
    RTCDevice device;
    RTCScene scene; // NULL before commit
    ty_trace_path path;
    bool has_subsurface; // some object honours TY_RAY_FRONT_ONLY

    ty_trace_prototype* prototypes;
    uint32_t prototype_count, prototype_capacity;
    ty_trace_object* objects;
    uint32_t object_count, object_capacity;
    uint32_t instance_count;

    ty_bounds bounds;
    atomic_int_fast64_t embree_bytes;
    enum RTCError embree_error; // the first since it was last looked at
    char embree_text[256];
};

// Travels with a ray through Embree; embree comes first, since Embree hands back a pointer to it.
typedef struct ty_trace_context
{
    ty_embree_context embree;
    const ty_world* world;
    const ty_ray* ray;
    uint32_t object, instance; // known below a user geometry; TY_NONE: Embree's instance id tells
} ty_trace_context;

// --- trace.c ---
// Embree's first error since it was last asked, as a status.
TY_CHECKED ty_status ty_trace_take_error(ty_world* world, const char* doing, ty_error* error);
// Room for one more element behind count; *capacity doubles.
TY_CHECKED bool ty_trace_make_room(void** array, uint32_t count, uint32_t* capacity, size_t size);

// --- trace_object.c ---
void ty_trace_free_objects(ty_world* world);
uint32_t ty_trace_prototype_of(const ty_trace_object* object, uint32_t instance);
// An instance within its object, before the object's own map.
ty_affine ty_trace_inner_map(const ty_trace_object* object, uint32_t instance);
// The object that holds an instance of the world's numbering.
const ty_trace_object* ty_trace_object_of(const ty_world* world, uint32_t instance);

// --- trace_motion.c ---
// Steps fine enough to be linear between: *out is owned by the caller. Singular or not finite maps and those that turn
// inside out are refused.
TY_CHECKED ty_status ty_trace_refine_motion(ty_motion motion, ty_affine** out, int* count, ty_error* error);
ty_affine ty_trace_map_at(const ty_affine* steps, int count, float time);

// --- trace_ellipsoid.c ---
// Smallest ellipsoid about the mesh's vertices (within a few percent of the least volume): fills to_sphere and
// from_sphere.
void ty_trace_fit_ellipsoid(ty_trace_prototype* prototype);

// --- trace_user.c ---
// The object's instances as one user geometry. NULL when Embree refuses.
RTCGeometry ty_trace_create_user_geometry(const ty_world* world, ty_trace_object* object);

// --- trace_moving.c ---
// A moving object as a user geometry of one primitive. NULL when Embree refuses.
RTCGeometry ty_trace_create_moving_geometry(ty_world* world, ty_trace_object* object);
// Box of the object at a step.
ty_bounds ty_trace_step_bounds(const ty_trace_object* object, int step);

// --- trace_query.c ---
// Rejects hits that the ray of a ty_trace_context passes through.
void ty_trace_filter(const struct RTCFilterFunctionNArguments* args);
// The filter is asked only where it can reject something.
RTCFilterFunctionN ty_trace_needed_filter(const ty_trace_object* object, const ty_ray* ray, uint32_t instance);
