// SPDX-License-Identifier: Apache-2.0
// The hollow of a vessel on a grid: what stays when one pours into it.
#pragma once
#include <stdbool.h>
#include <stddef.h>

// empty[size 2][size 1][size 0] says which nodes no material fills; y is the second axis. Marks those that hold what is
// poured up to the rim: empty, at or below the rim's row, open to above, and cut off from the sides and the floor of
// the grid below it. The rim's row is that of the most such nodes; -1 when there are none.
int ty_hollow_find(const bool* empty, const int size[3], bool* hollow);
