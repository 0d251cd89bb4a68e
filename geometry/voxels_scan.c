// SPDX-License-Identifier: Apache-2.0
// From a mesh to a grid of distances: the part of each triangle, and the search of each node.
#include "voxels_scan.h"
#include "triangle.h"

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

void voxels_scan_turn(voxels_scan* s, const uint32_t c[3], int low, int high)
{
    const ty_voxels* v = s->v;
    ty_vec3 a = s->mesh->positions[c[0]], b = s->mesh->positions[c[1]], d = s->mesh->positions[c[2]];
    double h = (double)v->step, oy = (double)v->origin.y, oz = (double)v->origin.z, ox = (double)v->origin.x;
    int j0 = (int)floor(((double)ty_min(a.y, ty_min(b.y, d.y)) - oy) / h);
    int j1 = (int)ceil(((double)ty_max(a.y, ty_max(b.y, d.y)) - oy) / h);
    int k0 = (int)floor(((double)ty_min(a.z, ty_min(b.z, d.z)) - oz) / h);
    int k1 = (int)ceil(((double)ty_max(a.z, ty_max(b.z, d.z)) - oz) / h);
    for (int k = k0 > low ? k0 : low; k <= k1 && k <= high; k++)
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

// --- the distance ---

ty_vec3 voxels_scan_closest(const voxels_scan* s, int32_t triangle, ty_vec3 p)
{
    const uint32_t* c = s->mesh->triangles[triangle];
    const ty_vec3* at = s->mesh->positions;
    return ty_triangle_at(at[c[0]], at[c[1]], at[c[2]], ty_triangle_closest(p, at[c[0]], at[c[1]], at[c[2]]));
}

// Takes the triangle where it is nearer than what the node has.
void voxels_scan_try(voxels_scan* s, size_t node, ty_vec3 p, int32_t triangle)
{
    float square = ty_length_sqr(ty_sub(p, voxels_scan_closest(s, triangle, p)));
    if (s->near[node] < 0 || square < s->v->values[node])
    {
        s->v->values[node] = square;
        s->near[node] = triangle;
    }
}

// Where the row (j, k) comes within two steps of the triangle's plane, as nodes first..last: long triangles askew
// would else fill their whole box.
static void row_clip(const voxels_scan* s, const uint32_t* c, int j, int k, int* first, int* last)
{
    const ty_voxels* v = s->v;
    const ty_vec3* at = s->mesh->positions;
    ty_vec3 n = ty_cross(ty_sub(at[c[1]], at[c[0]]), ty_sub(at[c[2]], at[c[0]]));
    float length = ty_length(n), width = 2.0f * v->step * length;
    float start = ty_dot(n, ty_sub(voxels_place(v, 0, j, k), at[c[0]])), rise = n.x * v->step;
    if (!(length > 0.0f) || fabsf(rise) * (float)(*last - *first) <= width)
        return; // runs along the plane
    float a = (-width - start) / rise, b = (width - start) / rise;
    float low = ty_clamp(floorf(ty_min(a, b)), -1.0f, 1e6f), high = ty_clamp(ceilf(ty_max(a, b)), -1.0f, 1e6f);
    *first = (int)low > *first ? (int)low : *first;
    *last = (int)high < *last ? (int)high : *last;
}

void voxels_scan_spread(voxels_scan* s, int32_t triangle, int bottom, int top, bool thin)
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
    for (int k = low[2] > bottom ? low[2] : bottom; k <= high[2] && k <= top; k++)
        for (int j = low[1]; j <= high[1]; j++)
        {
            int first = low[0], last = high[0];
            if (thin && last - first > 8)
                row_clip(s, c, j, k, &first, &last);
            for (int i = first; i <= last; i++)
                voxels_scan_try(s, voxels_index(v, i, j, k), voxels_place(v, i, j, k), triangle);
        }
}

// The distance transform measures to nodes, which lie up to a step off the surface: a node of it may be found some
// steps beside the nearest point. From there the search goes on over the surface, to triangles about the point that is
// nearest so far.
void voxels_scan_descend(voxels_scan* s, size_t node, ty_vec3 p)
{
    const ty_voxels* v = s->v;
    for (float before = TY_FLOAT_MAX; v->values[node] < before;)
    {
        before = v->values[node];
        ty_vec3 q = ty_sub(voxels_scan_closest(s, s->near[node], p), v->origin);
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
            voxels_scan_try(s, node, p, last);
        }
    }
}

// A node's neighbours know nearer triangles where the transform has chosen another side of the solid.
void voxels_scan_ask(voxels_scan* s, const int at[3], ty_vec3 p)
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
                voxels_scan_try(s, node, p, triangle);
        }
}
