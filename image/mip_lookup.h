// SPDX-License-Identifier: Apache-2.0
// Filtered lookups in one converted image.
#pragma once
#include "mip_cache.h"

// Adds weight times the filtered texel to sum: as many numbers as the image has channels. The arguments are those of
// ty_mip_texture_sample.
void ty_mip_image_add(ty_mip_cache* cache, const ty_mip_image* image, const ty_wrap wrap[2], ty_vec2 uv, ty_vec2 du,
                      ty_vec2 dv, float weight, float sum[4]);
