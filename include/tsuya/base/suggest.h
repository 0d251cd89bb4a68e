// SPDX-License-Identifier: Apache-2.0
// "Did you mean": the nearest of some names.
#pragma once

// The name with the smallest edit distance (a swap of neighbours counts 1, letter case 0) if it is near enough to be a
// slip: at most a third of the word's length, at least 1. NULL otherwise. names may hold NULL entries.
const char* ty_suggest_name(const char* word, const char* const* names, int count);
