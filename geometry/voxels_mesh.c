// SPDX-License-Identifier: Apache-2.0
// The signed distance from a closed mesh: winding numbers along rows, nearest triangles by a distance transform.
#include "triangle.h"
#include "voxels.h"
#include <string.h>

enum
{
    BAND = 4, // steps from the surface within which the distance is the nearest triangle's
};

typedef struct scan
{
    const ty_mesh* mesh;
    ty_voxels* v;
    int32_t* site;  // the node next to the surface that is nearest, [nodes]; -1 = none yet
    int32_t* near;  // the triangle that is nearest, [nodes]; -1 = none yet
    int16_t* turns; // change of the winding number between a node and the one before it in its row
} scan;

// --- the winding number ---

// Twice the area that the directed edge a-b and the node (y, z) span in the plane across the rows; both triangles at
// the edge get the same number with the other sign. *side is its sign: a node on the edge is taken to lie a little
// towards +y, and less so towards +z.
static double edge_area(ty_vec3 a, ty_vec3 b, double y, double z, int* side)
{
    bool swap = a.y > b.y || (a.y == b.y && a.z > b.z);
    ty_vec3 p = swap ? b : a, q = swap ? a : b;
    double dy = (double)q.y - (double)p.y, dz = (double)q.z - (double)p.z;
    double area = dy * (z - (double)p.z) - dz * (y - (double)p.y);
    double decides = area != 0.0 ? area : dz != 0.0 ? -dz : dy;
    *side = (decides > 0.0) - (decides < 0.0);
    *side = swap ? -*side : *side;
    return swap ? -area : area;
}

static void triangle_turn(scan* s, const uint32_t* c)
{
    const ty_voxels* v = s->v;
    ty_vec3 a = s->mesh->positions[c[0]], b = s->mesh->positions[c[1]], d = s->mesh->positions[c[2]];
    double h = (double)v->step, oy = (double)v->origin.y, oz = (double)v->origin.z, ox = (double)v->origin.x;
    int j0 = (int)floor(((double)ty_min(a.y, ty_min(b.y, d.y)) - oy) / h);
    int j1 = (int)ceil(((double)ty_max(a.y, ty_max(b.y, d.y)) - oy) / h);
    int k0 = (int)floor(((double)ty_min(a.z, ty_min(b.z, d.z)) - oz) / h);
    int k1 = (int)ceil(((double)ty_max(a.z, ty_max(b.z, d.z)) - oz) / h);
    for (int k = k0 > 0 ? k0 : 0; k <= k1 && k < v->size[2]; k++)
        for (int j = j0 > 0 ? j0 : 0; j <= j1 && j < v->size[1]; j++)
        {
            double y = oy + h * j, z = oz + h * k;
            int side[3];
            double u = edge_area(b, d, y, z, &side[0]), w = edge_area(d, a, y, z, &side[1]);
            double t = edge_area(a, b, y, z, &side[2]), sum = u + w + t;
            if (side[0] == 0 || side[0] != side[1] || side[0] != side[2] || sum == 0.0)
                continue;
            double x = (u * (double)a.x + w * (double)b.x + t * (double)d.x) / sum;
            double first = ceil((x - ox) / h);
            int i = first < 0.0 ? 0 : first < v->size[0] ? (int)first : v->size[0];
            if (i == v->size[0])
                continue;
            int16_t* turn = &s->turns[voxels_index(v, i, j, k)];
            *turn = (int16_t)(*turn - side[0]); // a face towards -x is where rows enter
        }
}

static void signs_apply(scan* s)
{
    const ty_voxels* v = s->v;
    for (int k = 0; k < v->size[2]; k++)
        for (int j = 0; j < v->size[1]; j++)
        {
            int winding = 0;
            size_t row = voxels_index(v, 0, j, k);
            for (int i = 0; i < v->size[0]; i++)
            {
                winding += s->turns[row + (size_t)i];
                v->values[row + (size_t)i] = copysignf(v->values[row + (size_t)i], winding > 0 ? -1.0f : 1.0f);
            }
        }
}

// --- the distance ---

static ty_vec3 triangle_closest(const scan* s, int32_t triangle, ty_vec3 p)
{
    const uint32_t* c = s->mesh->triangles[triangle];
    const ty_vec3* at = s->mesh->positions;
    return ty_triangle_at(at[c[0]], at[c[1]], at[c[2]], ty_triangle_closest(p, at[c[0]], at[c[1]], at[c[2]]));
}

// Takes the triangle where it is nearer than what the node has.
static void node_try(scan* s, size_t node, ty_vec3 p, int32_t triangle)
{
    float square = ty_length_sqr(ty_sub(p, triangle_closest(s, triangle, p)));
    if (s->near[node] < 0 || square < s->v->values[node])
    {
        s->v->values[node] = square;
        s->near[node] = triangle;
    }
}

// All nodes of the triangle's box and one step about it.
static void triangle_spread(scan* s, int32_t triangle)
{
    const ty_voxels* v = s->v;
    const uint32_t* c = s->mesh->triangles[triangle];
    ty_bounds b = ty_bounds_empty();
    for (int e = 0; e < 3; e++)
        b = ty_bounds_add(b, ty_mul(ty_sub(s->mesh->positions[c[e]], v->origin), 1.0f / v->step));
    const float lows[3] = {b.low.x, b.low.y, b.low.z}, highs[3] = {b.high.x, b.high.y, b.high.z};
    int low[3], high[3];
    for (int i = 0; i < 3; i++)
    {
        low[i] = (int)ty_clamp(ceilf(lows[i] - 1.0f), 0.0f, (float)(v->size[i] - 1));
        high[i] = (int)ty_clamp(floorf(highs[i] + 1.0f), 0.0f, (float)(v->size[i] - 1));
    }
    for (int k = low[2]; k <= high[2]; k++)
        for (int j = low[1]; j <= high[1]; j++)
            for (int i = low[0]; i <= high[0]; i++)
                node_try(s, voxels_index(v, i, j, k), voxels_place(v, i, j, k), triangle);
}

// The lower envelope of parabolas along one line of n nodes, stride apart: site[q] lies at squared distance height[q]
// from its own node across the line.
typedef struct envelope
{
    int* at;        // lowest parabola, [n]
    double* begin;  // where it begins to be lowest, [n + 1]
    double* height; // [n], < 0: no site
    int32_t* site;  // [n]
} envelope;

static void line_transform(envelope* e, int32_t* site, size_t stride, int n)
{
    int top = -1;
    for (int q = 0; q < n; q++)
    {
        e->site[q] = site[(size_t)q * stride];
        if (e->height[q] < 0.0)
            continue;
        double from = -1e30;
        while (top >= 0)
        {
            int r = e->at[top];
            from = ((e->height[q] + (double)q * q) - (e->height[r] + (double)r * r)) / (2.0 * (q - r));
            if (from > e->begin[top])
                break;
            top--;
            from = -1e30;
        }
        e->at[++top] = q;
        e->begin[top] = from;
    }
    if (top < 0)
        return;
    e->begin[top + 1] = 1e30;
    for (int q = 0, t = 0; q < n; q++)
    {
        while (e->begin[t + 1] < (double)q)
            t++;
        site[(size_t)q * stride] = e->site[e->at[t]];
    }
}

// How far the site is from node (i, j, k) across the axis, squared: what earlier axes have found.
static double across(const ty_voxels* v, int32_t site, const int node[3], int axis)
{
    if (site < 0 || axis == 0)
        return site < 0 ? -1.0 : 0.0;
    int x = site % v->size[0], y = site / v->size[0] % v->size[1], z = site / v->size[0] / v->size[1];
    const int d[3] = {x - node[0], y - node[1], z - node[2]};
    double sum = 0.0;
    for (int i = 0; i < axis; i++)
        sum += (double)d[i] * d[i];
    return sum;
}

static void axis_transform(scan* s, envelope* e, int axis)
{
    const ty_voxels* v = s->v;
    int b = (axis + 1) % 3, c = (axis + 2) % 3, at[3];
    const size_t stride[3] = {1, (size_t)v->size[0], (size_t)v->size[0] * (size_t)v->size[1]};
    for (at[c] = 0; at[c] < v->size[c]; at[c]++)
        for (at[b] = 0; at[b] < v->size[b]; at[b]++)
        {
            at[axis] = 0;
            int32_t* first = s->site + voxels_index(v, at[0], at[1], at[2]);
            for (int q = 0; q < v->size[axis]; q++)
            {
                at[axis] = q;
                e->height[q] = across(v, first[(size_t)q * stride[axis]], at, axis);
            }
            line_transform(e, first, stride[axis], v->size[axis]);
        }
}

static bool sites_transform(scan* s)
{
    int n = s->v->size[0];
    n = s->v->size[1] > n ? s->v->size[1] : n;
    n = s->v->size[2] > n ? s->v->size[2] : n;
    envelope e = {TY_TRY_ALLOC(int, n), TY_TRY_ALLOC(double, n + 1), TY_TRY_ALLOC(double, n), TY_TRY_ALLOC(int32_t, n)};
    bool held = e.at && e.begin && e.height && e.site;
    for (int axis = 0; axis < 3 && held; axis++)
        axis_transform(s, &e, axis);
    ty_free(e.at);
    ty_free(e.begin);
    ty_free(e.height);
    ty_free(e.site);
    return held;
}

// The distance transform measures to nodes, which lie up to a step off the surface: a node of it may be found some
// steps beside the nearest point. From there the search goes on over the surface, to triangles about the point that is
// nearest so far.
static void node_descend(scan* s, size_t node, ty_vec3 p)
{
    const ty_voxels* v = s->v;
    for (float before = TY_FLOAT_MAX; v->values[node] < before;)
    {
        before = v->values[node];
        ty_vec3 q = ty_sub(triangle_closest(s, s->near[node], p), v->origin);
        const float low[3] = {q.x / v->step, q.y / v->step, q.z / v->step};
        int cell[3];
        for (int i = 0; i < 3; i++)
            cell[i] = (int)ty_clamp(low[i], 0.0f, (float)(v->size[i] - 2));
        int32_t last = s->near[node];
        for (int e = 0; e < 8; e++)
        {
            size_t corner = voxels_index(v, cell[0] + (e & 1), cell[1] + (e >> 1 & 1), cell[2] + (e >> 2));
            if (s->site[corner] != (int32_t)corner || s->near[corner] == last)
                continue;
            last = s->near[corner];
            node_try(s, node, p, last);
        }
    }
}

// A node's neighbours know nearer triangles where the transform has chosen another side of the solid.
static void neighbours_ask(scan* s, const int at[3], ty_vec3 p)
{
    const ty_voxels* v = s->v;
    size_t node = voxels_index(v, at[0], at[1], at[2]);
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2)
        {
            int to[3] = {at[0], at[1], at[2]};
            to[axis] += side;
            if (to[axis] < 0 || to[axis] >= v->size[axis])
                continue;
            int32_t triangle = s->near[voxels_index(v, to[0], to[1], to[2])];
            if (triangle != s->near[node])
                node_try(s, node, p, triangle);
        }
}

static void distances_finish(scan* s)
{
    const ty_voxels* v = s->v;
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < v->size[2]; k++)
            for (int j = 0; j < v->size[1]; j++)
                for (int i = 0; i < v->size[0]; i++)
                {
                    size_t node = voxels_index(v, i, j, k);
                    ty_vec3 p = voxels_place(v, i, j, k);
                    if (s->site[node] == (int32_t)node)
                        continue;
                    if (pass == 1)
                        neighbours_ask(s, (const int[3]){i, j, k}, p);
                    else
                        node_try(s, node, p, s->near[s->site[node]]);
                    if (pass == 0 && v->values[node] < ty_sqr((BAND + 1) * v->step))
                        node_descend(s, node, p);
                }
    for (size_t i = 0; i < voxels_count(v); i++)
        v->values[i] = sqrtf(v->values[i]);
}

static bool mesh_scan(scan* s)
{
    size_t count = voxels_count(s->v);
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++)
    {
        triangle_turn(s, s->mesh->triangles[t]);
        triangle_spread(s, (int32_t)t);
    }
    for (size_t i = 0; i < count; i++) // a triangle that is nearer than a step has the node in its box
        s->site[i] = s->near[i] >= 0 && s->v->values[i] <= ty_sqr(s->v->step) ? (int32_t)i : -1;
    if (!sites_transform(s))
        return false;
    distances_finish(s);
    signs_apply(s);
    return true;
}

ty_status ty_voxels_from_mesh(const ty_mesh* mesh, float step, float margin, ty_voxels* out, ty_error* error)
{
    ty_bounds bounds = ty_bounds_empty();
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        bounds = ty_bounds_add(bounds, mesh->positions[i]);
    *out = (ty_voxels){0};
    if (mesh->triangle_count == 0)
        return ty_error_set(error, TY_BAD_INPUT, "a mesh without triangles is no solid");
    ty_status status = voxels_init(bounds, step, margin, out, error);
    if (status == TY_OK)
    {
        size_t count = voxels_count(out);
        scan s = {mesh, out, TY_TRY_ALLOC(int32_t, count), TY_TRY_ALLOC(int32_t, count), TY_TRY_ALLOC(int16_t, count)};
        bool held = s.site && s.near && s.turns;
        if (held)
        {
            memset(s.near, 0xff, count * sizeof(int32_t));
            held = mesh_scan(&s);
        }
        ty_free(s.site);
        ty_free(s.near);
        ty_free(s.turns);
        if (!held)
            status = ty_error_set(error, TY_NO_MEMORY, "no memory for a grid of %zu nodes", count);
    }
    if (status != TY_OK)
        ty_voxels_term(out);
    return status;
}
