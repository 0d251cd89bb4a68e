// SPDX-License-Identifier: Apache-2.0
// Value noise in space, the same bits on every CPU.
#pragma once
#include <tsuya/base/math.h>

// Random values at the points of the unit lattice, blended by cubics: -1..1. p within the range of int. Any thread.
float ty_value_noise(ty_vec3 p, uint32_t seed);
