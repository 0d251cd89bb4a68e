// SPDX-License-Identifier: Apache-2.0
// What a world is made of: shared by the files that build it and those that query it.
#pragma once
#include "embree_compat.h"
#include <stdatomic.h>
#include <tsuya/geometry/trace.h>

typedef struct ty_trace_prototype
{
    const ty_mesh* mesh; // borrowed
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
    const ty_world* world; // the world that holds it, for Embree's callbacks
    uint32_t index;
    uint32_t first, count; // its instances among the world's
    bool aggregate;
    bool closed_subsurface;
} ty_trace_object;

struct ty_world
{
    char* isa; // kernels in use, owned
    RTCDevice device;
    RTCScene scene;
    ty_trace_path path;
    bool committed;
    bool has_subsurface; // some object honours TY_RAY_FRONT_ONLY

    ty_trace_prototype* prototypes;
    uint32_t prototype_count, prototype_capacity;
    ty_trace_object* objects;
    uint32_t object_count, object_capacity;
    // Instances of all objects one after another.
    ty_affine *to_world, *to_local;
    uint32_t* instance_prototype;
    uint32_t* instance_object;
    uint32_t instance_count, instance_capacity;

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

// Smallest ellipsoid about the mesh's vertices (within a few percent of the least volume): fills to_sphere and
// from_sphere.
void ty_trace_fit_ellipsoid(ty_trace_prototype* prototype);

// Makes the object's aggregate one user geometry. NULL when Embree refuses.
RTCGeometry ty_trace_create_user_geometry(const ty_world* world, ty_trace_object* object);

// Rejects hits that the ray of a ty_trace_context passes through.
void ty_trace_filter(const struct RTCFilterFunctionNArguments* args);
