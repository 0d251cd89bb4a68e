// SPDX-License-Identifier: Apache-2.0
// The k-th smallest of many numbers.
#pragma once
#include <stdint.h>

// Reorders finite values so that those before index k are not above values[k] and those after it not below; returns
// values[k]. Linear time on average (Hoare 1961).
float ty_select(float* values, int64_t count, int64_t k);
