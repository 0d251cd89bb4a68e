// SPDX-License-Identifier: Apache-2.0
// Fuzz: a layer of upright fibres, seen most at grazing angles. Local frame, both cosines positive.
#pragma once
#include <tsuya/base/math.h>

// f of white fuzz, without cosine: microfacets of sin^(1/r) about the normal with their own shadowing (Estevez & Kulla
// 2017, "Production friendly microfacet sheen BRDF"). Reciprocal, and passes on less than it gets.
float ty_fuzz_value(float roughness, ty_vec3 wo, ty_vec3 wi);
float ty_fuzz_albedo(float roughness, float mu); // by quadrature: for tables
