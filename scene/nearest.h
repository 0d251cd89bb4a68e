// SPDX-License-Identifier: Apache-2.0
// The tail of a message about an unknown name: "; did you mean 'x'?" or what there is.
#pragma once
#include "yaml_tree.h"
#include <tsuya/base/params.h>

#define TY_NEAREST_SIZE 400

// names may hold NULL entries. Returns buffer: a suggestion, else the names (as many as fit), else "".
const char* ty_nearest(const char* word, const char* const* names, int count, char buffer[TY_NEAREST_SIZE]);
const char* ty_nearest_key(const char* word, const ty_node* map, char buffer[TY_NEAREST_SIZE]); // map may be NULL
