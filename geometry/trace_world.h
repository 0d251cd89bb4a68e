// SPDX-License-Identifier: Apache-2.0
// What a world is made of: shared by the files that build it and those that query it.
#pragma once
#include "embree_compat.h"
#include <stdatomic.h>
#include <tsuya/geometry/trace.h>

typedef struct ty_trace_wide ty_trace_wide;

typedef struct ty_trace_prototype
{
    const ty_mesh* mesh; // borrowed; NULL = a free slot
    RTCScene scene;      // the mesh in its own space
    RTCScene moving;     // the same over the open shutter; NULL = it keeps its form
    ty_mesh_topology topology;
    ty_bounds bounds;      // in its own space, over the whole shutter
    ty_affine to_sphere;   // carries the bounding ellipsoid to the unit sphere, once the wide level holds it
    ty_affine from_sphere; // its inverse
    bool has_ellipsoid;
    uint8_t* horizons;      // by triangle, in TY_HORIZON_STEPS; 255 = none; owned; NULL = not known
    float inner_radius_sqr; // a ball about the sphere's centre that lies inside the closed surface; 0 = none
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
    bool is_identity;              // at rest where the aggregate's transforms put it, with all of its instances
    float open, close;             // as ty_motion's
    bool* drifts;                  // [count] the instance moves by itself; owned; NULL = none does
    uint32_t* drifting;            // [drift_count] those that do; owned
    float* reaches;                // [drift_count] radius about their origins, world; owned
    uint32_t drift_count;
    int drift_steps;    // between which their boxes move linearly
    uint64_t one_sided; // slots, as in ty_object_flags
    uint32_t mask;
    ty_trace_wide* wide; // a moving aggregate's instances in its own space; owned
} ty_trace_object;

struct ty_world
{
    char* isa;           // kernels in use, owned
    ty_workers* workers; // borrowed until commit returns
    RTCDevice device;
    RTCScene scene;      // NULL before commit; fast path: what is not in `wide`
    ty_trace_wide* wide; // fast path: the instances at rest; NULL = none
    bool has_rest;       // fast path: the scene is not empty
    bool use_avx512;
    ty_trace_path path;
    bool filters_rest; // something in the scene honours TY_RAY_FRONT_ONLY

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

// What rays of a time meet.
static inline RTCScene ty_trace_scene_of(const ty_trace_prototype* prototype)
{
    return prototype->moving ? prototype->moving : prototype->scene;
}

// A corner of a mesh with steps, or its normal, as Embree has it.
static inline ty_vec3 ty_trace_step_value(const ty_mesh* mesh, const ty_vec3* steps, uint32_t vertex, float time)
{
    float x = ty_clamp(time, 0.0f, 1.0f) * (float)(mesh->step_count - 1);
    int k = (int)x;
    k = k > mesh->step_count - 2 ? mesh->step_count - 2 : k;
    const ty_vec3* at = &steps[(size_t)k * mesh->vertex_count + vertex];
    return ty_lerp3(at[0], at[mesh->vertex_count], x - (float)k);
}

// --- trace.c ---
// Embree's first error since it was last asked, as a status.
TY_CHECKED ty_status ty_trace_take_error(ty_world* world, const char* doing, ty_error* error);
// Room for one more element behind count; *capacity doubles.
TY_CHECKED bool ty_trace_make_room(void** array, uint32_t count, uint32_t* capacity, size_t size);

// --- trace_object.c ---
void ty_trace_free_objects(ty_world* world);
static inline uint32_t ty_trace_prototype_of(const ty_trace_object* object, uint32_t instance)
{
    return object->prototypes[object->aggregate ? object->aggregate->prototype_index[instance] : 0];
}
// An instance within its object, before the object's own map.
ty_affine ty_trace_inner_map(const ty_trace_object* object, uint32_t instance);
// Prototype to world where it lies nowhere: of what moves, or of two maps.
ty_affine ty_trace_made_map(const ty_trace_object* object, uint32_t instance, float time);
// The same of any, where it lies or in scratch: a copy just written costs more to read than a hit's arithmetic.
static inline const ty_affine* ty_trace_to_world(const ty_trace_object* object, uint32_t instance, float time,
                                                 ty_affine* scratch)
{
    if (object->aggregate && object->is_identity)
        return &object->aggregate->transforms[instance];
    if (!object->aggregate && object->step_count == 1)
        return &object->steps[0];
    *scratch = ty_trace_made_map(object, instance, time);
    return scratch;
}
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
// The largest ball about the sphere's centre inside the closed mesh.
void ty_trace_fit_inner(const ty_world* world, uint32_t prototype);

// --- trace_wide_build.c ---
// The wide level over the instances of these objects, none of which moves (or of one that does, in its own space);
// NULL and TY_OK without any. Owned by the caller.
TY_CHECKED ty_status ty_trace_wide_create(ty_world* world, const uint32_t* objects, uint32_t object_count,
                                          ty_trace_wide** out, ty_error* error);
void ty_trace_wide_destroy(ty_trace_wide* wide); // NULL is allowed
uint64_t ty_trace_wide_memory(const ty_trace_wide* wide);
// Where an instance at rest stands in the world; for a moving object, in the object's space.
ty_affine ty_trace_placed(const ty_trace_object* object, uint32_t instance);
// From there to the prototype's sphere. False = singular.
bool ty_trace_sphere_map(const ty_world* world, const ty_trace_object* object, uint32_t instance, ty_affine* out);

// --- trace_horizon.c ---
#define TY_HORIZON_STEPS 1000.0f
// Sine of the elevation over each triangle's plane above which the mesh is not to be seen from there. Quadratic in the
// triangles; not done for large meshes.
void ty_trace_find_horizons(ty_trace_prototype* prototype);

// --- trace_moving.c ---
// A moving object as a user geometry of one primitive. NULL when Embree refuses.
RTCGeometry ty_trace_create_moving_geometry(const ty_world* world, ty_trace_object* object);
// Box of the object at a step.
ty_bounds ty_trace_step_bounds(const ty_trace_object* object, int step);

// --- trace_drift.c ---
// Which instances of an aggregate move by their own velocities while the shutter is open. Paths that leave the finite
// are refused.
TY_CHECKED ty_status ty_trace_find_drift(ty_trace_object* object, ty_motion motion, ty_error* error);
// One that does, within its object at a time.
ty_affine ty_trace_drifted(const ty_trace_object* object, uint32_t instance, float time);
// Steps as fine as an instance's own turn and the object's motion need to be linear between.
int ty_trace_drift_steps(const ty_trace_object* object, uint32_t instance);
ty_bounds ty_trace_drift_bounds(const ty_trace_object* object, uint32_t instance, int step);
// They are a user geometry of one primitive each. NULL when Embree refuses.
RTCGeometry ty_trace_create_drifting_geometry(const ty_world* world, ty_trace_object* object);

// --- trace_query.c ---
// Rejects hits that the ray of a ty_trace_context passes through.
void ty_trace_filter(const struct RTCFilterFunctionNArguments* args);
// Through the wide level: the nearest hit before ray_hit->ray.tfar, left there as Embree leaves one of a user geometry,
// with the instance as geomID. Origin and direction are ray_hit's, all else is the ray's.
void ty_trace_wide_intersect(const ty_world* world, const ty_trace_wide* wide, const ty_ray* ray,
                             struct RTCRayHit* ray_hit);
bool ty_trace_wide_occluded(const ty_world* world, const ty_trace_wide* wide, const ty_ray* ray,
                            const struct RTCRay* embree_ray);
// The filter is asked only where it can reject something.
RTCFilterFunctionN ty_trace_needed_filter(const ty_trace_object* object, const ty_ray* ray, uint32_t instance);
