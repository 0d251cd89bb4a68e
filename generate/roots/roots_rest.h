// SPDX-License-Identifier: Apache-2.0
// What the files that lay lines on the host share.
#pragma once
#include "roots_growth.h"

typedef struct resting
{
    const roots_host* host;
    float sink; // of the recipe
    bool exact;
} resting;

// Of a place over the host, with the unit normal there: over the mesh itself, or by the field where that will do. Reach
// follows from the field, so that few triangles are asked.
static inline float rest_height(const resting* on, ty_vec3 p, ty_vec3* n)
{
    float value = roots_host_value(on->host, p, n);
    if (on->exact)
        return roots_host_exact(on->host, p, fabsf(value) + 2.0f * on->host->field.step, n);
    *n = ty_normalize(*n);
    return value;
}

// How much higher than by itself each point of a line lies, m, as it comes out of the roots that it joins.
void rest_over(const resting* on, const roots_network* net, const roots_line* line, float* over);
// Turns the ends of a line along the roots that it joins.
void rest_ends(const resting* on, const roots_network* net, const roots_line* line, const float* over);
// A step beyond the first or last point of a line: back along the root that it joins there, or straight on.
ty_vec3 rest_beyond(const roots_network* net, const roots_line* line, bool last);
