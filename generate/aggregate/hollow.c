// SPDX-License-Identifier: Apache-2.0
// Floods a grid from its sides below a row: what stays dry under that row is what a vessel holds.
#include "hollow.h"
#include <string.h>
#include <tsuya/base/memory.h>

typedef struct flood
{
    const bool* empty;
    const int* size;
    bool* wet;  // reached from outside
    bool* kept; // dry, and open to above
    int* stack;
    int rim, depth;
} flood;

static void pour(flood* f, bool* mark, int x, int y, int z)
{
    if (x < 0 || y < 0 || z < 0 || x >= f->size[0] || y > f->rim || z >= f->size[2])
        return;
    int at = (z * f->size[1] + y) * f->size[0] + x;
    if (!f->empty[at] || f->wet[at] || mark[at])
        return;
    mark[at] = true;
    f->stack[f->depth++] = at;
}

// Spreads what was poured to all it reaches below the rim; returns how many nodes that were.
static int spread(flood* f, bool* mark)
{
    const int* n = f->size;
    int count = 0;
    for (; f->depth > 0; count++)
    {
        int at = f->stack[--f->depth], x = at % n[0], y = at / n[0] % n[1], z = at / (n[0] * n[1]);
        pour(f, mark, x - 1, y, z);
        pour(f, mark, x + 1, y, z);
        pour(f, mark, x, y - 1, z);
        pour(f, mark, x, y + 1, z);
        pour(f, mark, x, y, z - 1);
        pour(f, mark, x, y, z + 1);
    }
    return count;
}

// Pours in from above, down each column that is clear to the rim.
static void columns_pour(flood* f)
{
    const int* n = f->size;
    for (int z = 0; z < n[2]; z++)
        for (int x = 0; x < n[0]; x++)
        {
            int y = n[1] - 1;
            while (y > f->rim && f->empty[(z * n[1] + y) * n[0] + x])
                y--;
            if (y == f->rim)
                pour(f, f->kept, x, y, z);
        }
}

// Wets all that is reached from the sides and the floor, then fills what is dry from above; returns how much that is.
static int flood_run(flood* f)
{
    const int* n = f->size;
    size_t nodes = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    memset(f->wet, 0, nodes * sizeof(bool));
    memset(f->kept, 0, nodes * sizeof(bool));
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y <= f->rim; y++)
            for (int x = 0; x < n[0]; x += z == 0 || y == 0 || z == n[2] - 1 || x == n[0] - 1 ? 1 : n[0] - 1)
                pour(f, f->wet, x, y, z);
    spread(f, f->wet);
    columns_pour(f);
    return spread(f, f->kept);
}

int ty_hollow_find(const bool* empty, const int size[3], bool* hollow)
{
    size_t nodes = (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
    flood f = {
        .empty = empty, .size = size, .wet = TY_ALLOC(bool, nodes), .kept = hollow, .stack = TY_ALLOC(int, nodes)};
    int best = 0, rim = -1;
    for (f.rim = 0; f.rim < size[1]; f.rim++)
    {
        int held = flood_run(&f);
        if (held > best)
        {
            best = held;
            rim = f.rim;
        }
    }
    f.rim = rim;
    flood_run(&f); // at -1 nothing is marked
    ty_free(f.wet);
    ty_free(f.stack);
    return rim;
}
