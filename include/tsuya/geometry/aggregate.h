// SPDX-License-Identifier: Apache-2.0
// Aggregates: prototypes and where they stand. Files are GLB with EXT_mesh_gpu_instancing.
#pragma once
#include <tsuya/base/file.h>
#include <tsuya/geometry/mesh.h>

typedef struct ty_instance_attribute
{
    char name[32]; // without the leading underscore of the file, lower case: "moisture", "tint"
    float* values; // [instance_count]
} ty_instance_attribute;

// Owned arrays. Instance order is part of the identity of the file.
typedef struct ty_aggregate
{
    ty_mesh** prototypes;    // owned, unless:
    bool borrows_prototypes; // somebody else destroys the meshes
    int prototype_count;
    uint32_t instance_count;
    ty_affine* transforms;     // [instance_count] prototype to aggregate space
    uint32_t* prototype_index; // [instance_count]
    uint32_t* ids;             // [instance_count]
    ty_vec3* velocities;       // [instance_count] m/s, of the instance's origin; NULL = none are known
    ty_vec3* spins;            // [instance_count] rad/s, about it, in aggregate space; NULL = none are known
    ty_instance_attribute* attributes;
    int attribute_count;
    char* recipe;   // the text that made it, or NULL
    char* hash;     // hex, or NULL
    char* metrics;  // a JSON object as text, or NULL
    ty_bytes state; // what its generator needs to go on, or empty; files are read without it
} ty_aggregate;

TY_CHECKED ty_aggregate* ty_aggregate_create(uint32_t instance_count, int prototype_count); // NULL: no memory
void ty_aggregate_destroy(ty_aggregate* aggregate);                                         // NULL is allowed
float* ty_aggregate_add_attribute(ty_aggregate* aggregate, const char* name);               // zeros, owned
ty_vec3* ty_aggregate_add_velocities(ty_aggregate* aggregate); // zeros where there are none yet, owned
ty_vec3* ty_aggregate_add_spins(ty_aggregate* aggregate);      // the same
const ty_instance_attribute* ty_aggregate_find_attribute(const ty_aggregate* aggregate, const char* name);

// TRANSLATION, ROTATION, SCALE (and _MATRIX0..2 where an instance is sheared), _ID, _VELOCITY and _SPIN where they are
// known, every attribute as _NAME; one node a prototype; recipe, hash and metrics in the asset's extras. A prototype's
// slot, where it has one, is a material of that name. Equal input, equal bytes. Atomic.
TY_CHECKED ty_status ty_aggregate_write(const char* path, const ty_aggregate* aggregate, ty_error* error);

// Reads GLB in a child process after our own header checks; also PLY points (x y z, orient, pscale, v, w, attributes)
// with the given prototype mesh (NULL for GLB). An empty aggregate, missing prototype, singular matrix, or non-finite
// value is TY_BAD_FILE that names the instance.
TY_CHECKED ty_status ty_aggregate_read(const char* path, const ty_mesh* points_prototype, ty_aggregate** out,
                                       ty_error* error);

// The state that a GLB holds, freed by the caller; a file without is TY_BAD_FILE. No importer is asked.
TY_CHECKED ty_status ty_aggregate_read_state(const char* path, ty_bytes* out, ty_error* error);
// The same from memory.
TY_CHECKED ty_status ty_aggregate_find_state(const char* name, const void* bytes, size_t size, ty_bytes* out,
                                             ty_error* error);

// Our own bounded check of a GLB's header, chunks and lengths, before any library sees it. For fuzzing too.
TY_CHECKED ty_status ty_glb_check(const char* name, const void* bytes, size_t size, ty_error* error);

// All that ty_aggregate_read checks of a GLB before the importer sees it: the above, and every count, index and length
// in its JSON against the bytes.
TY_CHECKED ty_status ty_aggregate_check(const char* name, const void* bytes, size_t size, ty_error* error);
