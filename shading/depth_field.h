// SPDX-License-Identifier: Apache-2.0
// Per-vertex thickness and curvature, in the prototype's units.
#pragma once
#include <tsuya/shading/material.h>

struct ty_depth_field
{
    float* depth;     // [vertex_count] D > 0
    float* curvature; // [vertex_count] H >= 0
};
