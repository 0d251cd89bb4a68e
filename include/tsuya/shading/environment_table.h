// SPDX-License-Identifier: Apache-2.0
// Environment images as densities over directions. They depend on the image alone: not on how it is turned, or tinted.
#pragma once
#include <tsuya/image/texture.h>
#include <tsuya/shading/sampling.h>

typedef struct ty_environment_table
{
    float mean;                    // luminance over the sphere
    ty_distribution* distribution; // over (azimuth, angle from above) in 0..1; NULL = so even that rays find its light
} ty_environment_table;

// A latitude-longitude image. .1 s a megapixel on one thread.
void ty_environment_table_init(ty_environment_table* table, const ty_texture* image);
void ty_environment_table_term(ty_environment_table* table); // one of zeros is allowed
