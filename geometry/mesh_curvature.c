// SPDX-License-Identifier: Apache-2.0
// Principal curvatures and directions per vertex after Rusinkiewicz, "Estimating Curvatures and Their Derivatives on
// Triangle Meshes" (3DPVT 2004), over welded vertices: those at one position with one normal. The two sides of a crease
// stay apart, a seam of the uv does not.
#include "mesh_curvature.h"
#include "mesh_edges.h"

// A symmetric tensor in world axes.
typedef struct tensor3
{
    double xx, xy, xz, yy, yz, zz;
} tensor3;

// Per welded vertex (at its smallest index).
typedef struct curvature_field
{
    ty_mesh view;        // the mesh with welds only where the normals agree too (owned)
    ty_double3* normals; // unit
    double* areas;       // corner areas
    tensor3* tensors;
} curvature_field;

static void add_scaled(tensor3* sum, const tensor3* a, double s)
{
    sum->xx += a->xx * s;
    sum->xy += a->xy * s;
    sum->xz += a->xz * s;
    sum->yy += a->yy * s;
    sum->yz += a->yz * s;
    sum->zz += a->zz * s;
}

static double quadratic(const tensor3* a, ty_double3 u, ty_double3 v)
{
    return u.x * (a->xx * v.x + a->xy * v.y + a->xz * v.z) + u.y * (a->xy * v.x + a->yy * v.y + a->yz * v.z) +
           u.z * (a->xz * v.x + a->yz * v.y + a->zz * v.z);
}

// tt t t + tb (t b + b t) + bb b b.
static tensor3 tensor_from_plane(ty_double3 t, ty_double3 b, double tt, double tb, double bb)
{
    return (tensor3){
        tt * t.x * t.x + 2.0 * tb * t.x * b.x + bb * b.x * b.x,
        tt * t.x * t.y + tb * (t.x * b.y + t.y * b.x) + bb * b.x * b.y,
        tt * t.x * t.z + tb * (t.x * b.z + t.z * b.x) + bb * b.x * b.z,
        tt * t.y * t.y + 2.0 * tb * t.y * b.y + bb * b.y * b.y,
        tt * t.y * t.z + tb * (t.y * b.z + t.z * b.y) + bb * b.y * b.z,
        tt * t.z * t.z + 2.0 * tb * t.z * b.z + bb * b.z * b.z,
    };
}

static void plane_basis(ty_double3 n, ty_double3* t, ty_double3* b)
{
    double s = copysign(1.0, n.z), a = -1.0 / (s + n.z), c = n.x * n.y * a;
    *t = (ty_double3){1.0 + s * n.x * n.x * a, s * c, -s * n.x};
    *b = (ty_double3){c, s + n.y * n.y * a, -n.y};
}

// Carries a tensor in the plane of from to the plane of to by the least rotation that takes one normal to the other.
static tensor3 rotate_tensor(const tensor3* a, ty_double3 from, ty_double3 to)
{
    ty_double3 t, b, axis = ty_double3_cross(from, to);
    plane_basis(from, &t, &b);
    double tt = quadratic(a, t, t), tb = quadratic(a, t, b), bb = quadratic(a, b, b);
    double cosine = ty_double3_dot(from, to), factor = 1.0 / (1.0 + cosine);
    if (cosine < -0.999)
        return tensor_from_plane(t, b, tt, tb, bb);
    ty_double3* sides[2] = {&t, &b};
    for (int i = 0; i < 2; i++)
    {
        ty_double3 v = *sides[i], cross = ty_double3_cross(axis, v);
        double along = ty_double3_dot(axis, v) * factor;
        *sides[i] = (ty_double3){v.x * cosine + cross.x + axis.x * along, v.y * cosine + cross.y + axis.y * along,
                                 v.z * cosine + cross.z + axis.z * along};
    }
    return tensor_from_plane(t, b, tt, tb, bb);
}

// The part of the triangle's area nearest to each corner (Meyer et al. 2003, section 3.3), so that a fan's weights do
// not depend on how it is cut.
static void corner_areas(const ty_double3 e[3], double area, double out[3])
{
    double l[3], bary[3];
    for (int k = 0; k < 3; k++)
        l[k] = ty_double3_dot(e[k], e[k]);
    double sum = 0.0;
    for (int k = 0; k < 3; k++)
    {
        // e[k] lies opposite corner k; barycentric weights of the circumcentre.
        bary[k] = l[k] * (l[(k + 1) % 3] + l[(k + 2) % 3] - l[k]);
        sum += bary[k];
    }
    for (int k = 0; k < 3; k++)
        if (bary[k] <= 0.0) // obtuse at k: half the area there
        {
            out[k] = 0.5 * area;
            out[(k + 1) % 3] = out[(k + 2) % 3] = 0.25 * area;
            return;
        }
    for (int k = 0; k < 3; k++)
        out[k] = 0.5 * area * (bary[(k + 1) % 3] + bary[(k + 2) % 3]) / sum;
}

// The symmetric tensor on (t, b) that explains the normals' differences along the three edges best: least squares on
// six equations, II e = dn, solved through its 3 x 3 normal equations.
static bool fit_triangle(const ty_double3 e[3], const ty_double3 dn[3], ty_double3 t, ty_double3 b, double out[3])
{
    double uu = 0.0, uv = 0.0, vv = 0.0, r[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 3; k++)
    {
        double u = ty_double3_dot(e[k], t), v = ty_double3_dot(e[k], b);
        double nu = ty_double3_dot(dn[k], t), nv = ty_double3_dot(dn[k], b);
        uu += u * u;
        uv += u * v;
        vv += v * v;
        r[0] += u * nu;
        r[1] += u * nv + v * nu;
        r[2] += v * nv;
    }
    // [uu uv 0; uv uu+vv uv; 0 uv vv] x = r.
    double trace = uu + vv, det = trace * (uu * vv - uv * uv);
    if (!(det > 1e-12 * trace * trace * trace))
        return false;
    double a00 = trace * vv - uv * uv, a01 = -uv * vv, a02 = uv * uv;
    double a11 = uu * vv, a12 = -uu * uv, a22 = uu * trace - uv * uv;
    out[0] = (a00 * r[0] + a01 * r[1] + a02 * r[2]) / det;
    out[1] = (a01 * r[0] + a11 * r[1] + a12 * r[2]) / det;
    out[2] = (a02 * r[0] + a12 * r[1] + a22 * r[2]) / det;
    return true;
}

static void add_triangle(curvature_field* field, size_t triangle)
{
    const ty_mesh* mesh = &field->view;
    ty_double3 cross = ty_triangle_cross(mesh, triangle), e[3], dn[3];
    double area = 0.5 * sqrt(ty_double3_dot(cross, cross)), areas[3], form[3];
    if (!(area > 0.0))
        return;
    uint32_t w[3];
    for (int k = 0; k < 3; k++)
        w[k] = mesh->welds[mesh->triangles[triangle][k]];
    for (int k = 0; k < 3; k++)
    {
        uint32_t p = w[(k + 1) % 3], q = w[(k + 2) % 3];
        e[k] = ty_double3_between(mesh->positions[p], mesh->positions[q]);
        dn[k] = (ty_double3){field->normals[q].x - field->normals[p].x, field->normals[q].y - field->normals[p].y,
                             field->normals[q].z - field->normals[p].z};
    }
    corner_areas(e, area, areas);
    ty_double3 n = ty_double3_scale(cross, 0.5 / area), t = ty_double3_normalize(e[0]), b = ty_double3_cross(n, t);
    bool fits = fit_triangle(e, dn, t, b, form);
    tensor3 tensor = fits ? tensor_from_plane(t, b, form[0], form[1], form[2]) : (tensor3){0};
    for (int k = 0; k < 3 && fits; k++)
    {
        tensor3 turned = rotate_tensor(&tensor, n, field->normals[w[k]]);
        add_scaled(&field->tensors[w[k]], &turned, areas[k]);
        field->areas[w[k]] += areas[k];
    }
}

// Vertices at one position are one vertex where their normals are within a degree. At most 8 normals are told apart at
// one position, so that no input makes this slow; further ones stay alone.
static uint32_t* weld_by_normal(const ty_mesh* mesh)
{
    enum
    {
        chain_limit = 8
    };
    const float least = 0.99985f;
    uint32_t* welds = TY_ALLOC(uint32_t, mesh->vertex_count);
    uint32_t* next = TY_ALLOC(uint32_t, mesh->vertex_count); // representative at the same position, 0 = end
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        uint32_t at = mesh->welds[i];
        int length = 1;
        while (at != i && ty_dot(mesh->normals[at], mesh->normals[i]) < least && next[at] && length++ < chain_limit)
            at = next[at];
        bool same = at == i || ty_dot(mesh->normals[at], mesh->normals[i]) >= least;
        if (!same && length < chain_limit)
            next[at] = i;
        welds[i] = same ? at : i;
    }
    ty_free(next);
    return welds;
}

static void field_init(curvature_field* field, const ty_mesh* mesh)
{
    size_t n = mesh->vertex_count;
    field->view = *mesh;
    field->view.welds = weld_by_normal(mesh);
    field->normals = TY_ALLOC(ty_double3, n);
    field->areas = TY_ALLOC(double, n);
    field->tensors = TY_ALLOC(tensor3, n);
    for (size_t i = 0; i < n; i++)
    {
        ty_double3* sum = &field->normals[field->view.welds[i]];
        ty_vec3 v = mesh->normals[i];
        *sum = (ty_double3){sum->x + (double)v.x, sum->y + (double)v.y, sum->z + (double)v.z};
    }
    for (size_t i = 0; i < n; i++)
    {
        ty_double3 unit = ty_double3_normalize(field->normals[i]);
        field->normals[i] = ty_double3_dot(unit, unit) > 0.0 ? unit : (ty_double3){0, 1, 0};
    }
    for (size_t t = 0; t < mesh->triangle_count; t++)
        if (!ty_triangle_is_collapsed(&field->view, t))
            add_triangle(field, t);
    for (size_t i = 0; i < n; i++)
    {
        tensor3 sum = field->tensors[i];
        field->tensors[i] = (tensor3){0};
        if (field->areas[i] > 0.0)
            add_scaled(&field->tensors[i], &sum, 1.0 / field->areas[i]);
    }
}

static void field_term(curvature_field* field)
{
    ty_free(field->view.welds);
    ty_free(field->normals);
    ty_free(field->areas);
    ty_free(field->tensors);
}

// The edges without repetition, as pairs of vertices.
static uint32_t (*collect_edges(const ty_mesh* mesh, size_t* edge_count))[2]
{
    size_t count, n = 0;
    size_t* sorted = ty_mesh_sort_half_edges(mesh, &count);
    uint32_t(*edges)[2] = ty_alloc(count, sizeof(*edges));
    for (size_t i = 0; i < count; i += ty_half_edge_run(mesh, sorted, i, count))
    {
        edges[n][0] = ty_half_edge_start(mesh, sorted[i]);
        edges[n++][1] = ty_half_edge_end(mesh, sorted[i]);
    }
    ty_free(sorted);
    *edge_count = n;
    return edges;
}

static double edge_length(const ty_mesh* mesh, const uint32_t edge[2])
{
    ty_double3 d = ty_double3_between(mesh->positions[edge[0]], mesh->positions[edge[1]]);
    return sqrt(ty_double3_dot(d, d));
}

// One pass over the one-rings: weight area * exp(-d^2 / (2 l^2)) with l the mean edge length at the vertex; the
// neighbour's tensor is first carried into the vertex's plane.
static void smooth_tensors(curvature_field* field, uint32_t (*edges)[2], size_t edge_count, const double* widths)
{
    size_t n = field->view.vertex_count;
    tensor3* sums = TY_ALLOC(tensor3, n);
    double* weights = TY_ALLOC(double, n);
    for (size_t i = 0; i < n; i++)
    {
        add_scaled(&sums[i], &field->tensors[i], field->areas[i]);
        weights[i] = field->areas[i];
    }
    for (size_t i = 0; i < edge_count; i++)
    {
        double length = edge_length(&field->view, edges[i]);
        for (int side = 0; side < 2; side++)
        {
            uint32_t to = edges[i][side], from = edges[i][1 - side];
            double ratio = length / widths[to];
            double weight = field->areas[from] * (double)ty_exp((float)(-0.5 * ratio * ratio));
            tensor3 turned = rotate_tensor(&field->tensors[from], field->normals[from], field->normals[to]);
            add_scaled(&sums[to], &turned, weight);
            weights[to] += weight;
        }
    }
    for (size_t i = 0; i < n; i++)
    {
        field->tensors[i] = (tensor3){0};
        if (weights[i] > 0.0)
            add_scaled(&field->tensors[i], &sums[i], 1.0 / weights[i]);
    }
    ty_free(weights);
    ty_free(sums);
}

static void smooth_passes(curvature_field* field, int passes)
{
    size_t n = field->view.vertex_count, edge_count;
    uint32_t(*edges)[2] = collect_edges(&field->view, &edge_count);
    double* widths = TY_ALLOC(double, n);
    uint32_t* valence = TY_ALLOC(uint32_t, n);
    for (size_t i = 0; i < edge_count; i++)
        for (int side = 0; side < 2; side++)
        {
            widths[edges[i][side]] += edge_length(&field->view, edges[i]);
            valence[edges[i][side]]++;
        }
    for (size_t i = 0; i < n; i++)
        widths[i] = widths[i] > 0.0 ? widths[i] / valence[i] : 1.0;
    for (int pass = 0; pass < passes; pass++)
        smooth_tensors(field, edges, edge_count, widths);
    ty_free(valence);
    ty_free(widths);
    ty_free(edges);
}

static void write_vertex(ty_mesh* mesh, const curvature_field* field, uint32_t i)
{
    uint32_t w = field->view.welds[i];
    ty_double3 t, b;
    plane_basis(field->normals[w], &t, &b);
    const tensor3* a = &field->tensors[w];
    ty_curvature_tensor form = {(float)quadratic(a, t, t), (float)quadratic(a, t, b), (float)quadratic(a, b, b)};
    ty_vec3 direction;
    ty_curvature_decompose(form, (ty_vec3){(float)t.x, (float)t.y, (float)t.z},
                           (ty_vec3){(float)b.x, (float)b.y, (float)b.z}, &mesh->curvature_1[i], &mesh->curvature_2[i],
                           &direction);
    ty_vec3 n = mesh->normals[i];
    mesh->direction_1[i] = ty_normalize(ty_sub(direction, ty_mul(n, ty_dot(n, direction))));
}

void ty_mesh_compute_curvature(ty_mesh* mesh, int smoothing)
{
    if (!mesh->welds)
        ty_mesh_compute_welds(mesh);
    curvature_field field;
    field_init(&field, mesh);
    if (smoothing > 0)
        smooth_passes(&field, smoothing);
    ty_free(mesh->curvature_1);
    ty_free(mesh->curvature_2);
    ty_free(mesh->direction_1);
    mesh->curvature_1 = TY_ALLOC(float, mesh->vertex_count);
    mesh->curvature_2 = TY_ALLOC(float, mesh->vertex_count);
    mesh->direction_1 = TY_ALLOC(ty_vec3, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        write_vertex(mesh, &field, i);
    field_term(&field);
}
