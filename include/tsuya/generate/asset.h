// SPDX-License-Identifier: Apache-2.0
// Make this asset: the one header through which scene/ and cli/ reach the generators.
#pragma once
#include <tsuya/base/params.h>
#include <tsuya/base/status.h>
#include <tsuya/base/workers.h>
#include <tsuya/geometry/aggregate.h>
#include <tsuya/image/exr.h>

typedef enum ty_product
{
    TY_PRODUCT_AGGREGATE,
    TY_PRODUCT_MESH,
    TY_PRODUCT_FRAMES, // pictures 1..n of a loop
} ty_product;

// Takes the frames of a sequence as they are made, each once, in any order: numbers from 1. The image is the
// generator's own; put may add attributes. A failure of put ends the making.
typedef struct ty_frame_sink
{
    ty_status (*put)(void* context, int frame, ty_exr* image, ty_error* error);
    // Where somebody keeps what a run goes on from: once, at its end or when it is interrupted after a frame. NULL:
    // nobody does.
    ty_status (*keep)(void* context, ty_exr* state, ty_error* error);
    void* context;
} ty_frame_sink;

// The same for a film of aggregates, in order. put may sign the aggregate; it stays the generator's.
typedef struct ty_aggregate_sink
{
    ty_status (*put)(void* context, int frame, ty_aggregate* aggregate, ty_error* error);
    void* context;
} ty_aggregate_sink;

// The same for meshes that grow.
typedef struct ty_mesh_sink
{
    ty_status (*put)(void* context, int frame, ty_mesh* mesh, ty_error* error);
    void* context;
} ty_mesh_sink;

// One of these, by product.
typedef struct ty_made
{
    ty_aggregate* aggregate; // made; the caller's
    ty_mesh* mesh;           // the same
    ty_frame_sink frames;    // given by the caller
    ty_aggregate_sink film;  // given where the caller wants an aggregate as a film; then there is no aggregate
    ty_mesh_sink growth;     // given where the caller wants a mesh's growth as frames; then there is no mesh
    ty_mesh_sink levels;     // given where the caller wants a mesh's coarser levels, from 1, beside it
    char* report; // of loops, and of roots where it is wanted: figures, a JSON object as text; the caller frees it with
                  // ty_free; else NULL
    char* curves; // of roots, where they are wanted: their centre lines, an ASCII PLY; the same
    ty_mesh* host; // of roots, the same: what they hold on to, in its place
    bool wants_report, wants_curves, wants_host;
    const char* cache; // given: a folder for what is costly and the same in another run; NULL = none
    const ty_bytes*
        state; // given where the making of an aggregate or of frames goes on from one that is kept; else NULL
} ty_made;

enum
{
    TY_FRAME_CHANNELS = 32,
};

// Of frames, besides the picture's own.
typedef struct ty_frame_channel
{
    char name[64];
    const char* output; // which of the recipe's `outputs` brings it
} ty_frame_channel;

// A kind of recipe. The def struct is described by params; scene/ fills it from YAML.
typedef struct ty_generator
{
    const char* kind;     // the recipe's `kind:`, e.g. "aggregate"
    const char* build_id; // changes when the same recipe would give another result
    ty_product product;
    const ty_param_table* params;        // of the whole recipe
    int (*frame_count)(const void* def); // of a sequence, or of a mesh that grows, at least 1; else NULL
    int (*channels)(const void* def, ty_frame_channel out[TY_FRAME_CHANNELS]); // how many there can be; NULL: none
    // Deterministic for any worker count. On failure *out is as before. Cancelled: TY_INTERRUPTED.
    // TY_NOT_AT_REST still gives an aggregate (the best state, its metrics say so).
    ty_status (*make)(const void* def, ty_workers* workers, ty_made* out, ty_error* error);
    // The mesh of one element alone, from 1: of aggregates; else NULL. The caller's; on failure *out is NULL.
    ty_status (*element)(const void* def, int number, ty_mesh** out, ty_error* error);
} ty_generator;

const ty_generator* ty_generator_find(const char* kind); // NULL if unknown
const ty_generator* const* ty_generator_list(int* count);
