// SPDX-License-Identifier: Apache-2.0
// What the files of sparse surface nets share.
#pragma once
#include <tsuya/geometry/surface_net.h>

enum
{
    NET_PAD = TY_NET_BLOCK + 1,  // nodes a side of a block and of the next ones' first
    NET_WIDE = TY_NET_BLOCK + 2, // cells a side of a block and of all about it
};

enum
{
    NET_OUTSIDE = -1, // of blocks that are not stored
    NET_SOLID = -2,
};

struct ty_net
{
    ty_net_def def; // active is the net's own copy
    int32_t* slots; // of each block, its place in active, or one of the below
    float* values;  // [active_count][TY_NET_NODES]
    bool* crossed;  // [active_count]: some of its cells may be
    int32_t* cells; // vertex of each cell, by its lowest node, [active_count][TY_NET_NODES]; -1 = none
    int vertex_count, quad_count;
    uint32_t* places;         // of each vertex: slot * TY_NET_NODES + node
    ty_vec3* positions;       // in steps from the origin
    int32_t (*neighbours)[6]; // of each vertex, across its cell's faces: -x +x -y +y -z +z; -1 = none
    int32_t (*quads)[4];      // counter-clockwise seen from outside
};

// The slot of a block, below 0 where it is not stored.
static inline int32_t net_slot(const ty_net* net, int x, int y, int z)
{
    const int* b = net->def.blocks;
    if (x < 0 || y < 0 || z < 0 || x >= b[0] || y >= b[1] || z >= b[2])
        return NET_OUTSIDE;
    return net->slots[((int64_t)z * b[1] + y) * b[0] + x];
}

// The field in a block that is not stored.
static inline float net_beyond(const ty_net* net, int32_t slot)
{
    return slot == NET_SOLID ? -net->def.step : net->def.step;
}

static inline void net_block_of(const ty_net* net, int slot, int block[3])
{
    const int* b = net->def.blocks;
    int number = net->def.active[slot];
    block[0] = number % b[0];
    block[1] = number / b[0] % b[1];
    block[2] = number / b[0] / b[1];
}

// Values at nodes 0..8 of a block each way.
void net_pad_values(const ty_net* net, int slot, float out[NET_PAD * NET_PAD * NET_PAD]);

// Fills nodes until those inside are well-composed. false: no memory.
bool net_compose(ty_net* net, ty_workers* workers);
// Numbers vertices, places them, finds neighbours and quads.
TY_CHECKED ty_status net_connect(ty_net* net, ty_workers* workers, ty_error* error);
