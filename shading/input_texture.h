// SPDX-License-Identifier: Apache-2.0
// What the texture of an input gives at a point.
#pragma once
#include <tsuya/shading/material.h>

// Of the channel asked for, before scale and offset; grey but for TY_CHANNEL_ALL.
ty_rgb ty_input_texel(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point);
