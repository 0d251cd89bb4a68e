// SPDX-License-Identifier: Apache-2.0
// Vertices of a sparse surface net spread evenly over the surface; its triangles.
#include "mesh_edges.h"
#include "net.h"
#include <string.h>

// --- the field between nodes ---

typedef struct between
{
    float value;
    ty_vec3 gradient; // per step
} between;

static void corners_find(const ty_net* net, const int low[3], float out[8])
{
    enum
    {
        LAST = TY_NET_BLOCK - 1
    };
    int x = low[0] & LAST, y = low[1] & LAST, z = low[2] & LAST;
    int32_t slot = net_slot(net, low[0] >> 3, low[1] >> 3, low[2] >> 3);
    if (slot >= 0 && x < LAST && y < LAST && z < LAST)
    {
        const float* at = net->values + (size_t)slot * TY_NET_NODES + (z * TY_NET_BLOCK + y) * TY_NET_BLOCK + x;
        for (int c = 0; c < 8; c++)
            out[c] = at[((c >> 2) * TY_NET_BLOCK + (c >> 1 & 1)) * TY_NET_BLOCK + (c & 1)];
        return;
    }
    for (int c = 0; c < 8; c++)
    {
        int at[3] = {low[0] + (c & 1), low[1] + (c >> 1 & 1), low[2] + (c >> 2)};
        slot = net_slot(net, at[0] >> 3, at[1] >> 3, at[2] >> 3);
        int node = ((at[2] & LAST) * TY_NET_BLOCK + (at[1] & LAST)) * TY_NET_BLOCK + (at[0] & LAST);
        out[c] = slot < 0 ? net_beyond(net, slot) : net->values[(size_t)slot * TY_NET_NODES + (size_t)node];
    }
}

static between field_at(const ty_net* net, ty_vec3 p)
{
    float v[8], fx = floorf(p.x), fy = floorf(p.y), fz = floorf(p.z);
    corners_find(net, (const int[3]){(int)fx, (int)fy, (int)fz}, v);
    float x = p.x - fx, y = p.y - fy, z = p.z - fz;
    float x00 = ty_lerp(v[0], v[1], x), x10 = ty_lerp(v[2], v[3], x), x01 = ty_lerp(v[4], v[5], x),
          x11 = ty_lerp(v[6], v[7], x);
    float y0 = ty_lerp(x00, x10, y), y1 = ty_lerp(x01, x11, y);
    float dx = ty_lerp(ty_lerp(v[1] - v[0], v[3] - v[2], y), ty_lerp(v[5] - v[4], v[7] - v[6], y), z);
    return (between){ty_lerp(y0, y1, z), {dx, ty_lerp(x10 - x00, x11 - x01, z), y1 - y0}};
}

// --- rounds ---

typedef struct relaxing
{
    const ty_net* net;
    const ty_vec3* from;
    ty_vec3* to;
} relaxing;

// Within the vertex' own cell and a third of a step about it: sheets cannot get through each other.
static ty_vec3 cell_clamp(const ty_net* net, uint32_t place, ty_vec3 p)
{
    int block[3], node = (int)(place % TY_NET_NODES);
    net_block_of(net, (int)(place / TY_NET_NODES), block);
    ty_vec3 low = {(float)(block[0] * TY_NET_BLOCK + node % TY_NET_BLOCK) - 0.33f,
                   (float)(block[1] * TY_NET_BLOCK + node / TY_NET_BLOCK % TY_NET_BLOCK) - 0.33f,
                   (float)(block[2] * TY_NET_BLOCK + node / TY_NET_BLOCK / TY_NET_BLOCK) - 0.33f};
    return ty_max3(low, ty_min3(ty_add(low, ty_vec3_make(1.66f, 1.66f, 1.66f)), p));
}

static ty_vec3 project(const ty_net* net, ty_vec3 p)
{
    between f = field_at(net, p);
    float least = 0.25f * ty_sqr(net->def.step); // where sheets meet there is hardly a gradient
    float move = f.value / ty_max(ty_length_sqr(f.gradient), least);
    return ty_mad(p, f.gradient, -move);
}

static void vertices_relax(void* context, int64_t begin, int64_t end, int worker)
{
    const relaxing* r = context;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        ty_vec3 sum = {0.0f, 0.0f, 0.0f};
        float count = 0.0f;
        for (int i = 0; i < 6; i++)
        {
            int32_t other = r->net->neighbours[v][i];
            if (other < 0)
                continue;
            sum = ty_add(sum, r->from[other]);
            count += 1.0f;
        }
        uint32_t place = r->net->places[v];
        ty_vec3 p = cell_clamp(r->net, place, ty_mul(sum, 1.0f / count));
        r->to[v] = cell_clamp(r->net, place, project(r->net, p));
    }
}

bool ty_net_relax(ty_net* net, int rounds, ty_workers* workers)
{
    ty_vec3* other = TY_ALLOC(ty_vec3, net->vertex_count);
    bool done = true;
    for (int i = 0; i < rounds && done; i++)
    {
        relaxing r = {net, net->positions, other};
        done = ty_parallel_for(workers, net->vertex_count, 4096, vertices_relax, &r);
        if (!done)
            break;
        other = net->positions;
        net->positions = r.to;
    }
    ty_free(other);
    return done;
}

// --- pieces ---

static double quad_volume(const ty_net* net, const int32_t* q)
{
    const ty_vec3* p = net->positions;
    ty_vec3 a = ty_sub(p[q[1]], p[q[0]]), b = ty_sub(p[q[2]], p[q[0]]), c = ty_sub(p[q[3]], p[q[0]]);
    ty_vec3 n = ty_add(ty_cross(a, b), ty_cross(b, c));
    return (double)ty_dot(p[q[0]], n);
}

// Each vertex' piece, by its first vertex; returns that of the largest shell.
static size_t pieces_find(const ty_net* net, size_t* piece, double* volume, ty_net_pieces* pieces)
{
    size_t count = (size_t)net->vertex_count, best = 0;
    for (size_t v = 0; v < count; v++)
        piece[v] = v;
    for (size_t v = 0; v < count; v++)
        for (int i = 0; i < 6; i++)
            if (net->neighbours[v][i] >= 0)
                ty_set_join(piece, v, (size_t)net->neighbours[v][i]);
    for (size_t v = 0; v < count; v++)
        piece[v] = ty_set_find(piece, v);
    for (int q = 0; q < net->quad_count; q++)
        volume[piece[net->quads[q][0]]] += quad_volume(net, net->quads[q]);
    *pieces = (ty_net_pieces){0};
    for (size_t v = 0; v < count; v++)
        if (piece[v] == v)
        {
            best = volume[v] > volume[best] ? v : best;
            pieces->shells += volume[v] > 0.0;
            pieces->voids += volume[v] <= 0.0;
        }
    return best;
}

// --- triangles ---

// The cosine of the smallest corner's angle.
static float sharpest(ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    ty_vec3 ab = ty_normalize(ty_sub(b, a)), bc = ty_normalize(ty_sub(c, b)), ca = ty_normalize(ty_sub(a, c));
    return ty_max(-ty_dot(ca, ab), ty_max(-ty_dot(ab, bc), -ty_dot(bc, ca)));
}

// Along the diagonal that leaves the larger smallest corner.
static void quad_cut(const ty_vec3* p, const int32_t* q, uint32_t (*out)[3])
{
    ty_vec3 a = p[q[0]], b = p[q[1]], c = p[q[2]], d = p[q[3]];
    float first = ty_max(sharpest(a, b, c), sharpest(a, c, d)), second = ty_max(sharpest(b, c, d), sharpest(b, d, a));
    int turn = first <= second ? 0 : 1;
    const uint32_t v[4] = {(uint32_t)q[turn], (uint32_t)q[turn + 1], (uint32_t)q[(turn + 2) & 3],
                           (uint32_t)q[(turn + 3) & 3]};
    memcpy(out[0], (const uint32_t[3]){v[0], v[1], v[2]}, sizeof(uint32_t[3]));
    memcpy(out[1], (const uint32_t[3]){v[0], v[2], v[3]}, sizeof(uint32_t[3]));
}

static ty_mesh* shell_mesh(const ty_net* net, const size_t* piece, size_t shell, int32_t* number)
{
    uint32_t vertices = 0, quads = 0;
    for (int32_t v = 0; v < net->vertex_count; v++)
        number[v] = piece[v] == shell ? (int32_t)vertices++ : -1;
    for (int q = 0; q < net->quad_count; q++)
        quads += number[net->quads[q][0]] >= 0;
    ty_mesh* mesh = ty_mesh_create(vertices, 2 * quads);
    if (!mesh)
        return NULL;
    for (int32_t v = 0; v < net->vertex_count; v++)
        if (number[v] >= 0)
            mesh->positions[number[v]] = ty_mad(net->def.origin, net->positions[v], net->def.step);
    uint32_t t = 0;
    for (int q = 0; q < net->quad_count; q++)
    {
        if (number[net->quads[q][0]] < 0)
            continue;
        quad_cut(net->positions, net->quads[q], mesh->triangles + t);
        for (int i = 0; i < 6; i++)
            mesh->triangles[t + (uint32_t)i / 3][i % 3] = (uint32_t)number[mesh->triangles[t + (uint32_t)i / 3][i % 3]];
        t += 2;
    }
    return mesh;
}

ty_status ty_net_mesh(const ty_net* net, ty_mesh** out, ty_net_pieces* pieces, ty_error* error)
{
    size_t* piece = TY_TRY_ALLOC(size_t, net->vertex_count);
    int32_t* number = TY_TRY_ALLOC(int32_t, net->vertex_count);
    double* volume = TY_TRY_ALLOC(double, net->vertex_count);
    ty_net_pieces found;
    *out = NULL;
    if (piece && number && volume)
    {
        size_t shell = pieces_find(net, piece, volume, pieces ? pieces : &found);
        *out = shell_mesh(net, piece, shell, number);
    }
    ty_free(piece);
    ty_free(number);
    ty_free(volume);
    return *out ? TY_OK
                : ty_error_set(error, TY_NO_MEMORY, "no memory for a surface of %d vertices", net->vertex_count);
}
