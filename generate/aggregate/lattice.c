// SPDX-License-Identifier: Apache-2.0
// A regular lattice as the start of a full simulation, and the measure that tells a lattice from a pile.
#include "start.h"
#include <string.h>

// --- sites ---

// Both ends and the middle of an element that lies along x keep half its width from every wall.
static bool site_is_free(const ty_container* c, ty_vec3 p, ty_vec3 pitch)
{
    ty_bounds interior = ty_container_interior(c);
    bool above = ty_container_is_open(c) && p.y >= interior.high.y;
    float half = 0.5f * ty_max(pitch.y, pitch.z), reach = ty_max(0.0f, 0.5f * pitch.x - half);
    for (int e = -1; e <= 1; e++)
    {
        ty_vec3 q = {p.x + (float)e * reach, p.y, p.z}, n;
        if (above && interior.high.y > interior.low.y) // over the rim, in the column of the hollow
            q.y = interior.high.y - 1e-3f * (interior.high.y - interior.low.y);
        if (!ty_container_holds(c, q))
            return false;
        for (int w = 0; w < ty_container_wall_count(c); w++)
            if (ty_container_wall(c, w, q, &n) < half)
                return false;
    }
    return true;
}

int ty_fill_lattice(const ty_container* c, ty_vec3 pitch, int count, ty_vec3* out)
{
    ty_bounds b = ty_container_interior(c);
    ty_vec3 size = ty_sub(b.high, b.low);
    int nx = (int)(size.x / pitch.x) + 2, nz = (int)(size.z / pitch.z) + 2, found = 0;
    float x0 = 0.5f * (b.low.x + b.high.x - (float)(nx - 1) * pitch.x);
    float z0 = 0.5f * (b.low.z + b.high.z - (float)(nz - 1) * pitch.z);
    for (int j = 0; found < count; j++)
    {
        float y = b.low.y + pitch.y * ((float)j + 0.5f);
        int before = found;
        for (int k = 0; k < nz; k++)
            for (int i = 0; i < nx && found < count; i++)
            {
                ty_vec3 p = {x0 + (float)i * pitch.x, y, z0 + (float)k * pitch.z};
                if (site_is_free(c, p, pitch))
                    out[found++] = p;
            }
        if (y > b.high.y && (!ty_container_is_open(c) || found == before))
            break;
    }
    return found;
}

// --- repetition ---

enum
{
    SPAN = 4,       // displacements up to this many cells count
    PARTS = 4,      // bins a cell
    ORIGINS = 8000, // bodies whose neighbours are counted, at most
    SIDE = 2 * SPAN * PARTS + 1,
};

typedef struct buckets
{
    ty_vec3 low;
    float cell;
    int size[3];
    int* first; // of each bucket's chain, -1 = none
    int* next;
} buckets;

static int bucket_of(const buckets* b, ty_vec3 p, int c[3])
{
    c[0] = (int)((p.x - b->low.x) / b->cell), c[1] = (int)((p.y - b->low.y) / b->cell);
    c[2] = (int)((p.z - b->low.z) / b->cell);
    return (c[2] * b->size[1] + c[1]) * b->size[0] + c[0];
}

static buckets buckets_create(const ty_body* bodies, int count, float cell)
{
    ty_bounds box = ty_bounds_empty();
    for (int i = 0; i < count; i++)
        box = ty_bounds_add(box, bodies[i].position);
    ty_vec3 size = ty_sub(box.high, box.low);
    float most = ty_max(size.x, ty_max(size.y, size.z));
    buckets b = {.low = box.low, .cell = ty_max(cell, most / 255.0f)};
    b.size[0] = (int)(size.x / b.cell) + 1, b.size[1] = (int)(size.y / b.cell) + 1;
    b.size[2] = (int)(size.z / b.cell) + 1;
    int cells = b.size[0] * b.size[1] * b.size[2], c[3];
    b.first = TY_ALLOC(int, cells);
    b.next = TY_ALLOC(int, count);
    memset(b.first, 0xff, (size_t)cells * sizeof(int));
    for (int i = count - 1; i >= 0; i--)
    {
        int at = bucket_of(&b, bodies[i].position, c);
        b.next[i] = b.first[at];
        b.first[at] = i;
    }
    return b;
}

static void buckets_destroy(buckets* b)
{
    ty_free(b->first);
    ty_free(b->next);
}

// The bin of a displacement, shared between the two nearest in each direction so that none falls on an edge.
static void displacement_count(float* bins, ty_vec3 d, float cell)
{
    float q[3] = {d.x, d.y, d.z}, f[3];
    int at[3];
    for (int a = 0; a < 3; a++)
    {
        float x = (q[a] / cell + (float)SPAN) * (float)PARTS;
        if (!(x >= 0.0f && x < (float)(SIDE - 1)))
            return;
        at[a] = (int)x;
        f[a] = x - (float)at[a];
    }
    for (int e = 0; e < 8; e++)
    {
        float w = (e & 1 ? f[0] : 1.0f - f[0]) * (e & 2 ? f[1] : 1.0f - f[1]) * (e & 4 ? f[2] : 1.0f - f[2]);
        bins[((at[2] + (e >> 2 & 1)) * SIDE + at[1] + (e >> 1 & 1)) * SIDE + at[0] + (e & 1)] += w;
    }
}

static void neighbours_count(const buckets* b, const ty_body* bodies, int i, float cell, float* bins)
{
    int c[3];
    bucket_of(b, bodies[i].position, c);
    int reach = (int)((float)SPAN * cell / b->cell) + 1;
    for (int z = c[2] - reach; z <= c[2] + reach; z++)
        for (int y = c[1] - reach; y <= c[1] + reach; y++)
            for (int x = c[0] - reach; x <= c[0] + reach; x++)
            {
                if (x < 0 || y < 0 || z < 0 || x >= b->size[0] || y >= b->size[1] || z >= b->size[2])
                    continue;
                for (int j = b->first[(z * b->size[1] + y) * b->size[0] + x]; j >= 0; j = b->next[j])
                    if (j != i)
                        displacement_count(bins, ty_sub(bodies[j].position, bodies[i].position), cell);
            }
}

float ty_pile_repeat(const ty_body* bodies, int count, float cell)
{
    if (count < 2)
        return 0.0f;
    buckets b = buckets_create(bodies, count, cell);
    size_t bin_count = (size_t)SIDE * SIDE * SIDE;
    float* bins = TY_ALLOC(float, bin_count);
    int stride = 1 + (count - 1) / ORIGINS, origins = 0;
    for (int i = 0; i < count; i += stride, origins++)
        neighbours_count(&b, bodies, i, cell, bins);
    float most = 0.0f;
    for (size_t i = 0; i < bin_count; i++)
        most = ty_max(most, bins[i]);
    buckets_destroy(&b);
    ty_free(bins);
    return most / (float)origins;
}
