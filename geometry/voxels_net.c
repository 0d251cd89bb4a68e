// SPDX-License-Identifier: Apache-2.0
// Surface nets: a vertex in each cell of the solid's surface, four cells about each edge that it crosses.
#include "mesh_edges.h"
#include "voxels.h"
#include <string.h>

// The nodes of the net's own grid. Its border lies outside, whatever the field says.
typedef struct net
{
    const ty_voxels* field;
    ty_voxels grid;
    int32_t* vertex; // of each cell, by its lowest node; -1 = none
    ty_vec3* positions;
    int (*cells)[3]; // of each vertex
    ty_vec3* sums;   // of neighbours
    int* counts;
    int32_t (*quads)[4]; // counter-clockwise seen from outside
    int vertex_count, quad_count;
} net;

static bool is_inside(const net* n, int i, int j, int k)
{
    return n->grid.values[voxels_index(&n->grid, i, j, k)] < 0.0f;
}

// --- the nodes ---

static ty_status nodes_sample(net* n, float cell, ty_error* error)
{
    const ty_voxels* f = n->field;
    ty_bounds bounds = {f->origin, voxels_place(f, f->size[0] - 1, f->size[1] - 1, f->size[2] - 1)};
    ty_status status = voxels_init(bounds, cell, cell, &n->grid, error);
    if (status != TY_OK)
        return status;
    ty_voxels* g = &n->grid;
    for (int k = 0; k < g->size[2]; k++)
        for (int j = 0; j < g->size[1]; j++)
            for (int i = 0; i < g->size[0]; i++)
            {
                bool border =
                    i == 0 || j == 0 || k == 0 || i == g->size[0] - 1 || j == g->size[1] - 1 || k == g->size[2] - 1;
                float value = border ? cell : ty_voxels_value(f, voxels_place(g, i, j, k));
                g->values[voxels_index(g, i, j, k)] = value;
            }
    return TY_OK;
}

// Fills the node of these that is least outside. False: none is.
static bool node_fill(net* n, const size_t* nodes, int count)
{
    float* values = n->grid.values;
    size_t best = nodes[0];
    bool found = false;
    for (int i = 0; i < count; i++)
        if (values[nodes[i]] >= 0.0f && (!found || values[nodes[i]] < values[best]))
        {
            best = nodes[i];
            found = true;
        }
    if (found)
        values[best] = -1e-3f * n->grid.step;
    return found;
}

// Two diagonal nodes of a square in one state and two in the other: the sheets on its two sides would share an edge.
static bool square_mend(net* n, size_t at, size_t a, size_t b)
{
    const float* v = n->grid.values;
    const size_t nodes[4] = {at, at + a, at + b, at + a + b};
    bool in[4];
    for (int i = 0; i < 4; i++)
        in[i] = v[nodes[i]] < 0.0f;
    return in[0] == in[3] && in[1] == in[2] && in[0] != in[1] && node_fill(n, nodes, 4);
}

// Two opposite nodes of a cube in one state, all others in the other: sheets would share a corner.
static bool cube_mend(net* n, size_t at, size_t dy, size_t dz)
{
    const size_t nodes[8] = {at, at + 1, at + dy, at + dy + 1, at + dz, at + dz + 1, at + dz + dy, at + dz + dy + 1};
    int inside = 0;
    for (int i = 0; i < 8; i++)
        inside |= (n->grid.values[nodes[i]] < 0.0f) << i;
    for (int i = 0; i < 4; i++)
    {
        int pair = 1 << i | 1 << (7 - i);
        if (inside == pair || inside == (255 ^ pair))
            return node_fill(n, nodes, 8);
    }
    return false;
}

// Until the nodes inside are well-composed: then the faces of their cubes are a two-manifold (Latecki 1997). Each
// mending adds a node to the inside, so that it ends.
static void nodes_mend(net* n)
{
    const ty_voxels* g = &n->grid;
    const size_t dy = (size_t)g->size[0], dz = dy * (size_t)g->size[1];
    for (bool again = true; again;)
    {
        again = false;
        for (int k = 0; k + 1 < g->size[2]; k++)
            for (int j = 0; j + 1 < g->size[1]; j++)
                for (int i = 0; i + 1 < g->size[0]; i++)
                {
                    size_t at = voxels_index(g, i, j, k);
                    again |= square_mend(n, at, 1, dy);
                    again |= square_mend(n, at, 1, dz);
                    again |= square_mend(n, at, dy, dz);
                    again |= cube_mend(n, at, dy, dz);
                }
    }
}

// --- vertices ---

static bool cell_is_crossed(const net* n, int i, int j, int k)
{
    int inside = 0;
    for (int c = 0; c < 8; c++)
        inside += is_inside(n, i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
    return inside > 0 && inside < 8;
}

// Calls for each crossed cell; counts, or numbers them and writes their places.
static void cells_visit(net* n, bool write)
{
    const ty_voxels* g = &n->grid;
    n->vertex_count = 0;
    for (int k = 0; k + 1 < g->size[2]; k++)
        for (int j = 0; j + 1 < g->size[1]; j++)
            for (int i = 0; i + 1 < g->size[0]; i++)
            {
                bool crossed = cell_is_crossed(n, i, j, k);
                n->vertex[voxels_index(g, i, j, k)] = crossed ? n->vertex_count : -1;
                if (crossed && write)
                    memcpy(n->cells[n->vertex_count], (const int[3]){i, j, k}, sizeof(int[3]));
                n->vertex_count += crossed;
            }
}

// The mean of where the cell's edges cross the surface.
static ty_vec3 cell_middle(const net* n, const int cell[3])
{
    ty_vec3 sum = {0.0f, 0.0f, 0.0f};
    int count = 0;
    for (int a = 0; a < 8; a++)
        for (int axis = 0; axis < 3; axis++)
        {
            if (a >> axis & 1)
                continue;
            int b = a | 1 << axis, at[2][3];
            float value[2];
            for (int e = 0; e < 2; e++)
            {
                int corner = e ? b : a;
                for (int i = 0; i < 3; i++)
                    at[e][i] = cell[i] + (corner >> i & 1);
                value[e] = n->grid.values[voxels_index(&n->grid, at[e][0], at[e][1], at[e][2])];
            }
            if ((value[0] < 0.0f) == (value[1] < 0.0f))
                continue;
            ty_vec3 from = voxels_place(&n->grid, at[0][0], at[0][1], at[0][2]);
            ty_vec3 to = voxels_place(&n->grid, at[1][0], at[1][1], at[1][2]);
            sum = ty_add(sum, ty_lerp3(from, to, value[0] / (value[0] - value[1])));
            count++;
        }
    return ty_mul(sum, 1.0f / (float)count);
}

// A little off the cell's sides, so that no two vertices fall together.
static ty_vec3 cell_clamp(const net* n, const int cell[3], ty_vec3 p)
{
    float off = 0.02f * n->grid.step;
    ty_vec3 margin = {off, off, off};
    ty_vec3 low = ty_add(voxels_place(&n->grid, cell[0], cell[1], cell[2]), margin);
    ty_vec3 high = ty_sub(voxels_place(&n->grid, cell[0] + 1, cell[1] + 1, cell[2] + 1), margin);
    return ty_max3(low, ty_min3(high, p));
}

// Onto the zero of the field, within the cell.
static ty_vec3 cell_project(const net* n, const int cell[3], ty_vec3 p)
{
    for (int i = 0; i < 3; i++)
    {
        ty_voxel_sample s = ty_voxels_sample(n->field, p);
        float square = ty_max(ty_length_sqr(s.gradient), 0.25f); // where sheets meet there is hardly a gradient
        p = cell_clamp(n, cell, ty_mad(p, s.gradient, -s.value / square));
        if (fabsf(s.value) < 1e-4f * n->grid.step)
            break;
    }
    return p;
}

// --- faces ---

// The four cells about the edge from node (at) along axis, counter-clockwise seen from the edge's end.
static void edge_quad(net* n, const int at[3], int axis, bool turned)
{
    static const int around[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
    int b = (axis + 1) % 3, c = (axis + 2) % 3;
    int32_t* quad = n->quads[n->quad_count++];
    for (int e = 0; e < 4; e++)
    {
        int cell[3] = {at[0], at[1], at[2]};
        cell[b] -= around[e][0];
        cell[c] -= around[e][1];
        quad[turned ? 3 - e : e] = n->vertex[voxels_index(&n->grid, cell[0], cell[1], cell[2])];
    }
}

static int edges_visit(net* n, bool write)
{
    const ty_voxels* g = &n->grid;
    int count = 0;
    for (int k = 0; k < g->size[2]; k++)
        for (int j = 0; j < g->size[1]; j++)
            for (int i = 0; i < g->size[0]; i++)
                for (int axis = 0; axis < 3; axis++)
                {
                    int to[3] = {i, j, k};
                    if (++to[axis] >= g->size[axis])
                        continue;
                    bool inside = is_inside(n, i, j, k);
                    if (inside == is_inside(n, to[0], to[1], to[2]))
                        continue;
                    if (write)
                        edge_quad(n, (const int[3]){i, j, k}, axis, !inside);
                    count++;
                }
    return count;
}

static void vertices_relax(net* n)
{
    memset(n->sums, 0, sizeof(ty_vec3) * (size_t)n->vertex_count);
    memset(n->counts, 0, sizeof(int) * (size_t)n->vertex_count);
    for (int q = 0; q < n->quad_count; q++)
        for (int e = 0; e < 4; e++)
        {
            int a = n->quads[q][e], b = n->quads[q][(e + 1) % 4];
            n->sums[a] = ty_add(n->sums[a], n->positions[b]);
            n->sums[b] = ty_add(n->sums[b], n->positions[a]);
            n->counts[a]++;
            n->counts[b]++;
        }
    for (int v = 0; v < n->vertex_count; v++)
        n->positions[v] = cell_project(n, n->cells[v], ty_mul(n->sums[v], 1.0f / (float)n->counts[v]));
}

// --- pieces ---

// Six times the signed volume of the quad's cone from the origin of the grid.
static double quad_volume(const net* n, const int32_t* q)
{
    ty_vec3 p[4];
    for (int e = 0; e < 4; e++)
        p[e] = ty_sub(n->positions[q[e]], n->grid.origin);
    return (double)ty_dot(p[0], ty_cross(p[1], p[2])) + (double)ty_dot(p[0], ty_cross(p[2], p[3]));
}

// Leaves the quads of the largest piece; its cavities are pieces of their own, of negative volume.
static ty_status pieces_drop(net* n, ty_error* error)
{
    size_t* parents = TY_TRY_ALLOC(size_t, n->vertex_count);
    double* volume = TY_TRY_ALLOC(double, n->vertex_count);
    ty_status status = parents && volume ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "no memory for a surface");
    if (status == TY_OK)
    {
        size_t count = (size_t)n->vertex_count, best = 0;
        int kept = 0;
        for (size_t v = 0; v < count; v++)
            parents[v] = v;
        for (int q = 0; q < n->quad_count; q++)
            for (int e = 1; e < 4; e++)
                ty_set_join(parents, (size_t)n->quads[q][e], (size_t)n->quads[q][0]);
        for (int q = 0; q < n->quad_count; q++)
            volume[ty_set_find(parents, (size_t)n->quads[q][0])] += quad_volume(n, n->quads[q]);
        for (size_t v = 0; v < count; v++)
            best = volume[v] > volume[best] ? v : best;
        for (int q = 0; q < n->quad_count; q++)
            if (ty_set_find(parents, (size_t)n->quads[q][0]) == best)
                memmove(n->quads[kept++], n->quads[q], sizeof(*n->quads));
        n->quad_count = kept;
    }
    ty_free(parents);
    ty_free(volume);
    return status;
}

// --- the mesh ---

static void vertex_finish(const net* n, ty_mesh* mesh, uint32_t v)
{
    ty_voxel_sample s = ty_voxels_sample(n->field, mesh->positions[v]);
    mesh->normals[v] = ty_normalize(s.gradient);
    ty_voxel_curvature(&s, &mesh->curvature_1[v], &mesh->curvature_2[v], &mesh->direction_1[v]);
    float most = 1.0f / n->grid.step; // a net shows no finer bend
    mesh->curvature_1[v] = ty_clamp(mesh->curvature_1[v], -most, most);
    mesh->curvature_2[v] = ty_clamp(mesh->curvature_2[v], -most, most);
    mesh->welds[v] = v;
}

// Vertices that no quad is left of are dropped.
static ty_status net_mesh(net* n, ty_mesh** out, ty_error* error)
{
    uint32_t used = 0;
    for (int v = 0; v < n->vertex_count; v++)
        n->counts[v] = -1;
    for (int q = 0; q < n->quad_count; q++)
        for (int e = 0; e < 4; e++)
            if (n->counts[n->quads[q][e]] < 0)
                n->counts[n->quads[q][e]] = (int)used++;
    ty_mesh* mesh = ty_mesh_create(used, 2 * (uint32_t)n->quad_count);
    if (mesh)
    {
        mesh->welds = TY_TRY_ALLOC(uint32_t, used);
        mesh->curvature_1 = TY_TRY_ALLOC(float, used);
        mesh->curvature_2 = TY_TRY_ALLOC(float, used);
        mesh->direction_1 = TY_TRY_ALLOC(ty_vec3, used);
    }
    if (!mesh || !mesh->welds || !mesh->curvature_1 || !mesh->curvature_2 || !mesh->direction_1)
    {
        ty_mesh_destroy(mesh);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a surface of %u vertices", used);
    }
    for (int v = 0; v < n->vertex_count; v++)
        if (n->counts[v] >= 0)
            mesh->positions[n->counts[v]] = n->positions[v];
    for (uint32_t v = 0; v < used; v++)
        vertex_finish(n, mesh, v);
    for (int q = 0; q < n->quad_count; q++)
    {
        uint32_t corners[4];
        for (int e = 0; e < 4; e++)
            corners[e] = (uint32_t)n->counts[n->quads[q][e]];
        ty_mesh_set_quad(mesh, 2 * (uint32_t)q, corners);
    }
    ty_mesh_compute_bounds(mesh);
    *out = mesh;
    return TY_OK;
}

static ty_status net_allocate(net* n, ty_error* error)
{
    n->vertex = TY_TRY_ALLOC(int32_t, voxels_count(&n->grid));
    if (!n->vertex)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a grid of %zu nodes", voxels_count(&n->grid));
    cells_visit(n, false);
    int quads = edges_visit(n, false);
    if (quads == 0)
        return ty_error_set(error, TY_BAD_INPUT, "nothing of the solid is left, or cells of %g mm miss it",
                            (double)n->grid.step * 1e3);
    n->positions = TY_TRY_ALLOC(ty_vec3, n->vertex_count);
    n->cells = ty_try_alloc((size_t)n->vertex_count, sizeof(*n->cells));
    n->sums = TY_TRY_ALLOC(ty_vec3, n->vertex_count);
    n->counts = TY_TRY_ALLOC(int, n->vertex_count);
    n->quads = ty_try_alloc((size_t)quads, sizeof(*n->quads));
    if (n->positions && n->cells && n->sums && n->counts && n->quads)
        return TY_OK;
    return ty_error_set(error, TY_NO_MEMORY, "no memory for a surface of %d vertices", n->vertex_count);
}

static void net_term(net* n)
{
    ty_voxels_term(&n->grid);
    ty_free(n->vertex);
    ty_free(n->positions);
    ty_free(n->cells);
    ty_free(n->sums);
    ty_free(n->counts);
    ty_free(n->quads);
}

ty_status ty_voxels_net(const ty_voxels* voxels, const ty_voxel_net_def* def, ty_mesh** out, ty_error* error)
{
    net n = {.field = voxels};
    *out = NULL;
    ty_status status = nodes_sample(&n, def->cell, error);
    if (status == TY_OK)
    {
        nodes_mend(&n);
        status = net_allocate(&n, error);
    }
    if (status == TY_OK)
    {
        cells_visit(&n, true);
        (void)edges_visit(&n, true);
        for (int v = 0; v < n.vertex_count; v++)
            n.positions[v] = cell_project(&n, n.cells[v], cell_middle(&n, n.cells[v]));
        for (int i = 0; i < def->relax; i++)
            vertices_relax(&n);
        status = def->hollow ? TY_OK : pieces_drop(&n, error);
    }
    if (status == TY_OK)
        status = net_mesh(&n, out, error);
    net_term(&n);
    return status;
}
