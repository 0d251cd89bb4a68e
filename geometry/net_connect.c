// SPDX-License-Identifier: Apache-2.0
// Vertices and faces of a sparse surface net: counted block by block, then written where the sums say.
#include "net.h"
#include <string.h>

typedef struct join
{
    ty_net* net;
    int32_t* firsts; // of each slot: how many before it, [active_count + 1]
} join;

// Counts become sums; the total.
static int64_t sums_make(join* j)
{
    int64_t sum = 0;
    for (int slot = 0; slot <= j->net->def.active_count; slot++)
    {
        int32_t own = slot < j->net->def.active_count ? j->firsts[slot] : 0;
        j->firsts[slot] = (int32_t)sum;
        sum += own;
    }
    return sum;
}

// --- vertices ---

static int cell_inside(const float* low)
{
    int inside = 0;
    for (int c = 0; c < 8; c++)
        inside |= (low[((c >> 2) * NET_PAD + (c >> 1 & 1)) * NET_PAD + (c & 1)] < 0.0f) << c;
    return inside;
}

// The mean of where the cell's edges cross the surface, in steps from its lowest node.
static ty_vec3 cell_middle(const float* low)
{
    static const int node[8] = {0,
                                1,
                                NET_PAD,
                                NET_PAD + 1,
                                NET_PAD * NET_PAD,
                                NET_PAD * NET_PAD + 1,
                                NET_PAD * NET_PAD + NET_PAD,
                                NET_PAD * NET_PAD + NET_PAD + 1};
    float sum[3] = {0.0f, 0.0f, 0.0f};
    int count = 0;
    for (int a = 0; a < 8; a++)
        for (int axis = 0; axis < 3; axis++)
        {
            float from = low[node[a]], to = low[node[a | 1 << axis]];
            if (a >> axis & 1 || (from < 0.0f) == (to < 0.0f))
                continue;
            for (int i = 0; i < 3; i++)
                sum[i] += i == axis ? from / (from - to) : (float)(a >> i & 1);
            count++;
        }
    return ty_mul(ty_vec3_make(sum[0], sum[1], sum[2]), 1.0f / (float)count);
}

static void vertices_count(void* context, int64_t begin, int64_t end, int worker)
{
    const join* j = context;
    float pad[NET_PAD * NET_PAD * NET_PAD];
    (void)worker;
    for (int64_t slot = begin; slot < end; slot++)
    {
        int32_t* cells = j->net->cells + slot * TY_NET_NODES;
        int count = 0;
        memset(cells, 0xff, TY_NET_NODES * sizeof(int32_t));
        j->firsts[slot] = 0;
        if (!j->net->crossed[slot])
            continue;
        net_pad_values(j->net, (int)slot, pad);
        for (int node = 0; node < TY_NET_NODES; node++)
        {
            int x = node % TY_NET_BLOCK, y = node / TY_NET_BLOCK % TY_NET_BLOCK, z = node / TY_NET_BLOCK / TY_NET_BLOCK;
            int inside = cell_inside(pad + (z * NET_PAD + y) * NET_PAD + x);
            if (inside != 0 && inside != 255)
                cells[node] = count++;
        }
        j->firsts[slot] = count;
    }
}

static void vertices_place(void* context, int64_t begin, int64_t end, int worker)
{
    const join* j = context;
    ty_net* net = j->net;
    float pad[NET_PAD * NET_PAD * NET_PAD];
    (void)worker;
    for (int64_t slot = begin; slot < end; slot++)
    {
        int32_t* cells = net->cells + slot * TY_NET_NODES;
        int block[3];
        if (j->firsts[slot] == j->firsts[slot + 1])
            continue;
        net_pad_values(net, (int)slot, pad);
        net_block_of(net, (int)slot, block);
        for (int node = 0; node < TY_NET_NODES; node++)
        {
            if (cells[node] < 0)
                continue;
            int x = node % TY_NET_BLOCK, y = node / TY_NET_BLOCK % TY_NET_BLOCK, z = node / TY_NET_BLOCK / TY_NET_BLOCK;
            int32_t v = cells[node] += j->firsts[slot];
            ty_vec3 low = {(float)(block[0] * TY_NET_BLOCK + x), (float)(block[1] * TY_NET_BLOCK + y),
                           (float)(block[2] * TY_NET_BLOCK + z)};
            net->positions[v] = ty_add(low, cell_middle(pad + (z * NET_PAD + y) * NET_PAD + x));
            net->places[v] = (uint32_t)(slot * TY_NET_NODES + node);
        }
    }
}

// --- neighbours and quads ---

// Vertices of cells -1..8 of a block each way.
static void pad_cells(const ty_net* net, int slot, int32_t out[NET_WIDE * NET_WIDE * NET_WIDE])
{
    static const int from[3] = {0, 1, TY_NET_BLOCK + 1}, count[3] = {1, TY_NET_BLOCK, 1};
    static const int first[3] = {TY_NET_BLOCK - 1, 0, 0};
    int block[3];
    net_block_of(net, slot, block);
    for (int side = 0; side < 27; side++)
    {
        int s[3] = {side % 3, side / 3 % 3, side / 9};
        int32_t other = net_slot(net, block[0] + s[0] - 1, block[1] + s[1] - 1, block[2] + s[2] - 1);
        const int32_t* cells = other < 0 ? NULL : net->cells + (size_t)other * TY_NET_NODES;
        for (int z = 0; z < count[s[2]]; z++)
            for (int y = 0; y < count[s[1]]; y++)
            {
                int32_t* row = out + ((z + from[s[2]]) * NET_WIDE + y + from[s[1]]) * NET_WIDE + from[s[0]];
                int at = ((z + first[s[2]]) * TY_NET_BLOCK + y + first[s[1]]) * TY_NET_BLOCK + first[s[0]];
                for (int x = 0; x < count[s[0]]; x++)
                    row[x] = cells ? cells[at + x] : -1;
            }
    }
}

static const int pad_step[3] = {1, NET_PAD, NET_PAD* NET_PAD};
static const int wide_step[3] = {1, NET_WIDE, NET_WIDE* NET_WIDE};

// Across each face of the cell that the surface passes.
static void cell_neighbours(const float* low, const int32_t* cell, int32_t out[6])
{
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++)
        {
            const float* face = low + side * pad_step[axis];
            int b = pad_step[(axis + 1) % 3], c = pad_step[(axis + 2) % 3];
            int inside = (face[0] < 0.0f) + (face[b] < 0.0f) + (face[c] < 0.0f) + (face[b + c] < 0.0f);
            bool passes = inside > 0 && inside < 4;
            out[2 * axis + side] = passes ? cell[(2 * side - 1) * wide_step[axis]] : -1;
        }
}

static void neighbours_find(void* context, int64_t begin, int64_t end, int worker)
{
    const join* j = context;
    ty_net* net = j->net;
    float pad[NET_PAD * NET_PAD * NET_PAD];
    int32_t wide[NET_WIDE * NET_WIDE * NET_WIDE];
    (void)worker;
    for (int64_t slot = begin; slot < end; slot++)
    {
        int quads = 0;
        if (net->crossed[slot])
        {
            net_pad_values(net, (int)slot, pad);
            pad_cells(net, (int)slot, wide);
            for (int node = 0; node < TY_NET_NODES; node++)
            {
                int x = node % TY_NET_BLOCK, y = node / TY_NET_BLOCK % TY_NET_BLOCK;
                int z = node / TY_NET_BLOCK / TY_NET_BLOCK;
                const float* low = pad + (z * NET_PAD + y) * NET_PAD + x;
                const int32_t* cell = wide + ((z + 1) * NET_WIDE + y + 1) * NET_WIDE + x + 1;
                if (*cell >= 0)
                    cell_neighbours(low, cell, net->neighbours[*cell]);
                for (int axis = 0; axis < 3; axis++)
                    quads += (low[0] < 0.0f) != (low[pad_step[axis]] < 0.0f);
            }
        }
        j->firsts[slot] = quads;
    }
}

// The four cells about the edge from a node along an axis.
static void edge_quad(const int32_t* cell, int axis, bool turned, int32_t out[4])
{
    static const int around[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
    int b = wide_step[(axis + 1) % 3], c = wide_step[(axis + 2) % 3];
    for (int e = 0; e < 4; e++)
        out[turned ? 3 - e : e] = cell[-around[e][0] * b - around[e][1] * c];
}

static void quads_write(void* context, int64_t begin, int64_t end, int worker)
{
    const join* j = context;
    ty_net* net = j->net;
    float pad[NET_PAD * NET_PAD * NET_PAD];
    int32_t wide[NET_WIDE * NET_WIDE * NET_WIDE];
    (void)worker;
    for (int64_t slot = begin; slot < end; slot++)
    {
        int32_t quad = j->firsts[slot];
        if (quad == j->firsts[slot + 1])
            continue;
        net_pad_values(net, (int)slot, pad);
        pad_cells(net, (int)slot, wide);
        for (int node = 0; node < TY_NET_NODES; node++)
        {
            int x = node % TY_NET_BLOCK, y = node / TY_NET_BLOCK % TY_NET_BLOCK, z = node / TY_NET_BLOCK / TY_NET_BLOCK;
            const float* low = pad + (z * NET_PAD + y) * NET_PAD + x;
            const int32_t* cell = wide + ((z + 1) * NET_WIDE + y + 1) * NET_WIDE + x + 1;
            for (int axis = 0; axis < 3; axis++)
                if ((low[0] < 0.0f) != (low[pad_step[axis]] < 0.0f))
                    edge_quad(cell, axis, low[0] >= 0.0f, net->quads[quad++]);
        }
    }
}

static ty_status too_little(ty_error* error)
{
    return ty_error_set(error, TY_NO_MEMORY, "no memory for a surface");
}

static ty_status connect(join* j, ty_workers* workers, ty_error* error)
{
    ty_net* net = j->net;
    int slots = net->def.active_count;
    ty_parallel_all(workers, slots, 64, vertices_count, j);
    int64_t vertices = sums_make(j);
    if (vertices == 0 || vertices > INT32_MAX)
        return ty_error_set(error, TY_BAD_INPUT,
                            vertices ? "a surface of too many vertices"
                                     : "nothing of the surface is wider than a cell");
    net->vertex_count = (int)vertices;
    net->positions = TY_TRY_ALLOC(ty_vec3, vertices);
    net->places = TY_TRY_ALLOC(uint32_t, vertices);
    net->neighbours = ty_try_alloc((size_t)vertices, sizeof(*net->neighbours));
    if (!net->positions || !net->places || !net->neighbours)
        return too_little(error);
    ty_parallel_all(workers, slots, 64, vertices_place, j);
    ty_parallel_all(workers, slots, 64, neighbours_find, j);
    int64_t quads = sums_make(j);
    net->quad_count = (int)quads;
    net->quads = quads <= INT32_MAX ? ty_try_alloc((size_t)quads, sizeof(*net->quads)) : NULL;
    if (!net->quads)
        return too_little(error);
    ty_parallel_all(workers, slots, 64, quads_write, j);
    return TY_OK;
}

ty_status net_connect(ty_net* net, ty_workers* workers, ty_error* error)
{
    join j = {net, TY_TRY_ALLOC(int32_t, net->def.active_count + 1)};
    ty_status status = j.firsts ? connect(&j, workers, error) : too_little(error);
    ty_free(j.firsts);
    return status;
}

void net_pad_values(const ty_net* net, int slot, float out[NET_PAD * NET_PAD * NET_PAD])
{
    int block[3];
    net_block_of(net, slot, block);
    for (int side = 0; side < 8; side++)
    {
        int dx = side & 1, dy = side >> 1 & 1, dz = side >> 2;
        int32_t other = net_slot(net, block[0] + dx, block[1] + dy, block[2] + dz);
        const float* from = other < 0 ? NULL : net->values + (size_t)other * TY_NET_NODES;
        int nx = dx ? 1 : TY_NET_BLOCK, ny = dy ? 1 : TY_NET_BLOCK, nz = dz ? 1 : TY_NET_BLOCK;
        for (int z = 0; z < nz; z++)
            for (int y = 0; y < ny; y++)
            {
                float* row = out + ((z + dz * TY_NET_BLOCK) * NET_PAD + y + dy * TY_NET_BLOCK) * NET_PAD;
                for (int x = 0; x < nx; x++)
                    row[x + dx * TY_NET_BLOCK] =
                        from ? from[(z * TY_NET_BLOCK + y) * TY_NET_BLOCK + x] : net_beyond(net, other);
            }
    }
}
