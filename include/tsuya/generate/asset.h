// SPDX-License-Identifier: Apache-2.0
// Make this asset: the one header through which scene/ and cli/ reach the generators.
#pragma once
#include <tsuya/base/params.h>
#include <tsuya/base/status.h>
#include <tsuya/base/workers.h>
#include <tsuya/geometry/aggregate.h>

// A kind of recipe. The def struct is described by params; scene/ fills it from YAML.
typedef struct ty_generator
{
    const char* kind;             // the recipe's `kind:`, e.g. "aggregate"
    const char* build_id;         // changes when the same recipe would give another result
    const ty_param_table* params; // of the whole recipe
    // Deterministic for any worker count. On failure *out is NULL. Cancelled: TY_INTERRUPTED.
    // TY_NOT_AT_REST still gives *out (the best state, its metrics say so).
    ty_status (*make)(const void* def, ty_workers* workers, ty_aggregate** out, ty_error* error);
} ty_generator;

const ty_generator* ty_generator_find(const char* kind); // NULL if unknown
const ty_generator* const* ty_generator_list(int* count);
